// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, words that
//! are not taken, sinks that stall, memories that fail, thresholds that change between frames, and
//! resets at any edge.

use foveate_pixels::Frame;
use proptest::prelude::*;

use super::driver::{RasterDriver, RasterStimulus, RasterTrace, RasterTraffic, SinkPattern};
use super::memory::MemoryFaultRates;
use super::raster_oracle::RasterOracle;
use super::raster_parameters::{
    RasterParameters, arbitrary_raster_parameters, arbitrary_zoned_raster_parameters,
};
use crate::frames::{ClipScript, SeededRandom, arbitrary_scripts, make_clip};
use crate::oracle::{OracleOutcome, check_memory};
use crate::port_thresholds::PortThresholds;

fn arbitrary_traffic() -> impl Strategy<Value = RasterTraffic> {
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

/// A clip with the thresholds of each frame.
pub(crate) struct RasterClip {
    frames: Vec<Frame>,
    recipes: Vec<RasterParameters>,
}

impl RasterClip {
    /// Makes the clip of a script, with other thresholds in each frame if they are inputs.
    fn from_script(recipe: &RasterParameters, script: &ClipScript) -> Self {
        let other = |&(_, seed): &(_, u64)| RasterParameters {
            base: recipe.base.with_other_thresholds(seed),
            ..recipe.clone()
        };
        Self {
            frames: make_clip(&recipe.base, script),
            recipes: script.iter().map(other).collect(),
        }
    }

    /// Makes a clip whose frames all have the thresholds of the recipe.
    pub(crate) fn from_frames(recipe: &RasterParameters, frames: &[Frame]) -> Self {
        Self { frames: frames.to_vec(), recipes: vec![recipe.clone(); frames.len()] }
    }

    /// Plays the clip and `rest` clocks after a reset, stops after some clocks, and checks all
    /// outputs. Once nothing is pending, the core must know the references and summaries for the
    /// next frame.
    pub(crate) fn check(
        &self,
        driver: &mut RasterDriver,
        (rest, clocks): (i64, i64),
    ) -> Result<(RasterTrace, Vec<OracleOutcome>), String> {
        let job = |(frame, recipe): (&Frame, &RasterParameters)| RasterStimulus {
            frame: frame.clone(),
            thresholds: PortThresholds::applied(&recipe.base),
        };
        let jobs: Vec<_> = self.frames.iter().zip(&self.recipes).map(job).collect();
        let recipe = driver.recipe.clone();
        let trace = driver.run(&jobs, rest, clocks);
        let (recipes, frames) = (&self.recipes, &self.frames);
        let history = RasterOracle::check(&recipe, recipes, frames, &trace, &mut driver.maps)?;
        let regions = recipe.base.columns() * recipe.base.rows();
        let is_decided = |outcome: &OracleOutcome| outcome.regions.len() as i64 == regions;
        let is_over = history.len() == frames.len() && history.iter().all(is_decided);
        if is_over && !driver.rcm.is_pending() {
            check_memory(&recipe.base, &history, &driver.rcm)?;
        }
        Ok((trace, history))
    }
}

fn play(driver: &mut RasterDriver, script: &ClipScript, clocks: i64) -> Result<(), String> {
    let rest = 40 + driver.recipe.words() / 2;
    RasterClip::from_script(&driver.recipe, script).check(driver, (rest, clocks)).map(|_| ())
}

/// Returns a number of clocks that no clip takes, unless its sink is never ready: such a sink stops
/// every frame that waits for it.
fn most_clocks(recipe: &RasterParameters) -> i64 {
    60 * recipe.advances()
}

/// Plays a clip for some clocks, resets the core, and plays another one.
fn play_with_reset(
    recipe: &RasterParameters,
    (before, after): (&ClipScript, &ClipScript),
    traffic: RasterTraffic,
    (clocks, held): (i64, i64),
) -> Result<(), String> {
    let mut driver = RasterDriver::new(recipe, traffic);
    play(&mut driver, before, clocks)?;
    driver.reset(held);
    play(&mut driver, after, most_clocks(recipe))
}

/// Returns a number of clocks in which a clip of this many frames is under way.
fn any_clocks(recipe: &RasterParameters, frames: usize, seed: u64) -> i64 {
    SeededRandom(seed).below(recipe.advances() * frames as i64 + 100)
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
        prop_assert_eq!(play(&mut driver, &script, most_clocks(&recipe)), Ok(()));
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in arbitrary_raster_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), 1i64..=2),
    ) {
        let clocks = any_clocks(&recipe, before.len(), cut);
        let check = play_with_reset(&recipe, (&before, &after), traffic, (clocks, held));
        prop_assert_eq!(check, Ok(()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(600)))]

    /// Maps are written and committed at any edge. The reset comes at any edge of the first clip,
    /// in half of the cases after it. The maps stay.
    #[test]
    fn every_port_after_every_edge_while_maps_are_written(
        recipe in arbitrary_zoned_raster_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), 1i64..=2),
    ) {
        let anywhere = any_clocks(&recipe, before.len(), cut);
        let clocks = if cut % 2 == 0 { anywhere } else { most_clocks(&recipe) };
        let check = play_with_reset(&recipe, (&before, &after), traffic, (clocks, held));
        prop_assert_eq!(check, Ok(()));
    }
}
