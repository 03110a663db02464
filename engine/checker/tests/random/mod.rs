//! Graphs from dice: buffers, images with mips and layers, depth images, imports in every kind of state (another
//! queue family's too), exports, histories, forwarded and culled passes.

use airglow_graph::{
    Access, Buffer, BufferDesc, Graph, GraphError, Handle, Image, ImageDesc, LeftOut, Limits, Options,
    PassBuilder, PassKind, Plan, RelativeExtent, State,
};
use ash::vk;
use proptest::prelude::*;

const MIPS: u32 = 3;
const LAYERS: u32 = 2;
const OTHER_FAMILY: u32 = 7;
const RESOURCES: usize = 10;

/// One use, as dice: which resource, access and part; how old a version; write some or all.
type UseDice = (usize, usize, usize, usize, bool);

#[derive(Clone, Debug)]
pub struct Dice {
    /// Per import: entry and exit.
    imports: Vec<(usize, usize)>,
    /// Per pass: its kind, whether it has a side effect or is left out, and its uses.
    passes: Vec<(usize, Vec<UseDice>)>,
    exports: Vec<(usize, usize)>,
}

pub fn dice() -> impl Strategy<Value = Dice> {
    let used = (0..RESOURCES, 0..64usize, 0..6usize, 0..8usize, any::<bool>());
    let pass = (0..16usize, prop::collection::vec(used, 1..5));
    let imports = prop::collection::vec((0..32usize, 0..32usize), 4);
    let exports = prop::collection::vec((0..RESOURCES, 0..32usize), 0..3);
    (imports, prop::collection::vec(pass, 1..12), exports).prop_map(|(imports, passes, exports)| Dice {
        imports,
        passes,
        exports,
    })
}

/// Host states to choose from.
fn state(die: usize, depth: bool) -> State {
    use Access as U;
    let colour = [
        U::FragmentSampled,
        U::ComputeStorageRead,
        U::ComputeStorageWrite,
        U::ColorAttachmentWrite,
        U::TransferSource,
        U::VertexSampled,
    ];
    let deep = [
        U::FragmentSampledDepth,
        U::DepthAttachmentReadWrite,
        U::DepthAttachmentRead,
        U::DepthAttachmentWrite,
        U::TransferSource,
        U::ComputeSampledDepth,
    ];
    let accesses = if depth { deep } else { colour };
    match die {
        0..=3 => State::idle(vk::ImageLayout::GENERAL),
        4..=9 => State::of(accesses[die % 6]).on_queue_family(OTHER_FAMILY),
        10 => everything(vk::AccessFlags2::MEMORY_READ),
        11 => everything(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE),
        _ => State::of(accesses[die % 6]),
    }
}

/// What a host says that does not track its stages.
fn everything(access: vk::AccessFlags2) -> State {
    State { stage: vk::PipelineStageFlags2::ALL_COMMANDS, access, ..State::idle(vk::ImageLayout::GENERAL) }
}

type Filled = [[bool; LAYERS as usize]; MIPS as usize];

/// What the generator knows about a resource: each version's handle and which subresources it fills.
enum Known {
    Buffer(Vec<(Handle<Buffer>, bool)>),
    Image { versions: Vec<(Handle<Image>, Filled)>, depth: bool, read_only: bool },
}

