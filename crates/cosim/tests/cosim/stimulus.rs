// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors reach their targets. No tool is needed for that.

use crate::common::vectors::{clock_records, field_of_role, pairs_of_decisions};
use crate::common::{design, directed_stimulus};
use foveate_camera::FeatureKind;
use foveate_cosim::{CosimLevel, Recording, Stimulus, vectors_hex};
use foveate_design::{Design, DesignConfig, Organization, PortRole};
use foveate_pixels::Frame;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};

fn config(toml: &str) -> DesignConfig {
    DesignConfig::from_toml(toml).unwrap()
}

fn record(design: &Design, stimulus: &Stimulus) -> Recording {
    stimulus.record(design, &mut |_, _| {}).unwrap()
}

#[test]
fn equal_seeds_give_equal_vectors() {
    let design = design(&config(""), (1, 1));
    let text = |seed| {
        let stimulus = Stimulus { seed, ..directed_stimulus(CosimLevel::Rpu, 1) };
        vectors_hex(&record(&design, &stimulus), u64::MAX).unwrap()
    };
    assert_eq!(text(1), text(1));
    assert_ne!(text(1), text(2));
}

/// Every threshold of a decision is met exactly, missed by one, and passed by one.
#[test]
fn decisions_are_made_on_below_and_above_their_thresholds() {
    let kinds = Organization::Pipelined.feature_kinds();
    let features = kinds.iter();
    let toml: String =
        features.map(|kind| format!("[[spatial]]\nfeature = \"{kind}\"\n")).collect();
    let design = design(&config(&toml), (1, 1));
    let recording = record(&design, &directed_stimulus(CosimLevel::Rpu, 2));
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let scores = kinds.iter().map(|&k| (PortRole::MinScore(k), PortRole::Score(k)));
    let count = (PortRole::TemporalMinCount, PortRole::TemporalCount);
    for (minimum, score) in scores.chain([count]) {
        let mut found = BTreeSet::new();
        for (input, output) in clock_records(&recording) {
            if field_of_role(outputs, PortRole::DecisionValid).get(&output, 0) == 1 {
                let score = field_of_role(outputs, score).get(&output, 0);
                let minimum = field_of_role(inputs, minimum).get(&input, 0);
                found.insert(i128::from(score) - i128::from(minimum));
            }
        }
        assert!([-1, 0, 1].iter().all(|near| found.contains(near)), "{minimum:?}: {found:?}");
    }
}

/// Summaries are sent and not sent after decisions of every kind. With constant thresholds, only
/// the cases that depend on the means are required.
#[test]
fn summaries_are_due_and_not_due() {
    const ALL: [&str; 4] = ["active", "held", "sent", "kept"];
    for feature in ["edge", "mad"] {
        for (size, thresholds) in [(4, "runtime"), (8, "runtime"), (4, "constant"), (8, "constant")]
        {
            let toml = format!(
                "[[spatial]]\nfeature = \"{feature}\"\n[region]\nsize = {size}\n[render]\n\
                 irrelevant = \"mean\"\n[hardware]\nthresholds = \"{thresholds}\"\n"
            );
            let design = design(&config(&toml), (1, 1));
            let found =
                pairs_of_decisions(&record(&design, &directed_stimulus(CosimLevel::Rpu, 2)));
            // The screen shows no summary of an active region, unless its minima change after the
            // decision.
            let is_odd = thresholds == "constant" && found.contains(&("active", "kept"));
            assert!(!is_odd, "{toml}");
            let kinds = if thresholds == "runtime" { &ALL[..] } else { &ALL[2..] };
            for &before in kinds {
                for &now in kinds.iter().filter(|&&now| (before, now) != ("active", "kept")) {
                    assert!(found.contains(&(before, now)), "{before}, {now}: {found:?} {toml}");
                }
            }
        }
    }
}

#[test]
fn scores_reach_their_largest_values() {
    let toml = "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"edge\"\n\
                [[spatial]]\nfeature = \"mad\"\n[[spatial]]\nfeature = \"variance\"\n";
    let design = design(&config(toml), (1, 1));
    let recording = record(&design, &directed_stimulus(CosimLevel::Rpu, 2));
    for feature in design.features() {
        let port = field_of_role(recording.outputs(), PortRole::Score(feature.kind()));
        let reached = clock_records(&recording).iter().map(|(_, output)| port.get(output, 0)).max();
        assert_eq!(reached, Some(feature.score_max()), "{}", feature.kind());
    }
}

/// One round contains the largest gradient with a level just below it and with a level equal to it.
#[test]
fn the_largest_gradient_meets_its_level() {
    for bits in [1, 3, 8, 16] {
        let toml = format!(
            "[frame]\npixel_bits = {bits}\n[denoise]\nfilter = \"none\"\n[[spatial]]\n\
             feature = \"edge\"\nlevel = 1\n[temporal]\nlevel = 0\n"
        );
        let design = design(&config(&toml), (1, 1));
        let recording = record(&design, &directed_stimulus(CosimLevel::Rpu, 1));
        let largest = 6 * u64::from(design.pixel_max());
        let (inputs, outputs) = (recording.inputs(), recording.outputs());
        let mut found = BTreeSet::new();
        for (input, output) in clock_records(&recording) {
            if field_of_role(outputs, PortRole::DecisionValid).get(&output, 0) == 1 {
                let level =
                    field_of_role(inputs, PortRole::Level(FeatureKind::Edge)).get(&input, 0);
                let score =
                    field_of_role(outputs, PortRole::Score(FeatureKind::Edge)).get(&output, 0);
                found.insert((level, score > 0));
            }
        }
        assert!(found.contains(&(largest - 1, true)), "{bits} bits: {found:?}");
        assert!(found.contains(&(largest, false)), "{bits} bits: {found:?}");
    }
}

