// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kinds of spatial features, and what distinguishes them: one description for each kind, in
//! a file of its own ([`FeatureSpec`]). Whatever is a table of features reads the descriptions;
//! only the formulas of the scores stand elsewhere.

mod corner;
mod edge;
mod flow;
mod mad;
mod range;
mod segment;
mod surface;
mod variance;

use crate::ranges::FLOW_RADII;

crate::choice! {
    /// A kind of spatial feature.
    #[derive(Default)]
    FeatureKind {
        /// 3x3 Sobel: pixels with |Gx| + |Gy| > level.
        #[default]
        Edge = "edge",
        /// FAST 5/8: pixels with 5 contiguous neighbors all brighter or all darker by > level.
        Corner = "corner",
        /// Mean absolute deviation from the region's mean.
        Mad = "mad",
        /// Variance of the region.
        Variance = "variance",
        /// The largest minus the smallest pixel of the region.
        Range = "range",
        /// The smallest of four sums: the differences of the region from a copy of itself that is
        /// moved by one pixel in one of four directions.
        Surface = "surface",
        /// The smaller of two counts: of the pixels that are above the mean by more than a level,
        /// and of those that are below it by more than the level.
        Segment = "segment",
        /// The gain of the best displacement of the region from its reference.
        Flow = "flow",
    }
}

/// The description of a kind of feature. Thresholds are those of pixels of 8 bits.
#[derive(Debug)]
pub struct FeatureSpec {
    /// The quantity that the score measures, in a few words that follow the name of the feature.
    pub summary: &'static str,
    /// The values of pixels that the score is computed from.
    pub source: ScoreSource,
    /// The unit of the score.
    pub unit: ScoreUnit,
    /// The per-pixel threshold; `None` for a feature without one.
    pub level: Option<LevelSpec>,
    /// The default of `min_score`, in `unit`.
    pub min_score: u64,
    /// Returns the number of score units in one unit of `min_score`.
    pub(crate) scale: fn(&RegionNumbers) -> u64,
    /// Returns the largest score.
    pub(crate) score_max: fn(&RegionNumbers) -> u64,
    /// Features with which this one is tested together, among them itself.
    pub companions: &'static [FeatureKind],
}

/// The values of the pixels of a region that a score is computed from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScoreSource {
    /// The number of pixels whose 3x3 window is a hit, which is the score.
    WindowHits,
    /// Sums over the 3x3 windows of all pixels.
    WindowSums {
        /// The number of sums.
        sums: u32,
    },
    /// The sum of the pixels and the sum of their squares.
    Squares,
    /// The smallest and the largest pixel.
    Extremes,
    /// The sum of the pixels and, in a second pass over them, their distances from the mean.
    Deviations,
    /// The pixels of the region and of its reference.
    Reference,
}

/// The unit of a score, which says how the score scales with the pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ScoreUnit {
    /// Pixels of the region that count: hits, or pixels of the smaller part for `segment`.
    Pixels,
    /// Differences of pixels in grey levels.
    Levels,
    /// Squares of differences of pixels.
    SquaredLevels,
}

/// The per-pixel threshold of a feature whose score counts pixels.
#[derive(Debug)]
pub struct LevelSpec {
    /// The default.
    pub default: u32,
    /// The values that a search tries, from the lowest to the highest.
    pub trial: &'static [u32],
    /// Returns the largest value that the threshold is compared with.
    pub(crate) max: fn(pixel_max: u32) -> u32,
    /// Returns the largest threshold with which a region can have a score above 0, for so many
    /// fraction bits of the mean, or `None` if every region has the score 0.
    pub(crate) largest_deciding: fn(pixel_max: u32, fraction_bits: u32) -> Option<u32>,
    /// The divisor that turns the largest score into one that about half of the regions of random
    /// pixels reach, if the threshold is a quarter of the range of pixels.
    pub random_divisor: u64,
}

/// The numbers of a region that limits of a score depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionNumbers {
    /// The number of pixels n.
    pub(crate) n: u64,
    /// The largest value of a pixel.
    pub(crate) pixel_max: u32,
    /// The fraction bits of the mean; 0 for a feature without one.
    pub(crate) fraction_bits: u32,
}

impl RegionNumbers {
    /// Returns n times the largest value of a pixel.
    fn pixel_sum_max(&self) -> u64 {
        self.n * u64::from(self.pixel_max)
    }
}

impl ScoreSource {
    fn has_window(self) -> bool {
        match self {
            Self::WindowHits | Self::WindowSums { .. } => true,
            Self::Squares | Self::Extremes | Self::Deviations | Self::Reference => false,
        }
    }

    fn counts_window_hits(self) -> bool {
        match self {
            Self::WindowHits => true,
            Self::WindowSums { .. }
            | Self::Squares
            | Self::Extremes
            | Self::Deviations
            | Self::Reference => false,
        }
    }

    fn has_second_pass(self) -> bool {
        match self {
            Self::Deviations => true,
            Self::WindowHits
            | Self::WindowSums { .. }
            | Self::Squares
            | Self::Extremes
            | Self::Reference => false,
        }
    }

