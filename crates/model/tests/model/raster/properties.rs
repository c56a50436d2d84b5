// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, words that
//! are not taken, sinks that stall, memories that fail, thresholds that change between frames, and
//! resets at any edge.

use foveate_pixels::Frame;
use proptest::prelude::*;

use super::driver::{RasterDriver, RasterStimulus, RasterTraffic, SinkPattern};
use super::memory::MemoryFaultRates;
use super::raster_oracle::{RasterCheckResult, RasterOracle};
use super::raster_parameters::{RasterParameters, arbitrary_raster_parameters};
use crate::class_maps::ClassMapLog;
use crate::frames::{ClipScript, SeededRandom, arbitrary_scripts, make_clip};
use crate::port_thresholds::PortThresholds;

pub(crate) fn arbitrary_traffic() -> impl Strategy<Value = RasterTraffic> {
    let gaps = prop_oneof![3 => Just(0i64), 1 => 1i64..70];
    let pushing = prop_oneof![Just(0i64), Just(50), Just(100)];
    let sink = prop_oneof![
        2 => Just(SinkPattern::Percent(100)),
        2 => (5i64..100).prop_map(SinkPattern::Percent),
        1 => Just(SinkPattern::Percent(0)),
        2 => (2i64..60).prop_map(SinkPattern::Alternating),
        2 => (60i64..3000).prop_map(SinkPattern::Alternating),
    ];
    let faults = prop_oneof![
        2 => Just(MemoryFaultRates::NONE),
        1 => (0i64..20, 0i64..20).prop_map(|(missing, wrong)| MemoryFaultRates { missing, wrong }),
        1 => (0i64..500, 0i64..500).prop_map(|(missing, wrong)| MemoryFaultRates { missing, wrong }),
    ];
    let source = (gaps, 0i64..20, pushing);
    (source, sink, faults, any::<u64>()).prop_map(
        |((gaps, between, pushing), sink, faults, seed)| RasterTraffic {
            gaps,
            max_pause: between,
            pushing,
            sink,
            faults,
            seed,
        },
    )
}

/// Returns the recipe with other thresholds, if they are inputs.
fn with_other_thresholds(recipe: &RasterParameters, seed: u64) -> RasterParameters {
    RasterParameters { base: recipe.base.with_other_thresholds(seed), ..recipe.clone() }
}

/// A clip with the thresholds of each frame.
pub(crate) struct RasterClip {
    pub(crate) frames: Vec<Frame>,
    pub(crate) recipes: Vec<RasterParameters>,
}

impl RasterClip {
    pub(crate) fn new(recipe: &RasterParameters, script: &ClipScript) -> Self {
        let recipes = script.iter().map(|&(_, seed)| with_other_thresholds(recipe, seed)).collect();
        Self { frames: make_clip(&recipe.base, script), recipes }
    }

    pub(crate) fn stimuli(&self) -> Vec<RasterStimulus> {
        let job = |(frame, recipe): (&Frame, &RasterParameters)| RasterStimulus {
            frame: frame.clone(),
            thresholds: PortThresholds::applied(&recipe.base),
        };
        self.frames.iter().zip(&self.recipes).map(job).collect()
    }
}

/// Plays frames after a reset, and stops after some clocks.
fn check_sequence(
    driver: &mut RasterDriver,
    recipe: &RasterParameters,
    script: &ClipScript,
    clocks: i64,
) -> RasterCheckResult {
    check_zoned_sequence(driver, recipe, script, clocks, &mut ClassMapLog::new(&recipe.base))
}

/// Plays frames after a reset, and stops after some clocks. `maps` has all edges before.
pub(crate) fn check_zoned_sequence(
    driver: &mut RasterDriver,
    recipe: &RasterParameters,
    script: &ClipScript,
    clocks: i64,
    maps: &mut ClassMapLog,
) -> RasterCheckResult {
    let clip = RasterClip::new(recipe, script);
    let rest = 40 + recipe.words() / 2;
    let trace = driver.run(&clip.stimuli(), rest, clocks);
    RasterOracle::check_with_maps(recipe, &clip.recipes, &clip.frames, &trace, maps)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(1000)))]

    #[test]
    fn every_port_after_every_edge(
        recipe in arbitrary_raster_parameters(),
        script in arbitrary_scripts(4),
        traffic in arbitrary_traffic(),
    ) {
        let mut driver = RasterDriver::new(&recipe, traffic);
        // A sink that is never ready stops every frame that waits for it, so the number of clocks
        // is limited.
        let clocks = 60 * recipe.advances();
        prop_assert_eq!(check_sequence(&mut driver, &recipe, &script, clocks), Ok(()));
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in arbitrary_raster_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), 1i64..=2),
    ) {
        let mut driver = RasterDriver::new(&recipe, traffic);
        let clocks = SeededRandom(cut).below(recipe.advances() * before.len() as i64 + 100);
        prop_assert_eq!(check_sequence(&mut driver, &recipe, &before, clocks), Ok(()));
        driver.reset(held);
        let clocks = 60 * recipe.advances();
        prop_assert_eq!(check_sequence(&mut driver, &recipe, &after, clocks), Ok(()));
    }
}
