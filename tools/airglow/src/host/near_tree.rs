//! The radiance pass's tree over a scene's vertices: built once with progress, and then read from the cache.

use std::ops::ControlFlow;
use std::path::Path;

use airglow::radiance::{Hierarchy, Node};
use airglow_bake::cache::Miss;
use airglow_bake::cache::container::{Container, Element, Field, key};
use airglow_scene::Scene;
use serde_json::{Map, Value};

use super::needed;
use super::placed::Placed;
use super::transfer::SceneTransfer;
use crate::failure::{Failure, Outcome};
use crate::output::Output;

/// The file: tensors `nodes`, U32 [nodes, 16], the words of [`Node`], and `vertices`, U32 [vertices]; `vertices` in the
/// metadata entry is their number, and `key` BLAKE3 over positions and transfer vectors.
const CONTAINER: Container = Container { entry: "airglow.radiance.tree", schema: 1 };
/// Words of a node.
const WORDS: usize = size_of::<Node>() / 4;

/// The tree of a scene whose emitters light anything; none for others.
pub fn of_scene(
    scene: &Scene,
    transfer: &SceneTransfer,
    cache: &Path,
    output: &Output,
) -> Outcome<Option<Hierarchy>> {
    if !needed::near_light(scene) {
        return Ok(None);
    }
    let placed = Placed::new(scene, transfer);
    std::fs::create_dir_all(cache).map_err(|error| Failure::file(cache, "making the cache folder", error))?;
    let bar = output.progress("tree", placed.positions.len() as u64, "vertices");
    let (tree, miss) =
        kept(&placed.positions, &placed.vectors, cache, &|vertices| bar.set_position(vertices as u64))?;
    bar.finish_and_clear();
    if let Some(miss) = miss {
        output.say(format!("built the tree over {} vertices ({miss})", placed.positions.len()));
    }
    Ok(Some(tree))
}

/// The tree from its file, or built and stored there, and why; `progress` hears of vertices placed.
fn kept(
    positions: &[[f32; 3]],
    vectors: &[f32],
    cache: &Path,
    progress: &dyn Fn(usize),
) -> Outcome<(Hierarchy, Option<Miss>)> {
    let key = key(CONTAINER, &[bytemuck::cast_slice(positions), bytemuck::cast_slice(vectors)]);
    let file = cache.join(format!("tree-{}.safetensors", &key[..16]));
    let miss = match load(&file, &key) {
        Ok(tree) => return Ok((tree, None)),
        Err(miss) => miss,
    };
    let tree = Hierarchy::build(positions, vectors, &mut |placed, _| {
        progress(placed);
        ControlFlow::Continue(())
    });
    let tree = tree.map_err(Failure::work)?;
    let vertices = tree.vertices().len();
    let words = |name, shape, bytes| Field { name, element: Element::U32, shape, bytes };
    let fields = [
        words("nodes", vec![tree.nodes().len(), WORDS], bytemuck::cast_slice(tree.nodes())),
        words("vertices", vec![vertices], bytemuck::cast_slice(tree.vertices())),
    ];
    let description = Map::from_iter([("vertices".to_owned(), Value::from(vertices))]);
    CONTAINER.store(&file, &key, description, &fields).map_err(Failure::work)?;
    Ok((tree, Some(miss)))
}

fn load(file: &Path, key: &str) -> Result<Hierarchy, Miss> {
    let bytes = Container::read(file)?;
    let mut opened = CONTAINER.open(&bytes, key)?;
    let count = opened.description.get("vertices").and_then(Value::as_u64).unwrap_or(0) as usize;
    let nodes = words(opened.field("nodes", &[(2 * count).saturating_sub(1), WORDS])?)?;
    let vertices = words(opened.field("vertices", &[count])?)?;
    opened.check()?;
    Hierarchy::from_parts(nodes, vertices).map_err(|error| Miss::Damaged(error.to_string()))
}

/// The values of a field, whose bytes need not be aligned.
fn words<T: bytemuck::AnyBitPattern>((element, bytes): (Element, &[u8])) -> Result<Vec<T>, Miss> {
    match element {
        Element::U32 => Ok(bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect()),
        Element::F32 | Element::F16 => Err(Miss::Damaged("a tensor is not of words".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_is_built_once_and_again_where_its_file_is_of_no_use() {
        let folder = tempfile::tempdir().unwrap();
        let positions: Vec<[f32; 3]> = (0..99).map(|i| [i as f32, (i as f32).sin(), 0.0]).collect();
        let take = |positions: &[[f32; 3]]| {
            let (tree, miss) = kept(positions, &[], folder.path(), &|_| ()).unwrap();
            (tree, miss.map(|miss| format!("{miss:?}")))
        };
        let (built, miss) = take(&positions);
        assert_eq!(miss.as_deref(), Some("Absent"));
        assert_eq!(take(&positions), (built.clone(), None));
        assert_eq!(take(&positions[1..]).1.as_deref(), Some("Absent"));
        let key = key(CONTAINER, &[bytemuck::cast_slice(&positions), &[]]);
        let file = folder.path().join(format!("tree-{}.safetensors", &key[..16]));
        let sound = std::fs::read(&file).unwrap();
        let mut flipped = sound.clone();
        *flipped.last_mut().unwrap() ^= 1;
        let name = CONTAINER.entry.as_bytes();
        let place = sound.windows(name.len()).position(|bytes| bytes == name).unwrap();
        let mut foreign = sound.clone();
        foreign[place..place + 7].copy_from_slice(b"another");
        for (bytes, reason) in [
            (sound[..sound.len() / 2].to_vec(), "Damaged"),
            (flipped, "Damaged"),
            (b"nothing".to_vec(), "Damaged"),
            (foreign, "Foreign"),
        ] {
            std::fs::write(&file, &bytes).unwrap();
            let (again, miss) = take(&positions);
            assert!(again == built && miss.as_ref().unwrap().starts_with(reason), "{miss:?} for {reason}");
            assert!(sound == std::fs::read(&file).unwrap(), "the file after {reason}");
        }
        assert_eq!(take(&positions), (built, None));
    }
}
