//! What it costs to see an environment through fog: the map at full size, and a smaller one of its glow alone.
//!
//! ```text
//! cargo run --release -p airglow-fog --example background
//! ```
//!
//! Milliseconds from submission to the end of a frame, the least of three: work of the frame in which the environment or
//! the medium changes, none in others.

use std::time::Instant;

use airglow_fog::{Background, Distant, Fog, FogError, Seen, Settings};
use airglow_graph::{Access, State};
use airglow_tests::device::fixture_with;

#[path = "../tests/gpu/maps.rs"]
mod maps;

/// A sky with a small sun.
fn sky([width, height]: [u32; 2]) -> Vec<[f32; 4]> {
    let texel = |i: u32| {
        let (x, y) = (i % width, i / width);
        let sky = 0.5 - 0.4 * y as f32 / height as f32;
        if (x, y) == (width / 3, height / 4) { [9e4, 7e4, 5e4, 1.0] } else { [sky, sky, 1.2 * sky, 1.0] }
    };
    (0..width * height).map(texel).collect()
}

fn main() -> Result<(), FogError> {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let distants = [
        ("grey", Distant { optical_distance: [0.5; 3], albedo: [1.0; 3] }),
        ("three extinctions", Distant { optical_distance: [0.4, 0.5, 0.6], albedo: [1.0; 3] }),
    ];
    for (size, target, seen) in [
        ([128, 64], [128, 64], Seen::Whole),
        ([256, 128], [256, 128], Seen::Whole),
        ([256, 128], [64, 32], Seen::Glow),
        ([1024, 512], [64, 32], Seen::Glow),
    ] {
        let map = maps::uploaded(&fixture, size, &sky(size));
        let image = maps::target(&fixture, target);
        let background = Background::new(fixture.context(), size, maps::FORMAT)?;
        for (name, distant) in &distants {
            let mut least = f64::INFINITY;
            for _ in 0..3 {
                let start = Instant::now();
                let recorded = fixture.device().run(fixture.context(), |recorder| {
                    recorder.transition(&image, State::UNDEFINED, Access::ColorAttachmentWrite)?;
                    let (map, image) = (map.full_view()?, image.full_view()?);
                    Ok(background.record(recorder, &map, &image, distant, seen))
                });
                recorded??;
                least = least.min(1e3 * start.elapsed().as_secs_f64());
            }
            let texels = f64::from(target[0] * target[1]);
            println!(
                "environment {size:?}, map {target:?}, {seen:?}, {name}: {least:.0} ms, {:.3} ms a texel",
                least / texels
            );
        }
    }
    Ok(())
}
