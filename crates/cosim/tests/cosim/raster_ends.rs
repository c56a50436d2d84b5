// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fate of every region for a receiver that sees only the ports: whole, ended early, or lost.
//! The vectors of raster cores must contain every way in which a region is lost.

use std::collections::{BTreeMap, VecDeque};

use crate::common::vectors::{clock_records, port_value};
use crate::common::{check_agreement, design, directed_stimulus, feature, has_simulators};
use foveate_camera::{
    CameraConfig, Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Payload,
    ReferencePolicy,
};
use foveate_cosim::{CosimLevel, Recording, Simulator, Stimulus};
use foveate_design::{Design, DesignConfig, Pipelining, PortRole};
use foveate_pixels::Frame;

/// Returns designs with frames of which some regions are lost: plain and deep, with and without a
/// second pass, with both kinds of references, the fewest words that a region can have, fewer rows
/// of regions than the buffer keeps, and means beside pixels.
fn designs() -> Vec<Design> {
    let of = |kind, (size, pixels), grid, more: &dyn Fn(&mut DesignConfig)| {
        let mut config = DesignConfig::from(CameraConfig {
            spatial: vec![feature(kind, 0)],
            ..CameraConfig::default()
        });
        config.hardware.make_raster().pixels_per_clock = Some(pixels);
        config.camera.region.size = size;
        config.camera.denoise.filter = DenoiseFilter::None;
        config.camera.spatial[0].min_score = Some(Decimal::from_whole(1));
        config.camera.temporal.min_count = 1;
        more(&mut config);
        design(&config, grid)
    };
    vec![
        of(FeatureKind::Edge, (4, 1), (4, 4), &|_| {}),
        of(FeatureKind::Mad, (4, 1), (5, 5), &|config| {
            config.camera.temporal.reference = ReferencePolicy::LastSent;
        }),
        of(FeatureKind::Variance, (8, 4), (8, 4), &|config| {
            config.hardware.pipelining = Pipelining::Deep;
            config.camera.temporal.reference = ReferencePolicy::LastSent;
            config.camera.render.payload = Payload::Raw;
        }),
        of(FeatureKind::Edge, (2, 2), (16, 1), &|config| {
            config.hardware.pipelining = Pipelining::Deep;
        }),
        of(FeatureKind::Mad, (4, 4), (16, 2), &|_| {}),
        of(FeatureKind::Edge, (4, 1), (4, 4), &|config| {
            config.camera.render.irrelevant = IrrelevantRendering::Mean;
            config.camera.spatial[0].min_score = Some(Decimal::from_whole(6));
        }),
    ]
}

fn record(design: &Design) -> Recording {
    directed_stimulus(CosimLevel::Full, 8).record(design, &mut |_, _| {}).unwrap()
}

/// The index of a region and the number of its frame, as the ports show them.
type FrameRegion = (u64, u64);

/// The fate of a region that sends something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum RegionFate {
    Whole,
    /// A word with `abort` ended it, and it was reported as lost.
    Aborted,
    /// It was reported as lost; no word of it left.
    Lost,
    /// A reset came before its end.
    CutByReset,
}

/// A receiver that sees only the ports.
struct PortReceiver<'a> {
    design: &'a Design,
    /// The number of frames decided since reset.
    frames: u64,
    /// The regions that send something and whose fate is not yet known, in the order of their
    /// decisions. The flag is true for a summary.
    waiting: VecDeque<(FrameRegion, bool)>,
    /// The regions that were reported as lost and for which no word with `abort` has come.
    lost: Vec<FrameRegion>,
    /// The region whose words are coming, and the position of the next word.
    open: Option<(FrameRegion, u64)>,
    fates: BTreeMap<RegionFate, u64>,
    /// The number of losses in the middle: while the last word waits for the sink, as it comes to
    /// the ports, with a single word, and one after another.
    losses_within: [u64; 4],
    /// The number of words with `abort` that were taken at once, and of those taken later.
    taken_aborts: [u64; 2],
    /// The number of summaries that came whole, that ended early, and that were lost as a whole.
    summaries: [u64; 3],
    after_abort: bool,
}

impl<'a> PortReceiver<'a> {
    fn new(design: &'a Design) -> Self {
        Self {
            design,
            frames: 0,
            waiting: VecDeque::new(),
            lost: Vec::new(),
            open: None,
            fates: BTreeMap::new(),
            losses_within: [0; 4],
            taken_aborts: [0; 2],
            summaries: [0; 3],
            after_abort: false,
        }
    }

