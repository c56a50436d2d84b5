// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors of serial designs reach their targets, and their inputs keep to the contract. No
//! tool is needed for that.

use crate::common;
use crate::common::serial::serial_config;
use crate::common::vectors::{clock_records, pairs_of_decisions, port_value};
use crate::common::{design, directed_stimulus, feature};
use foveate_camera::{
    DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, ReferencePolicy,
};
use foveate_cosim::{CosimLevel, RecordLayout, Recording, Stimulus};
use foveate_design::{Design, DesignConfig, PixelFeed, PortRole, SerialTiming};
use foveate_pixels::Frame;
use std::collections::BTreeSet;

const GRID: (u32, u32) = (3, 2);
const LEVEL: CosimLevel = CosimLevel::Rcm { columns: GRID.0, rows: GRID.1 };

fn record(design: &Design, stimulus: &Stimulus) -> Recording {
    stimulus.record(design, &mut |_, _| {}).unwrap()
}

/// Returns a small configuration with every feature and `last-sent` references.
fn config_with_every_feature() -> DesignConfig {
    let features: Vec<_> = FeatureKind::ALL.iter().map(|&kind| feature(kind, 2)).collect();
    let mut config = serial_config(&features);
    config.camera.region.size = 4;
    config.camera.denoise.filter = DenoiseFilter::None;
    config.camera.temporal.reference = ReferencePolicy::LastSent;
    config
}

/// Returns one design of each feed. The one with the raster feed has a halo, and a fold that leaves
/// slots empty.
fn designs() -> [Design; 2] {
    let mut raster = config_with_every_feature();
    raster.hardware.make_serial().feed = Some(PixelFeed::Raster);
    raster.hardware.make_serial().fold = 4;
    raster.camera.region.neighborhood = Neighborhood::Shared;
    [config_with_every_feature(), raster].map(|config| design(&config, GRID))
}

/// One clock of a recording.
struct SerialClock {
    reset: bool,
    valid: bool,
    /// True if a pixel is taken at the edge of this clock.
    is_taken: bool,
    /// True if that pixel is the first of a frame.
    is_first_of_frame: bool,
    thresholds: Vec<u64>,
    input: Vec<u8>,
    output: Vec<u8>,
    /// The outputs of the clock before.
    before: Vec<u8>,
    /// True if a frame was complete before this clock, and the array is not yet ready again.
    at_work: bool,
    /// True if some but not all pixels of a frame were taken before this clock.
    loading: bool,
}

/// Returns the clocks of a recording. A pixel is taken if the expected `ready_o` was 1.
fn clocks_of(design: &Design, recording: &Recording) -> Vec<SerialClock> {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let timing = SerialTiming::from_design(design.as_serial().unwrap());
    let ready = |record: &[u8]| port_value(outputs, PortRole::Ready, record) == 1;
    let (mut before, mut taken, mut story) = (outputs.zero_record(), 0, Vec::new());
    for (input, output) in clock_records(recording) {
        let reset = port_value(inputs, PortRole::Reset, &input) == 1;
        let valid = port_value(inputs, PortRole::Valid, &input) == 1;
        let takes = valid && ready(&before) && !reset;
        let at_work = taken == timing.load_pixels() && !ready(&before);
        let loading = taken > 0 && taken < timing.load_pixels();
        let first = takes && !loading;
        taken = match (reset, takes) {
            (true, _) => 0,
            (false, true) if first => 1,
            (false, true) => taken + 1,
            (false, false) if taken == timing.load_pixels() && ready(&before) => 0,
            (false, false) => taken,
        };
        let is_threshold = |role| {
            use PortRole::{Level, MinScore, TemporalLevel, TemporalMinCount};
            matches!(role, Level(_) | MinScore(_) | TemporalLevel | TemporalMinCount)
        };
        let fields = inputs.fields().iter().filter(|field| is_threshold(field.port.role));
        let thresholds = fields.map(|field| field.get(&input, 0)).collect();
        let last = std::mem::replace(&mut before, output.clone());
        story.push(SerialClock {
            reset,
            valid,
            is_taken: takes,
            is_first_of_frame: first,
            thresholds,
            input,
            output,
            before: last,
            at_work,
            loading,
        });
    }
    story
}

