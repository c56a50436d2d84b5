// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of one region, computed from its stream alone.

use foveate_camera::{Camera, FeatureKind, Filter, Payload, Periphery, SpatialFeature};

use crate::Thresholds;
use crate::denoise::median;
use crate::feature::score;
use crate::number::{amount, index};
use crate::periphery::block_means;
use crate::square::Square;
use crate::temporal::changed_pixels;
use crate::view::RegionView;
use crate::window::Window;

/// A scorer of one region after the other. A test driver uses it to know the scores of a frame
/// before the array outputs them, so that it can set thresholds next to them.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionScorer {
    /// Side of a region N.
    side: usize,
    filter: Filter,
    payload: Payload,
    periphery: Option<Periphery>,
    needs_border: bool,
    features: Vec<SpatialFeature>,
    raw: Square,
    /// Side of the square that is scored: the region with the halo of its windows.
    scored_side: usize,
    scored: Square,
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
            raw: Square::black(index(camera.stream_side())),
            scored_side,
            scored: Square::black(scored_side),
        }
    }

    /// Takes the stream of a region, as [`crate::region_stream`] makes it, and denoises it.
    /// `border` is the value of [`crate::region_border`].
    pub fn take(&mut self, stream: impl Iterator<Item = u16>, border: u8) {
        match self.filter {
            Filter::None => self.scored.fill(stream),
            Filter::Median3x3 => {
                self.raw.fill(stream);
                let windows = self.raw.windows(self.scored_side);
                self.scored.fill(windows.map(|window| median(&window)));
                if self.needs_border {
                    self.scored.repeat_beyond(border);
                }
            }
        }
    }

    /// Returns the scored pixels of the region in row-major order.
    pub fn pixels(&self) -> impl Iterator<Item = u16> + '_ {
        self.scored.middle(self.side)
    }

    /// Returns the pixels of the region that it forwards, in row-major order.
    pub(crate) fn payload(&self) -> impl Iterator<Item = u16> + '_ {
        let sent = match (self.payload, self.filter) {
            (Payload::Denoised, _) | (Payload::Raw, Filter::None) => &self.scored,
            (Payload::Raw, Filter::Median3x3) => &self.raw,
        };
        sent.middle(self.side)
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
        thresholds: &Thresholds,
    ) -> [u64; FeatureKind::COUNT] {
        let seen = self.seen(reference);
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
    pub fn temporal_count(&self, reference: Option<&[u16]>, thresholds: &Thresholds) -> u32 {
        changed_pixels(&self.seen(reference), thresholds.temporal_level)
    }

    fn seen<'a>(&'a self, reference: Option<&'a [u16]>) -> Seen<'a> {
        Seen { scored: &self.scored, side: self.side, reference }
    }
}

/// A region that was taken, with its reference.
struct Seen<'a> {
    scored: &'a Square,
    side: usize,
    reference: Option<&'a [u16]>,
}

impl RegionView for Seen<'_> {
    fn n(&self) -> u64 {
        amount(self.side * self.side)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.scored.middle(self.side)
    }

    fn windows(&self) -> impl Iterator<Item = Window> {
        self.scored.windows(self.side)
    }

    fn before(&self) -> Option<impl Iterator<Item = u16>> {
        self.reference.map(|pixels| pixels.iter().copied())
    }
}
