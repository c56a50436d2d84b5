// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of one region, computed from its stream alone.

use foveate_camera::{
    Camera, DenoiseFilter, Displacement, FeatureKind, Payload, Periphery, SpatialFeature,
};

use crate::ThresholdInputs;
use crate::conversions::{as_u64, index};
use crate::feature::flow::flow_match;
use crate::feature::score;
use crate::periphery::block_means;
use crate::pixel_square::PixelSquare;
use crate::region_view::RegionView;
use crate::temporal::changed_pixels;
use crate::window::PixelWindow;
use crate::window_filter::filtered_pixel;

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

    /// Returns the scored pixels of the region, row by row.
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