    fn count_fate(&mut self, fate: RegionFate) {
        *self.fates.entry(fate).or_default() += 1;
    }

    fn reset(&mut self) {
        for _ in 0..self.waiting.len() {
            self.count_fate(RegionFate::CutByReset);
        }
        self.waiting.clear();
        self.lost.clear();
        (self.open, self.frames, self.after_abort) = (None, 0, false);
    }

    /// Records the decision of a region.
    fn decide(&mut self, region: u64, active: bool, summary: bool) {
        assert!(!(active && summary), "{region}");
        if active || summary {
            self.waiting.push_back(((region, self.frames % 256), summary));
        }
        self.frames += u64::from(region + 1 == u64::from(self.design.regions()));
    }

    /// Returns the position of the word after `position`: of the next pixels, or of the next block.
    /// Returns `None` after the last word.
    fn next_position(&self, position: u64, summary: bool) -> Option<u64> {
        let side = u64::from(self.design.region_size());
        let word = u64::from(self.design.as_raster().unwrap().pixels_per_clock());
        let next = match self.design.periphery() {
            Some(own) if summary => {
                let block = u64::from(own.block_side);
                let is_row_end = position % side + block == side;
                position + if is_row_end { (block - 1) * side + block } else { block }
            }
            Some(_) | None => position + word,
        };
        (next < side * side).then_some(next)
    }

    /// Records a word that is taken.
    fn take_word(
        &mut self,
        name: FrameRegion,
        position: u64,
        [first, last, abort]: [bool; 3],
        summary: bool,
    ) {
        assert_eq!(first, self.open.is_none(), "{name:?}");
        if first {
            // The regions before this one were lost as a whole.
            while self.waiting.front() != Some(&(name, summary)) {
                let (before, summary) =
                    self.waiting.pop_front().expect("it was decided, and not settled");
                self.summaries[2] += u64::from(summary);
                let at = self.lost.iter().position(|&lost| lost == before);
                self.lost
                    .remove(at.unwrap_or_else(|| panic!("{before:?} neither came nor was lost")));
                self.count_fate(RegionFate::Lost);
            }
        }
        let (open, next) = self.open.take().unwrap_or((name, 0));
        assert_eq!((open, next), (name, position));
        let next = self.next_position(position, summary);
        assert_eq!(last, next.is_none() || abort, "{name:?}");
        assert!(!(next.is_none() && abort), "{name:?}");
        if let Some(next) = next.filter(|_| !last) {
            self.open = Some((name, next));
            return;
        }
        assert_eq!(self.waiting.pop_front(), Some((name, summary)));
        self.summaries[usize::from(abort)] += u64::from(summary);
        let at = self.lost.iter().position(|&lost| lost == name);
        assert_eq!(at.is_some(), abort, "{name:?} is named as lost exactly if it ends early");
        if let Some(at) = at {
            self.lost.remove(at);
        }
        self.losses_within[3] += u64::from(abort && self.after_abort);
        self.after_abort = abort;
        self.count_fate(if abort { RegionFate::Aborted } else { RegionFate::Whole });
    }

    /// Checks the end of a sequence: everything has left, so the waiting regions were lost as a
    /// whole and each was reported.
    fn check_end(&mut self) {
        assert_eq!(self.open, None);
        assert_eq!(self.lost, self.waiting.drain(..).map(|(name, _)| name).collect::<Vec<_>>());
        for _ in 0..std::mem::take(&mut self.lost).len() {
            self.count_fate(RegionFate::Lost);
        }
    }

