// SPDX-License-Identifier: MIT OR Apache-2.0
//! The spatial features, one file each: what one window or one region of pixels scores.

pub mod corner;
pub mod edge;
pub mod mad;
pub mod variance;

use foveate_camera::{Camera, FeatureKind, SpatialFeature};

use crate::number::count;
use crate::view::{FrameRegion, RegionView};
use crate::window::Window;
use foveate_frame::Frame;

pub use corner::corner_strengths;
pub use edge::edge_magnitudes;

/// The score of a region. `level` is without meaning for a feature that counts no hits.
pub fn score(feature: &SpatialFeature, level: u32, region: &impl RegionView) -> u64 {
    let sum = || region.pixels().map(u64::from).sum();
    match feature.kind() {
        kind @ (FeatureKind::Edge | FeatureKind::Corner) => {
            count(region.windows().map(|window| is_hit(kind, &window, level))).into()
        }
        FeatureKind::Mad => {
            let fraction_bits = feature.mean().expect("mad has a mean").fraction_bits;
            let mean = mad::mean(sum(), region.n(), fraction_bits);
            region.pixels().map(|pixel| mad::deviation(pixel, mean, fraction_bits)).sum()
        }
        FeatureKind::Variance => {
            let square_sum = region.pixels().map(variance::square).sum();
            variance::score(region.n(), sum(), square_sum)
        }
    }
}

/// Which pixels of a region of a denoised padded frame are hits, row by row; `None` for a feature that counts
/// no hits.
///
/// # Panics
/// When the frame is not as large as the camera's padded frame, or has no such region.
#[must_use]
pub fn hits(
    camera: &Camera,
    feature: &SpatialFeature,
    denoised: &Frame,
    region: u32,
) -> Option<Vec<bool>> {
    let level = feature.level().filter(|_| feature.kind().measure().is_count())?;
    let region = FrameRegion::new(camera, denoised, region);
    Some(region.windows().map(|window| is_hit(feature.kind(), &window, level)).collect())
}

/// Whether the center of a window is a hit; never for features that do not count hits.
#[must_use]
pub fn is_hit(kind: FeatureKind, window: &Window, level: u32) -> bool {
    match kind {
        FeatureKind::Edge => edge::magnitude(window) > level,
        FeatureKind::Corner => corner::strength(window).is_some_and(|strength| level <= strength),
        FeatureKind::Mad | FeatureKind::Variance => false,
    }
}

/// The level around which the center of a window becomes a hit or none: the largest of which it is one, or one
/// more. `None` where it is one with no level.
#[must_use]
pub fn decisive_level(kind: FeatureKind, window: &Window) -> Option<u32> {
    match kind {
        FeatureKind::Edge => Some(edge::magnitude(window)),
        FeatureKind::Corner => corner::strength(window),
        FeatureKind::Mad | FeatureKind::Variance => None,
    }
}
