// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, words that
//! are not taken, sinks that stall, memories that fail, thresholds that change between frames, and
//! resets at any edge.

use foveate_design::FeatureKind;
use foveate_frame::Frame;
use foveate_model::Thresholds;
use proptest::prelude::*;

use super::driver::{Driver, Job, Manner, Sink};
use super::expected::{Check, Oracle};
use super::memory::Faults;
use super::recipe::{RasterRecipe, raster_recipes};
use crate::frames::{Random, Script, film, scripts};

fn manners() -> impl Strategy<Value = Manner> {
    let gaps = prop_oneof![3 => Just(0i64), 1 => 1i64..70];
    let pushing = prop_oneof![Just(0i64), Just(50), Just(100)];
    let sink = prop_oneof![
        2 => Just(Sink::Often(100)),
        2 => (5i64..100).prop_map(Sink::Often),
        1 => Just(Sink::Often(0)),
        2 => (2i64..60).prop_map(Sink::Turns),
        2 => (60i64..3000).prop_map(Sink::Turns),
    ];
    let faults = prop_oneof![
        2 => Just(Faults::NONE),
        1 => (0i64..20, 0i64..20).prop_map(|(missing, wrong)| Faults { missing, wrong }),
        1 => (0i64..500, 0i64..500).prop_map(|(missing, wrong)| Faults { missing, wrong }),
    ];
    let source = (gaps, 0i64..20, pushing);
    (source, sink, faults, any::<u64>()).prop_map(
        |((gaps, between, pushing), sink, faults, seed)| Manner {
            gaps,
            between,
            pushing,
            sink,
            faults,
            seed,
        },
    )
}

/// Returns the recipe with other thresholds, if they are inputs.
fn changed(recipe: &RasterRecipe, seed: u64) -> RasterRecipe {
    let mut recipe = recipe.clone();
    let mut random = Random(seed);
    if recipe.base.constant || random.below(3) == 0 {
        return recipe;
    }
    for feature in &mut recipe.base.features {
        feature.level /= 1 + random.below(3);
        // The threshold stays a whole number, as counts of hits must be.
        feature.min_milli = feature.min_milli / (1 + random.below(3)) / 1000 * 1000;
    }
    recipe.base.temporal_level /= 1 + random.below(3);
    recipe.base.temporal_min /= 1 + random.below(3);
    if let Some(periphery) = &mut recipe.base.periphery {
        periphery.level /= 1 + random.below(3);
    }
    recipe
}

/// Returns the values of the threshold inputs. They are arbitrary if the core has constants.
fn applied(recipe: &RasterRecipe) -> Thresholds {
    if recipe.base.constant {
        let (level, min_score) = ([1; FeatureKind::COUNT], [1; FeatureKind::COUNT]);
        return Thresholds {
            level,
            min_score,
            temporal_level: 0,
            temporal_min_count: 1,
            summary_level: 0,
        };
    }
    Thresholds::of(&recipe.design())
}

/// A clip with the thresholds of each frame.
pub(crate) struct Film {
    pub(crate) frames: Vec<Frame>,
    pub(crate) recipes: Vec<RasterRecipe>,
}

impl Film {
    pub(crate) fn new(recipe: &RasterRecipe, script: &Script) -> Self {
        let recipes = script.iter().map(|&(_, seed)| changed(recipe, seed)).collect();
        Self { frames: film(&recipe.base, script), recipes }
    }

    pub(crate) fn jobs(&self) -> Vec<Job> {
        let job = |(frame, recipe): (&Frame, &RasterRecipe)| Job {
            frame: frame.clone(),
            thresholds: applied(recipe),
        };
        self.frames.iter().zip(&self.recipes).map(job).collect()
    }
}

/// Plays frames after a reset, and stops after some clocks.
fn sequence(driver: &mut Driver, recipe: &RasterRecipe, script: &Script, clocks: i64) -> Check {
    let film = Film::new(recipe, script);
    let rest = 40 + recipe.words() / 2;
    let trace = driver.run(&film.jobs(), rest, clocks);
    Oracle::check(recipe, &film.recipes, &film.frames, &trace)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_port_after_every_edge(
        recipe in raster_recipes(),
        script in scripts(4),
        manner in manners(),
    ) {
        let mut driver = Driver::new(&recipe, manner);
        // A sink that is never ready stops every frame that waits for it, so the number of clocks
        // is limited.
        let clocks = 60 * recipe.advances();
        prop_assert_eq!(sequence(&mut driver, &recipe, &script, clocks), Ok(()));
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in raster_recipes(),
        (before, after) in (scripts(3), scripts(2)),
        manner in manners(),
        (cut, held) in (any::<u64>(), 1i64..=2),
    ) {
        let mut driver = Driver::new(&recipe, manner);
        let clocks = Random(cut).below(recipe.advances() * before.len() as i64 + 100);
        prop_assert_eq!(sequence(&mut driver, &recipe, &before, clocks), Ok(()));
        driver.reset(held);
        let clocks = 60 * recipe.advances();
        prop_assert_eq!(sequence(&mut driver, &recipe, &after, clocks), Ok(()));
    }
}
