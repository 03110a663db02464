//! Every evaluator's bindings as stated in Rust, against reflection of its modules.

use airglow_fog::reference::table::Filter;
use airglow_fog::rivals::{Evaluator, Froxels, Round};
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;

#[test]
fn every_rival_declares_what_is_stated() {
    let taps = [1, 2, 4, 6, 8, 12, 16].map(|count| Evaluator::Taps { count });
    let poles = [4, 7].map(|count| Evaluator::Poles { count });
    let table = Evaluator::Table { size: 64, filter: Filter::Bilinear };
    let marches = [Evaluator::March { steps: 8 }, Evaluator::Equiangular { steps: 8 }];
    let others = [Evaluator::Nothing, Evaluator::DepthFog, Evaluator::Entries { size: 64 }, table];
    for evaluator in taps.into_iter().chain(poles).chain(marches).chain(others) {
        for spirv in evaluator.spirv().unwrap() {
            let module = Module::read(spirv).unwrap_or_else(|error| panic!("{evaluator}: {error}"));
            module.assert_bindings(&evaluator.bindings());
            assert_eq!(module.workgroup, [64, 1, 1], "{evaluator}");
            let pushed = module.push_constants.as_ref().unwrap();
            pushed.assert_matches(&host_layout!(Round { pixels, lights, stride, mask, steps, repeats }));
        }
    }
    let froxels = Froxels { cells: [16; 3] };
    for spirv in froxels.spirv() {
        Module::read(spirv).unwrap().assert_bindings(&froxels.bindings());
    }
}

#[test]
fn numbers_without_a_module_are_refused() {
    for evaluator in [Evaluator::Taps { count: 3 }, Evaluator::Poles { count: 5 }] {
        let refused = evaluator.spirv().unwrap_err().to_string();
        assert!(refused.contains("give"), "{refused}");
    }
}
