// SPDX-License-Identifier: MIT OR Apache-2.0
//! The passes over pixels that features need, and the thresholds of features, in the form that the
//! kernels need.

use foveate_camera::{FeatureKind, SpatialFeature};

use crate::kernel::segment::SegmentPlan;
use foveate_pixels::vectors::{VectorPixel, saturated_threshold};

/// The passes over the pixels of a band that the features need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FeaturePasses<T: VectorPixel> {
    /// Half of the level of `edge`.
    pub(crate) edge: Option<T::Signed>,
    /// The level of `corner`.
    pub(crate) corner: Option<T>,
    /// True if a feature uses windows.
    pub(crate) has_windows: bool,
    pub(crate) needs_sums: bool,
    /// True if a feature needs the sum of the squares of the pixels.
    pub(crate) needs_squares: bool,
    /// True if a feature needs the smallest and the largest pixel.
    pub(crate) needs_extremes: bool,
    /// True if a feature needs the sums of differences of neighbors.
    pub(crate) needs_differences: bool,
    /// The fraction bits of the mean of `mad`.
    pub(crate) mad: Option<u32>,
    pub(crate) segment: Option<SegmentPlan>,
}

/// A feature of the camera and its threshold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FeaturePlan {
    pub(crate) kind: FeatureKind,
    pub(crate) min_score: u64,
}

/// Returns the features with their minimum scores.
pub(crate) fn feature_plans(features: &[SpatialFeature]) -> Vec<FeaturePlan> {
    let plan = |feature: &SpatialFeature| FeaturePlan {
        kind: feature.kind(),
        min_score: feature.min_score(),
    };
    features.iter().map(plan).collect()
}

impl<T: VectorPixel> FeaturePasses<T> {
    /// Returns the passes that the features need, with the levels of the features.
    pub(crate) fn from_features(features: &[SpatialFeature]) -> Self {
        let mut passes = Self {
            edge: None,
            corner: None,
            has_windows: features.iter().any(|feature| feature.kind().has_window()),
            needs_sums: false,
            needs_squares: false,
            needs_extremes: false,
            needs_differences: false,
            mad: None,
            segment: None,
        };
        for feature in features {
            let level = || feature.level().expect("a feature that counts pixels has a level");
            let fraction_bits =
                || feature.mean().expect("mad and segment have a mean").fraction_bits;
            match feature.kind() {
                FeatureKind::Edge => passes.edge = Some(half_level(level())),
                FeatureKind::Corner => passes.corner = Some(saturated_threshold(level())),
                FeatureKind::Mad => {
                    passes.needs_sums = true;
                    passes.mad = Some(fraction_bits());
                }
                FeatureKind::Variance => (passes.needs_sums, passes.needs_squares) = (true, true),
                FeatureKind::Range => passes.needs_extremes = true,
                FeatureKind::Surface => passes.needs_differences = true,
                FeatureKind::Segment => {
                    passes.needs_sums = true;
                    let plan = SegmentPlan { fraction_bits: fraction_bits(), level: level() };
                    passes.segment = Some(plan);
                }
                // The search has a plan of its own.
                FeatureKind::Flow => {}
            }
        }
        passes
    }
}

/// Converts an edge level to half of it, rounded down, at most 3 * 65535.
fn half_level<S: TryFrom<u32> + From<T>, T: VectorPixel<Signed = S>>(level: u32) -> S {
    let half = S::try_from(level / 2);
    half.unwrap_or_else(|_| {
        unreachable!("a level is at most that of the largest gradient, not {level}")
    })
}
