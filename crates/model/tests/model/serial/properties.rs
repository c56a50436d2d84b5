// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, pixels that
//! are not taken, thresholds that change between frames, skipped clocks, and resets at any edge.

use foveate_design::FeatureKind;
use foveate_model::{CoreInput, SerialRcm, Thresholds};
use proptest::prelude::*;

use super::bench::{Bench, Check, Job, Manner, applied};
use super::recipe::{SerialRecipe, serial_recipes};
use super::waveform::facts;
use crate::frames::{Random, Script, film, scripts};
use crate::oracle::watch_changing;
use crate::recipe::Recipe;

fn manners() -> impl Strategy<Value = Manner> {
    let gaps = prop_oneof![2 => Just(0i64), 1 => 1i64..70];
    let pushing = prop_oneof![Just(0i64), Just(50), Just(100)];
    (gaps, 0i64..20, pushing, any::<bool>(), any::<u64>()).prop_map(
        |(gaps, between, pushing, skips, seed)| Manner { gaps, between, pushing, skips, seed },
    )
}

/// Returns the recipe with other thresholds, if they are inputs.
fn changed(recipe: &Recipe, seed: u64) -> Recipe {
    let mut recipe = recipe.clone();
    let mut random = Random(seed);
    if recipe.constant || random.below(3) == 0 {
        return recipe;
    }
    for feature in &mut recipe.features {
        feature.level /= 1 + random.below(3);
        // The threshold stays a whole number, as counts of hits must be.
        feature.min_milli = feature.min_milli / (1 + random.below(3)) / 1000 * 1000;
    }
    recipe.temporal_level /= 1 + random.below(3);
    recipe.temporal_min /= 1 + random.below(3);
    if let Some(periphery) = &mut recipe.periphery {
        periphery.level /= 1 + random.below(3);
    }
    recipe
}

/// Returns the values of the threshold inputs. They are arbitrary if the core has constants.
fn applied_thresholds(recipe: &Recipe) -> Thresholds {
    if recipe.constant {
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

/// Returns a clip with the thresholds of each frame and the results of the oracle.
pub(crate) fn jobs(recipe: &SerialRecipe, script: &Script) -> Vec<Job> {
    let film = film(&recipe.base, script);
    let recipes: Vec<Recipe> =
        script.iter().map(|&(_, seed)| changed(&recipe.base, seed)).collect();
    let history = watch_changing(&recipes, &film);
    let job = |((frame, seen), changed): ((&_, &_), &Recipe)| Job {
        pixels: applied(recipe, frame),
        thresholds: applied_thresholds(changed),
        facts: facts(seen),
    };
    film.iter().zip(&history).zip(&recipes).map(job).collect()
}

/// Runs some edges, resets the array, and runs a new clip from its start.
fn interrupted(bench: &mut Bench, before: &[Job], after: &[Job], edges: i64, held: bool) -> Check {
    bench.stop_after(edges);
    bench.run(before)?;
    bench.stop_after(i64::MAX);
    bench.reset(true)?;
    if held {
        bench.reset(false)?;
    }
    bench.run(after)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn every_port_after_every_edge(
        recipe in serial_recipes(),
        script in scripts(4),
        manner in manners(),
    ) {
        let rcm = SerialRcm::new(recipe.design().serial().unwrap());
        let check = Bench::new(&recipe, rcm, manner).run(&jobs(&recipe, &script));
        prop_assert_eq!(check, Ok(()));
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in serial_recipes(),
        (before, after) in (scripts(3), scripts(2)),
        manner in manners(),
        (cut, held) in (any::<u64>(), any::<bool>()),
    ) {
        let mut bench = Bench::new(&recipe, SerialRcm::new(recipe.design().serial().unwrap()), manner);
        let frame = recipe.frame_pixels() + recipe.steps_per_frame() + 1;
        // A third of the resets come while pixels are taken, although that is the smaller part of a
        // frame.
        let whole = frame * before.len() as i64;
        let edges = Random(cut).below(if cut % 3 == 0 { recipe.frame_pixels() } else { whole });
        let (before, after) = (jobs(&recipe, &before), jobs(&recipe, &after));
        prop_assert_eq!(interrupted(&mut bench, &before, &after, edges, held), Ok(()));
    }

    #[test]
    fn skipping_is_stepping(
        recipe in serial_recipes(),
        script in scripts(2),
        cut in any::<u64>(),
        clocks in prop_oneof![0u64..5, 0u64..100_000],
    ) {
        let jobs = jobs(&recipe, &script);
        let mut bench = Bench::new(&recipe, SerialRcm::new(recipe.design().serial().unwrap()), Manner::DENSE);
        let frame = recipe.frame_pixels() + recipe.steps_per_frame() + 1;
        bench.stop_after(Random(cut).below(frame * jobs.len() as i64));
        prop_assert_eq!(bench.run(&jobs), Ok(()));
        let (mut stepped, mut skipped) = (bench.rcm.clone(), bench.rcm);
        let (pixels, thresholds) = (vec![0; recipe.ports() as usize], jobs[0].thresholds);
        let idle =
            CoreInput::idle(&pixels, &thresholds);
        let ready_in = stepped.clocks_until_ready();
        for clock in 0..clocks {
            prop_assert_eq!(stepped.output().ready, clock >= ready_in);
            stepped.step(&idle);
        }
        skipped.skip(clocks);
        prop_assert_eq!(skipped.output(), stepped.output());
        prop_assert!(skipped == stepped, "the same state");
    }
}
