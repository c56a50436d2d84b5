// SPDX-License-Identifier: MIT OR Apache-2.0
//! The spatial features, one file each: what one window or one region of pixels scores.

pub mod corner;
pub mod edge;
pub mod mad;
pub mod variance;

use foveate_design::{Design, FeatureKind, SpatialFeature};

use crate::window::{RegionView, Window};
use foveate_frame::Frame;

pub use corner::corner_strengths;
pub use edge::edge_magnitudes;

/// The score of one region of a denoised padded frame.
pub(crate) fn score(
    design: &Design,
    feature: &SpatialFeature,
    denoised: &Frame,
    region: u32,
) -> u64 {
    let view = RegionView::new(design, denoised, region);
    let n = u64::from(design.region_pixels());
    match feature.kind() {
        kind @ (FeatureKind::Edge | FeatureKind::Corner) => {
            let level = feature.level().unwrap_or_default();
            crate::number::count(view.windows().map(|window| is_hit(kind, &window, level))).into()
        }
        FeatureKind::Mad => {
            let fraction_bits = feature.mean().map_or(0, |mean| mean.fraction_bits);
            let mean = mad::mean(view.pixels().map(u64::from).sum(), n, fraction_bits);
            view.pixels().map(|pixel| mad::deviation(pixel, mean, fraction_bits)).sum()
        }
        FeatureKind::Variance => {
            let sum = view.pixels().map(u64::from).sum();
            variance::score(n, sum, view.pixels().map(variance::square).sum())
        }
    }
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
