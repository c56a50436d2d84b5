// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raster cores with an external or a single-port frame store, and cores without forwarding: the
//! contents of their vectors, and the agreement of model and RTL.

use std::collections::VecDeque;

use crate::common::vectors::{clock_records, field_of_role, port_value};
use crate::common::{
    check_agreement, config_name, design, directed_stimulus, feature, feature_sets, has_simulators,
    in_parallel, in_turn,
};
use foveate_camera::{CameraConfig, DenoiseFilter, FeatureKind, Neighborhood, Payload};
use foveate_cosim::{CosimLevel, Recording, Simulator};
use foveate_design::{
    Design, DesignConfig, FrameStoreKind, Organization, Pipelining, PortRole, RasterTiming,
    ThresholdSource,
};
use foveate_tools::testing::{cover, sample};

/// Returns a configuration with an external store and regions of 4x4 pixels with these features.
fn config(kinds: &[FeatureKind]) -> DesignConfig {
    let spatial = kinds.iter().map(|&kind| feature(kind, 1)).collect();
    let mut config = DesignConfig::from(CameraConfig { spatial, ..CameraConfig::default() });
    config.hardware.make_raster().store = Some(FrameStoreKind::External);
    config.camera.region.size = 4;
    config
}

/// Returns designs with an external store: plain and deep, with words of one and two pixels, and
/// with a second pass.
fn external_store_designs() -> [Design; 3] {
    let plain = config(&[FeatureKind::Edge, FeatureKind::Variance]);
    let mut deep = config(&[FeatureKind::Corner]);
    deep.hardware.pipelining = Pipelining::Deep;
    deep.hardware.make_raster().pixels_per_clock = Some(2);
    deep.camera.region.neighborhood = Neighborhood::Shared;
    deep.hardware.make_raster().forward = Some(false);
    let mut pass = config(&[FeatureKind::Mad]);
    pass.camera.denoise.filter = DenoiseFilter::None;
    [design(&plain, (4, 3)), design(&deep, (8, 2)), design(&pass, (4, 3))]
}

fn record(design: &Design, rounds: u32) -> Recording {
    directed_stimulus(CosimLevel::Full, rounds).record(design, &mut |_, _| {}).unwrap()
}

/// The references that the core asked for in a sequence.
#[derive(Debug, Default)]
struct ReferenceCounts {
    name: String,
    /// The number of valid words that equal those stored a frame earlier.
    right: u64,
    /// The number of valid words that differ from those stored a frame earlier.
    wrong: u64,
    /// The number of requested words that were not valid.
    missing: u64,
    /// The number of valid words at edges at which the core asked for none.
    unasked: u64,
    /// The index of the first word that was missing or wrong.
    first_fault: Option<u64>,
    /// True if the sequence ended with `reference_ready_o`.
    ends_asking: bool,
    /// True if the sequence ended with `underrun_o`.
    ends_in_underrun: bool,
}

