//! Random graphs: the same declaration gives the same plan, an independent checker accepts it, and with any
//! one barrier dropped or two dependent steps swapped it refuses.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, its helpers too")]

mod checker;

use airglow_graph::{
    Access, BufferDesc, Graph, GraphError, Handle, Image, ImageDesc, Limits, PassKind, Plan, State,
};
use ash::vk;
use checker::Trace;
use proptest::prelude::*;
use proptest::strategy::ValueTree;

const MIPS: u32 = 3;
const LAYERS: u32 = 2;
const FAMILY: u32 = 0;

/// One use, as dice: which resource, access and part; how old a version; write some or all.
type UseDice = (usize, usize, usize, usize, bool);

#[derive(Clone, Debug)]
struct Dice {
    /// Per import: entry and exit.
    imports: Vec<(usize, usize)>,
    /// Per pass: its kind and whether it has a side effect, and its uses.
    passes: Vec<(usize, Vec<UseDice>)>,
    exports: Vec<(usize, usize)>,
}

fn dice() -> impl Strategy<Value = Dice> {
    let used = (0..6usize, 0..64usize, 0..6usize, 0..8usize, any::<bool>());
    let pass = (0..8usize, prop::collection::vec(used, 1..5));
    let imports = prop::collection::vec((0..32usize, 0..32usize), 3);
    let exports = prop::collection::vec((0..6usize, 0..32usize), 0..3);
    (imports, prop::collection::vec(pass, 1..12), exports).prop_map(|(imports, passes, exports)| Dice {
        imports,
        passes,
        exports,
    })
}

/// Host states to choose from; those of images only have a layout.
fn state(die: usize) -> State {
    use Access as U;
    let accesses = [
        U::FragmentSampled,
        U::ComputeStorageRead,
        U::ComputeStorageWrite,
        U::ColorAttachmentWrite,
        U::TransferSource,
        U::VertexSampled,
    ];
    match die {
        0..=3 => State::idle(vk::ImageLayout::GENERAL),
        4..=7 => State::of(accesses[die % 6]).on_queue_family(7),
        _ => State::of(accesses[die % 6]),
    }
}

/// What the generator knows about a resource: each version's handle and which subresources it fills.
#[derive(Clone)]
enum Known {
    Buffer(Vec<(Handle<airglow_graph::Buffer>, bool)>),
    Image(Vec<(Handle<Image>, [[bool; LAYERS as usize]; MIPS as usize])>),
}

fn resources(graph: &mut Graph<u32>, dice: &Dice) -> Vec<Known> {
    let buffer = BufferDesc { size: 64, usage: vk::BufferUsageFlags::from_raw(0x1ff) };
    let format = vk::Format::R16G16B16A16_SFLOAT;
    let usage = vk::ImageUsageFlags::from_raw(0x1f);
    let image = ImageDesc { mips: MIPS, layers: LAYERS, usage, ..ImageDesc::new_2d(8, 8, format) };
    let empty = [[false; LAYERS as usize]; MIPS as usize];
    let full = [[true; LAYERS as usize]; MIPS as usize];
    let mut known = vec![
        Known::Buffer(vec![(graph.create_buffer("buffer", buffer), false)]),
        Known::Image(vec![(graph.create_image("image", image), empty)]),
        Known::Image(vec![(graph.create_image("image", image), empty)]),
    ];
    for (i, (entry, exit)) in dice.imports.iter().enumerate() {
        let (entry, exit) = (state(*entry), state(*exit));
        known.push(match i {
            0 => Known::Buffer(vec![(graph.import_buffer("host buffer", buffer, entry, exit), true)]),
            _ => Known::Image(vec![(graph.import_image("host image", image, entry, exit), full)]),
        });
    }
    known
}

/// Base and count of mips, then of layers.
const PARTS: [[u32; 4]; 6] =
    [[0, 3, 0, 2], [0, 1, 0, 2], [1, 1, 0, 1], [1, 2, 0, 2], [2, 1, 1, 1], [0, 3, 1, 1]];

