// SPDX-License-Identifier: MIT OR Apache-2.0
//! The spatial features, one file each: what one window or one region of pixels scores.

pub mod corner;
pub mod edge;
pub mod mad;
pub mod variance;

use foveate_camera::{Camera, FeatureKind, SpatialFeature};

use crate::window::{RegionView, Window};
use foveate_frame::Frame;

pub use corner::corner_strengths;
pub use edge::edge_magnitudes;

/// The score of a region of `n` pixels, from these and the windows around them. `level` is without meaning
/// for a feature that counts no hits.
pub fn score<P: Iterator<Item = u16>>(
    feature: &SpatialFeature,
    level: u32,
    n: u64,
    pixels: impl Fn() -> P,
    windows: impl Iterator<Item = Window>,
) -> u64 {
    let sum = || pixels().map(u64::from).sum();
    match feature.kind() {
        kind @ (FeatureKind::Edge | FeatureKind::Corner) => {
            crate::number::count(windows.map(|window| is_hit(kind, &window, level))).into()
        }
        FeatureKind::Mad => {
            let fraction_bits = feature.mean().expect("mad has a mean").fraction_bits;
            let mean = mad::mean(sum(), n, fraction_bits);
            pixels().map(|pixel| mad::deviation(pixel, mean, fraction_bits)).sum()
        }
        FeatureKind::Variance => variance::score(n, sum(), pixels().map(variance::square).sum()),
    }
}

/// The score of one region of a denoised padded frame.
pub(crate) fn of_region(
    camera: &Camera,
    feature: &SpatialFeature,
    denoised: &Frame,
    region: u32,
) -> u64 {
    let view = RegionView::new(camera, denoised, region);
    let n = u64::from(camera.region_pixels());
    // A feature without a level does not ask for one.
    score(feature, feature.level().unwrap_or(0), n, || view.pixels(), view.windows())
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
    let level = feature.level()?;
    let windows = RegionView::new(camera, denoised, region).windows();
    Some(windows.map(|window| is_hit(feature.kind(), &window, level)).collect())
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
