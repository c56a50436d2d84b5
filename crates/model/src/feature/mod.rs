// SPDX-License-Identifier: MIT OR Apache-2.0
//! The spatial features, one file each: the score of one window or of one region.

pub mod corner;
pub mod edge;
pub mod flow;
pub mod mad;
pub mod mean;
pub mod range;
pub mod segment;
pub mod surface;
pub mod variance;

use foveate_camera::{Camera, FeatureKind, SpatialFeature};

use super::region::{FrameRegion, RegionView};
use crate::conversions::count_true;
use crate::window::PixelWindow;
use foveate_pixels::Frame;

use flow::flow_match;
use mean::region_mean;
use range::PixelExtremes;
use segment::{SegmentCounts, sides_of_mean};
use surface::displacement_sums;

/// Returns the score of a region. `level` is ignored for a feature without one.
pub fn score(feature: &SpatialFeature, level: u32, region: &impl RegionView) -> u64 {
    let sum = || region.pixels().map(u64::from).sum();
    let fraction_bits = feature.mean().map_or(0, |mean| mean.fraction_bits);
    match feature.kind() {
        kind @ (FeatureKind::Edge | FeatureKind::Corner) => {
            count_true(region.windows().map(|window| is_hit(kind, &window, level))).into()
        }
        FeatureKind::Mad => {
            let mean = region_mean(region, fraction_bits);
            region.pixels().map(|pixel| mad::deviation(pixel, mean, fraction_bits)).sum()
        }
        FeatureKind::Variance => {
            let square_sum = region.pixels().map(variance::square).sum();
            variance::score(region.pixel_count(), sum(), square_sum)
        }
        FeatureKind::Range => {
            let seen = PixelExtremes::default();
            region.pixels().fold(seen, PixelExtremes::with).range()
        }
        FeatureKind::Surface => displacement_sums(region).score(),
        FeatureKind::Segment => {
            let sides = sides_of_mean(region, level, fraction_bits);
            sides.fold(SegmentCounts::default(), SegmentCounts::with).score()
        }
        FeatureKind::Flow => {
            let radius = feature.radius().expect("flow has a radius");
            flow_match(region, radius).score
        }
    }
}

/// Returns true for every pixel of a region of a denoised padded frame that is a hit, in row-major
/// order. Returns `None` for a feature that counts no hits of windows.
///
/// # Panics
/// Panics if the frame does not have the size of the padded frame of the camera, or has no such
/// region.
#[must_use]
pub fn region_hits(
    camera: &Camera,
    feature: &SpatialFeature,
    denoised: &Frame,
    region: u32,
) -> Option<Vec<bool>> {
    let level = feature.level().filter(|_| feature.kind().counts_window_hits())?;
    let region = FrameRegion::new(camera, denoised, region);
    Some(region.windows().map(|window| is_hit(feature.kind(), &window, level)).collect())
}

/// Returns true if the center of a window is a hit. It is never one for a feature that counts no
/// hits.
#[must_use]
pub fn is_hit(kind: FeatureKind, window: &PixelWindow, level: u32) -> bool {
    match kind {
        FeatureKind::Edge => edge::edge_magnitude(window) > level,
        FeatureKind::Corner => {
            corner::corner_strength(window).is_some_and(|strength| level <= strength)
        }
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Segment
        | FeatureKind::Flow => false,
    }
}

/// Returns a level next to which the center of a window changes between hit and no hit: the largest
/// level at which it is a hit, or one more. Returns `None` if it is not a hit at any level.
#[must_use]
pub fn decisive_level(kind: FeatureKind, window: &PixelWindow) -> Option<u32> {
    match kind {
        FeatureKind::Edge => Some(edge::edge_magnitude(window)),
        FeatureKind::Corner => corner::corner_strength(window),
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Segment
        | FeatureKind::Flow => None,
    }
}
