// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, pixels that
//! are not taken, thresholds that change between frames, skipped clocks, and resets at any edge.

use foveate_model::{ClassMapInputs, CoreInput, SerialRcm};
use proptest::prelude::*;

use super::bench::{SerialBench, SerialCheckResult, SerialStimulus, SerialTraffic, port_pixels};
use super::expected_outputs::region_results;
use super::serial_parameters::{SerialParameters, arbitrary_serial_parameters};
use crate::class_maps::ZonedFrame;
use crate::frames::{ClipScript, SeededRandom, arbitrary_scripts, make_clip};
use crate::oracle::oracle_history_with_thresholds;
use crate::parameters::DesignParameters;
use crate::port_thresholds::PortThresholds;

pub(crate) fn arbitrary_traffic() -> impl Strategy<Value = SerialTraffic> {
    let gaps = prop_oneof![2 => Just(0i64), 1 => 1i64..70];
    let pushing = prop_oneof![Just(0i64), Just(50), Just(100)];
    (gaps, 0i64..20, pushing, any::<bool>(), any::<u64>()).prop_map(
        |(gaps, between, pushing, skips, seed)| SerialTraffic {
            gaps,
            max_pause: between,
            pushing,
            skips,
            seed,
        },
    )
}

/// Returns a clip with the thresholds of each frame and the results of the oracle.
pub(crate) fn stimuli(recipe: &SerialParameters, script: &ClipScript) -> Vec<SerialStimulus> {
    let clip = make_clip(&recipe.base, script);
    let recipes: Vec<DesignParameters> =
        script.iter().map(|&(_, seed)| recipe.base.with_other_thresholds(seed)).collect();
    let history = oracle_history_with_thresholds(&recipes, &clip);
    let job = |((frame, outcome), changed): ((&_, &_), &DesignParameters)| SerialStimulus {
        pixels: port_pixels(recipe, frame),
        thresholds: PortThresholds::applied(changed),
        facts: region_results(outcome),
        zoned: recipe.base.zones.as_ref().map(|_| {
            let (recipe, frame) = (changed.clone(), (*frame).clone());
            ZonedFrame { recipe, frame }
        }),
    };
    clip.iter().zip(&history).zip(&recipes).map(job).collect()
}

/// Runs some edges, resets the array, and runs a new clip from its start.
pub(crate) fn run_with_reset(
    bench: &mut SerialBench,
    before: &[SerialStimulus],
    after: &[SerialStimulus],
    edges: i64,
    held: bool,
) -> SerialCheckResult {
    bench.stop_after(edges);
    bench.run(before)?;
    bench.stop_after(i64::MAX);
    bench.reset(true)?;
    if held {
        bench.reset(false)?;
    }
    bench.run(after)
}

/// Checks that clocks that are skipped after `cut` leave the same state as clocks that are not.
pub(crate) fn check_skipping(
    recipe: &SerialParameters,
    script: &ClipScript,
    cut: u64,
    clocks: u64,
) -> Result<(), TestCaseError> {
    let jobs = stimuli(recipe, script);
    let rcm = SerialRcm::new(recipe.design().as_serial().unwrap());
    let mut bench =
        SerialBench::new(recipe, rcm, SerialTraffic { seed: cut, ..SerialTraffic::DENSE });
    let frame = recipe.frame_pixels() + recipe.steps_per_frame() + 1;
    bench.stop_after(SeededRandom(cut).below(frame * jobs.len() as i64));
    prop_assert_eq!(bench.run(&jobs), Ok(()));
    let (mut stepped, mut skipped) = (bench.rcm.clone(), bench.rcm);
    let (pixels, thresholds) = (vec![0; recipe.port_pixels() as usize], jobs[0].thresholds);
    let zones = recipe.base.zones.as_ref();
    let zones = zones.map(|_| thresholds.zone_inputs(ClassMapInputs::default()));
    let idle = CoreInput { zones, ..CoreInput::idle(&pixels, &thresholds.own) };
    let (ready_in, quiet) = (stepped.clocks_until_ready(), stepped.quiet_clocks());
    let before = stepped.output().clone();
    for clock in 0..clocks {
        prop_assert_eq!(stepped.output().ready, clock >= ready_in);
        prop_assert!(clock > quiet || stepped.output() == &before, "a quiet clock");
        stepped.step(&idle);
    }
    skipped.skip(clocks);
    prop_assert_eq!(skipped.output(), stepped.output());
    prop_assert!(skipped == stepped, "the same state");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(500)))]

    #[test]
    fn every_port_after_every_edge(
        recipe in arbitrary_serial_parameters(),
        script in arbitrary_scripts(4),
        traffic in arbitrary_traffic(),
    ) {
        let rcm = SerialRcm::new(recipe.design().as_serial().unwrap());
        let check = SerialBench::new(&recipe, rcm, traffic).run(&stimuli(&recipe, &script));
        prop_assert_eq!(check, Ok(()));
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in arbitrary_serial_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), any::<bool>()),
    ) {
        let mut bench = SerialBench::new(&recipe, SerialRcm::new(recipe.design().as_serial().unwrap()), traffic);
        let frame = recipe.frame_pixels() + recipe.steps_per_frame() + 1;
        // A third of the resets come while pixels are taken, although that is the smaller part of a
        // frame.
        let whole = frame * before.len() as i64;
        let edges = SeededRandom(cut).below(if cut % 3 == 0 { recipe.frame_pixels() } else { whole });
        let (before, after) = (stimuli(&recipe, &before), stimuli(&recipe, &after));
        prop_assert_eq!(run_with_reset(&mut bench, &before, &after, edges, held), Ok(()));
    }

    #[test]
    fn skipping_is_stepping(
        recipe in arbitrary_serial_parameters(),
        script in arbitrary_scripts(2),
        cut in any::<u64>(),
        clocks in prop_oneof![0u64..5, 0u64..100_000],
    ) {
        check_skipping(&recipe, &script, cut, clocks)?;
    }
}
