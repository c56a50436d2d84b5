// SPDX-License-Identifier: MIT OR Apache-2.0
//! Benchmarks of the engine: features, neighborhoods, instruction sets, threads, batches and still
//! scenes.

use divan::Bencher;
use divan::counter::ItemsCount;
use foveate_camera::{CameraConfig, DenoiseFilter, FeatureKind, Neighborhood, SpatialConfig};
use foveate_engine::{BatchScreens, Engine, EngineOptions, InstructionSet};

fn main() {
    divan::main();
}

#[derive(Clone, Copy, Debug)]
struct BenchmarkCase {
    width: u32,
    height: u32,
    side: u32,
    neighborhood: Neighborhood,
    filter: DenoiseFilter,
    features: &'static [FeatureKind],
}

const EDGE: &[FeatureKind] = &[FeatureKind::Edge];
const ALL: &[FeatureKind] = FeatureKind::ALL;
const HD: BenchmarkCase = BenchmarkCase {
    width: 1920,
    height: 1080,
    side: 32,
    neighborhood: Neighborhood::Shared,
    filter: DenoiseFilter::Median3x3,
    features: EDGE,
};
const SMALL: BenchmarkCase = BenchmarkCase { width: 224, height: 224, side: 8, ..HD };

const CASES: [(&str, BenchmarkCase); 6] = [
    ("1080p edge shared", HD),
    ("1080p edge isolated", BenchmarkCase { neighborhood: Neighborhood::Isolated, ..HD }),
    ("1080p all shared", BenchmarkCase { features: ALL, ..HD }),
    ("224 edge shared", SMALL),
    ("224 edge isolated", BenchmarkCase { neighborhood: Neighborhood::Isolated, ..SMALL }),
    ("224 all shared", BenchmarkCase { features: ALL, ..SMALL }),
];

/// Makes an engine for a case, and frames of a moving pattern with noise.
fn setup(case: BenchmarkCase, options: EngineOptions) -> (Engine, Vec<Vec<u8>>) {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(case.width), Some(case.height));
    config.region.size = case.side;
    config.region.neighborhood = case.neighborhood;
    config.denoise.filter = case.filter;
    config.spatial = case.features.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    let camera = config.validate().expect("a valid camera");
    let engine = Engine::with_options(&camera, options).expect("threads");
    let mut state = 1u32;
    let mut frame = |shift: u32| -> Vec<u8> {
        let places = (0..case.height).flat_map(|y| (0..case.width).map(move |x| (x, y)));
        places
            .map(|(x, y)| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let pattern = if ((x + shift) / 40 + y / 40).is_multiple_of(2) { 60 } else { 180 };
                pattern + state.to_le_bytes()[3] % 8
            })
            .collect()
    };
    let frames = (0..8).map(|number| frame(3 * number)).collect();
    (engine, frames)
}

/// Times frames one by one. With `still`, the same frame is given again and again.
fn run_single(bencher: Bencher, case: BenchmarkCase, options: EngineOptions, still: bool) {
    let (mut engine, frames) = setup(case, options);
    let width = usize::try_from(case.width).expect("a width");
    let mut number = 0;
    bencher.counter(ItemsCount::new(frames[0].len())).bench_local(|| {
        number += usize::from(!still);
        engine.step_u8(&frames[number % frames.len()], width).map(|outcome| outcome.skipped)
    });
}

/// Times frames that are computed as a whole.
fn run_moving(bencher: Bencher, case: BenchmarkCase) {
    let options = EngineOptions { skips_identical_regions: false, ..EngineOptions::default() };
    run_single(bencher, case, options, false);
}

fn case(name: &str) -> BenchmarkCase {
    CASES.iter().find(|(case_name, _)| *case_name == name).expect("a case").1
}

#[divan::bench(args = CASES.map(|(name, _)| name))]
fn moving(bencher: Bencher, name: &str) {
    run_moving(bencher, case(name));
}

#[divan::bench(args = CASES.map(|(name, _)| name))]
fn moving_with_skip(bencher: Bencher, name: &str) {
    run_single(bencher, case(name), EngineOptions::default(), false);
}

#[divan::bench(args = CASES.map(|(name, _)| name))]
fn still_with_skip(bencher: Bencher, name: &str) {
    run_single(bencher, case(name), EngineOptions::default(), true);
}

/// Times each feature alone, without a filter.
#[divan::bench(args = FeatureKind::ALL)]
fn one_feature(bencher: Bencher, kind: &FeatureKind) {
    let features = FeatureKind::ALL.chunks(1).find(|alone| alone[0] == *kind).expect("a kind");
    let case = BenchmarkCase { filter: DenoiseFilter::None, features, ..HD };
    run_moving(bencher, case);
}

/// Times each filter with `range`, the cheapest feature.
#[divan::bench(args = DenoiseFilter::ALL)]
fn one_filter(bencher: Bencher, filter: &DenoiseFilter) {
    let case = BenchmarkCase { filter: *filter, features: &[FeatureKind::Range], ..HD };
    run_moving(bencher, case);
}

#[divan::bench(args = [1, 2])]
fn threads(bencher: Bencher, threads: usize) {
    run_single(
        bencher,
        HD,
        EngineOptions { threads, skips_identical_regions: false, ..EngineOptions::default() },
        false,
    );
}

/// The numbers of threads and of frames per call, and whether the screens are kept.
const BATCH_OPTIONS: [(usize, usize, bool); 8] = [
    (1, 4, false),
    (1, 4, true),
    (1, 32, false),
    (1, 32, true),
    (2, 4, false),
    (2, 4, true),
    (2, 32, false),
    (2, 32, true),
];

/// Times several frames per call.
fn run_batch(bencher: Bencher, case: BenchmarkCase, (threads, batch, keep): (usize, usize, bool)) {
    let options =
        EngineOptions { threads, skips_identical_regions: false, ..EngineOptions::default() };
    let (mut engine, frames) = setup(case, options);
    let frames: Vec<&[u8]> = frames.iter().map(Vec::as_slice).cycle().take(batch).collect();
    let width = usize::try_from(case.width).expect("a width");
    let mut screens = BatchScreens::new();
    bencher.counter(ItemsCount::new(batch * frames[0].len())).bench_local(|| {
        let screens = keep.then_some(&mut screens);
        engine.step_batch_u8(&frames, width, screens).map(<[_]>::len)
    });
}

#[divan::bench(args = BATCH_OPTIONS)]
fn batches_1080p(bencher: Bencher, options: (usize, usize, bool)) {
    run_batch(bencher, HD, options);
}

#[divan::bench(args = BATCH_OPTIONS)]
fn batches_224(bencher: Bencher, options: (usize, usize, bool)) {
    run_batch(bencher, SMALL, options);
}

#[divan::bench(args = InstructionSet::available().into_iter().map(InstructionSet::name))]
fn instructions(bencher: Bencher, name: &str) {
    let level = InstructionSet::available().into_iter().find(|level| level.name() == name);
    let level = level.expect("an available level");
    run_single(
        bencher,
        HD,
        EngineOptions { level, skips_identical_regions: false, ..EngineOptions::default() },
        false,
    );
}
