// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outcome of one frame, region by region.

use std::ops::Range;

use foveate_camera::{Camera, Displacement, FeatureKind, RegionAction};

/// The scores and decisions of every region, numbered row by row. The fields are those of the
/// functional model's outcome. [`Engine::rendered`](crate::Engine::rendered) has the rendered
/// frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameOutcome {
    /// SRS, the spatial relevance of every region.
    pub srs: Vec<bool>,
    /// TRS, the temporal relevance of every region.
    pub trs: Vec<bool>,
    /// The active regions: SRS and TRS are both set, and the new pixels are forwarded.
    pub active: Vec<bool>,
    /// The action on every region of the screen.
    pub actions: Vec<RegionAction>,
    /// The number of changed pixels of every region, N x N if there was no valid reference.
    pub temporal_count: Vec<u32>,
    /// The scores, by feature in the order of the camera and then by region.
    pub scores: Vec<Vec<u64>>,
    /// The displacement of every region since its reference. It is empty for a camera without
    /// `flow`.
    pub displacements: Vec<Displacement>,
    /// The number of regions whose results were kept because their pixels were bit-identical to
    /// those of the previous frame. With shared neighborhoods the regions around them had to be
    /// identical, too.
    pub skipped: usize,
}

impl FrameOutcome {
    pub(crate) fn new(camera: &Camera, regions: usize) -> Self {
        let displaced = camera.displacement_feature().map_or(0, |_| regions);
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![RegionAction::Hold; regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; camera.features().len()],
            displacements: vec![Displacement::default(); displaced],
            skipped: 0,
        }
    }

    /// Borrows the results of all regions, to be written.
    pub(crate) fn results(&mut self) -> RegionResults<'_> {
        let mut scores = self.scores.iter_mut();
        RegionResults {
            srs: &mut self.srs,
            trs: &mut self.trs,
            active: &mut self.active,
            actions: &mut self.actions,
            temporal_count: &mut self.temporal_count,
            scores: std::array::from_fn(|_| scores.next().map_or(&mut [][..], |values| values)),
            displacements: &mut self.displacements,
        }
    }
}

/// The results of consecutive regions.
#[derive(Debug)]
pub(crate) struct RegionResults<'a> {
    pub(crate) srs: &'a mut [bool],
    pub(crate) trs: &'a mut [bool],
    pub(crate) active: &'a mut [bool],
    pub(crate) actions: &'a mut [RegionAction],
    pub(crate) temporal_count: &'a mut [u32],
    /// One slice per feature. Slices beyond the camera's features are empty.
    pub(crate) scores: [&'a mut [u64]; FeatureKind::COUNT],
    /// The displacements; empty for a camera without `flow`.
    pub(crate) displacements: &'a mut [Displacement],
}

impl<'a> RegionResults<'a> {
    /// Splits off the results of the first `regions` regions.
    pub(crate) fn split_off(&mut self, regions: usize) -> RegionResults<'a> {
        let scores = &mut self.scores;
        RegionResults {
            srs: split_off(&mut self.srs, regions),
            trs: split_off(&mut self.trs, regions),
            active: split_off(&mut self.active, regions),
            actions: split_off(&mut self.actions, regions),
            temporal_count: split_off(&mut self.temporal_count, regions),
            scores: std::array::from_fn(|feature| split_off(&mut scores[feature], regions)),
            displacements: split_off(&mut self.displacements, regions),
        }
    }
}

impl RegionResults<'_> {
    #[inline(always)]
    pub(crate) fn copy_from(&mut self, other: &RegionResults<'_>) {
        self.srs.copy_from_slice(other.srs);
        self.trs.copy_from_slice(other.trs);
        self.active.copy_from_slice(other.active);
        self.actions.copy_from_slice(other.actions);
        self.temporal_count.copy_from_slice(other.temporal_count);
        for (values, other) in self.scores.iter_mut().zip(&other.scores) {
            values.copy_from_slice(other);
        }
        self.displacements.copy_from_slice(other.displacements);
    }

    /// Borrows the results of a range of the regions.
    #[inline(always)]
    pub(crate) fn range(&mut self, regions: Range<usize>) -> RegionResults<'_> {
        RegionResults {
            srs: &mut self.srs[regions.clone()],
            trs: &mut self.trs[regions.clone()],
            active: &mut self.active[regions.clone()],
            actions: &mut self.actions[regions.clone()],
            temporal_count: &mut self.temporal_count[regions.clone()],
            scores: self.scores.each_mut().map(|scores| cut_to_range(scores, &regions)),
            displacements: cut_to_range(self.displacements, &regions),
        }
    }
}

/// Returns a range of the values, cut to the values that exist.
#[inline(always)]
pub(crate) fn cut_to_range<'s, T>(values: &'s mut [T], range: &Range<usize>) -> &'s mut [T] {
    let len = values.len();
    &mut values[range.start.min(len)..range.end.min(len)]
}

/// Splits off the first `len` values, or all of them if there are fewer.
pub(crate) fn split_off<'a, T>(values: &mut &'a mut [T], len: usize) -> &'a mut [T] {
    let all = std::mem::take(values);
    let (first, rest) = all.split_at_mut(len.min(all.len()));
    *values = rest;
    first
}
