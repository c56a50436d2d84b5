// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many objects a design sends, in whole and in part, over the frames of a clip.

use std::collections::BTreeMap;

use foveate_design::Design;
use foveate_footage::boxes::Grid;

use super::class::CLASSES;
use super::truth::{Object, Truth};
use crate::watch::Seen;

/// Objects of one class by how many of their regions say yes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shares {
    /// None of their regions.
    pub(super) none: u64,
    /// At least a quarter, a half, all.
    pub(super) at_least: [u64; 3],
}

/// Objects of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    pub(super) objects: u64,
    /// Of which regions are active.
    pub(super) active: Shares,
    /// Of which regions are relevant (SRS), sent or not.
    pub(super) relevant: Shares,
}

/// One object over the frames that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Track {
    pub(super) frames: u64,
    /// Frames in which some regions, a quarter, a half, all of them are active.
    pub(super) some: u64,
    pub(super) at_least: [u64; 3],
    /// Frames since at least half was active, and the most there have been.
    gap: u64,
    pub(super) longest_gap: u64,
}

/// Sums over frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    frames: u64,
    bits: u64,
    /// One per class.
    counts: Vec<Count>,
    pub(super) tracks: BTreeMap<u64, Track>,
}

/// What a design makes of a clip. Frame 0 has no reference: it counts only in a clip that has no other.
#[derive(Default)]
pub(super) struct ObjectTally {
    first: Sums,
    rest: Sums,
}

impl ObjectTally {
    pub(super) fn add(&mut self, truth: &Truth, design: &Design, seen: &Seen<'_>) {
        let sums = if seen.without_reference { &mut self.first } else { &mut self.rest };
        sums.add(truth.objects(), design, seen);
    }

    pub(super) fn sums(&self) -> &Sums {
        if self.rest.frames > 0 { &self.rest } else { &self.first }
    }
}

impl Sums {
    fn add(&mut self, objects: &[Object], design: &Design, seen: &Seen<'_>) {
        let outcome = seen.outcome;
        self.frames += 1;
        self.bits += design.bits_sent(1, design.values_of(&outcome.actions));
        self.counts.resize(CLASSES.len(), Count::default());
        let (side, width, height) = (design.region_size(), design.width(), design.height());
        let grid = Grid { side, width, height };
        for object in objects {
            let (active, regions) = grid.votes(&object.rect, &outcome.active);
            let (relevant, _) = grid.votes(&object.rect, &outcome.srs);
            for class in object.classes {
                let count = &mut self.counts[class];
                count.objects += 1;
                count.active.add(active, regions);
                count.relevant.add(relevant, regions);
            }
            if let Some(track) = object.track {
                self.tracks.entry(track).or_default().add(active, regions);
            }
        }
    }

    /// Adds another clip. Its tracks are other objects, so they are not kept.
    pub(super) fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.bits += other.bits;
        self.counts.resize(CLASSES.len(), Count::default());
        for (own, other) in self.counts.iter_mut().zip(&other.counts) {
            own.objects += other.objects;
            own.active.merge(&other.active);
            own.relevant.merge(&other.relevant);
        }
    }

    pub(super) fn count(&self, class: usize) -> Count {
        self.counts.get(class).copied().unwrap_or_default()
    }

    /// Bytes per frame, rounded to the nearest.
    pub(super) fn bytes(&self) -> u64 {
        let eighths = 8 * self.frames.max(1);
        (self.bits + eighths / 2) / eighths
    }
}

impl Shares {
    fn add(&mut self, yes: u64, regions: u64) {
        self.none += u64::from(yes == 0);
        add(&mut self.at_least, levels(yes, regions).map(u64::from));
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.none += other.none;
        add(&mut self.at_least, other.at_least);
    }
}

impl Track {
    fn add(&mut self, active: u64, regions: u64) {
        let levels = levels(active, regions);
        self.frames += 1;
        self.some += u64::from(active > 0);
        add(&mut self.at_least, levels.map(u64::from));
        self.gap = if levels[1] { 0 } else { self.gap + 1 };
        self.longest_gap = self.longest_gap.max(self.gap);
    }
}

/// Whether that is a quarter, a half, all of the regions.
fn levels(yes: u64, regions: u64) -> [bool; 3] {
    [4 * yes >= regions, 2 * yes >= regions, yes == regions]
}

fn add(sums: &mut [u64; 3], more: [u64; 3]) {
    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// Tracks as objects: what each had at least once.
pub(super) fn once<'a>(tracks: impl Iterator<Item = &'a Track>) -> (Count, Option<u64>) {
    let (mut count, mut longest) = (Count::default(), None);
    for track in tracks {
        count.objects += 1;
        count.active.none += u64::from(track.some == 0);
        add(&mut count.active.at_least, track.at_least.map(|frames| u64::from(frames > 0)));
        longest = longest.max(Some(track.longest_gap));
    }
    (count, longest)
}
