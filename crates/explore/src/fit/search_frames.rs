// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that a fit uses: every clip has parts for the search, its confirmation and the
//! result ([`ClipPart`]). Those of the search come with the decisions of the ideal camera
//! ([`SearchFrames`]); they are kept in memory if they fit, and read again otherwise.

use super::decision_rates::frame_group;
use crate::ExploreError;
use crate::disturbance::{ClipDisturbance, FrameDisturbance};
use crate::footage::ExplorationFootage;
use crate::measure::frame_order;
use crate::row::count_to_f64;
use foveate_camera::Camera;
use foveate_ideal::IdealCamera;
use foveate_measure::{DecisionAreas, DecisionState, FrameOrder, GridCells};
use foveate_media::{ClipHalves, PlayedFrame, RunMonitor, RunProgress};
use foveate_pixels::ByteFrame;
use std::ops::Range;

/// The most memory of frames that are kept, in bytes.
const MAX_KEPT_BYTES: usize = 1 << 28;

/// A frame, and the decisions of the ideal camera.
pub(super) struct SearchFrame {
    pub(super) frame: PlayedFrame,
    /// The pixels that cameras see in place of the frame's, if it is disturbed.
    pub(super) shown: Option<ByteFrame>,
    pub(super) order: FrameOrder,
    pub(super) ideal: Vec<DecisionState>,
    pub(super) group: usize,
    /// The share of all searched frames that are seen after this one, 0..=1; infinite for a frame
    /// that confirms.
    pub(super) seen: f64,
}

/// The frames of the searched part.
pub(super) struct SearchFrames<'a> {
    footage: &'a ExplorationFootage<'a>,
    halves: &'a ClipHalves,
    pub(super) ideal: Camera,
    kept: Option<Vec<SearchFrame>>,
    /// The areas of all searched frames, and of the frames that confirm, as the ideal decides.
    pub(super) areas: [DecisionAreas; 2],
}

/// Returns the bytes of a frame's pixels and decisions.
fn byte_count(frame: &SearchFrame) -> usize {
    let own = &frame.frame.frame;
    let bytes = if own.bits() <= 8 { 1 } else { 2 };
    let planes = 1 + usize::from(frame.shown.is_some());
    planes * bytes * own.width() as usize * own.height() as usize + frame.ideal.len()
}

impl<'a> SearchFrames<'a> {
    /// Reads the frames, and keeps them if they fit into memory.
    pub(super) fn read(
        footage: &'a ExplorationFootage<'a>,
        halves: &'a ClipHalves,
        ideal: &Camera,
    ) -> Result<Self, ExploreError> {
        let ideal = ideal.clone();
        let mut frames = Self { footage, halves, ideal, kept: None, areas: Default::default() };
        let (mut kept, mut bytes) = (Some(Vec::new()), 0);
        let mut areas = [DecisionAreas::default(); 2];
        let cells = GridCells::new(&frames.ideal, &frames.ideal);
        let progress = || RunProgress::work("reading the frames of the search".to_owned());
        frames.read_again(|(half, _)| half, &progress, &mut |frame| {
            let is_searched = frame.seen <= 1.0;
            let areas = &mut areas[usize::from(!is_searched)];
            cells.for_each(|region, _, pixels| {
                areas.add_pair((frame.ideal[region], frame.ideal[region]), pixels, frame.order);
            });
            if !is_searched {
                return Ok(());
            }
            bytes += byte_count(&frame);
            kept = kept.take().filter(|_| bytes <= MAX_KEPT_BYTES);
            if let Some(kept) = &mut kept {
                kept.push(frame);
            }
            Ok(())
        })?;
        (frames.kept, frames.areas) = (kept, areas);
        Ok(frames)
    }

