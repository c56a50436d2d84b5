// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raster cores.

use std::collections::BTreeSet;

use foveate_camera::RegionAction;
use foveate_design::{Design, DesignConfig, RasterTiming};
use foveate_engine::Engine;
use foveate_pixels::Frame;
use foveate_timed::CoreTiming;
use proptest::prelude::*;

use crate::clip_script::{FrameChange, clip, scripts};
use crate::comparison::{
    PlantedFault, cases, check, event_kinds, first_difference, found_faults, is_whole, recordings,
    with_any_sync,
};
use crate::driver::{Driver, RecordedRun};
use crate::event::CoreEvent;
use crate::raster_parameters::arbitrary_raster_parameters;
use crate::traffic::traffic;

fn designs() -> impl Strategy<Value = Design> {
    with_any_sync(arbitrary_raster_parameters().prop_map(|recipe| recipe.design()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(120)))]

    #[test]
    fn every_transaction_of_a_raster_core_has_its_clock(
        design in designs(),
        (seed, script) in scripts(),
        traffic in traffic(),
    ) {
        check(&design, traffic, &clip(&design, seed, &script));
    }
}

#[test]
fn random_traffic_of_raster_cores_shows_every_kind_of_event() {
    let expected = [
        "aborted means",
        "aborted pixels",
        "decision",
        "error",
        "loss",
        "mean",
        "pixels",
        "reset",
        "summary",
    ];
    assert_eq!(event_kinds(&recordings(designs(), 60)), BTreeSet::from(expected));
}

#[test]
fn the_comparison_finds_every_wrong_number_of_a_raster_core() {
    let recordings = recordings(designs(), 60);
    let faults: [PlantedFault<RasterTiming>; 15] = [
        ("stored late", |timing| timing.store_latency += 1),
        ("stored early", |timing| timing.store_latency -= 1),
        ("decided late", |timing| timing.decision_latency += 1),
        ("decided early", |timing| timing.decision_latency -= 1),
        ("queued long", |timing| timing.queue_latency += 1),
        ("queued briefly", |timing| timing.queue_latency -= 1),
        ("held rarely", |timing| timing.hold_interval += 1),
        ("held often", |timing| timing.hold_interval -= 1),
        ("a row more", |timing| timing.buffer_rows += 1),
        ("a row less", |timing| timing.buffer_rows = timing.buffer_rows.saturating_sub(1)),
        ("a window more", |timing| timing.windows += 1),
        ("no wait for pending regions", |timing| timing.waits_for_pending = false),
        ("a late second pass", |timing| {
            timing.second_pass.iter_mut().for_each(|pass| pass.after_store += 1);
        }),
        ("a late decision after it", |timing| {
            timing.second_pass.iter_mut().for_each(|pass| pass.decision_latency += 1);
        }),
        ("no second pass", |timing| timing.second_pass = None),
    ];
    for (name, plant) in faults {
        let faulty = |design: &Design| {
            let mut timing = RasterTiming::from_design(design.as_raster().unwrap());
            plant(&mut timing);
            CoreTiming::Raster(timing)
        };
        assert!(found_faults(&recordings, faulty) > 0, "{name}");
    }
}

/// Returns a small design whose values depend on losses.
fn design_with_losses(keys: &str) -> Design {
    let toml = format!(
        "frame = {{ width = 36, height = 30 }}\nregion.size = 4\ndenoise.filter = \"none\"\n\
         temporal.min_count = 1\nhardware.organization = \"raster\"\n{keys}"
    );
    DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
}

/// The sink stalls once, so long that regions are lost, from every clock of a frame on. Afterwards
/// frames are still, so that lost regions differ from the others only in what was forgotten.
#[test]
fn a_loss_at_every_clock_changes_the_next_frame() {
    let designs = [
        "temporal.reference = \"last-sent\"\n[[spatial]]\nfeature = \"edge\"\nmin_score = 0",
        "render.irrelevant = \"mean\"\n[[spatial]]\nfeature = \"variance\"\nmin_score = 5000",
        "temporal.reference = \"last-sent\"\nrender.irrelevant = \"mean\"\n[periphery]\n\
         blocks = 2\n[[spatial]]\nfeature = \"mad\"\nmin_score = 62",
    ];
    for keys in designs {
        let design = design_with_losses(keys);
        let clocks = design.timing().clocks_per_frame();
        let script =
            [FrameChange::Still, FrameChange::Noise, FrameChange::Still, FrameChange::Still];
        let frames = clip(&design, 7, &script);
        let plain = decisions_without_losses(&design, &frames);
        let step = if is_whole() { 1 } else { 7 };
        let mut changed = 0;
        for start in (0..clocks).step_by(step) {
            let stall = start + 2 * clocks..start + 3 * clocks - clocks / 4;
            let recorded = Driver::with_stall(&design, stall).play(&frames);
            let timing = CoreTiming::from_design(&design);
            let difference = first_difference(&design, timing, &recorded);
            assert_eq!(difference, None, "a stall from clock {start} of a frame, {keys}");
            changed += u64::from(decisions(&recorded) != plain);
        }
        assert!(changed * step as u64 > clocks / 2, "{changed} stalls changed a decision, {keys}");
    }
}

/// Returns what is decided: the region, its relevance, whether it sends a summary, and its count.
type DecidedRegion = (u32, [bool; 2], bool, u32);

fn decisions(recorded: &RecordedRun) -> Vec<DecidedRegion> {
    let decisions = recorded.events.iter().filter_map(|event| match event.event {
        CoreEvent::Decision { region, relevance, summary, count, .. } => {
            Some((region, relevance, summary, count))
        }
        CoreEvent::SyncError
        | CoreEvent::Score { .. }
        | CoreEvent::SerialDecision { .. }
        | CoreEvent::SerialWord { .. }
        | CoreEvent::Word { .. }
        | CoreEvent::Loss { .. } => None,
    });
    decisions.collect()
}

fn decisions_without_losses(design: &Design, frames: &[Frame]) -> Vec<DecidedRegion> {
    let mut engine = Engine::new(design);
    let mut decisions = Vec::new();
    for frame in frames {
        let outcome = engine.step(frame).unwrap();
        decisions.extend((0..design.regions()).map(|region| {
            let place = region as usize;
            let summary = outcome.actions[place] == RegionAction::Summarize;
            let relevance = [outcome.srs[place], outcome.trs[place]];
            (region, relevance, summary, outcome.temporal_count[place])
        }));
    }
    decisions
}