fn build(dice: &Dice) -> Graph<u32> {
    let mut graph = Graph::new();
    let mut known = resources(&mut graph, dice);
    let accesses: Vec<Access> = Access::ALL.to_vec();
    for (i, (kind, uses)) in dice.passes.iter().enumerate() {
        let has_side_effect = *kind >= 4;
        let kind = [PassKind::Graphics, PassKind::Compute, PassKind::Compute, PassKind::Transfer][*kind % 4];
        let suits: Vec<Access> = accesses.iter().copied().filter(|a| suits(*a, kind)).collect();
        let mut pass = graph.pass("pass", kind);
        let mut taken: Vec<usize> = Vec::new();
        for (resource, access, part, age, some) in uses {
            // One use of a resource a pass, so that nothing overlaps.
            if taken.contains(resource) {
                continue;
            }
            let access = suits[access % suits.len()];
            if declare(&mut pass, &mut known[*resource], access, PARTS[*part], *age, *some) {
                taken.push(*resource);
            }
        }
        if has_side_effect {
            pass.side_effect();
        }
        pass.record(i as u32);
    }
    let mut exported = Vec::new();
    for (resource, die) in &dice.exports {
        if exported.contains(resource) {
            continue;
        }
        exported.push(*resource);
        match &known[*resource] {
            Known::Buffer(versions) => match versions.last() {
                Some((handle, true)) => graph.export(*handle, state(*die)),
                _ => continue,
            },
            Known::Image(versions) => match versions.last() {
                Some((handle, filled)) if filled[0] == [true; 2] => {
                    graph.export(handle.whole().mip(0), state(*die))
                }
                _ => continue,
            },
        }
    }
    graph
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
    pass: &mut airglow_graph::PassBuilder<'_, u32>,
    known: &mut Known,
    access: Access,
    part: [u32; 4],
    age: usize,
    some: bool,
) -> bool {
    use Access as U;
    let loads = matches!(access, U::ColorAttachmentWrite | U::DepthAttachmentWrite);
    let update = access.keeps_contents() || (some && !loads);
    match known {
        Known::Buffer(versions) => {
            let newest = versions.len() - 1;
            let (handle, filled) =
                versions[if access.writes() { newest } else { newest.saturating_sub(age / 6) }];
            if access.buffer_usage().is_empty() || (update && !filled) {
                return false;
            }
            if access.writes() {
                let next = if update { pass.update(handle, access) } else { pass.write(handle, access) };
                versions.push((next, true));
            } else if filled {
                pass.read(&handle, access);
            }
            filled || access.writes()
        }
        Known::Image(versions) => {
            let newest = versions.len() - 1;
            let (handle, mut filled) =
                versions[if access.writes() { newest } else { newest.saturating_sub(age / 6) }];
            let depth = format!("{access:?}").contains("Depth");
            let [mip, mips, layer, layers] = part;
            let here = (mip..mip + mips).flat_map(|m| (layer..layer + layers).map(move |l| (m, l)));
            let full = here.clone().all(|(m, l)| filled[m as usize][l as usize]);
            let needs = update || !access.writes();
            if access.image_usage().is_empty() || depth || (needs && !full) {
                return false;
            }
            let handle = handle.whole().mips(mip, mips).layers(layer, layers);
            if access.writes() {
                let next = if update { pass.update(handle, access) } else { pass.write(handle, access) };
                here.for_each(|(m, l)| filled[m as usize][l as usize] = true);
                versions.push((next, filled));
            } else {
                pass.read(&handle, access);
            }
            true
        }
    }
}

/// `None` where reads of old versions make a cycle, which is an error as it should be.
fn compile(dice: &Dice) -> Option<Plan<u32>> {
    match build(dice).compile(&Limits { queue_family: FAMILY, ..Limits::default() }) {
        Ok(plan) => Some(plan),
        Err(GraphError::Cycle { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}

/// Whether one of two neighbouring steps reads what the other writes. (Two writes that nobody reads in between
/// may be swapped.)
fn depend(trace: &Trace, step: usize) -> bool {
    let pairs = trace.steps[step].1.iter().flat_map(|a| trace.steps[step + 1].1.iter().map(move |b| (a, b)));
    let mut pairs = pairs.filter(|(a, b)| a.resource == b.resource && a.range.overlaps(b.range));
    pairs.any(|(a, b)| (a.output.is_some() && b.keeps_contents) || (a.keeps_contents && b.output.is_some()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_plans_are_deterministic_and_synchronised(dice in dice()) {
        let Some(plan) = compile(&dice) else { return Ok(()) };
        let again = compile(&dice).map(|plan| plan.text());
        prop_assert_eq!(Some(plan.text()), again);
        let trace = Trace::of(&plan, FAMILY);
        if let Err(error) = trace.check() {
            return Err(TestCaseError::fail(format!("{error}\n{}", plan.text())));
        }
    }

    #[test]
    fn the_checker_notices_every_dropped_barrier_and_swapped_step(dice in dice()) {
        let Some(plan) = compile(&dice) else { return Ok(()) };
        let trace = Trace::of(&plan, FAMILY);
        for (i, mutant) in trace.without_one_barrier().into_iter().enumerate() {
            prop_assert!(mutant.check().is_err(), "barrier {} is redundant\n{}", i, plan.text());
        }
        for step in 0..trace.steps.len().saturating_sub(1) {
            if depend(&trace, step) {
                let mut mutant = trace.clone();
                mutant.steps.swap(step, step + 1);
                prop_assert!(mutant.check().is_err(), "steps {step} and next swapped\n{}", plan.text());
            }
        }
    }
}

/// The properties above would hold of empty plans too: these are not.
#[test]
fn random_graphs_are_worth_checking() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut compiled, mut steps, mut barriers) = (0, 0, 0);
    for _ in 0..200 {
        let dice = dice().new_tree(&mut runner).map(|tree| tree.current());
        let Some(plan) = dice.ok().as_ref().and_then(compile) else { continue };
        compiled += 1;
        steps += plan.steps().len();
        barriers += Trace::of(&plan, FAMILY).without_one_barrier().len();
    }
    println!("{compiled} of 200 compiled, {steps} steps, {barriers} barriers");
    assert!(compiled > 100 && steps > 3 * compiled && barriers > 4 * compiled);
}