fn resources(graph: &mut Graph<u32>, dice: &Dice) -> Vec<Known> {
    let buffer = BufferDesc { size: 64, usage: vk::BufferUsageFlags::from_raw(0x1ff) };
    let format = vk::Format::R16G16B16A16_SFLOAT;
    let usage = vk::ImageUsageFlags::from_raw(0x1f);
    let colour = ImageDesc { mips: MIPS, layers: LAYERS, usage, ..ImageDesc::new_2d(8, 8, format) };
    let usage = vk::ImageUsageFlags::from_raw(0x2f);
    let deep = ImageDesc { format: vk::Format::D32_SFLOAT, usage, ..colour };
    let (empty, full) = ([[false; LAYERS as usize]; MIPS as usize], [[true; LAYERS as usize]; MIPS as usize]);
    let image =
        |handle, filled, depth| Known::Image { versions: vec![(handle, filled)], depth, read_only: false };
    let half = graph.create_image("image", colour);
    graph.size_relative(&half, RelativeExtent::of_frame(1, 2));
    let mut known = vec![
        Known::Buffer(vec![(graph.create_buffer("buffer", buffer), false)]),
        image(graph.create_image("image", colour), empty, false),
        image(half, empty, false),
        image(graph.create_image("depth", deep), empty, true),
    ];
    for (i, (entry, exit)) in dice.imports.iter().enumerate() {
        let depth = i == 3;
        let (entry, exit) = (state(*entry, depth), state(*exit, depth));
        known.push(match i {
            0 => Known::Buffer(vec![(graph.import_buffer("host buffer", buffer, entry, exit), true)]),
            3 => image(graph.import_image("host depth", deep, entry, exit), full, true),
            _ => image(graph.import_image("host image", colour, entry, exit), full, false),
        });
    }
    let history = graph.history_image("history", colour, Access::FragmentSampled);
    let previous = vec![(history.previous, full)];
    known.push(Known::Image { versions: previous, depth: false, read_only: true });
    known.push(image(history.current, empty, false));
    known
}

/// Base and count of mips, then of layers.
const PARTS: [[u32; 4]; 6] =
    [[0, 3, 0, 2], [0, 1, 0, 2], [1, 1, 0, 1], [1, 2, 0, 2], [2, 1, 1, 1], [0, 3, 1, 1]];

pub fn build(dice: &Dice) -> Graph<u32> {
    let mut graph = Graph::new();
    let mut known = resources(&mut graph, dice);
    for (i, (die, uses)) in dice.passes.iter().enumerate() {
        if *die == 15 {
            forward(&mut graph, &mut known, uses[0].0);
            continue;
        }
        let kind = [PassKind::Graphics, PassKind::Compute, PassKind::Graphics, PassKind::Transfer][*die % 4];
        let suits: Vec<Access> = Access::ALL.into_iter().filter(|a| suits(*a, kind)).collect();
        let mut pass = graph.pass("pass", kind);
        let mut taken: Vec<usize> = Vec::new();
        for (resource, access, part, age, some) in uses {
            // One use of a resource a pass, so that nothing overlaps.
            let access = suits[access % suits.len()];
            if !taken.contains(resource)
                && declare(&mut pass, &mut known[*resource], access, PARTS[*part], *age, *some)
            {
                taken.push(*resource);
            }
        }
        if *die >= 8 {
            pass.side_effect();
        }
        pass.record(i as u32);
    }
    finish_history(&mut graph, &known[RESOURCES - 1]);
    export(&mut graph, &known, dice);
    graph
}

/// A pass that is left out: what it would have written is forwarded.
fn forward(graph: &mut Graph<u32>, known: &mut [Known], resource: usize) {
    let left_out = LeftOut {
        what: "pass".to_owned(),
        why: "the dice say so".to_owned(),
        bytes: 0,
        time: None,
        would_return: "other dice".to_owned(),
    };
    if let Known::Image { versions, .. } = &mut known[resource] {
        let newest = versions.len() - 1;
        versions[newest].0 = graph.forward(versions[newest].0, left_out);
    }
}

/// All of the current half has to be written.
fn finish_history(graph: &mut Graph<u32>, current: &Known) {
    let Known::Image { versions, .. } = current else { return };
    let mut pass = graph.pass("finish history", PassKind::Compute);
    if let Some((handle, _)) = versions.last() {
        pass.write(handle.whole(), Access::ComputeStorageWrite);
    }
    pass.record(0);
}

