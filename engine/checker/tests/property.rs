//! Random graphs: the same declaration gives the same plan, the checker accepts it in every legal order, and
//! notices whatever is broken in it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, its helpers too")]

mod random;

use airglow_checker::{Kind, Mutation, Trace, check, check_sharing};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, Limits, PassKind, State};
use ash::vk;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use random::{Dice, compile, dice};
use std::collections::BTreeMap;

/// Seeds of the order, besides the declared one.
const SEEDS: u64 = 4;
/// Graphs whose every mutation is tried.
const MUTATED: usize = 3000;

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_plans_are_deterministic_and_sound_in_every_order(dice in dice()) {
        let Some(plan) = compile(&dice, None) else { return Ok(()) };
        let again = compile(&dice, None).map(|plan| plan.text());
        prop_assert_eq!(Some(plan.text()), again);
        for seed in std::iter::once(None).chain((0..SEEDS).map(Some)) {
            let plan = compile(&dice, seed).unwrap();
            let report = check(&plan).map_err(|e| TestCaseError::fail(format!("{e}\n{}", plan.text())))?;
            prop_assert!(report.redundant.is_empty(), "{report}\n{}", plan.text());
            let excess = Trace::of(&plan).excess();
            prop_assert!(excess.is_empty(), "{}\n{}", excess[0], plan.text());
        }
    }
}

/// The first `count` compiling graphs of a fixed row.
fn plans(count: usize) -> impl Iterator<Item = (Dice, Trace)> {
    let mut runner = TestRunner::deterministic();
    let dice = std::iter::from_fn(move || Some(dice().new_tree(&mut runner).unwrap().current()));
    dice.filter_map(|dice| compile(&dice, None).map(|plan| (dice, Trace::of(&plan)))).take(count)
}

fn name(mutation: Mutation) -> &'static str {
    match mutation {
        Mutation::Drop => "barrier dropped",
        Mutation::SourceStage(_) => "first stage narrowed",
        Mutation::DestinationStage(_) => "second stage narrowed",
        Mutation::SourceAccess(_) => "first access narrowed",
        Mutation::DestinationAccess(_) => "second access narrowed",
        Mutation::OldLayout(_) => "old layout wrong",
        Mutation::NewLayout(_) => "new layout wrong",
        Mutation::SourceFamily(_) => "giving family wrong",
        Mutation::DestinationFamily(_) => "taking family wrong",
    }
}

#[test]
fn every_mutation_of_every_barrier_is_rejected() {
    let mut rejected: BTreeMap<&str, usize> = BTreeMap::new();
    let mut kinds: BTreeMap<Kind, usize> = BTreeMap::new();
    let (mut steps, mut barriers, mut uses) = (0, 0, 0);
    for (dice, trace) in plans(MUTATED) {
        steps += trace.moments.len() - 3;
        barriers += trace.barriers().count();
        uses += trace.moments.iter().map(|moment| moment.uses.len()).sum::<usize>();
        for edit in trace.edits() {
            let barrier = &trace.moments[edit.moment].barriers[edit.barrier];
            match trace.check_edit(edit) {
                Ok(()) => panic!("{edit:?} of {barrier:?} goes unnoticed in {dice:?}"),
                Err(violation) => *kinds.entry(violation.kind).or_default() += 1,
            }
            *rejected.entry(name(edit.mutation)).or_default() += 1;
        }
    }
    println!("{MUTATED} graphs: {steps} passes, {uses} uses, {barriers} barriers; rejected {rejected:#?}");
    println!("by kind {kinds:#?}");
    assert_eq!(rejected.len(), 9, "a kind of mutation was never tried: {rejected:?}");
    assert!(steps > 2 * MUTATED && barriers > 4 * MUTATED);
}

