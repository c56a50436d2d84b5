// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of one region, computed from its stream alone ([`RegionScorer`]). The stream
//! fills a square of pixels: a region with its halo ([`PixelSquare`]).

use super::cycle_model::{BOTTOM, LEFT, RIGHT, TOP};
use super::region::RegionView;
use crate::ThresholdInputs;
use crate::conversions::{as_u64, index};
use crate::feature::flow::flow_match;
use crate::feature::score;
use crate::periphery::block_means;
use crate::temporal::changed_pixels;
use crate::window::PixelWindow;
use crate::window_filter::filtered_pixel;
use foveate_camera::{
    Camera, DenoiseFilter, Displacement, FeatureKind, Payload, Periphery, SpatialFeature,
};

/// A scorer of one region after the other. A test driver uses it to know the scores of a frame
/// before the array outputs them, so that it can set thresholds next to them.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionScorer {
    /// Side of a region N.
    side: usize,
    filter: DenoiseFilter,
    payload: Payload,
    periphery: Option<Periphery>,
    needs_border: bool,
    features: Vec<SpatialFeature>,
    raw: PixelSquare,
    /// Side of the square that is scored: the region with the halo of its windows.
    scored_side: usize,
    scored: PixelSquare,
}

impl RegionScorer {
    /// Makes a scorer of the regions of the camera.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let scored_side = index(camera.denoised_side());
        Self {
            side: index(camera.region_size()),
            filter: camera.filter(),
            payload: camera.payload(),
            periphery: camera.periphery().copied(),
            needs_border: camera.needs_border(),
            features: camera.features().to_vec(),
            raw: PixelSquare::black(index(camera.stream_side())),
            scored_side,
            scored: PixelSquare::black(scored_side),
        }
    }

    /// Takes the stream of a region, as [`crate::region_stream`] makes it, and denoises it.
    /// `border` is the value of [`crate::region_border`].
    pub fn load(&mut self, stream: impl Iterator<Item = u16>, border: u8) {
        let filter = self.filter;
        if !filter.has_window() {
            self.scored.fill(stream);
            return;
        }
        self.raw.fill(stream);
        self.scored.fill_from_windows(&self.raw, |window| filtered_pixel(filter, window));
        if self.needs_border {
            self.scored.repeat_borders(border);
        }
    }

    /// Returns the scored pixels of the region in row-major order.
    pub fn pixels(&self) -> impl Iterator<Item = u16> + '_ {
        self.scored.inner_pixels(self.side)
    }

    pub(crate) fn pixel_rows(&self) -> Vec<&[u16]> {
        self.scored.inner_rows(self.side).collect()
    }

    /// Returns the pixels of the region that it forwards, row by row.
    pub(crate) fn payload_rows(&self) -> Vec<&[u16]> {
        self.sent().inner_rows(self.side).collect()
    }

    /// Returns the pixels of the region that it forwards, in row-major order.
    pub(crate) fn payload(&self) -> impl Iterator<Item = u16> + '_ {
        self.sent().inner_pixels(self.side)
    }

    /// Returns the square that has the pixels that the region forwards.
    fn sent(&self) -> &PixelSquare {
        match self.payload {
            Payload::Raw if self.filter.has_window() => &self.raw,
            Payload::Raw | Payload::Denoised => &self.scored,
        }
    }

    /// Returns the means of the blocks of the region. They are empty if irrelevant regions send no
    /// means.
    #[must_use]
    pub fn means(&self) -> Vec<u16> {
        let means = |periphery| block_means(periphery, self.payload());
        self.periphery.as_ref().map_or(Vec::new(), means)
    }

    /// Returns the scores of the features in the order of the camera. `reference` is `None` if
    /// there is no valid one.
    #[must_use]
    pub fn scores(
        &self,
        reference: Option<&[u16]>,
        thresholds: &ThresholdInputs,
    ) -> [u64; FeatureKind::COUNT] {
        let seen = self.scored_region(reference);
        let mut scores = [0; FeatureKind::COUNT];
        let features = self.features.iter().zip(&thresholds.level);
        for (own, (feature, &level)) in scores.iter_mut().zip(features) {
            *own = score(feature, level, &seen);
        }
        scores
    }

    /// Returns the number of pixels that differ from the reference by more than the level, or n if
    /// there is no valid reference.
    #[must_use]
    pub fn temporal_count(&self, reference: Option<&[u16]>, thresholds: &ThresholdInputs) -> u32 {
        changed_pixels(&self.scored_region(reference), thresholds.temporal_level)
    }

    /// Returns the displacement of the region since its reference, or `None` for a camera without
    /// `flow`. `reference` is `None` if there is no valid one.
    #[must_use]
    pub fn displacement(&self, reference: Option<&[u16]>) -> Option<Displacement> {
        let radius = self.features.iter().find_map(SpatialFeature::radius)?;
        Some(flow_match(&self.scored_region(reference), radius).displacement)
    }

    fn scored_region<'a>(&'a self, reference: Option<&'a [u16]>) -> ScoredRegion<'a> {
        ScoredRegion { scored: &self.scored, side: self.side, reference }
    }
}