    /// Shows every frame in its order. `progress` is reported, and the hooks may cancel.
    pub(super) fn for_each(
        &self,
        progress: &(dyn Fn() -> RunProgress<'static> + Sync),
        show: &mut dyn FnMut(&SearchFrame) -> Result<(), ExploreError>,
    ) -> Result<(), ExploreError> {
        let Some(kept) = &self.kept else {
            let searched = |halves| ClipPart::Search.frames(halves).end;
            return self.read_again(searched, progress, &mut |frame| show(&frame));
        };
        let stage = |_| progress();
        let monitor = RunMonitor::of_stage(self.footage.hooks, &stage);
        kept.iter().try_for_each(|frame| {
            monitor.add_frame();
            monitor.check()?;
            show(frame)
        })
    }

    /// Reads the frames of every clip up to an end. The frames that confirm belong to no group.
    fn read_again(
        &self,
        end: impl Fn((u64, u64)) -> u64,
        progress: &(dyn Fn() -> RunProgress<'static> + Sync),
        take: &mut dyn FnMut(SearchFrame) -> Result<(), ExploreError>,
    ) -> Result<(), ExploreError> {
        let stage = |_| progress();
        let monitor = RunMonitor::of_stage(self.footage.hooks, &stage);
        let searched = |halves: (u64, u64)| ClipPart::Search.frames(halves).end;
        let all: u64 = self.halves.frames.iter().map(|halves| searched(*halves)).sum();
        let (all, mut number) = (usize::try_from(all).unwrap_or(usize::MAX), 0);
        for (clip, &halves) in self.halves.frames.iter().enumerate() {
            let mut camera = IdealCamera::new(&self.ideal);
            let mut disturbance = ClipDisturbance::new(self.footage.disturbance, clip);
            let mut player = self.footage.clips.open(clip)?.limited_to(end(halves));
            for frame in monitor.watch(&mut player) {
                let frame = frame?;
                if frame.is_first() {
                    camera.reset();
                }
                let FrameDisturbance { truth, shown } =
                    disturbance.disturb(&frame.frame, frame.number)?;
                let outcome = camera.step(truth.as_ref().unwrap_or(&frame.frame))?;
                let (srs, trs) = (&outcome.srs, &outcome.trs);
                let ideal = DecisionState::of_regions(srs, trs, &outcome.actions).collect();
                let (order, mut group, mut seen) = (frame_order(&frame), 0, f64::INFINITY);
                if frame.number < searched(halves) {
                    group = frame_group(number, all);
                    number += 1;
                    seen = count_to_f64(number as u64) / count_to_f64(all as u64);
                }
                take(SearchFrame { frame, shown, order, ideal, group, seen })?;
            }
        }
        Ok(())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClipPart {
    /// The first two thirds of the first half, which cameras are searched by.
    Search,
    /// The rest of the first half, which comes later, has no part in the search, and confirms its
    /// result.
    Confirmation,
    /// The second half.
    HeldOut,
}

impl ClipPart {
    /// All parts, in the order of their frames.
    pub(super) const ALL: [Self; 3] = [Self::Search, Self::Confirmation, Self::HeldOut];

    /// The fewest frames of a clip with which each part has a frame.
    pub(super) const MIN_FRAMES: u64 = 6;

    /// Returns the frames of this part of a clip with `all` frames, of which `half` are the first
    /// half.
    pub(super) fn frames(self, (half, all): (u64, u64)) -> Range<u64> {
        let searched = (2 * half).div_ceil(3);
        match self {
            Self::Search => 0..searched,
            Self::Confirmation => searched..half,
            Self::HeldOut => half..all,
        }
    }

    /// Returns the frames without the first one of the clip, which every camera sends whole.
    pub(super) fn later_frames(self, halves: (u64, u64)) -> Range<u64> {
        let Range { start, end } = self.frames(halves);
        start.max(1)..end
    }
}

pub(super) fn spread_evenly(range: Range<u64>, most: u64) -> Vec<u64> {
    let length = range.end.saturating_sub(range.start);
    let count = most.min(length);
    (0..count).map(|index| range.start + (2 * index + 1) * length / (2 * count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every frame but the first is in one part, the confirming frames come after those of the
    /// search, and no part is empty.
    #[test]
    fn parts_follow_each_other() {
        for all in ClipPart::MIN_FRAMES..200 {
            let [searched, confirmed, held_out] =
                ClipPart::ALL.map(|part| part.later_frames((all / 2, all)));
            let ends = (searched.start, held_out.end);
            assert_eq!(
                (ends, searched.end, confirmed.end),
                ((1, all), confirmed.start, held_out.start)
            );
            assert!(!searched.is_empty() && !confirmed.is_empty() && !held_out.is_empty(), "{all}");
        }
        assert_eq!(ClipPart::Confirmation.frames((90, 180)), 60..90);
        let one_fewer = ClipPart::MIN_FRAMES - 1;
        assert!(ClipPart::Confirmation.frames((one_fewer / 2, one_fewer)).is_empty());
    }

    #[test]
    fn frames_are_spread_evenly() {
        assert_eq!(spread_evenly(1..5, 10), [1, 2, 3, 4]);
        assert_eq!(spread_evenly(0..100, 4), [12, 37, 62, 87]);
        assert_eq!(spread_evenly(50..60, 1), [55]);
        assert!(spread_evenly(1..1, 4).is_empty());
    }
}
