// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors of raster designs reach their targets, and their inputs keep to the contract. No
//! tool is needed for that.

use std::collections::BTreeSet;

use crate::common::vectors::{clock_records, port_value};
use crate::common::{design, directed_stimulus, feature};
use foveate_camera::{CameraConfig, DenoiseFilter, FeatureKind, Neighborhood, ReferencePolicy};
use foveate_cosim::{CosimLevel, Recording, Stimulus};
use foveate_design::{Design, DesignConfig, Organization, PortRole, RasterTiming};
use foveate_pixels::Frame;

/// Returns a small design with two features, the last of which is `last`.
fn config(last: FeatureKind) -> DesignConfig {
    let features = [feature(FeatureKind::Edge, 0), feature(last, 1)];
    let mut config =
        DesignConfig::from(CameraConfig { spatial: features.to_vec(), ..CameraConfig::default() });
    config.hardware.organization = Organization::Raster.into();
    config.camera.region.size = 4;
    config.camera.temporal.reference = ReferencePolicy::LastSent;
    config
}

/// Returns three designs: one with a second pass, one with words of two pixels and without a second
/// pass, and one whose frames wait for the pixels of the frame before.
fn designs() -> [Design; 3] {
    let mut wide = config(FeatureKind::Variance);
    wide.hardware.make_raster().pixels_per_clock = Some(2);
    wide.camera.region.neighborhood = Neighborhood::Shared;
    let mut small = config(FeatureKind::Corner);
    small.camera.denoise.filter = DenoiseFilter::None;
    [design(&config(FeatureKind::Mad), (4, 5)), design(&wide, (8, 4)), design(&small, (4, 2))]
}

/// One clock of a recording.
struct RasterClock {
    reset: bool,
    valid: bool,
    /// True if a word is taken at the edge of this clock.
    is_taken: bool,
    /// True if words of a frame were taken before this clock, and the frame is not over.
    under_way: bool,
    /// True if some but not all words of a frame were taken before this clock.
    loading: bool,
    word: u64,
    thresholds: Vec<u64>,
    /// The outputs of the clock before.
    before: Vec<u8>,
    output: Vec<u8>,
}

fn clocks_of(design: &Design, recording: &Recording) -> Vec<RasterClock> {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let frame = RasterTiming::from_design(design.as_raster().unwrap()).taken_words_per_frame();
    let shows = |record: &[u8], role| port_value(outputs, role, record) == 1;
    let (mut before, mut story) = (outputs.zero_record(), Vec::new());
    let (mut taken, mut undecided) = (0, 0);
    for (input, output) in clock_records(recording) {
        let reset = port_value(inputs, PortRole::Reset, &input) == 1;
        let valid = port_value(inputs, PortRole::Valid, &input) == 1;
        let ready = shows(&before, PortRole::Ready);
        let takes = valid && ready && !reset;
        if taken == frame && ready {
            taken = 0;
        }
        let under_way = taken > 0 || (design.has_second_pass() && undecided > 0);
        let loading = taken > 0 && taken < frame;
        if takes {
            undecided += if taken == 0 { design.regions() } else { 0 };
            taken += 1;
        }
        undecided -= u32::from(shows(&output, PortRole::DecisionValid));
        if reset {
            (taken, undecided) = (0, 0);
        }
        let is_threshold = |role| {
            use PortRole::{Level, MinScore, TemporalLevel, TemporalMinCount};
            matches!(role, Level(_) | MinScore(_) | TemporalLevel | TemporalMinCount)
        };
        let fields = inputs.fields().iter().filter(|field| is_threshold(field.port.role));
        let thresholds = fields.map(|field| field.get(&input, 0)).collect();
        let before = std::mem::replace(&mut before, output.clone());
        let word = port_value(inputs, PortRole::Pixel, &input);
        story.push(RasterClock {
            reset,
            valid,
            is_taken: takes,
            under_way,
            loading,
            word,
            thresholds,
            before,
            output,
        });
    }
    story
}

fn record(design: &Design, rounds: u32) -> Recording {
    directed_stimulus(CosimLevel::Full, rounds).record(design, &mut |_, _| {}).unwrap()
}

#[test]
fn thresholds_stand_still_while_a_frame_is_under_way_and_only_then() {
    for design in designs() {
        let story = clocks_of(&design, &record(&design, 1));
        let mut changes = 0;
        for pair in story.windows(2) {
            let [last, now] = pair else { unreachable!() };
            let changed = last.thresholds != now.thresholds;
            assert!(!changed || !now.under_way || now.reset || last.reset, "under way");
            changes += u32::from(changed);
        }
        assert!(changes > 100, "{changes} changes");
    }
}

