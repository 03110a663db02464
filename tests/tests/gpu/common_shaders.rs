//! The functions that hosts may copy (`shaders/glsl/common`), run on the device and compared with f64. The rotation
//! and the product are compared where a pass runs them.

use airglow_gpu::{Binding, BindingDesc, BindingKind, ComputePipelineDesc, Label, Location};
use airglow_graph::{Access, BufferDesc};
use airglow_math::sphere::{cube, equirect};
use airglow_math::world::Depth;
use airglow_math::{World, sequence, sh};
use airglow_scene::{false_colour, srgb_encode, tone};
use airglow_tests::device::fixture;
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;
use airglow_tests::spirv::words;
use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

const MODULE: &str = "test/common_functions";
const BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Input {
    direction: [f32; 4],
    color: [f32; 4],
    depth_coefficients: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Row {
    basis: [[f32; 6]; 6],
    equirect: [f32; 2],
    cube: [f32; 2],
    equirect_direction: [f32; 3],
    face: f32,
    cube_direction: [f32; 3],
    half_bits: u32,
    display: [f32; 3],
    angle: f32,
    encoded: [f32; 3],
    view_distance: f32,
    decoded: [f32; 3],
    padding: f32,
    false_colour: [f32; 3],
    not_a_number: f32,
}

/// Directions over the sphere, the axes and the diagonals; colours to 30; numbers over the range of halves.
fn inputs() -> Vec<Input> {
    let special = [-1.0, 0.0, 1.0].into_iter().flat_map(|x| {
        [-1.0, 0.0, 1.0].into_iter().flat_map(move |y| [-1.0, 0.0, 1.0].map(|z| DVec3::new(x, y, z)))
    });
    let special = special.filter(|direction| *direction != DVec3::ZERO).map(DVec3::normalize);
    let sphere = (0..4000).map(|i| sequence::uniform_sphere(sequence::sobol(i, 7)));
    special
        .chain(sphere)
        .enumerate()
        .map(|(i, direction)| {
            let [u, v] = sequence::sobol(i as u32, 11);
            let halved = (2.0f64.powf(44.0 * u - 26.0) * if i % 2 == 0 { 1.0 } else { -1.0 }) as f32;
            Input {
                direction: direction.as_vec3().extend(v as f32).to_array(),
                color: [(30.0 * u * v * v) as f32, v as f32, (1.5 * u) as f32, halved],
                depth_coefficients: world(i).depth_coefficients().map(|c| c as f32),
            }
        })
        .collect()
}

/// Hosts with all six kinds of depth, in metres and in centimetres, one after another.
fn world(row: usize) -> World {
    let far = [Some(4000.0), None, Some(30.0)][row / 2 % 3];
    let depth = Depth { reversed: row % 2 == 1, near: 0.5, far, orthographic: row / 2 % 3 == 2 };
    World { depth, metres_per_unit: [1.0, 0.01][row / 6 % 2], ..World::default() }
}

/// The shader's rows for `inputs`.
fn run(inputs: &[Input]) -> Vec<Row> {
    let fixture = fixture();
    let context = fixture.context();
    let buffer = |name, bytes: usize, location| {
        let desc = BufferDesc { size: bytes as u64, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
        context.create_buffer(Label::new("test", name), &desc, location).unwrap()
    };
    let source = buffer("inputs", size_of_val(inputs), Location::Upload);
    let results = buffer("results", inputs.len() * size_of::<Row>(), Location::Readback);
    source.write(0, inputs).unwrap();
    let pipeline = context
        .create_compute_pipeline(&ComputePipelineDesc {
            name: "common functions",
            spirv: &words(MODULE),
            bindings: &BINDINGS,
            push_constant_size: 0,
        })
        .unwrap();
    fixture
        .device()
        .run(context, |recorder| {
            recorder
                .bind_compute(&pipeline, &[Binding::storage(0, &source), Binding::storage(1, &results)])?;
            recorder.dispatch([inputs.len().div_ceil(64) as u32, 1, 1])?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::HostRead)
        })
        .unwrap();
    results.read(0, inputs.len()).unwrap()
}

/// The largest of the differences, and where.
struct Worst {
    what: &'static str,
    limit: f64,
    value: f64,
    place: String,
}

impl Worst {
    fn new(what: &'static str, limit: f64) -> Self {
        Self { what, limit, value: 0.0, place: String::new() }
    }

    fn add(&mut self, found: f64, truth: f64, input: &Input) {
        let difference = (found - truth).abs();
        if difference > self.value || difference.is_nan() {
            self.value = difference;
            let direction = &input.direction[..3];
            self.place = format!("found {found}, truth {truth} at {direction:?}, {:?}", input.color);
        }
    }

    fn check(self) {
        println!("{:20} {:.2e} (limit {:.0e}) {}", self.what, self.value, self.limit, self.place);
        assert!(self.value <= self.limit, "{} is {:.2e}: {}", self.what, self.value, self.place);
    }
}

#[test]
fn the_shader_functions_agree_with_f64() {
    let inputs = inputs();
    let rows = run(&inputs);
    let mut basis = Worst::new("basis, orders 1-6", 2e-6);
    let mut angle = Worst::new("angle", 4e-7);
    let mut map = Worst::new("equirect place", 2e-7);
    let mut map_direction = Worst::new("equirect direction", 1.5e-6);
    let mut cube_place = Worst::new("cube place", 2e-7);
    let mut cube_direction = Worst::new("cube direction", 2e-7);
    for (input, row) in inputs.iter().zip(&rows) {
        let [x, y, z, _] = input.direction;
        let direction = Vec3::new(x, y, z).as_dvec3();
        let mut truth = [0.0; 36];
        sh::evaluate(6, direction.normalize(), &mut truth).unwrap();
        row.basis
            .as_flattened()
            .iter()
            .zip(truth)
            .for_each(|(found, truth)| basis.add(f64::from(*found), truth, input));
        let truth = if (x, y) == (0.0, 0.0) { 0.0 } else { direction.y.atan2(direction.x) };
        angle.add(f64::from(row.angle), truth, input);

        // On the seam u may be 0 or 1; the direction below tells them no further apart.
        let [u, v] = equirect::uv(direction);
        let turns = f64::from(row.equirect[0]) - u;
        map.add(turns - turns.round(), 0.0, input);
        map.add(f64::from(row.equirect[1]), v, input);
        for (found, truth) in row.equirect_direction.iter().zip(direction.normalize().to_array()) {
            map_direction.add(f64::from(*found), truth, input);
        }

        let (face, uv) = cube::face_uv(direction).unwrap();
        assert_eq!(row.face as usize, face as usize, "face of {direction}");
        row.cube.iter().zip(uv).for_each(|(found, truth)| cube_place.add(f64::from(*found), truth, input));
        for (found, truth) in row.cube_direction.iter().zip(direction.normalize().to_array()) {
            cube_direction.add(f64::from(*found), truth, input);
        }
    }
    for worst in [basis, angle, map, map_direction, cube_place, cube_direction] {
        worst.check();
    }
}

/// Depth that goes from near to far is as good as its own 24 bits; a reversed perspective is good in
/// every distance.
#[test]
fn view_distances_are_those_of_the_host_s_world() {
    let inputs = inputs();
    let mut there_and_back = Worst::new("depth there and back", 3e-7);
    let mut reversed = Worst::new("perspective, reversed", 3e-7);
    for ((row, input), found) in inputs.iter().enumerate().zip(run(&inputs)) {
        let (world, depth) = (world(row), f64::from(input.direction[3]));
        let found = f64::from(found.view_distance) / world.metres_per_unit;
        there_and_back.add(world.depth.value(found), depth, input);
        if world.depth.reversed && !world.depth.orthographic && depth > 0.0 {
            reversed.add(found / world.depth.view_distance(depth), 1.0, input);
        }
    }
    there_and_back.check();
    reversed.check();
}

#[test]
fn halves_and_display_colours_are_those_of_the_cpu() {
    let inputs = inputs();
    let rows = run(&inputs);
    let mut display = Worst::new("tone map", 2e-6);
    let mut encoded = Worst::new("sRGB encoding", 4e-6);
    let mut decoded = Worst::new("sRGB there and back", 4e-6);
    let mut false_colours = Worst::new("false colours", 1e-6);
    for (input, row) in inputs.iter().zip(&rows) {
        let [r, g, b, number] = input.color;
        assert_eq!(row.half_bits, u32::from(half::f16::from_f32(number).to_bits()), "half of {number:e}");
        let truth = tone::tone_map([r, g, b]);
        for (k, truth) in truth.into_iter().enumerate() {
            display.add(f64::from(row.display[k]), f64::from(truth), input);
            encoded.add(f64::from(row.encoded[k]), f64::from(srgb_encode(row.display[k])), input);
            decoded.add(f64::from(row.decoded[k]), f64::from(row.display[k]), input);
        }
        let truth = false_colour((input.direction[0] + 0.8) / 1.6);
        for (found, truth) in row.false_colour.iter().zip(truth) {
            false_colours.add(f64::from(*found), f64::from(truth), input);
        }
        assert_eq!(row.not_a_number, 1.0, "what is not a number is magenta");
    }
    for worst in [display, encoded, decoded, false_colours] {
        worst.check();
    }
}

#[test]
fn the_host_structs_are_the_shaders() {
    let module = Module::load(&format!("{MODULE}.spv")).unwrap();
    module.assert_bindings(&BINDINGS);
    let rows = |binding| module.block(0, binding).unwrap().member("rows").unwrap();
    rows(0).assert_matches(&host_layout!(Input { direction, color, depth_coefficients }));
    rows(1).assert_matches(&host_layout!(Row {
        basis,
        equirect,
        cube,
        equirect_direction,
        face,
        cube_direction,
        half_bits,
        display,
        angle,
        encoded,
        view_distance,
        decoded,
        padding,
        false_colour,
        not_a_number,
    }));
}