/// Checks the ports against the contract at every clock, and returns the counts of every sequence.
fn reference_counts(design: &Design, recording: &Recording) -> Vec<ReferenceCounts> {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let words = RasterTiming::from_design(design.as_raster().unwrap()).words();
    let mut before = outputs.zero_record();
    let (mut stories, mut stored) = (Vec::<ReferenceCounts>::new(), VecDeque::new());
    let (mut asked, mut underrun) = (0, false);
    for (clock, (input, output)) in (0..).zip(clock_records(recording)) {
        let shows = |role| port_value(outputs, role, &output) == 1;
        let was_asked = port_value(outputs, PortRole::ReferenceReady, &before) == 1;
        if port_value(inputs, PortRole::Reset, &input) == 1 {
            if let Some(story) = stories.last_mut().filter(|_| asked + stored.len() as u64 > 0) {
                (story.ends_asking, story.ends_in_underrun) = (was_asked, underrun);
            }
            (asked, underrun) = (0, false);
            stored.clear();
            let name = recording.span(clock).unwrap().sequence.clone();
            stories.push(ReferenceCounts { name, ..ReferenceCounts::default() });
            assert!(!shows(PortRole::ReferenceReady) && !shows(PortRole::StoreValid));
        } else {
            let story = stories.last_mut().unwrap();
            let valid = port_value(inputs, PortRole::ReferenceValid, &input) == 1;
            if was_asked {
                let due: u64 = stored.pop_front().expect("only what was stored is asked for");
                let is_right = port_value(inputs, PortRole::ReferencePixel, &input) == due;
                match (valid, is_right) {
                    (true, true) => story.right += 1,
                    (true, false) => story.wrong += 1,
                    (false, _) => story.missing += 1,
                }
                if !valid || !is_right {
                    story.first_fault.get_or_insert(asked);
                }
                underrun |= !valid;
                asked += 1;
            } else {
                story.unasked += u64::from(valid);
            }
        }
        assert_eq!(shows(PortRole::Underrun), underrun, "clock {clock}");
        if shows(PortRole::StoreValid) {
            stored.push_back(port_value(outputs, PortRole::StorePixel, &output));
        }
        // In each frame as many words are stored as are requested of the frame before, except in
        // the first frame.
        assert!(stored.len() as u64 <= words + 2, "clock {clock}");
        before = output;
    }
    // A reset may take two clocks.
    stories.retain(|story| story.right + story.wrong + story.missing + story.unasked > 0);
    stories
}

#[test]
fn the_store_returns_what_was_stored_except_for_its_faults() {
    for design in external_store_designs() {
        let stories = reference_counts(&design, &record(&design, 3));
        let of = |name: &'static str| stories.iter().filter(move |story| story.name == name);
        let (mut right, mut underruns) = (0, 0);
        for story in &stories {
            let fails = story.name.contains("references") && !story.name.contains("while")
                || story.name.contains("underrun");
            assert!(fails || story.wrong + story.missing == 0, "{story:?}");
            right += story.right;
            underruns += u32::from(story.missing > 0);
            assert!(story.unasked > 0, "{story:?}");
        }
        assert!(right > 10_000 && underruns >= 9, "{right} {underruns}");
        for story in of("late references") {
            // Words are off by one after each of the two that were late.
            assert!(story.missing == 2 && story.wrong > 100, "{story:?}");
        }
        for story in of("lost references") {
            // The words that come are those that are due.
            assert!(story.missing == 2 && story.wrong == 0, "{story:?}");
        }
        for story in of("wrong references") {
            assert!(story.missing == 0 && story.wrong > 20 && story.right > 100, "{story:?}");
        }
        assert!(of("reset after an underrun").all(|story| story.ends_in_underrun), "{stories:?}");
        let asking = stories.iter().filter(|story| story.ends_asking).count();
        assert!(asking > 2, "{asking} resets while references come");
        let firsts: std::collections::BTreeSet<_> =
            stories.iter().filter_map(|story| story.first_fault).collect();
        assert!(firsts.contains(&0) && firsts.len() > 3, "{firsts:?}");
    }
}

/// A wrong reference changes scores.
#[test]
fn wrong_references_change_temporal_counts() {
    let [design, ..] = external_store_designs();
    let (recording, inside) = (record(&design, 1), {
        let mut config = design.config();
        config.hardware.make_raster().store = Some(FrameStoreKind::Block);
        record(&config.validate().unwrap(), 1)
    });
    // The sequences of both recordings are equal up to the first one with a faulty store.
    let counts = |recording: &Recording| -> Vec<(String, u64)> {
        let outputs = recording.outputs();
        let decided = (0..)
            .zip(clock_records(recording))
            .filter(|(_, (_, output))| port_value(outputs, PortRole::DecisionValid, output) == 1);
        let count = |(clock, (_, output)): (u64, (Vec<u8>, Vec<u8>))| {
            let name = recording.span(clock).unwrap().sequence.clone();
            (name, port_value(outputs, PortRole::TemporalCount, &output))
        };
        decided.map(count).collect()
    };
    let (own, block) = (counts(&recording), counts(&inside));
    assert!(own.len() > block.len());
    let flat =
        |(name, count): &&(String, u64)| name == "wrong references of extremes" && *count > 0;
    let changed = own.iter().filter(flat).count();
    assert!(changed > 12 + 12, "more than the first frame and the step: {changed}");
}