    fn check_recording(&mut self, recording: &Recording) {
        let (inputs, outputs) = (recording.inputs(), recording.outputs());
        let mut before = outputs.zero_record();
        let mut waits = 0;
        let all = clock_records(recording);
        for (clock, (input, output)) in (0_u64..).zip(&all) {
            let shown = |role, record: &[u8]| port_value(outputs, role, record);
            let says = |role| shown(role, output);
            let ends = |record: &[u8]| {
                use PortRole::{ForwardAbort, ForwardFirst, ForwardLast};
                [ForwardFirst, ForwardLast, ForwardAbort].map(|role| shown(role, record) == 1)
            };
            let word = |record: &[u8]| {
                let name =
                    (shown(PortRole::ForwardRegion, record), shown(PortRole::ForwardFrame, record));
                let is_mean = self.design.periphery().is_some()
                    && shown(PortRole::ForwardSummary, record) == 1;
                (name, shown(PortRole::ForwardPosition, record), ends(record), is_mean)
            };
            let had = shown(PortRole::ForwardValid, &before) == 1;
            if port_value(inputs, PortRole::Reset, input) == 1 {
                let last = clock.checked_sub(1).and_then(|clock| recording.span(clock));
                let is_cut = last.is_none_or(|span| span.sequence.contains("reset"));
                if !is_cut {
                    self.check_end();
                }
                self.reset();
                assert_eq!(says(PortRole::LostValid), 0);
            } else {
                let takes = port_value(inputs, PortRole::ForwardReady, input) == 1;
                if had && takes {
                    let (name, position, ends, is_mean) = word(&before);
                    self.taken_aborts[usize::from(waits > 0)] += u64::from(ends[2]);
                    self.take_word(name, position, ends, is_mean);
                }
                waits = if had && !takes { waits + 1 } else { 0 };
                assert!(!had || takes || word(&before) == word(output), "a word that waits stays");
                if says(PortRole::LostValid) == 1 {
                    self.lost.push((says(PortRole::LostRegion), says(PortRole::LostFrame)));
                }
                if says(PortRole::ForwardValid) == 1 && ends(output)[2] && (takes || !had) {
                    let lost = (says(PortRole::LostRegion), says(PortRole::LostFrame));
                    let is_now = says(PortRole::LostValid) == 1 && lost == word(output).0;
                    self.losses_within[usize::from(is_now)] += 1;
                    self.losses_within[2] += u64::from(ends(output)[0]);
                }
                if says(PortRole::DecisionValid) == 1 {
                    let is_sent = self.design.periphery().is_some() && says(PortRole::Summary) == 1;
                    self.decide(says(PortRole::Region), says(PortRole::Active) == 1, is_sent);
                }
            }
            before.clone_from(output);
        }
    }
}

#[test]
fn every_region_is_whole_or_ends_early_or_is_named_as_lost() {
    let mut together = 0;
    for design in designs() {
        let mut receiver = PortReceiver::new(&design);
        receiver.check_recording(&record(&design));
        let PortReceiver { fates, losses_within: ways, taken_aborts: taken, summaries, .. } =
            &receiver;
        let fate = |fate| fates.get(&fate).copied().unwrap_or_default();
        let told = format!("{fates:?} {ways:?} {taken:?}, {:?}", design.config());
        assert!(fate(RegionFate::Whole) > 200 && fate(RegionFate::Aborted) > 20, "{told}");
        assert!(fate(RegionFate::Lost) > 50 && fate(RegionFate::CutByReset) > 5, "{told}");
        assert!(ways[..3].iter().chain(taken).all(|&seen| seen > 5), "{told}");
        let has_summaries = design.periphery().is_some();
        assert!(summaries.iter().all(|&seen| (seen > 10) == has_summaries), "{summaries:?} {told}");
        together += ways[3];
    }
    assert!(together > 200, "{together} ended early after another that did");
}

/// The frame number wraps around after 256 frames of one row of regions.
#[test]
fn frame_numbers_wrap_around_after_256() {
    if !has_simulators() {
        return;
    }
    let design = designs().swap_remove(3);
    let (width, height) = (design.width(), design.height());
    let frame = |number: u32| {
        let pixel = |x: u32, y: u32| if (x / 2 + y + number).is_multiple_of(2) { 255 } else { 0 };
        Frame::from_fn(width, height, design.pixel_bits(), pixel).unwrap()
    };
    let frames = (0..260).map(frame).collect();
    let stimulus =
        Stimulus { level: CosimLevel::Full, seed: 1, rounds: 0, frames, sufficient_clocks: None };
    let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
    let seen: Vec<u64> = clock_records(&recording)
        .iter()
        .filter(|(_, output)| port_value(recording.outputs(), PortRole::ForwardFirst, output) == 1)
        .map(|(_, output)| port_value(recording.outputs(), PortRole::ForwardFrame, output))
        .collect();
    assert_eq!((seen.first(), seen.iter().max(), seen.last()), (Some(&0), Some(&255), Some(&3)));
    let output = tempfile::tempdir().unwrap();
    let folder = output.path().join("replay");
    check_agreement("frames", &design, Simulator::Iverilog, stimulus, &folder).unwrap();
}