#[test]
fn thresholds_stand_still_while_a_frame_is_under_way_and_only_then() {
    for design in designs() {
        let recording = record(&design, &directed_stimulus(LEVEL, 1));
        let story = clocks_of(&design, &recording);
        let (mut changes, mut frames) = (0, 0);
        for pair in story.windows(2) {
            let [last, now] = pair else { unreachable!() };
            let changed = last.thresholds != now.thresholds;
            let under_way = (now.at_work || now.loading) && !now.reset && !last.reset;
            assert!(!changed || !under_way, "thresholds change while a frame is under way");
            changes += u32::from(changed);
            frames += u32::from(now.is_first_of_frame);
        }
        assert!(frames > 40 && changes > frames, "{changes} changes, {frames} frames");
    }
}

#[test]
fn pixels_are_offered_while_none_is_taken_and_frames_follow_at_once() {
    for design in designs() {
        let recording = record(&design, &directed_stimulus(LEVEL, 1));
        let story = clocks_of(&design, &recording);
        let pixel =
            |clock: &SerialClock| port_value(recording.inputs(), PortRole::Pixel, &clock.input);
        let refused: Vec<_> = story.iter().filter(|c| c.valid && !c.is_taken && !c.reset).collect();
        let garbage: BTreeSet<u64> = refused.iter().map(|clock| pixel(clock)).collect();
        assert!(refused.len() > 1000 && garbage.len() > 100, "{} refused", refused.len());
        let ready = |record: &[u8]| port_value(recording.outputs(), PortRole::Ready, record) == 1;
        let at_once = story.windows(2).filter(|pair| {
            let rises = !ready(&pair[0].before) && ready(&pair[0].output);
            rises && pair[1].is_first_of_frame && !pair[0].reset
        });
        assert!(at_once.count() > 5);
        let gaps = story.iter().filter(|clock| clock.loading && !clock.valid).count();
        assert!(gaps > 100, "{gaps} gaps");
    }
}

#[test]
fn resets_come_everywhere() {
    for design in designs() {
        let recording = record(&design, &directed_stimulus(LEVEL, 3));
        let outputs = recording.outputs();
        let shows = |role: PortRole, clock: &SerialClock| {
            let field = common::vectors::field_of_role(outputs, role);
            field.bytes_in(&clock.before).iter().any(|&byte| byte != 0)
        };
        let timing = SerialTiming::from_design(design.as_serial().unwrap());
        let mut found = BTreeSet::new();
        let mut worked = 0;
        for clock in clocks_of(&design, &recording) {
            worked = if clock.at_work { worked + 1 } else { 0 };
            if !clock.reset {
                continue;
            }
            let places = [
                ("loading", clock.loading),
                ("at the start", (1..4).contains(&worked)),
                ("working", clock.at_work && worked > 4),
                ("rotating", shows(PortRole::ScoreValid, &clock)),
                ("unloading", shows(PortRole::ForwardValid, &clock)),
                ("about to be ready", clock.at_work && worked + 3 > timing.steps()),
                ("ready", !clock.at_work && !clock.loading),
                ("with a pixel", clock.valid),
            ];
            found.extend(places.iter().filter(|(_, here)| *here).map(|(place, _)| *place));
        }
        assert_eq!(found.len(), 8, "{found:?}");
    }
}

/// The outputs for one region of one frame.
struct RegionOutputs {
    frame: usize,
    region: u64,
    scores: Vec<u64>,
    minima: Vec<u64>,
    srs: bool,
    active: bool,
}