#[test]
fn without_forwarding_there_are_no_forward_columns() {
    let mut config = config(&[FeatureKind::Edge]);
    config.hardware.make_raster().store = Some(FrameStoreKind::SinglePort);
    config.hardware.make_raster().forward = Some(false);
    let design = design(&config, (4, 3));
    let recording = record(&design, 1);
    let layouts = [recording.inputs(), recording.outputs()];
    let names: Vec<&str> = layouts
        .iter()
        .flat_map(|layout| layout.fields())
        .map(|field| field.port.name.as_str())
        .collect();
    for part in ["forward", "lost", "reference", "store", "underrun"] {
        assert!(names.iter().all(|name| !name.contains(part)), "{names:?}");
    }
    let active = field_of_role(recording.outputs(), PortRole::Active);
    let seen =
        clock_records(&recording).iter().filter(|(_, output)| active.get(output, 0) == 1).count();
    assert!(seen > 100, "{seen} active regions");
}

/// Returns the designs of every store, with and without forwarding: features x pipelining, with the
/// other keys in turn.
fn matrix() -> Vec<Design> {
    [
        (FrameStoreKind::SinglePort, true),
        (FrameStoreKind::External, true),
        (FrameStoreKind::Block, false),
        (FrameStoreKind::SinglePort, false),
        (FrameStoreKind::External, false),
    ]
    .map(|(store, forward)| designs_with_store(store, forward))
    .concat()
}

fn designs_with_store(store: FrameStoreKind, forward: bool) -> Vec<Design> {
    let mut designs = Vec::new();
    for kinds in feature_sets(Organization::Raster) {
        for pipelining in [Pipelining::Plain, Pipelining::Deep] {
            let turn = designs.len();
            let mut config = config(&kinds);
            config.hardware.make_raster().store = Some(store);
            config.hardware.make_raster().forward = Some(forward);
            config.hardware.pipelining = pipelining;
            let (size, pixels) = [(4, 1), (4, 2), (5, 1), (8, 4), (4, 4)][turn % 5];
            (config.camera.region.size, config.hardware.make_raster().pixels_per_clock) =
                (size, Some(pixels));
            config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn / 2);
            config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 3);
            config.camera.render.payload = in_turn(Payload::ALL, turn / 2);
            config.hardware.thresholds =
                [ThresholdSource::Runtime, ThresholdSource::Runtime, ThresholdSource::Constant]
                    [turn % 3];
            let columns = (16 * pixels).div_ceil(size).max(4);
            // Every second frame does not fill its last column and row of regions.
            let odd = u32::try_from(turn % 2).unwrap();
            config.camera.frame.width = Some(columns * size - odd);
            config.camera.frame.height = Some(3 * size - 2 * odd);
            designs.push(config.validate().unwrap());
        }
    }
    designs
}

#[test]
fn the_rtl_of_a_raster_core_with_any_store_agrees() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let designs = sample(cover(matrix(), |design| design.config().to_toml()), 2);
    let failures = in_parallel(&designs, |design| {
        // Icarus has unknown values, but is slow for wide words. It simulates words of one pixel,
        // plain and deep.
        let is_narrow = design.as_raster().unwrap().pixels_per_clock() == 1;
        let simulator = if is_narrow { Simulator::Iverilog } else { Simulator::Verilator };
        let folder = output.path().join(design.fingerprint());
        let what =
            format!("{} {}", config_name(&design.config()), design.config().hardware.description());
        check_agreement(&what, design, simulator, directed_stimulus(CosimLevel::Full, 1), &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}