#[test]
fn words_are_refused_and_frames_follow_at_once() {
    for design in designs() {
        let recording = record(&design, 3);
        let story = clocks_of(&design, &recording);
        let ready = |record: &[u8]| port_value(recording.outputs(), PortRole::Ready, record) == 1;
        let refused = story.iter().filter(|clock| clock.valid && !clock.is_taken && !clock.reset);
        assert!(refused.count() > 500);
        let at_once = story.windows(2).filter(|pair| {
            let rises = !ready(&pair[0].before) && ready(&pair[0].output);
            rises && pair[1].is_taken && !pair[1].loading && !pair[0].reset
        });
        assert!(at_once.count() > 5);
        assert!(story.iter().filter(|clock| clock.loading && !clock.valid).count() > 500);
    }
}

#[test]
fn regions_are_lost_and_small_frames_wait() {
    let [pass, wide, small] = designs();
    for design in [&pass, &wide] {
        let recording = record(design, 2);
        let counts: BTreeSet<u64> = clock_records(&recording)
            .iter()
            .map(|(_, output)| port_value(recording.outputs(), PortRole::LostCount, output))
            .collect();
        assert!(counts.len() > 20, "{} counts", counts.len());
        // Whole rows of regions are lost, too.
        let takes = |(input, _): &(Vec<u8>, Vec<u8>)| {
            port_value(recording.inputs(), PortRole::ForwardReady, input) == 1
        };
        let clocks = clock_records(&recording);
        let longest = clocks.split(takes).map(<[_]>::len).max().unwrap();
        let row = RasterTiming::from_design(design.as_raster().unwrap()).words()
            / u64::from(design.rows());
        assert!(longest as u64 > 2 * row, "{longest} clocks");
    }
    let recording = record(&small, 2);
    let longest = RasterTiming::from_design(small.as_raster().unwrap()).edges_to_ready();
    let (mut closed, mut waits) = (0, 0);
    for (_, output) in clock_records(&recording) {
        assert_eq!(port_value(recording.outputs(), PortRole::Lost, &output), 0);
        let ready = port_value(recording.outputs(), PortRole::Ready, &output) == 1;
        closed = if ready { 0 } else { closed + 1 };
        waits += u32::from(closed == longest + 1);
    }
    assert!(waits > 20, "{waits} waits");
}

#[test]
fn resets_come_everywhere() {
    let mut lost = 0;
    for design in designs() {
        let recording = record(&design, 3);
        let outputs = recording.outputs();
        let shows = |role, clock: &RasterClock| port_value(outputs, role, &clock.before) == 1;
        let story = clocks_of(&design, &recording);
        // The first reset is at power-up.
        let resets: Vec<&RasterClock> = story.iter().skip(1).filter(|clock| clock.reset).collect();
        let count = |which: &dyn Fn(&RasterClock) -> bool| {
            resets.iter().filter(|clock| which(clock)).count()
        };
        assert!(count(&|clock| clock.loading) > 2, "loading");
        assert!(count(&|clock| !shows(PortRole::Ready, clock)) > 2, "flushing");
        assert!(count(&|clock| shows(PortRole::ForwardValid, clock)) > 2, "leaving");
        lost += count(&|clock| shows(PortRole::Lost, clock));
    }
    assert!(lost > 5, "{lost} after losses");
}

/// The lone core has 4x3 regions of 4x4 pixels. The frame has two tiles side by side, and the
/// second lies partly beyond the frame.
#[test]
fn frames_of_the_caller_go_through_the_lone_core_tile_by_tile() {
    let design = design(&config(FeatureKind::Mad), (6, 3));
    let frame = Frame::from_fn(24, 12, 8, |x, y| u16::try_from(x + 16 * y).unwrap()).unwrap();
    let frames = vec![frame.clone(), frame];
    let stimulus = Stimulus { rounds: 0, frames, ..Stimulus::default() };
    let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
    assert_eq!((recording.sequences(), recording.frames()), (2, 4));
    let last = recording.span(recording.clocks()).unwrap();
    assert_eq!((last.sequence.as_str(), last.frame), ("frames from x 16, y 0 on", 1));
    let taken =
        clocks_of(&design.lone_unit(), &recording).into_iter().filter(|clock| clock.is_taken);
    let words: Vec<u64> = taken.map(|clock| clock.word).collect();
    assert_eq!(words.len(), 4 * 16 * 12);
    assert_eq!(words[14..18], [14, 15, 16, 17]);
    assert_eq!(words[16 * 12..][..2], [0, 1], "the frame after");
    // The row has columns 16 to 23, then the last column repeated.
    let row: Vec<u64> = (16..24).chain([23; 8]).collect();
    assert_eq!(words[2 * 16 * 12..][..16], row, "the second tile");
}
