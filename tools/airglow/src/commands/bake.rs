//! `airglow bake`: the transfer of a scene, made or found.

use clap::Args;

use crate::failure::Outcome;
use crate::host::bake;
use crate::host::transfer::Account;
use crate::output::Output;
use crate::scene_options::SceneOptions;
use crate::text::bytes;

/// Bake the light transport of a scene: transfer vectors for each vertex, kept in the cache.
///
/// `render` bakes what it needs by itself; this command does it ahead, and says what it took. A bake is found again
/// by the content of its mesh, of what casts shadows on it, and of its settings.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  airglow bake assets/scenes/spot.toml --order 4 --rays 1024")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
}

/// Runs the command.
pub fn run(arguments: &Arguments, output: &Output) -> Outcome {
    let scene = arguments.scene.load(output)?;
    let baked = bake::of_scene(&scene, &scene.quality, &arguments.scene.cache, output)?;
    let quality = scene.quality;
    output.result(&baked.accounts, |accounts| {
        let mut text =
            format!("order {}, {} rays a vertex, {:?}\n", quality.order, quality.rays, quality.shadow);
        for account in accounts {
            text.push_str(&line(account, quality.order));
        }
        text
    })
}

fn line(account: &Account, order: u32) -> String {
    let size = bytes(4 * account.vertices as u64 * u64::from(order * order));
    let rate = if account.rays > 0 {
        format!(", {:.2} million rays/s", account.rays_per_second * 1e-6)
    } else {
        String::new()
    };
    let file = account.file.as_ref().map_or(String::new(), |file| format!("\n    {}", file.display()));
    format!(
        "{}: {} vertices, {} triangles cast shadows, {size}: {}{rate}{file}\n",
        account.name, account.vertices, account.occluders, account.source
    )
}
