// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of every port after every edge, for every kind of design: with gaps, pauses, pixels that
//! are not taken, thresholds that change between frames, skipped clocks, and resets at any edge.

use foveate_model::{ClassMapInputs, CoreInput};
use foveate_pixels::Frame;
use proptest::prelude::*;

use super::bench::{SerialBench, SerialCheckResult, SerialStimulus, SerialTraffic};
use super::serial_parameters::{
    SerialParameters, arbitrary_serial_parameters, arbitrary_zoned_serial_parameters,
};
use crate::frames::{ClipScript, SeededRandom, arbitrary_scripts, make_clip};

fn arbitrary_traffic() -> impl Strategy<Value = SerialTraffic> {
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

/// Returns a clip with the thresholds of each frame.
fn stimuli(recipe: &SerialParameters, script: &ClipScript) -> Vec<SerialStimulus> {
    let frames = make_clip(&recipe.base, script);
    let job = |(frame, &(_, seed)): (&Frame, &(_, u64))| {
        SerialStimulus::new(recipe, recipe.base.with_other_thresholds(seed), frame)
    };
    frames.iter().zip(script).map(job).collect()
}

/// Runs some edges, resets the array, and runs a new clip from its start.
fn run_with_reset(
    recipe: &SerialParameters,
    (before, after): (&ClipScript, &ClipScript),
    traffic: SerialTraffic,
    (edges, held): (i64, bool),
) -> SerialCheckResult {
    let mut bench = SerialBench::new(recipe, traffic);
    bench.stop_after(edges);
    bench.run(&stimuli(recipe, before))?;
    bench.stop_after(i64::MAX);
    bench.reset(true)?;
    if held {
        bench.reset(false)?;
    }
    bench.run(&stimuli(recipe, after))
}

/// Returns the clocks of a frame that comes without gaps.
fn frame_clocks(recipe: &SerialParameters) -> i64 {
    recipe.frame_pixels() + recipe.steps_per_frame() + 1
}

/// Checks that clocks that are skipped after `cut` leave the same state as clocks that are not.
fn check_skipping(
    recipe: &SerialParameters,
    script: &ClipScript,
    cut: u64,
    clocks: u64,
) -> Result<(), TestCaseError> {
    let jobs = stimuli(recipe, script);
    let traffic = SerialTraffic { seed: cut, ..SerialTraffic::DENSE };
    let mut bench = SerialBench::new(recipe, traffic);
    bench.stop_after(SeededRandom(cut).below(frame_clocks(recipe) * jobs.len() as i64));
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
        let check = SerialBench::new(&recipe, traffic).run(&stimuli(&recipe, &script));
        prop_assert_eq!(check, Ok(()));
    }

    /// A third of the resets come while pixels are taken, although that is the smaller part of a
    /// frame.
    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in arbitrary_serial_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), any::<bool>()),
    ) {
        let whole = frame_clocks(&recipe) * before.len() as i64;
        let edges = SeededRandom(cut).below(if cut % 3 == 0 { recipe.frame_pixels() } else { whole });
        let check = run_with_reset(&recipe, (&before, &after), traffic, (edges, held));
        prop_assert_eq!(check, Ok(()));
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(400)))]

    /// Maps are written and committed at any edge. The reset comes at any edge of the first clip,
    /// in half of the cases after it. The maps stay.
    #[test]
    fn every_port_after_every_edge_while_maps_are_written(
        recipe in arbitrary_zoned_serial_parameters(),
        (before, after) in (arbitrary_scripts(3), arbitrary_scripts(2)),
        traffic in arbitrary_traffic(),
        (cut, held) in (any::<u64>(), any::<bool>()),
    ) {
        let anywhere = SeededRandom(cut).below(frame_clocks(&recipe) * before.len() as i64);
        let edges = if cut % 2 == 0 { anywhere } else { i64::MAX };
        let check = run_with_reset(&recipe, (&before, &after), traffic, (edges, held));
        prop_assert_eq!(check, Ok(()));
    }

    #[test]
    fn skipping_is_stepping_with_zones(
        recipe in arbitrary_zoned_serial_parameters(),
        script in arbitrary_scripts(2),
        cut in any::<u64>(),
        clocks in prop_oneof![0u64..5, 0u64..100_000],
    ) {
        check_skipping(&recipe, &script, cut, clocks)?;
    }
}
