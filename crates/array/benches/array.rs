// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks of the paper's RCM, 784 RPUs, dense random pixels: the array and the model it follows.

use divan::Bencher;
use divan::counter::ItemsCount;
use foveate_array::PipelinedArray;
use foveate_design::{CameraConfig, Config, Design, FeatureKind, SpatialConfig};
use foveate_lanes::Level;
use foveate_model::{PipelinedRcm, RcmInput, Thresholds};

fn main() {
    divan::main();
}

const CLOCKS: usize = 640;

const DESIGNS: [(&str, &[FeatureKind]); 4] = [
    ("edge", &[FeatureKind::Edge]),
    ("corner", &[FeatureKind::Corner]),
    ("mad", &[FeatureKind::Mad]),
    ("all", FeatureKind::ALL),
];

fn design(features: &[FeatureKind]) -> Design {
    let spatial = features.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    let config = Config::from(CameraConfig { spatial, ..CameraConfig::default() });
    config.validate().expect("a valid design")
}

fn pixels(design: &Design) -> Vec<Vec<u8>> {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state.to_le_bytes()[3]
    };
    (0..CLOCKS).map(|_| (0..design.regions()).map(|_| next()).collect()).collect()
}

#[divan::bench(args = DESIGNS.map(|(name, _)| name))]
fn array(bencher: Bencher, name: &str) {
    on_level(bencher, name, Level::detect());
}

#[divan::bench(args = DESIGNS.map(|(name, _)| name))]
fn array_portable(bencher: Bencher, name: &str) {
    on_level(bencher, name, Level::PORTABLE);
}

fn on_level(bencher: Bencher, name: &str, level: Level) {
    let (_, features) = DESIGNS.into_iter().find(|(known, _)| *known == name).expect("a design");
    let design = design(features);
    let (pixels, thresholds) = (pixels(&design), Thresholds::of(&design));
    let mut array =
        PipelinedArray::with_level(design.pipelined().expect("the preset is pipelined"), level);
    bencher.counter(ItemsCount::new(CLOCKS)).bench_local(|| {
        for pixels in &pixels {
            divan::black_box(array.step_u8(false, true, pixels, &thresholds));
        }
    });
}

#[divan::bench(args = DESIGNS.map(|(name, _)| name), sample_count = 5)]
fn model(bencher: Bencher, name: &str) {
    let (_, features) = DESIGNS.into_iter().find(|(known, _)| *known == name).expect("a design");
    let design = design(features);
    let pixels: Vec<Vec<u16>> = pixels(&design)
        .iter()
        .map(|pixels| pixels.iter().map(|&pixel| pixel.into()).collect())
        .collect();
    let thresholds = Thresholds::of(&design);
    let mut rcm = PipelinedRcm::new(design.pipelined().expect("the preset is pipelined"));
    bencher.counter(ItemsCount::new(CLOCKS)).bench_local(|| {
        for pixels in &pixels {
            divan::black_box(rcm.step(&RcmInput {
                reset: false,
                valid: true,
                sof: false,
                pixels,
                thresholds: &thresholds,
            }));
        }
    });
}