fn export(graph: &mut Graph<u32>, known: &[Known], dice: &Dice) {
    let mut exported = Vec::new();
    for (resource, die) in &dice.exports {
        // The halves of a history leave in their resting state.
        if exported.contains(resource) || *resource >= RESOURCES - 2 {
            continue;
        }
        exported.push(*resource);
        match &known[*resource] {
            Known::Buffer(versions) => match versions.last() {
                Some((handle, true)) => graph.export(*handle, state(*die, false)),
                _ => continue,
            },
            Known::Image { versions, depth, .. } => match versions.last() {
                Some((handle, filled)) if filled[0] == [true; 2] => {
                    graph.export(handle.whole().mip(0), state(*die, *depth))
                }
                _ => continue,
            },
        }
    }
}

fn suits(access: Access, kind: PassKind) -> bool {
    use vk::PipelineStageFlags2 as S;
    let anywhere = access.stage().intersects(S::ALL_TRANSFER);
    let indirect = access == Access::IndirectBuffer && kind != PassKind::Transfer;
    let compute = access.stage().contains(S::COMPUTE_SHADER);
    let host = access.stage().intersects(S::HOST) || access.stage().is_empty();
    let own = match kind {
        PassKind::Graphics => !compute && !host,
        PassKind::Compute => compute,
        PassKind::Transfer => false,
    };
    anywhere || indirect || own
}

/// Declares one use if it makes sense, and says whether it did.
fn declare(
    pass: &mut PassBuilder<'_, u32>,
    known: &mut Known,
    access: Access,
    part: [u32; 4],
    age: usize,
    some: bool,
) -> bool {
    use Access as U;
    let loads = matches!(access, U::ColorAttachmentWrite | U::DepthAttachmentWrite);
    let update = access.keeps_contents() || (some && !loads);
    let version = |count: usize| match access.writes() {
        true => count - 1,
        false => (count - 1).saturating_sub(age / 6),
    };
    match known {
        Known::Buffer(versions) => {
            let (handle, filled) = versions[version(versions.len())];
            if access.buffer_usage().is_empty() || ((update || !access.writes()) && !filled) {
                return false;
            }
            match access.writes() {
                true => versions.push((write(pass, handle, access, update), true)),
                false => _ = pass.read(&handle, access),
            }
        }
        Known::Image { versions, depth, read_only } => {
            let (handle, mut filled) = versions[version(versions.len())];
            let [mip, mips, layer, layers] = part;
            let here = (mip..mip + mips).flat_map(|m| (layer..layer + layers).map(move |l| (m, l)));
            let full = here.clone().all(|(m, l)| filled[m as usize][l as usize]);
            let needs = update || !access.writes();
            let unsuitable = access.image_usage().is_empty() || !suits_format(access, *depth);
            if unsuitable || (needs && !full) || (*read_only && access.writes()) {
                return false;
            }
            let handle = handle.whole().mips(mip, mips).layers(layer, layers);
            if access.writes() {
                here.for_each(|(m, l)| filled[m as usize][l as usize] = true);
                versions.push((write(pass, handle, access, update), filled));
            } else {
                pass.read(&handle, access);
            }
        }
    }
    true
}

fn write<T: airglow_graph::Kind>(
    pass: &mut PassBuilder<'_, u32>,
    handle: Handle<T>,
    access: Access,
    update: bool,
) -> Handle<T> {
    if update { pass.update(handle, access) } else { pass.write(handle, access) }
}

/// Colour accesses for colour formats, depth accesses for depth formats, copies for both.
fn suits_format(access: Access, depth: bool) -> bool {
    let deep = format!("{access:?}").contains("Depth");
    let copies = matches!(access, Access::TransferSource | Access::TransferDestination);
    copies || deep == depth
}

/// `None` where reads of old versions make a cycle, which is an error as it should be.
pub fn compile(dice: &Dice, seed: Option<u64>) -> Option<Plan<u32>> {
    let options = Options { seed, frame_extent: Some([16, 15]) };
    match build(dice).compile_with(&Limits::default(), &options) {
        Ok(plan) => Some(plan),
        Err(GraphError::Cycle { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}
