//! What a record call leaves behind in the host's command buffer: exactly what `engine/gpu/README.md` lists, and the
//! declared states of imports, foreign queue families included. A watched function table hears every command.

use airglow_gpu::ash::vk;
use airglow_gpu::{AdoptInfo, Context, Requirements};
use airglow_graph::{Access, State};
use airglow_tests::compare::assert_close;
use airglow_tests::device::open;
use airglow_tests::shim::{ACTIONS, Call, STATE, watch};
use airglow_tests::workload::{Workload, reference};
use std::collections::BTreeSet;

/// Records the workload once, through the watch, and returns the commands and the picture.
fn record(entry: State, exit: State) -> (Vec<Call>, Vec<f32>) {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    let mut extensions = Vec::new();
    let info = AdoptInfo {
        get_device_proc_addr: Some(shim.get_device_proc_addr()),
        ..device.adopt_info(&mut extensions, 2)
    };
    // SAFETY: handles of the open device; everything is dropped before it, after `run` has waited.
    let context = unsafe { Context::adopt(info) }.unwrap();
    let mut work = Workload::new(&context, entry, exit).unwrap();
    let mut calls = Vec::new();
    let copy = device.run(&context, |recorder| {
        shim.take_calls();
        work.record(recorder)?;
        calls = shim.take_calls();
        // The host relies on the exit state; a foreign owner gives the picture back in the same layout.
        recorder.transition(&work.picture, State::idle(exit.layout), Access::TransferSource)?;
        recorder.read_back_image(&work.picture.full_view()?)
    });
    let picture = copy.unwrap().texels().unwrap().concat();
    let messages = device.messages();
    drop((work, context));
    assert!(shim.alive().is_empty(), "left alive: {:?}", shim.alive());
    drop(device);
    let said = messages.take();
    assert!(said.is_empty(), "validation said {said:?}");
    (calls, picture)
}

#[test]
fn only_the_documented_state_changes() {
    let (calls, picture) = record(State::UNDEFINED, Access::FragmentSampled.into());
    assert_close("the picture", &picture, &reference(), 1e-6, 1e-6);
    let named = |name: &'static str| calls.iter().filter(move |call| call.name == name);
    for call in &calls {
        let known = STATE.contains(&call.name) || ACTIONS.contains(&call.name);
        assert!(known, "{} is in neither list", call.name);
    }
    for state in STATE {
        assert!(named(state).next().is_some(), "{state} was not exercised");
    }
    assert!(named("vkCmdBindDescriptorSets").all(|call| call.numbers[1..] == [0, 1]), "set 0 alone");
    assert!(named("vkCmdBindVertexBuffers").all(|call| call.numbers == [0, 1]), "the slot asked for");
    for single in ["vkCmdSetViewport", "vkCmdSetScissor"] {
        assert!(named(single).all(|call| call.numbers == [0, 1]), "{single}: the first alone");
    }
    let most = named("vkCmdPushConstants").map(|call| call.numbers[1] + call.numbers[2]).max();
    assert_eq!(most, Some(8), "no push constants beyond what the pipelines state");
    for [begin, end] in [
        ["vkCmdBeginRendering", "vkCmdEndRendering"],
        ["vkCmdBeginDebugUtilsLabelEXT", "vkCmdEndDebugUtilsLabelEXT"],
    ] {
        let mut open = 0;
        for call in &calls {
            open += i32::from(call.name == begin) - i32::from(call.name == end);
            assert!((0..=1).contains(&open), "{begin} and {end} do not pair up");
        }
        assert_eq!((open, named(begin).count() > 0), (0, true), "{begin} was left open, or never called");
    }
    let readme = include_str!("../../../engine/gpu/README.md");
    for call in STATE {
        assert!(readme.contains(call), "engine/gpu/README.md does not list {call}");
    }
}

/// The image barriers of the commands, in order.
fn image_barriers(calls: &[Call]) -> Vec<&vk::ImageMemoryBarrier2<'static>> {
    calls.iter().flat_map(|call| &call.images).collect()
}

#[test]
fn imports_come_from_their_entry_and_leave_in_their_exit_state() {
    let entry = State::of(Access::FragmentSampled);
    let exit = State::of(Access::ComputeSampled);
    for (entry, exit) in [(State::UNDEFINED, exit), (State::UNDEFINED, Access::TransferSource.into())] {
        let (calls, _) = record(entry, exit);
        let barriers = image_barriers(&calls);
        let (first, last) = (barriers[0], barriers[barriers.len() - 1]);
        assert_eq!(first.old_layout, entry.layout);
        assert_eq!(last.new_layout, exit.layout);
        assert_eq!((last.dst_stage_mask, last.dst_access_mask), (exit.stage, exit.access));
        let layouts = barriers.windows(2).all(|pair| pair[0].new_layout == pair[1].old_layout);
        assert!(layouts, "each barrier starts where the one before ended");
    }
    // What the pass overwrites needs no old contents, but waits for the readers before it.
    let (calls, _) = record_after_reading(entry, exit);
    let first = image_barriers(&calls)[0];
    assert!(first.src_stage_mask.contains(vk::PipelineStageFlags2::FRAGMENT_SHADER), "{first:?}");
}

/// As [`record`], but the picture is brought into its entry state by the host first.
fn record_after_reading(entry: State, exit: State) -> (Vec<Call>, ()) {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    let mut extensions = Vec::new();
    let info = AdoptInfo {
        get_device_proc_addr: Some(shim.get_device_proc_addr()),
        ..device.adopt_info(&mut extensions, 2)
    };
    // SAFETY: as in `record`.
    let context = unsafe { Context::adopt(info) }.unwrap();
    let mut work = Workload::new(&context, entry, exit).unwrap();
    let mut calls = Vec::new();
    let recorded = device.run(&context, |recorder| {
        recorder.transition(&work.picture, State::UNDEFINED, entry)?;
        shim.take_calls();
        work.record(recorder)?;
        calls = shim.take_calls();
        Ok(())
    });
    recorded.unwrap();
    let said = device.messages().take();
    assert!(said.is_empty(), "validation said {said:?}");
    (calls, ())
}

#[test]
fn a_foreign_queue_family_gives_and_gets_back() {
    let external = vk::QUEUE_FAMILY_EXTERNAL;
    let entry = State::idle(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL).on_queue_family(external);
    let exit = State::of(Access::FragmentSampled).on_queue_family(external);
    let (calls, ()) = record_after_reading(entry, exit);
    let barriers = image_barriers(&calls);
    let transfers: Vec<_> = barriers
        .iter()
        .filter(|barrier| barrier.src_queue_family_index != barrier.dst_queue_family_index)
        .map(|barrier| (barrier.src_queue_family_index, barrier.dst_queue_family_index))
        .collect();
    let own: BTreeSet<_> =
        transfers.iter().flat_map(|&(from, to)| [from, to]).filter(|&f| f != external).collect();
    assert_eq!(own.len(), 1, "one family of ours: {transfers:?}");
    let own = own.into_iter().next().unwrap();
    let expected = [(external, own), (own, external)];
    let kept: Vec<_> = transfers.iter().filter(|t| expected.contains(t)).copied().collect();
    assert_eq!(kept, transfers, "nothing but acquire and release");
    assert_eq!(transfers.last(), Some(&(own, external)), "released last");
    let release = barriers.last().unwrap();
    assert_eq!(release.new_layout, exit.layout);
    assert_eq!(release.dst_access_mask, vk::AccessFlags2::NONE, "a release makes nothing visible itself");
}