fn region_outputs(design: &Design, recording: &Recording) -> Vec<RegionOutputs> {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let (mut frame, mut open, mut done) = (0, Vec::new(), Vec::new());
    let minima = |input: &[u8]| -> Vec<u64> {
        let features = design.features().iter().map(|f| PortRole::MinScore(f.kind()));
        let roles = [PortRole::TemporalMinCount].into_iter().chain(features);
        roles.map(|role| port_value(inputs, role, input)).collect()
    };
    for clock in clocks_of(design, recording) {
        if clock.is_first_of_frame {
            frame += 1;
            open.clear();
        }
        let says = |role| port_value(outputs, role, &clock.output);
        if says(PortRole::ScoreValid) == 1 {
            let (region, index) = (says(PortRole::Region), says(PortRole::ScoreIndex));
            open.push((region, index, says(PortRole::AnyScore)));
            if says(PortRole::DecisionValid) == 1 {
                let own = open.iter().filter(|(r, _, _)| *r == region);
                done.push(RegionOutputs {
                    frame,
                    region,
                    scores: own.map(|(_, _, score)| *score).collect(),
                    minima: minima(&clock.input),
                    srs: says(PortRole::Srs) == 1,
                    active: says(PortRole::Active) == 1,
                });
            }
        }
    }
    done
}

/// Every threshold of a decision is met exactly, missed by one, and passed by one, in more than one
/// region.
#[test]
fn decisions_are_made_on_below_and_above_their_minima() {
    for design in designs() {
        let recording = record(&design, &directed_stimulus(LEVEL, 2));
        let verdicts = region_outputs(&design, &recording);
        for index in 0..=design.features().len() {
            for near in [-1, 0, 1] {
                let distance = |v: &&RegionOutputs| {
                    i128::from(v.scores[index]) - i128::from(v.minima[index]) == near
                };
                let regions: BTreeSet<u64> =
                    verdicts.iter().filter(distance).map(|verdict| verdict.region).collect();
                assert!(regions.len() > 1, "score {index}, {near}: regions {regions:?}");
            }
        }
    }
}

/// The regions of one frame differ in their states: relevant or not, active or not, with or without
/// a reference. Every region is in every state at least once.
#[test]
fn regions_of_a_frame_are_in_different_states() {
    for design in designs() {
        let recording = record(&design, &directed_stimulus(LEVEL, 3));
        let verdicts = region_outputs(&design, &recording);
        let all = u64::from(design.region_pixels());
        let frames = verdicts.last().unwrap().frame;
        let mut mixed = [0; 3];
        for frame in 1..=frames {
            let of_frame = || verdicts.iter().filter(|verdict| verdict.frame == frame);
            let states: [BTreeSet<bool>; 3] = [
                of_frame().map(|verdict| verdict.active).collect(),
                of_frame().map(|verdict| verdict.srs).collect(),
                of_frame().map(|verdict| verdict.scores[0] == all).collect(),
            ];
            for (count, states) in mixed.iter_mut().zip(states) {
                *count += usize::from(states.len() == 2);
            }
        }
        assert!(mixed.iter().all(|&count| count > 8), "{mixed:?} of {frames} frames");
        for region in 0..u64::from(design.regions()) {
            let of_region = || verdicts.iter().filter(|verdict| verdict.region == region);
            let states: BTreeSet<_> = of_region().map(|v| (v.srs, v.active)).collect();
            assert_eq!(states.len(), 3, "region {region}: {states:?}");
        }
    }
}

#[test]
fn scores_reach_their_largest_values() {
    let design = designs()[0].clone();
    let recording = record(&design, &directed_stimulus(LEVEL, 2));
    let verdicts = region_outputs(&design, &recording);
    for (feature, index) in design.features().iter().zip(1..) {
        let reached = verdicts.iter().map(|verdict| verdict.scores[index]).max().unwrap();
        match feature.kind() {
            // The largest scores of these features are bounds that no region is known to reach.
            FeatureKind::Corner | FeatureKind::Surface | FeatureKind::Flow => {}
            kind => assert_eq!(reached, feature.score_max(), "{kind}"),
        }
    }
}