    fn is_displacement(self) -> bool {
        match self {
            Self::Reference => true,
            Self::WindowHits
            | Self::WindowSums { .. }
            | Self::Squares
            | Self::Extremes
            | Self::Deviations => false,
        }
    }

    /// Returns true if the score needs the sum of the pixels of the region.
    #[must_use]
    pub fn needs_pixel_sum(self) -> bool {
        match self {
            Self::Squares | Self::Deviations => true,
            Self::WindowHits | Self::WindowSums { .. } | Self::Extremes | Self::Reference => false,
        }
    }
}

impl ScoreUnit {
    /// Returns the exponent e of the scaling: when every difference of pixels doubles, the score is
    /// multiplied by 2^e.
    #[must_use]
    pub fn scaling_exponent(self) -> u32 {
        match self {
            Self::Pixels => 0,
            Self::Levels => 1,
            Self::SquaredLevels => 2,
        }
    }

    /// Returns true if the score is a count of pixels: a whole number that does not depend on the
    /// scale of pixels.
    #[must_use]
    pub fn is_count(self) -> bool {
        match self {
            Self::Pixels => true,
            Self::Levels | Self::SquaredLevels => false,
        }
    }

    /// Returns the name of the unit of `min_score`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels of a region",
            Self::Levels => "grey levels",
            Self::SquaredLevels => "squared grey levels",
        }
    }
}

impl FeatureKind {
    /// Number of kinds, which is the length of arrays with one element per kind.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns the description of the kind.
    #[must_use]
    pub fn spec(self) -> &'static FeatureSpec {
        match self {
            Self::Edge => &edge::SPEC,
            Self::Corner => &corner::SPEC,
            Self::Mad => &mad::SPEC,
            Self::Variance => &variance::SPEC,
            Self::Range => &range::SPEC,
            Self::Surface => &surface::SPEC,
            Self::Segment => &segment::SPEC,
            Self::Flow => &flow::SPEC,
        }
    }

    /// Returns the unit of the score.
    #[must_use]
    pub fn score_unit(self) -> ScoreUnit {
        self.spec().unit
    }

    /// Returns true if the feature uses the 3x3 window around each pixel.
    #[must_use]
    pub fn has_window(self) -> bool {
        self.spec().source.has_window()
    }

    /// Returns true if the score is the number of pixels whose 3x3 window is a hit.
    #[must_use]
    pub fn counts_window_hits(self) -> bool {
        self.spec().source.counts_window_hits()
    }

    /// Returns true if the score needs the pixels of the region a second time, once their mean is
    /// known.
    #[must_use]
    pub fn has_second_pass(self) -> bool {
        self.spec().source.has_second_pass()
    }

    /// Returns true if the feature finds the displacement of a region from its reference.
    #[must_use]
    pub fn is_displacement(self) -> bool {
        self.spec().source.is_displacement()
    }

    /// Returns the default radius of a search for a displacement.
    pub(crate) fn default_radius(self) -> Option<u32> {
        self.is_displacement().then_some(*FLOW_RADII.start())
    }

    /// Returns the largest value that the per-pixel threshold is compared with, or `None` if the
    /// feature has no such threshold.
    pub(crate) fn level_max(self, pixel_max: u32) -> Option<u32> {
        self.spec().level.as_ref().map(|level| (level.max)(pixel_max))
    }

    /// Returns the largest level with which a region can have a score above 0, or `None` if every
    /// region has the score 0 or the feature has no such threshold.
    pub(crate) fn largest_deciding_level(self, pixel_max: u32, fraction_bits: u32) -> Option<u32> {
        let level = self.spec().level.as_ref()?;
        (level.largest_deciding)(pixel_max, fraction_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Calls `visit` with every multiset of `n` pixels in `0..=max`.
    pub(super) fn every_region(n: usize, max: u64, visit: &mut impl FnMut(&[u64])) {
        fn fill(pixels: &mut Vec<u64>, n: usize, max: u64, visit: &mut impl FnMut(&[u64])) {
            if pixels.len() == n {
                return visit(pixels);
            }
            for value in pixels.last().copied().unwrap_or(0)..=max {
                pixels.push(value);
                fill(pixels, n, max, visit);
                pixels.pop();
            }
        }
        fill(&mut Vec::new(), n, max, visit);
    }

    /// Code that tests only one of these properties would miss a feature in which they differ.
    #[test]
    fn levels_belong_to_features_that_count_pixels() {
        for kind in FeatureKind::ALL {
            let spec = kind.spec();
            assert_eq!(spec.level.is_some(), spec.unit.is_count(), "{kind}");
            assert!(spec.level.as_ref().is_none_or(|level| !level.trial.is_empty()), "{kind}");
            assert!(spec.companions.contains(kind), "{kind}");
        }
    }

    #[test]
    fn hits_of_windows_are_counts_of_pixels() {
        for kind in FeatureKind::ALL.iter().filter(|kind| kind.counts_window_hits()) {
            assert!(kind.score_unit().is_count(), "{kind}");
        }
    }
}
