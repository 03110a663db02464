//! The evaluator of the room of normal maps: `normals`.

use std::path::Path;

use airglow::normals::eval::{self, Evaluated, TexelRow};
use airglow::normals::{Bench, Brdf, Method, NormalMap};
use airglow_scene::image_io::read_image;
use airglow_scene::srgb_encode;
use glam::DVec3;

use super::table::Table;
use super::{Columns, Settings, accepted, number, rejoin};
use crate::failure::{Failure, Outcome};

/// `normals`: level, x, y, light, view, brdf and, if there, method in, radiance out.
pub fn normals(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let path = settings.get("map").ok_or_else(|| {
        Failure::usage("normals needs the map: --set map=FILE.png (xyz * 0.5 + 0.5) or FILE.exr".to_owned())
    })?;
    let map = read_map(Path::new(path))?;
    let read = |row| {
        let number = |column| table.number(row, column);
        let vector =
            |[x, y, z]: [&'static str; 3]| Ok::<_, String>(DVec3::new(number(x)?, number(y)?, number(z)?));
        let method = table.word(row, "method", "default")?;
        Ok(TexelRow {
            level: table.whole(row, "level", 0..=map.levels() - 1)?,
            x: table.whole(row, "x", 0..=map.size(0)[0])?,
            y: table.whole(row, "y", 0..=map.size(0)[1])?,
            light: vector(["lx", "ly", "lz"])?,
            view: vector(["vx", "vy", "vz"])?,
            brdf: brdf(table.word(row, "brdf", "")?)?,
            method: method.parse::<Method>().map_err(|error| error.to_string())?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    let results = eval::texels(bench, &map, &rows).map_err(Failure::work)?;
    let rows =
        rejoin(places, results, |Evaluated { value, reference }| (vec![vec![value]], vec![vec![reference]]));
    Ok(Columns { rows })
}

/// A map from an EXR file, the vectors themselves, or from a PNG file, whose components were decoded as colours.
fn read_map(path: &Path) -> Outcome<NormalMap> {
    let image = read_image(path).map_err(Failure::input)?;
    let vectors: Vec<[f32; 3]> = match path.extension().and_then(|extension| extension.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("png") => {
            image.pixels.iter().map(|rgb| rgb.map(|value| 2.0 * srgb_encode(value) - 1.0)).collect()
        }
        _ => image.pixels,
    };
    NormalMap::from_vectors(image.width, image.height, &vectors)
        .map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

/// `lambert`, `blinn:n` or `ggx:a`.
fn brdf(text: &str) -> Result<Brdf, String> {
    let (name, value) = text.split_once(':').unwrap_or((text, ""));
    let value = number::parse(value);
    match (name, value) {
        ("lambert", _) if text == name => Ok(Brdf::Lambert),
        ("blinn", Ok(exponent)) => Ok(Brdf::BlinnPhong { exponent }),
        ("ggx", Ok(alpha)) => Ok(Brdf::Ggx { alpha }),
        _ => Err(format!("brdf is `{text}`; expected lambert, blinn:n or ggx:a")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn materials_are_read_or_refused() {
        assert_eq!(brdf("lambert"), Ok(Brdf::Lambert));
        assert_eq!(brdf("blinn:50"), Ok(Brdf::BlinnPhong { exponent: 50.0 }));
        assert_eq!(brdf("ggx:0.3"), Ok(Brdf::Ggx { alpha: 0.3 }));
        for bad in ["", "lambert:", "lambert:1", "blinn", "blinn:", "ggx:a", "phong:5"] {
            assert!(brdf(bad).unwrap_err().contains("expected lambert"), "{bad}");
        }
    }
}