/// Whether one of two neighbouring moments reads what the other writes. (Two writes that nobody reads in between
/// may be swapped.)
fn depend(trace: &Trace, moment: usize) -> bool {
    let (first, second) = (&trace.moments[moment].uses, &trace.moments[moment + 1].uses);
    let mut pairs = first.iter().flat_map(|a| second.iter().map(move |b| (a, b)));
    pairs.any(|(a, b)| {
        let meet = a.resource == b.resource && a.range.overlaps(b.range);
        meet && ((a.output.is_some() && b.keeps_contents) || (a.keeps_contents && b.output.is_some()))
    })
}

#[test]
fn every_swap_of_dependent_passes_is_rejected() {
    let mut swapped = 0;
    for (dice, trace) in plans(MUTATED) {
        for moment in 1..trace.moments.len().saturating_sub(3) {
            if depend(&trace, moment) {
                let mut mutant = trace.clone();
                mutant.moments.swap(moment, moment + 1);
                assert!(mutant.check().is_err(), "moments {moment} and next swapped in {dice:?}");
                swapped += 1;
            }
        }
    }
    println!("{MUTATED} graphs: {swapped} swaps of dependent passes rejected");
    assert!(swapped > MUTATED / 6);
}

#[test]
fn shared_memory_is_taken_over_in_turn() {
    let mut runner = TestRunner::deterministic();
    let (mut saving, mut handovers) = (0, 0);
    for _ in 0..MUTATED {
        let dice = dice().new_tree(&mut runner).unwrap().current();
        let Some(plan) = compile(&dice, None) else { continue };
        let sharing = plan.sharing();
        check_sharing(&plan, &sharing).unwrap_or_else(|violation| panic!("{violation}\n{}", plan.text()));
        saving += usize::from(sharing.saved() > 0);
        handovers += sharing.handovers.len();
        for i in 0..sharing.handovers.len() {
            let mut without = sharing.clone();
            let dropped = without.handovers.remove(i);
            assert!(check_sharing(&plan, &without).is_err(), "{dropped:?} is redundant in {dice:?}");
        }
    }
    println!("{MUTATED} graphs: {saving} would save memory by sharing; {handovers} handovers, each needed");
    assert!(saving > 50 && handovers > 100);
}

/// An image and a buffer that another family has before and after: of this device, of another process, of another device.
#[test]
fn whoever_owned_a_resource_is_taken_from_and_given_back_to() {
    for family in [3, vk::QUEUE_FAMILY_EXTERNAL, vk::QUEUE_FAMILY_FOREIGN_EXT] {
        let mut graph = Graph::new();
        let desc = ImageDesc {
            usage: vk::ImageUsageFlags::SAMPLED,
            ..ImageDesc::new_2d(4, 4, vk::Format::R32_SFLOAT)
        };
        let theirs = |access| State::of(access).on_queue_family(family);
        let [sampled, kept] = [Access::FragmentSampled, Access::VertexBuffer].map(theirs);
        let image = graph.import_image("camera", desc, sampled, sampled);
        let desc = BufferDesc { size: 64, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
        let buffer = graph.import_buffer("light", desc, kept, kept);
        let mut pass = graph.pass("measure", PassKind::Compute);
        pass.read(&image, Access::ComputeSampled);
        pass.write(buffer, Access::ComputeStorageWrite);
        pass.record(());
        let plan = graph.compile(&Limits::default()).unwrap();
        let text = plan.text();
        assert!(check(&plan).unwrap().redundant.is_empty(), "{text}");
        let ends = [plan.acquires(), plan.releases()];
        assert!(ends.iter().all(|end| (end.buffers.len(), end.images.len()) == (1, 1)), "{text}");
        let trace = Trace::of(&plan);
        let families = trace.barriers().filter(|(.., b)| b.src_queue_family != b.dst_queue_family);
        assert_eq!(families.count(), 4, "{text}");
        for edit in trace.edits() {
            assert!(trace.check_edit(edit).is_err(), "{family}: {edit:?} goes unnoticed\n{text}");
        }
    }
}
