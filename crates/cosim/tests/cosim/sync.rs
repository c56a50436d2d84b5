// SPDX-License-Identifier: MIT OR Apache-2.0
//! Designs with `sync`: the contents of their vectors, and the agreement of model and RTL.

use crate::common::vectors::{clock_records, port_value};
use crate::common::{check_agreement, directed_stimulus, has_simulators, in_parallel, in_turn};
use foveate_cosim::{CosimLevel, Recording, Simulator};
use foveate_design::{Design, DesignConfig, PortRole};
use foveate_tools::testing::sample;
use std::collections::BTreeMap;

/// Designs of every organization, in small frames. Every second one is simulated in Icarus, which
/// is slow for many clocks.
const DESIGNS: &[&[&str]] = &[
    &["frame={width=12,height=8}", "region.size=4"],
    &[
        "frame={width=8,height=8}",
        "region={size=4,neighborhood='shared'}",
        "temporal.reference='last-sent'",
    ],
    &[
        "frame={width=9,height=6}",
        "region.size=3",
        "spatial=[{feature='mad'}]",
        "hardware.pipelining='deep'",
    ],
    &[
        "frame={width=4,height=2}",
        "region.size=2",
        "denoise.filter='none'",
        "temporal.min_count=2",
        "spatial.0.min_score=2",
    ],
    &["frame={width=10,height=5}", "region.size=5", "hardware.thresholds='constant'"],
    &["frame={width=8,height=4}", "region.size=4", "render.irrelevant='mean'"],
    &[
        "frame={width=12,height=4}",
        "region.size=4",
        "hardware.organization='serial'",
        "hardware.fold=2",
        "render.irrelevant='mean'",
    ],
    &[
        "frame={width=12,height=8}",
        "region.size=4",
        "hardware={organization='serial',fold=3,feed='raster',memory='block',pipelining='deep'}",
        "denoise.filter='none'",
        "temporal.reference='last-sent'",
    ],
    &[
        "frame={width=8,height=8}",
        "region={size=4,neighborhood='shared'}",
        "hardware.organization='serial'",
        "hardware.feed='raster'",
    ],
    &["frame={width=16,height=12}", "region.size=4", "hardware.organization='raster'"],
    &[
        "frame={width=29,height=7}",
        "region.size=4",
        "hardware={organization='raster',pixels_per_clock=2,pipelining='deep'}",
        "temporal.reference='last-sent'",
        "render.irrelevant='mean'",
    ],
    &[
        "frame={width=13,height=9}",
        "region.size=4",
        "hardware.organization='raster'",
        "temporal.reference='last-sent'",
        "denoise.filter='none'",
    ],
    &[
        "frame={width=64,height=8}",
        "region.size=4",
        "hardware={organization='raster',pixels_per_clock=4,store='external'}",
        "spatial=[{feature='mad'}]",
    ],
    &[
        "frame={width=25,height=11}",
        "region.size=5",
        "hardware={organization='raster',store='single-port',forward=false}",
    ],
];

fn design(keys: &[&str]) -> Design {
    let config = DesignConfig::from_toml_with("", keys).unwrap();
    DesignConfig::from_toml_with(&config.to_toml(), &["hardware.sync=true"])
        .unwrap()
        .validate()
        .unwrap()
}

