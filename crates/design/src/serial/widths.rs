// SPDX-License-Identifier: MIT OR Apache-2.0
//! The widths of the registers of a serial lane and of the sequencer.

use super::feature::{chain_bits, feature_register_widths};
use crate::{PixelFeed, SerialDesign};
use foveate_camera::{DenoiseFilter, index_bits};

/// The widths of the registers of a serial array, in bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneWidths {
    /// Width of the accumulator, which is signed.
    pub accumulator: u32,
    /// Width of the second word, which holds a mean, a sum, a quotient or the largest pixel. It is at
    /// least 2.
    pub second: u32,
    /// Width of the word that travels around the ring of lanes: a score, the sum of a block, a mean
    /// or, with raster feed, a pixel.
    pub chain: u32,
    /// Width of the constant that the sequencer shifts from step to step.
    pub scale: u32,
    /// Width of the number of a center in the larger square of centers.
    pub center: u32,
}

impl LaneWidths {
    fn from_design(design: SerialDesign<'_>) -> Self {
        let pixel = design.pixel_bits();
        let raster = match design.feed() {
            PixelFeed::Parallel => 0,
            PixelFeed::Raster => pixel,
        };
        let sums = design.block_mean_division();
        let counts = design.features().iter().map(|feature| chain_bits(&design, feature));
        let chain = counts
            .fold(design.max_score_bits(), u32::max)
            .max(raster)
            .max(sums.map_or(0, |sums| sums.passing_bits));
        let filter = match design.filter() {
            DenoiseFilter::None | DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3 => 1,
            DenoiseFilter::Binomial3x3 => 5,
        };
        // The accumulator holds the difference of two pixels, or of their windows. The scale holds
        // the power of two that the median search starts with.
        let mut widths = Self {
            accumulator: (pixel + filter).max(sums.map_or(0, |sums| sums.sum_bits)),
            second: 2,
            chain,
            scale: pixel,
            center: index_bits(if design.filter().has_window() {
                u64::from(design.denoised_side()).pow(2)
            } else {
                design.region_pixels().into()
            }),
        };
        for feature in design.features() {
            let needs = feature_register_widths(&design, feature, chain);
            widths.accumulator = widths.accumulator.max(needs.accumulator);
            widths.second = widths.second.max(needs.second);
            widths.scale = widths.scale.max(needs.scale);
        }
        widths
    }
}

impl SerialDesign<'_> {
    /// Returns the widths of the registers of the array.
    #[must_use]
    pub fn lane_widths(&self) -> LaneWidths {
        LaneWidths::from_design(*self)
    }
}
