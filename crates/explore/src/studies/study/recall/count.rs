// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of objects that a design sends, in whole and in part, over the frames of a clip.

use std::collections::BTreeMap;

use foveate_design::Design;
use foveate_media::boxes::RegionGrid;

use super::class::CLASSES;
use super::truth::{FrameObject, GroundTruthObjects};
use crate::studies::runner::FrameResult;

/// The numbers of objects of one class by the share of their regions that have a vote.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LevelCounts {
    /// The number of objects without such a region.
    pub(super) none: u64,
    /// The numbers of objects with at least a quarter, at least half, and all of their regions.
    pub(super) at_least: [u64; 3],
}

/// The counts of the objects of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ClassCounts {
    pub(super) objects: u64,
    /// The objects by their active regions.
    pub(super) active: LevelCounts,
    /// The objects by their relevant regions (SRS), sent or not.
    pub(super) relevant: LevelCounts,
}

/// The counts of one object over the frames that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TrackCounts {
    pub(super) frames: u64,
    /// The number of frames in which some of the object's regions are active; `at_least` has the
    /// frames with at least a quarter, at least half, and all of them.
    pub(super) some_active: u64,
    pub(super) at_least: [u64; 3],
    /// The number of frames since at least half of the object's regions were active; `longest_gap`
    /// is the largest such number.
    current_gap: u64,
    pub(super) longest_gap: u64,
}

/// The sums over frames.
#[derive(Clone, Debug, Default)]
pub(super) struct RecallSums {
    frames: u64,
    bits: u64,
    counts: Vec<ClassCounts>,
    pub(super) tracks: BTreeMap<u64, TrackCounts>,
}

/// The sums of a design over a clip. Frame 0 has no reference, so it counts only in a clip without
/// other frames.
#[derive(Default)]
pub(super) struct ObjectTally {
    first_frame: RecallSums,
    other_frames: RecallSums,
}

impl ObjectTally {
    pub(super) fn add(
        &mut self,
        truth: &GroundTruthObjects,
        design: &Design,
        seen: &FrameResult<'_>,
    ) {
        let sums =
            if seen.is_without_reference { &mut self.first_frame } else { &mut self.other_frames };
        sums.add(truth.objects(), design, seen);
    }

    pub(super) fn sums(&self) -> &RecallSums {
        if self.other_frames.frames > 0 { &self.other_frames } else { &self.first_frame }
    }
}

impl RecallSums {
    fn add(&mut self, objects: &[FrameObject], design: &Design, seen: &FrameResult<'_>) {
        let outcome = seen.outcome;
        self.frames += 1;
        self.bits += design.bits_sent(1, design.values_sent_per_frame(&outcome.actions));
        self.counts.resize(CLASSES.len(), ClassCounts::default());
        let (side, width, height) = (design.region_size(), design.width(), design.height());
        let grid = RegionGrid { side, width, height };
        for object in objects {
            let (active, regions) = grid.count_votes(&object.rect, &outcome.active);
            let (relevant, _) = grid.count_votes(&object.rect, &outcome.srs);
            for class in object.classes {
                let count = &mut self.counts[class];
                count.objects += 1;
                count.active.add(active, regions);
                count.relevant.add(relevant, regions);
            }
            if let Some(track) = object.track {
                self.tracks.entry(track).or_default().add_levels(active, regions);
            }
        }
    }

    /// Adds another clip without its tracks, because they are other objects.
    pub(super) fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.bits += other.bits;
        self.counts.resize(CLASSES.len(), ClassCounts::default());
        for (own, other) in self.counts.iter_mut().zip(&other.counts) {
            own.objects += other.objects;
            own.active.merge(&other.active);
            own.relevant.merge(&other.relevant);
        }
    }

    pub(super) fn count(&self, class: usize) -> ClassCounts {
        self.counts.get(class).copied().unwrap_or_default()
    }

    /// Returns the bytes per frame, rounded to the nearest.
    pub(super) fn bytes_per_frame(&self) -> u64 {
        let eighths = 8 * self.frames.max(1);
        (self.bits + eighths / 2) / eighths
    }
}

impl LevelCounts {
    fn add(&mut self, yes: u64, regions: u64) {
        self.none += u64::from(yes == 0);
        add(&mut self.at_least, reached_levels(yes, regions).map(u64::from));
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.none += other.none;
        add(&mut self.at_least, other.at_least);
    }
}

impl TrackCounts {
    fn add_levels(&mut self, active: u64, regions: u64) {
        let levels = reached_levels(active, regions);
        self.frames += 1;
        self.some_active += u64::from(active > 0);
        add(&mut self.at_least, levels.map(u64::from));
        self.current_gap = if levels[1] { 0 } else { self.current_gap + 1 };
        self.longest_gap = self.longest_gap.max(self.current_gap);
    }
}

/// Returns whether `yes` regions are at least a quarter, at least half, and all of them.
fn reached_levels(yes: u64, regions: u64) -> [bool; 3] {
    [4 * yes >= regions, 2 * yes >= regions, yes == regions]
}

fn add(sums: &mut [u64; 3], more: [u64; 3]) {
    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// Counts tracks as objects by what each reached in at least one frame, and returns the longest gap
/// of all tracks.
pub(super) fn reached_at_least_once<'a>(
    tracks: impl Iterator<Item = &'a TrackCounts>,
) -> (ClassCounts, Option<u64>) {
    let (mut count, mut longest) = (ClassCounts::default(), None);
    for track in tracks {
        count.objects += 1;
        count.active.none += u64::from(track.some_active == 0);
        add(&mut count.active.at_least, track.at_least.map(|frames| u64::from(frames > 0)));
        longest = longest.max(Some(track.longest_gap));
    }
    (count, longest)
}