/// A region that was taken, with its reference.
struct ScoredRegion<'a> {
    scored: &'a PixelSquare,
    side: usize,
    reference: Option<&'a [u16]>,
}

impl RegionView for ScoredRegion<'_> {
    fn pixel_count(&self) -> u64 {
        as_u64(self.side * self.side)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.scored.inner_pixels(self.side)
    }

    fn windows(&self) -> impl Iterator<Item = PixelWindow> {
        self.scored.inner_windows(self.side)
    }

    fn reference(&self) -> Option<impl Iterator<Item = u16>> {
        self.reference.map(|pixels| pixels.iter().copied())
    }
}

/// A square of pixels in row-major order. Around it is a guard, one pixel wide, in which its
/// outermost pixels are repeated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PixelSquare {
    side: usize,
    guarded: Vec<u16>,
}

impl PixelSquare {
    pub(crate) fn black(side: usize) -> Self {
        Self { side, guarded: vec![0; (side + 2) * (side + 2)] }
    }

    /// Replaces the pixels of the square.
    pub(crate) fn fill(&mut self, mut pixels: impl Iterator<Item = u16>) {
        for row in self.rows_mut() {
            row.iter_mut().zip(&mut pixels).for_each(|(own, pixel)| *own = pixel);
        }
        self.repeat_guard();
    }

    /// Replaces the pixels of the square by the values of windows of another square: those around
    /// the pixels of its centered square that is as large as this one.
    pub(crate) fn fill_from_windows(&mut self, other: &Self, value: impl Fn(&PixelWindow) -> u16) {
        let side = self.side;
        for (y, row) in self.rows_mut().enumerate() {
            let windows = other.inner_row_windows(side, y);
            row.iter_mut().zip(windows).for_each(|(own, window)| *own = value(&window));
        }
        self.repeat_guard();
    }

    /// Returns the pixels of the centered square of side `inner` in row-major order.
    pub(crate) fn inner_pixels(&self, inner: usize) -> impl Iterator<Item = u16> + '_ {
        self.inner_rows(inner).flatten().copied()
    }

    /// Returns the rows of the centered square of side `inner`.
    pub(crate) fn inner_rows(&self, inner: usize) -> impl Iterator<Item = &[u16]> + '_ {
        let margin = 1 + (self.side - inner) / 2;
        (margin..margin + inner).map(move |y| &self.guarded_row(y)[margin..][..inner])
    }

    /// Returns the windows around the pixels of [`PixelSquare::inner_pixels`]. They see the guard
    /// only in isolated regions, where there is no margin.
    pub(crate) fn inner_windows(&self, inner: usize) -> impl Iterator<Item = PixelWindow> + '_ {
        (0..inner).flat_map(move |y| self.inner_row_windows(inner, y))
    }

    /// Returns the windows of row `y` of [`PixelSquare::inner_windows`].
    fn inner_row_windows(&self, inner: usize, y: usize) -> impl Iterator<Item = PixelWindow> + '_ {
        let margin = (self.side - inner) / 2;
        let threes = |y| self.guarded_row(margin + y)[margin..][..inner + 2].windows(3);
        threes(y).zip(threes(y + 1)).zip(threes(y + 2)).map(|((above, here), below)| {
            std::array::from_fn(|place| [above, here, below][place / 3][place % 3])
        })
    }

    /// Replaces the outermost pixels at the sides in `border` by their inner neighbors, so that
    /// positions beyond the frame hold the nearest pixel inside.
    pub(crate) fn repeat_borders(&mut self, border: u8) {
        self.repeat_inner_neighbors(1, border);
        self.repeat_guard();
    }

    /// Repeats the outermost pixels of the square in the guard.
    fn repeat_guard(&mut self) {
        self.repeat_inner_neighbors(0, TOP | BOTTOM | LEFT | RIGHT);
    }

    /// Replaces the pixels of some sides by their inner neighbors: those of the guard for `ring` 0,
    /// the outermost of the square for 1. Rows are replaced before columns, so that the columns
    /// carry the corners.
    fn repeat_inner_neighbors(&mut self, ring: usize, sides: u8) {
        let stride = self.side + 2;
        let (first, last) = (ring, stride - 1 - ring);
        let names = |bit: u8| sides & bit != 0;
        let row = |y: usize| y * stride..(y + 1) * stride;
        if names(TOP) {
            self.guarded.copy_within(row(first + 1), first * stride);
        }
        if names(BOTTOM) {
            self.guarded.copy_within(row(last - 1), last * stride);
        }
        for row in self.guarded.chunks_exact_mut(stride) {
            if names(LEFT) {
                row[first] = row[first + 1];
            }
            if names(RIGHT) {
                row[last] = row[last - 1];
            }
        }
    }

    /// Returns the rows of the square without the guard.
    fn rows_mut(&mut self) -> impl Iterator<Item = &mut [u16]> {
        let side = self.side;
        let rows = self.guarded.chunks_exact_mut(side + 2).skip(1).take(side);
        rows.map(move |row| &mut row[1..=side])
    }

    /// Returns row `y` of the square with its guard.
    fn guarded_row(&self, y: usize) -> &[u16] {
        let stride = self.side + 2;
        &self.guarded[y * stride..][..stride]
    }
}