#[test]
fn every_border_is_seen_and_resets_come_at_any_time() {
    let design = design(&config("[region]\nneighborhood = \"shared\"\n"), (1, 1));
    let recording = record(&design, &directed_stimulus(CosimLevel::Rpu, 4));
    let inputs = recording.inputs();
    let (mut borders, mut resets, mut busy) = (BTreeSet::new(), 0, 0);
    let (mut pixels, mut last_reset) = (0, true);
    for (input, _) in clock_records(&recording) {
        borders.insert(field_of_role(inputs, PortRole::Border).get(&input, 0));
        let reset = field_of_role(inputs, PortRole::Reset).get(&input, 0) == 1;
        if reset && !last_reset {
            resets += 1;
            busy += u32::from(pixels % design.stream_pixels() != 0);
        }
        let valid = field_of_role(inputs, PortRole::Valid).get(&input, 0) == 1;
        pixels = if reset { 0 } else { pixels + u32::from(valid) };
        last_reset = reset;
    }
    assert_eq!(borders.len(), 16, "{borders:?}");
    assert!(resets >= 60 && busy >= 6, "{resets} resets, {busy} of them in a frame");
}

/// The regions of a frame go through the one RPU in order, each after a reset and with its own
/// border.
#[test]
fn frames_of_the_caller_are_streamed_region_by_region() {
    let design = design(&config("[region]\nneighborhood = \"shared\"\n"), (3, 2));
    let frame = Frame::from_fn(24, 16, 8, |x, y| u16::try_from(x * 10 + y % 10).unwrap()).unwrap();
    let stimulus =
        Stimulus { rounds: 0, frames: vec![frame.clone(), frame], ..Stimulus::default() };
    let recording = record(&design, &stimulus);
    assert_eq!((recording.sequences(), recording.frames()), (6, 12));
    let first = recording.span(0).unwrap();
    assert_eq!((first.sequence.as_str(), first.region, first.frame), ("frames", Some(0), 0));
    let last = recording.span(recording.clocks()).unwrap();
    assert_eq!((last.region, last.frame), (Some(5), 1));
    let border = field_of_role(recording.inputs(), PortRole::Border);
    let borders: BTreeSet<u64> =
        clock_records(&recording).iter().map(|(i, _)| border.get(i, 0)).collect();
    assert_eq!(borders, BTreeSet::from([0b0101, 0b0100, 0b0110, 0b1001, 0b1000, 0b1010]));

    let array = Stimulus { level: CosimLevel::Rcm { columns: 2, rows: 1 }, ..stimulus };
    assert_eq!(record(&design, &array).sequences(), 1);
}

#[test]
fn nothing_to_simulate_is_refused() {
    let design = design(&config(""), (1, 1));
    let stimulus = Stimulus { rounds: 0, ..Stimulus::default() };
    let error = stimulus.record(&design, &mut |_, _| {}).unwrap_err().to_string();
    assert!(error.contains("no frames are given and rounds is 0"), "{error}");
}

#[test]
fn arrays_beyond_memory_are_refused_before_they_are_made() {
    let design = design(&config(""), (1, 1));
    let level = CosimLevel::Rcm { columns: 300, rows: 300 };
    let error =
        directed_stimulus(level, 1).record(&design, &mut |_, _| {}).unwrap_err().to_string();
    assert!(error.starts_with("an array of 90000 regions, which take 5760000 pixels"), "{error}");
    assert!(error.contains("the limits are 65536 regions and 67108864 pixels"), "{error}");
}

#[test]
fn an_interrupt_stops_the_model() {
    let design = design(&config(""), (1, 1));
    let cancel = AtomicBool::new(false);
    let mut heard = 0;
    let result =
        directed_stimulus(CosimLevel::Rpu, 3).record_until(&design, &cancel, &mut |done, _| {
            heard = done;
            cancel.store(done == 2, Ordering::Relaxed);
        });
    assert!(result.unwrap_err().is_interrupted());
    assert_eq!(heard, 2);
}

#[test]
fn frames_of_another_kind_are_refused() {
    let design = design(&config(""), (3, 2));
    let frames = vec![Frame::filled(24, 16, 8, 0).unwrap(), Frame::filled(24, 15, 8, 0).unwrap()];
    let stimulus = Stimulus { frames, ..Stimulus::default() };
    let error = stimulus.record(&design, &mut |_, _| {}).unwrap_err().to_string();
    assert!(
        error.starts_with("frame 1 has 24x15 pixels of 8 bits, but the design takes"),
        "{error}"
    );
}
