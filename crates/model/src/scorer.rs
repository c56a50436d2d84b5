// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one region scores, from its stream alone.

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

/// Scores one region after the other. Whoever wants to know a frame's scores before the array
/// says them, to aim thresholds at them, asks this.
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
    /// Side of the square that is scored: the region with what its windows see around it.
    scored_side: usize,
    scored: Square,
}

impl RegionScorer {
    /// A scorer of the camera's regions.
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

    /// Takes the stream of a region (as of [`crate::region_stream`]) and denoises it; `border` is
    /// that of [`crate::region_border`].
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

    /// The region's pixels that are scored, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = u16> + '_ {
        self.scored.middle(self.side)
    }

    /// The region's pixels that are sent, row by row.
    pub(crate) fn payload(&self) -> impl Iterator<Item = u16> + '_ {
        let sent = match (self.payload, self.filter) {
            (Payload::Denoised, _) | (Payload::Raw, Filter::None) => &self.scored,
            (Payload::Raw, Filter::Median3x3) => &self.raw,
        };
        sent.middle(self.side)
    }

    /// The means of its blocks; none where irrelevant regions send none.
    #[must_use]
    pub fn means(&self) -> Vec<u16> {
        let means = |periphery| block_means(periphery, self.payload());
        self.periphery.as_ref().map_or(Vec::new(), means)
    }

    /// The scores of the features, in the order of the camera; `reference` is `None` where there is no valid one.
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

    /// Pixels that differ from the reference; all where there is none.
    #[must_use]
    pub fn temporal_count(&self, reference: Option<&[u16]>, thresholds: &Thresholds) -> u32 {
        changed_pixels(&self.seen(reference), thresholds.temporal_level)
    }

    fn seen<'a>(&'a self, reference: Option<&'a [u16]>) -> Seen<'a> {
        Seen { scored: &self.scored, side: self.side, reference }
    }
}

/// A region that was taken, and what it is compared with.
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
