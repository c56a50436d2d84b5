// SPDX-License-Identifier: MIT OR Apache-2.0
//! The array shows what the model shows, at every clock, on every port of every RPU.
#![allow(clippy::unwrap_used, reason = "a test")]

use foveate_array::PipelinedArray;
use foveate_design::{
    Combine, Config, Design, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, Pipelining,
    Reference, SpatialConfig, Thresholds as Source,
};
use foveate_lanes::Level;
use foveate_model::{PipelinedRcm, RcmInput, RpuOutput, Thresholds};
use proptest::prelude::*;
use proptest::sample::select;

/// A stream of edges that follows from a number.
struct Stimulus {
    state: u64,
    design: Design,
    /// Pixels of the frame before, so that some frames repeat.
    calm: bool,
}

impl Stimulus {
    fn next(&mut self, below: u64) -> u64 {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040);
        (self.state >> 33) % below
    }

    fn pixels(&mut self) -> Vec<u16> {
        let max = u64::from(self.design.pixel_max());
        let regions = self.design.regions();
        let one = |stimulus: &mut Self| match stimulus.next(4) {
            0 => 0,
            1 => max,
            _ if stimulus.calm => max / 2,
            _ => stimulus.next(max + 1),
        };
        (0..regions).map(|_| u16::try_from(one(self)).unwrap()).collect()
    }

    /// Thresholds near what scores reach.
    fn thresholds(&mut self) -> Thresholds {
        let mut thresholds = Thresholds::of(&self.design);
        for place in 0..self.design.features().len() {
            let feature = &self.design.features()[place];
            let (has_level, score_bits) = (feature.level().is_some(), feature.score_bits());
            if has_level {
                let max = u64::from(self.design.pixel_max());
                thresholds.level[place] = u32::try_from(self.next(3 * max + 2)).unwrap();
            }
            let top = 1u64 << score_bits.min(40);
            thresholds.min_score[place] = self.next(top);
        }
        thresholds.temporal_level = u32::try_from(self.next(20)).unwrap();
        let n = u64::from(self.design.region_pixels());
        thresholds.temporal_min_count = u32::try_from(self.next(n + 2)).unwrap();
        thresholds
    }
}

/// Steps both; `fault` is an output that is falsified, to see that it is noticed.
fn compare(design: &Design, level: Level, seed: u64, fault: Option<u64>) -> Result<(), String> {
    let mut stimulus =
        Stimulus { state: seed, design: design.clone(), calm: seed.is_multiple_of(2) };
    let mut array = PipelinedArray::with_level(design.pipelined().unwrap(), level);
    let mut model = PipelinedRcm::new(design.pipelined().unwrap());
    let mut thresholds = stimulus.thresholds();
    let frames = 5;
    for clock in 0..u64::from(design.stream_pixels() * frames) + 40 {
        let reset = stimulus.next(150) == 0 && clock.is_multiple_of(3);
        let valid = seed.is_multiple_of(3) || stimulus.next(8) > 0;
        if stimulus.next(40) == 0 {
            thresholds = stimulus.thresholds();
        }
        let pixels = stimulus.pixels();
        let outputs = array.step(reset, valid, &pixels, &thresholds);
        let (pixels, thresholds) = (&pixels[..], &thresholds);
        let expected = model.step(&RcmInput { reset, valid, sof: false, pixels, thresholds });
        for (region, expected) in expected.iter().enumerate() {
            let mut got: RpuOutput = outputs.rpu(region);
            got.forward_valid ^= fault == Some(clock);
            if got != *expected {
                return Err(format!("clock {clock}, region {region}: {got:?}, not {expected:?}"));
            }
        }
        let first = |ports: &[u8], bit: fn(&RpuOutput) -> bool| {
            ports.iter().map(|&port| port != 0).eq(expected.iter().map(bit))
        };
        assert_eq!(outputs.decision_valid(), expected[0].decision_valid);
        assert!(first(outputs.srs(), |output| output.srs));
        assert!(first(outputs.trs(), |output| output.trs));
        assert!(first(outputs.active(), |output| output.active));
        assert!(first(outputs.forward_valid(), |output| output.forward_valid));
    }
    Ok(())
}

fn designs() -> impl Strategy<Value = Design> {
    let features = proptest::sample::subsequence(FeatureKind::ALL.to_vec(), 1..=FeatureKind::COUNT)
        .prop_shuffle();
    let modes = (
        select(vec![Neighborhood::Isolated, Neighborhood::Shared]),
        select(vec![Filter::None, Filter::Median3x3]),
        select(vec![Reference::Previous, Reference::LastSent]),
        select(vec![Irrelevant::Zero, Irrelevant::Hold]),
        select(vec![Payload::Denoised, Payload::Raw]),
        select(vec![Combine::Any, Combine::All]),
        select(vec![Source::Runtime, Source::Constant]),
        select(Pipelining::ALL),
    );
    let sizes =
        (select(vec![2u32, 3, 4, 5, 8, 16]), select(vec![1u32, 4, 8, 10, 16]), 1u32..=3, 1u32..=3);
    (features, modes, sizes)
        .prop_map(|(features, modes, (size, bits, columns, rows))| {
            let mut config = Config::default();
            (config.camera.frame.width, config.camera.frame.height) =
                (Some(columns * size), Some(rows * size));
            config.camera.frame.pixel_bits = bits;
            config.camera.region.size = size;
            config.camera.temporal.level = Some(1);
            config.camera.temporal.min_count = size;
            config.camera.spatial = features
                .into_iter()
                .map(|kind| SpatialConfig { level: None, ..SpatialConfig::new(kind) })
                .collect();
            for spatial in &mut config.camera.spatial {
                if matches!(spatial.feature, FeatureKind::Edge | FeatureKind::Corner) {
                    spatial.level = Some(1);
                }
            }
            (config.camera.region.neighborhood, config.camera.denoise.filter) = (modes.0, modes.1);
            (config.camera.temporal.reference, config.camera.render.irrelevant) =
                (modes.2, modes.3);
            (config.camera.render.payload, config.camera.decision.combine) = (modes.4, modes.5);
            config.hardware.thresholds = modes.6;
            config.hardware.pipelining = Some(modes.7);
            config
        })
        .prop_filter_map("a valid design", |config| config.validate().ok())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn the_array_equals_the_model_at_every_clock(design in designs(), seed in any::<u64>()) {
        for level in Level::available() {
            if let Err(difference) = compare(&design, level, seed, None) {
                prop_assert!(false, "{}: {difference}", level.name());
            }
        }
    }
}

#[test]
fn more_regions_than_a_block_are_all_there() {
    let mut config = Config::default();
    (config.camera.frame.width, config.camera.frame.height) = (Some(80), Some(72));
    let design = config.validate().unwrap();
    assert_eq!(design.regions(), 90);
    assert_eq!(compare(&design, Level::detect(), 3, None), Ok(()));
}

#[test]
fn a_single_wrong_bit_is_noticed() {
    let mut config = Config::default();
    (config.camera.frame.width, config.camera.frame.height) = (Some(16), Some(8));
    let design = config.validate().unwrap();
    assert!(compare(&design, Level::detect(), 3, Some(100)).is_err());
}
