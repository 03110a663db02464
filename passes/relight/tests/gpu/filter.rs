//! A zonal filter of the light: convolution about every direction, band by band, on its way to the vertices.

use crate::host::{Numbers, length, wide, wide_rgb, with_bench};
use airglow_relight::{Bench, Case, CaseLight, Orientation, Relight, RelightError, Settings, reference};
use glam::DQuat;

const VERTICES: usize = 50;

struct Input {
    order: usize,
    vectors: Vec<f32>,
    light: Vec<[f32; 3]>,
    turn: DQuat,
    orientation: Orientation,
}

impl Input {
    fn new(order: usize) -> Self {
        let mut numbers = Numbers::new(order as u64);
        let vectors = numbers.values(order * order * VERTICES);
        let light = numbers.rgb(order * order);
        let rotation = DQuat::from_xyzw(0.3, -0.2, 0.9, 0.5);
        let orientation = Orientation { rotation, inverted: order.is_multiple_of(2) };
        Self { order, vectors, light, turn: DQuat::from_xyzw(0.1, 0.7, -0.2, 0.4), orientation }
    }

    fn run(&self, bench: &Bench<'_>, filter: Option<&[[f64; 3]]>) -> Result<Vec<f32>, RelightError> {
        let settings = Settings { order: self.order, ..Settings::default() };
        let mut relight = Relight::new(bench.context, settings)?;
        let mesh = relight.add_mesh(bench.context, "mesh", VERTICES as u32, Some(&self.vectors))?;
        let light = CaseLight::Uniform(&self.light, self.turn);
        let case = Case { orientation: self.orientation, filter, ..Case::new(light, mesh) };
        bench.results(&mut relight, &case)
    }
}

#[test]
fn each_band_of_each_channel_is_multiplied_with_its_factor() {
    with_bench(|bench| {
        for order in 1..=6 {
            let input = Input::new(order);
            let filter: Vec<[f64; 3]> =
                (0..order).map(|l| [1.0, 0.8, 0.5].map(|c: f64| c / (1.0 + l as f64))).collect();
            let values = input.run(bench, Some(&filter)).unwrap();
            let mut light =
                reference::light(order, &wide_rgb(&input.light), input.turn, input.orientation).unwrap();
            for (l, band) in filter.iter().enumerate() {
                for coefficient in &mut light[l * l..(l + 1) * (l + 1)] {
                    (0..3).for_each(|channel| coefficient[channel] *= band[channel]);
                }
            }
            let count = order * order;
            for (vertex, vector) in input.vectors.chunks_exact(count).enumerate() {
                let baked = wide(vector);
                let scale = length(baked.iter().copied()) * length(light.iter().copied().flatten());
                let expected = reference::colour(&baked, &light);
                for (actual, expected) in values[4 * vertex..].iter().zip(expected) {
                    let error = (f64::from(*actual) - expected).abs() / scale;
                    assert!(error < 1e-5, "order {order}, vertex {vertex}: {actual} and {expected}");
                }
            }
        }
    });
}

#[test]
fn without_a_filter_and_with_one_of_ones_the_bits_are_the_same() {
    with_bench(|bench| {
        let input = Input::new(4);
        let bits =
            |filter| input.run(bench, filter).unwrap().into_iter().map(f32::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(None), bits(Some(&[[1.0; 3]; 4][..])));
    });
}

#[test]
fn filters_of_another_order_and_not_finite_ones_are_refused() {
    with_bench(|bench| {
        let input = Input::new(3);
        let refused = |filter: &[[f64; 3]]| input.run(bench, Some(filter)).unwrap_err().to_string();
        let message = refused(&[[1.0; 3]; 4]);
        assert!(message.contains("filter") && message.contains('3') && message.contains('4'), "{message}");
        let message = refused(&[[1.0; 3], [1.0, f64::NAN, 1.0], [1.0; 3]]);
        assert!(message.contains("filter") && message.contains("NaN"), "{message}");
    });
}