#[test]
fn the_rtl_of_arrays_that_find_their_frames_agrees() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let designs: Vec<(usize, &&[&str])> = sample(DESIGNS.iter().enumerate(), 5);
    let failures = in_parallel(&designs, |(number, keys)| {
        let design = design(keys);
        let folder = output.path().join(design.fingerprint());
        let what = format!("{keys:?}");
        // Every organization is simulated in both simulators.
        let simulator = in_turn(&Simulator::ALL, *number);
        check_agreement(&what, &design, simulator, directed_stimulus(CosimLevel::Full, 1), &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The state of the frame synchronization, as the ports show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum SyncState {
    Seek,
    Start,
    Inside,
    Fill,
}

/// The counts of a recording.
#[derive(Debug, Default)]
struct SyncCounts {
    errors: u64,
    decisions: u64,
    /// The number of start marks without a beat, by state.
    lone_marks: BTreeMap<SyncState, u64>,
    /// The number of resets, by the state in which they come.
    resets: BTreeMap<SyncState, u64>,
}

fn count_sync_events(design: &Design, recording: &Recording) -> SyncCounts {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let beats = design.timing().pixels_per_frame();
    let has_ready = outputs.fields().iter().any(|field| field.port.role == PortRole::Ready);
    let (mut story, mut state, mut had, mut ready) =
        (SyncCounts::default(), SyncState::Seek, 0, true);
    let mut was_reset = true;
    for (input, output) in clock_records(recording) {
        let given = |role| port_value(inputs, role, &input) == 1;
        let shows = |role| port_value(outputs, role, &output) == 1;
        if given(PortRole::Reset) {
            if !was_reset {
                *story.resets.entry(state).or_default() += 1;
            }
            (state, had, was_reset, ready) = (SyncState::Seek, 0, true, true);
            continue;
        }
        was_reset = false;
        let (valid, sof) = (given(PortRole::Valid), given(PortRole::StartOfFrame));
        if sof && !valid {
            *story.lone_marks.entry(state).or_default() += 1;
        }
        match state {
            // An array with a `ready` output takes nothing until it has completed its frame.
            SyncState::Fill if has_ready => {}
            SyncState::Fill => had += 1,
            _ if !(valid && ready) => {}
            SyncState::Seek | SyncState::Start => {
                (state, had) = if sof { (SyncState::Inside, 1) } else { (SyncState::Seek, 0) };
            }
            SyncState::Inside if sof => state = SyncState::Fill,
            SyncState::Inside => had += 1,
        }
        ready = !has_ready || shows(PortRole::Ready);
        state = match state {
            SyncState::Inside if had == beats => SyncState::Start,
            SyncState::Fill if had == beats || (has_ready && ready) => SyncState::Seek,
            state => state,
        };
        story.errors += u64::from(shows(PortRole::SyncError));
        story.decisions += u64::from(shows(PortRole::DecisionValid));
    }
    story
}

#[test]
fn the_vectors_damage_streams_in_every_state() {
    for keys in DESIGNS {
        let design = design(keys);
        let recording =
            directed_stimulus(CosimLevel::Full, 3).record(&design, &mut |_, _| {}).unwrap();
        let story = count_sync_events(&design, &recording);
        assert!(story.errors >= 36 && story.decisions > 100, "{keys:?} {story:?}");
        for state in [SyncState::Seek, SyncState::Start, SyncState::Inside, SyncState::Fill] {
            let count = |map: &BTreeMap<SyncState, u64>| map.get(&state).copied().unwrap_or(0);
            assert!(count(&story.resets) > 0, "no reset in {state:?}: {keys:?} {story:?}");
            assert!(count(&story.lone_marks) > 0, "no mark alone in {state:?}: {keys:?} {story:?}");
        }
    }
}

/// Without `sync`, designs have the same sequences without the damaged ones.
#[test]
fn without_sync_the_vectors_have_no_damaged_sequences() {
    for keys in DESIGNS {
        let with = design(keys);
        let mut config = with.config();
        config.hardware.sync = false;
        let without = config.validate().unwrap();
        let record = |design: &Design| {
            directed_stimulus(CosimLevel::Full, 1).record(design, &mut |_, _| {}).unwrap()
        };
        let (with, without) = (record(&with), record(&without));
        assert_eq!(with.sequences(), without.sequences() + 14, "{keys:?}");
        let names = without.inputs().fields().iter().chain(without.outputs().fields());
        for name in names.map(|field| &field.port.name) {
            assert!(!name.contains("sof") && !name.contains("sync"), "{name}");
        }
    }
}
