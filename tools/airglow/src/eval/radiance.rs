//! The evaluator of the room of near emitters: `radiance-cube`.

use airglow::radiance::eval::{self, CubeRow, Evaluated, Method};
use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::{Incident, Triangle};
use glam::DVec3;

use super::table::Table;
use super::{Columns, Settings, accepted, rejoin};
use crate::failure::{Failure, Outcome};

/// `radiance-cube`: order, face, px, py, pz, triangles, radiance and, if there, method in, sh and distance out.
pub fn cube(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let rays = match settings.get("rays") {
        None => eval::default_rays(),
        Some(text) => {
            text.parse().map_err(|_| Failure::usage(format!("--set rays={text}: give 1, 2 or 4")))?
        }
    };
    let read = |row| {
        let number = |column| table.number(row, column);
        let radiance = table.numbers(row, "radiance")?;
        Ok(CubeRow {
            order: table.whole(row, "order", 1..=6)?,
            face: table.whole(row, "face", 1..=512)?,
            rays,
            point: DVec3::new(number("px")?, number("py")?, number("pz")?),
            triangles: triangles(&table.numbers(row, "triangles")?, &radiance)?,
            method: method(table.word(row, "method", "cube")?)?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    let results = eval::cubes(bench, &rows).map_err(Failure::work)?;
    let columns = |light: &Incident| {
        let sh = light.coefficients.iter().map(|l| l.x).collect();
        vec![sh, vec![light.distance()]]
    };
    let rows =
        rejoin(places, results, |Evaluated { value, reference }| (columns(&value), columns(&reference)));
    Ok(Columns { rows })
}

/// Nine numbers a triangle, and the radiance of each.
fn triangles(corners: &[f64], radiance: &[f64]) -> Result<Vec<Triangle>, String> {
    let (triangles, rest) = (corners.len() / 9, corners.len() % 9);
    if rest != 0 || radiance.len() != triangles {
        let (numbers, given) = (corners.len(), radiance.len());
        return Err(format!(
            "triangles has {numbers} numbers and radiance {given}; expected nine a triangle, and one"
        ));
    }
    let triangle = |(corners, radiance): (&[f64], &f64)| Triangle {
        corners: [0, 3, 6].map(|i| DVec3::new(corners[i], corners[i + 1], corners[i + 2])),
        radiance: DVec3::splat(*radiance),
    };
    Ok(corners.chunks_exact(9).zip(radiance).map(triangle).collect())
}

fn method(text: &str) -> Result<Method, String> {
    match text {
        "cube" => Ok(Method::Cube),
        "analytic" => Ok(Method::Analytic),
        _ => Err(format!("method is `{text}`; expected cube or analytic")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_and_methods_are_read_or_refused() {
        let corners: Vec<f64> = (0..18).map(f64::from).collect();
        let read = triangles(&corners, &[1.0, 2.0]).unwrap();
        assert_eq!(read[1].corners[2], DVec3::new(15.0, 16.0, 17.0));
        assert_eq!(read[1].radiance, DVec3::splat(2.0));
        assert_eq!(triangles(&[], &[]), Ok(Vec::new()));
        for (corners, radiance) in [(&corners[..17], &[1.0, 2.0][..]), (&corners[..], &[1.0])] {
            assert!(triangles(corners, radiance).unwrap_err().contains("expected nine"));
        }
        assert_eq!(method("analytic"), Ok(Method::Analytic));
        assert!(method("sphere").unwrap_err().contains("expected cube"));
    }
}