/// One round contains the largest gradient with a level just below it and with a level equal to it.
#[test]
fn the_largest_gradient_meets_its_level() {
    for bits in [1, 3, 8, 16] {
        let mut config = serial_config(&[feature(FeatureKind::Edge, 2)]);
        config.camera.frame.pixel_bits = bits;
        config.camera.region.size = 4;
        config.camera.denoise.filter = DenoiseFilter::None;
        config.camera.spatial[0].level = Some(1);
        config.camera.temporal.level = Some(0);
        let design = design(&config, GRID);
        let recording = record(&design, &directed_stimulus(LEVEL, 1));
        let largest = 6 * u64::from(design.pixel_max());
        let mut found = BTreeSet::new();
        for clock in clocks_of(&design, &recording) {
            let says = |role| port_value(recording.outputs(), role, &clock.output);
            if says(PortRole::ScoreValid) == 1 && says(PortRole::ScoreIndex) == 1 {
                let role = PortRole::Level(FeatureKind::Edge);
                let level = port_value(recording.inputs(), role, &clock.input);
                found.insert((level, says(PortRole::AnyScore) > 0));
            }
        }
        assert!(found.contains(&(largest - 1, true)), "{bits} bits: {found:?}");
        assert!(found.contains(&(largest, false)), "{bits} bits: {found:?}");
    }
}

fn port_names(layout: &RecordLayout) -> Vec<&str> {
    layout.fields().iter().map(|field| field.port.name.as_str()).collect()
}

/// The lanes of the frame go through the one lane in order, with as many regions as share it.
#[test]
fn frames_of_the_caller_are_streamed_lane_by_lane() {
    let mut config = config_with_every_feature();
    config.hardware.make_serial().fold = 2;
    let design = design(&config, (3, 1));
    let frame = Frame::from_fn(12, 4, 8, |x, y| u16::try_from(x * 4 + y).unwrap()).unwrap();
    let frames = vec![frame.clone(), frame];
    let stimulus = Stimulus { rounds: 0, frames, ..Stimulus::default() };
    let recording = record(&design, &stimulus);
    assert_eq!((recording.sequences(), recording.frames()), (2, 4));
    assert_eq!(recording.span(0).unwrap().region, Some(0));
    assert_eq!(recording.span(recording.clocks()).unwrap().region, Some(2));
    assert!(port_names(recording.outputs()).contains(&"forward_slot_o"));
    let lane = design.as_serial().unwrap().single_lane_design();
    let taken = clocks_of(&lane, &recording).into_iter().filter(|clock| clock.is_taken);
    let pixel = |clock: SerialClock| port_value(recording.inputs(), PortRole::Pixel, &clock.input);
    let pixels: Vec<u64> = taken.map(pixel).collect();
    // Slot 0 shows the first four columns in row-major order, then slot 1 the next four.
    assert_eq!(pixels[..5], [0, 4, 8, 12, 1]);
    assert_eq!(pixels[16..20], [16, 20, 24, 28]);
    assert_eq!(pixels[64..68], [32, 36, 40, 44], "the second lane");
    assert_eq!(pixels.len(), 2 * 2 * 32);
}

/// Summaries are sent and not sent after decisions of every kind, with one feed or the other.
#[test]
fn summaries_are_due_and_not_due() {
    const ALL: [&str; 4] = ["active", "held", "sent", "kept"];
    let mut found = BTreeSet::new();
    for design in designs() {
        let mut config = design.config();
        config.camera.render.irrelevant = IrrelevantRendering::Mean;
        let design = config.validate().unwrap();
        let pairs = pairs_of_decisions(&record(&design, &directed_stimulus(LEVEL, 1)));
        assert!(pairs.len() > 12, "{pairs:?}");
        found.extend(pairs);
    }
    assert!(!found.contains(&("active", "kept")), "nothing is shown");
    let pairs = ALL.iter().flat_map(|&before| ALL.map(|now| (before, now)));
    let missing: Vec<_> =
        pairs.filter(|pair| *pair != ("active", "kept") && !found.contains(pair)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
