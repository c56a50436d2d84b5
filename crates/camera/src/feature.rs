// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spatial features with their thresholds as integers, and the widths of their scores. The
//! differences between kinds of features are in [`crate::feature_spec`].

use std::fmt::Display;

use crate::depth::{self, DEFAULT_BITS};
use crate::feature_spec::{RegionNumbers, ScoreSource};
use crate::ranges::{FLOW_RADII, largest_flow_radius};
use crate::{ConfigError, Decimal, FeatureKind, Reciprocal, SpatialConfig, bits_for};

/// One spatial feature of a camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpatialFeature {
    kind: FeatureKind,
    level: Option<u32>,
    level_max: Option<u32>,
    largest_level: Option<u32>,
    unit: u64,
    min_score: u64,
    score_max: u64,
    mean: Option<MeanDivision>,
    variance: Option<VarianceWidths>,
    radius: Option<u32>,
}

/// The arithmetic of the mean of `mad` and `segment`: `floor((2^f * sum + floor(n/2)) / n)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeanDivision {
    /// Fraction bits f of the mean.
    pub fraction_bits: u32,
    /// Bits of the mean, in units of `2^-f` grey levels.
    pub mean_bits: u32,
    /// Bits of the dividend `2^f * sum + floor(n/2)`.
    pub dividend_bits: u32,
    /// The division by n.
    pub reciprocal: Reciprocal,
}

/// The widths of the accumulators of `variance`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VarianceWidths {
    /// Bits of the square of a pixel.
    pub square_bits: u32,
    /// Bits of the sum of the squares of the pixels of a region.
    pub square_sum_bits: u32,
    /// Bits of `n * sum(x^2)`, the minuend of the score.
    pub product_bits: u32,
}

impl SpatialFeature {
    /// Checks an entry whose defaults are filled in, for regions of `n` pixels of `bits` bits. The
    /// keys of the entry begin with `path` in messages.
    pub(crate) fn resolve(
        config: &SpatialConfig,
        path: &str,
        n: u64,
        bits: u32,
    ) -> Result<Self, ConfigError> {
        let entry = SpatialEntry { config, path, bits };
        let pixel_max = (1 << bits) - 1;
        let fraction_bits = entry.fraction_bits(n)?;
        let numbers = RegionNumbers { n, pixel_max, fraction_bits };
        let (kind, level_max) = (config.feature, config.feature.level_max(pixel_max));
        let always = config.min_score == Some(Decimal::from_whole(0));
        let largest_level =
            if always { level_max } else { kind.largest_deciding_level(pixel_max, fraction_bits) };
        let (mean, variance) = match kind.spec().source {
            ScoreSource::Deviations => {
                (Some(MeanDivision::new(n, pixel_max.into(), fraction_bits)), None)
            }
            ScoreSource::Squares => (None, Some(VarianceWidths::new(n, pixel_max.into()))),
            ScoreSource::WindowHits
            | ScoreSource::WindowSums { .. }
            | ScoreSource::Extremes
            | ScoreSource::Reference => (None, None),
        };
        let (unit, score_max) = ((kind.spec().scale)(&numbers), (kind.spec().score_max)(&numbers));
        Ok(Self {
            kind,
            level: entry.level(level_max, largest_level)?,
            level_max,
            largest_level,
            unit,
            min_score: entry.min_score(unit, score_max)?,
            score_max,
            mean,
            variance,
            radius: entry.radius(n)?,
        })
    }

    /// Returns the kind of the feature.
    #[must_use]
    pub fn kind(&self) -> FeatureKind {
        self.kind
    }

    /// Returns the per-pixel threshold of `edge`, `corner` and `segment`, or `None` for other
    /// features.
    #[must_use]
    pub fn level(&self) -> Option<u32> {
        self.level
    }

    /// Returns the bits of the per-pixel threshold, or 0 if the feature has none.
    #[must_use]
    pub fn level_bits(&self) -> u32 {
        self.level_max.map_or(0, |max| bits_for(max.into()))
    }

    /// Returns the largest value that the per-pixel threshold is compared with, or `None` if the
    /// feature has no such threshold.
    #[must_use]
    pub fn level_max(&self) -> Option<u32> {
        self.level_max
    }

    /// Returns the largest valid level of the configuration, or `None` if the feature has no
    /// per-pixel threshold. With any valid level some region can have a score above 0. A feature
    /// with a minimum score of 0 always votes, so every level is valid.
    #[must_use]
    pub fn largest_level(&self) -> Option<u32> {
        self.largest_level
    }

    /// Returns true if only a minimum score of 0 is valid, because no region has a score above 0
    /// with the level.
    pub(crate) fn needs_zero_minimum(&self, pixel_max: u32) -> bool {
        self.never_scores(pixel_max, self.mean.map_or(0, |mean| mean.fraction_bits))
    }

    /// Returns true if a mean without fraction bits is not valid.
    pub(crate) fn needs_mean_fraction(&self, pixel_max: u32) -> bool {
        self.min_score != 0 && self.never_scores(pixel_max, 0)
    }

    /// Returns true if no region has a score above 0 with the level and so many fraction bits of
    /// the mean.
    fn never_scores(&self, pixel_max: u32, fraction_bits: u32) -> bool {
        let largest = self.kind.largest_deciding_level(pixel_max, fraction_bits);
        self.level.is_some_and(|level| largest.is_none_or(|largest| level > largest))
    }

    /// Returns the number of score units in one unit of `min_score`. The unit of `min_score` is a
    /// pixel, a grey level or a squared grey level.
    #[must_use]
    pub fn unit(&self) -> u64 {
        self.unit
    }

    /// Returns the per-region threshold in units of the score: the feature votes when score >=
    /// this.
    #[must_use]
    pub fn min_score(&self) -> u64 {
        self.min_score
    }

    /// Returns the largest score that any region can have.
    #[must_use]
    pub fn score_max(&self) -> u64 {
        self.score_max
    }

    /// Returns the largest valid `min_score` of the configuration, rounded down to four digits
    /// after the point.
    #[must_use]
    pub fn largest_min_score(&self) -> Decimal {
        threshold_in_config_units(self.score_max, self.unit)
    }

    /// Returns the bits of the score and of its threshold.
    #[must_use]
    pub fn score_bits(&self) -> u32 {
        bits_for(self.score_max)
    }

    /// Returns the arithmetic of the mean, for `mad` and `segment` only.
    #[must_use]
    pub fn mean(&self) -> Option<&MeanDivision> {
        self.mean.as_ref()
    }

    /// Returns the largest displacement in both directions, in pixels, for `flow` only.
    #[must_use]
    pub fn radius(&self) -> Option<u32> {
        self.radius
    }

    /// Returns the widths of the accumulators, for `variance` only.
    #[must_use]
    pub fn variance(&self) -> Option<&VarianceWidths> {
        self.variance.as_ref()
    }
}

impl MeanDivision {
    fn new(n: u64, pixel_max: u64, fraction_bits: u32) -> Self {
        let dividend_max = ((n * pixel_max) << fraction_bits) + n / 2;
        Self {
            fraction_bits,
            mean_bits: bits_for(dividend_max / n),
            dividend_bits: bits_for(dividend_max),
            reciprocal: Reciprocal::new(n, dividend_max),
        }
    }
}

impl VarianceWidths {
    fn new(n: u64, pixel_max: u64) -> Self {
        Self {
            square_bits: bits_for(pixel_max * pixel_max),
            square_sum_bits: bits_for(n * pixel_max * pixel_max),
            product_bits: bits_for(n * n * pixel_max * pixel_max),
        }
    }
}

/// One entry of `[[spatial]]` with the path of its keys, which errors name.
struct SpatialEntry<'a> {
    config: &'a SpatialConfig,
    path: &'a str,
    /// Bits per pixel.
    bits: u32,
}

impl SpatialEntry<'_> {
    fn key(&self, name: &str) -> String {
        format!("{}.{name}", self.path)
    }

    /// Checks the level. `largest` is the largest valid one, or `None` if none is valid, and `max`
    /// the largest magnitude that a level is compared with.
    fn level(&self, max: Option<u32>, largest: Option<u32>) -> Result<Option<u32>, ConfigError> {
        let (level, max) = match (self.config.level, max) {
            (None, _) => return Ok(None),
            (Some(level), None) => return Err(self.inapplicable_key_error("level", level)),
            (Some(level), Some(max)) => (level, max),
        };
        let largest = largest.ok_or_else(|| self.whole_mean_error())?;
        let fits = |level: u32| level <= largest;
        if fits(level) {
            return Ok(Some(level));
        }
        let scaled = depth::scale_level(level, DEFAULT_BITS, self.bits);
        let hint = depth::depth_hint(&level, &scaled, fits(scaled), self.bits);
        let sides = if self.config.feature.has_second_pass() && largest < max {
            ", and some must be above and some below their mean"
        } else {
            ""
        };
        let valid = format!("0..={largest} (pixels of {} bits reach {max}{sides})", self.bits);
        Err(self.out_of_range_error("level", &level, &valid, &hint))
    }

    /// Returns the error for a feature whose mean of pixels of 1 bit is a pixel, so that no pixel
    /// is on its other side.
    fn whole_mean_error(&self) -> ConfigError {
        ConfigError::Combination {
            key: self.key("mean_fraction_bits"),
            value: "0".to_owned(),
            with: format!(
                "frame.pixel_bits = {}, because no region would have pixels on both sides of its mean",
                self.bits
            ),
            remedy: "set mean_fraction_bits = 1 or more in every feature that has this key"
                .to_owned(),
        }
    }

    fn fraction_bits(&self, n: u64) -> Result<u32, ConfigError> {
        let (side, max) = (n.isqrt(), crate::width::index_bits(n));
        let applies = self.config.has_mean_fraction();
        match self.config.mean_fraction_bits {
            None => Ok(0),
            Some(bits) if !applies => Err(self.inapplicable_key_error("mean_fraction_bits", bits)),
            Some(bits) if bits <= max => Ok(bits),
            Some(bits) => Err(self.out_of_range_error(
                "mean_fraction_bits",
                &bits,
                &format!("0..={max} (regions of {side}x{side} pixels)"),
                "",
            )),
        }
    }

    /// Checks the radius for regions of `n` pixels.
    fn radius(&self, n: u64) -> Result<Option<u32>, ConfigError> {
        let applies = self.config.feature.is_displacement();
        let side = u32::try_from(n.isqrt()).expect("a region has at most 4096 pixels");
        let valid = *FLOW_RADII.start()..=largest_flow_radius(side);
        match self.config.radius {
            None => Ok(None),
            Some(radius) if !applies => Err(self.inapplicable_key_error("radius", radius)),
            Some(radius) if valid.contains(&radius) => Ok(Some(radius)),
            Some(radius) => Err(self.out_of_range_error(
                "radius",
                &radius,
                &format!("{}..={} (regions of {side}x{side} pixels)", valid.start(), valid.end()),
                "",
            )),
        }
    }

    /// Returns the threshold as an integer. `unit` units of the score are one unit of the
    /// configuration.
    fn min_score(&self, unit: u64, score_max: u64) -> Result<u64, ConfigError> {
        let minimum = self.config.min_score.expect("the defaults are filled in before");
        let counts = self.config.feature.score_unit().is_count();
        if counts && minimum.as_whole().is_none() {
            return Err(ConfigError::Type {
                key: self.key("min_score"),
                problem: format!("{minimum} is not a whole number; this key counts pixels"),
            });
        }
        let threshold = |minimum: Decimal| {
            u64::try_from(minimum.ceil_times(unit)).ok().filter(|&score| score <= score_max)
        };
        threshold(minimum).ok_or_else(|| {
            let max = threshold_in_config_units(score_max, unit);
            let scaled =
                depth::scale_min_score(self.config.feature, minimum, DEFAULT_BITS, self.bits);
            let fits = !counts && threshold(scaled).is_some();
            let hint = depth::depth_hint(&minimum, &scaled, fits, self.bits);
            self.out_of_range_error("min_score", &minimum, &format!("0..={max}"), &hint)
        })
    }

    fn out_of_range_error(
        &self,
        key: &str,
        value: &dyn Display,
        valid: &str,
        hint: &str,
    ) -> ConfigError {
        let feature = self.config.feature;
        ConfigError::Range {
            key: self.key(key),
            value: value.to_string(),
            valid: format!("{valid} for `{feature}`{hint}"),
        }
    }

    fn inapplicable_key_error(&self, key: &str, value: u32) -> ConfigError {
        ConfigError::Combination {
            key: self.key(key),
            value: value.to_string(),
            with: format!("feature = \"{}\"", self.config.feature),
            remedy: "leave the key out".to_owned(),
        }
    }
}

/// Returns `score_max / unit` in the unit of the configuration, rounded down to four digits after
/// the point.
fn threshold_in_config_units(score_max: u64, unit: u64) -> Decimal {
    let billionths = u128::from(score_max) * 10_000 / u128::from(unit) * 100_000;
    Decimal::from_billionths(u64::try_from(billionths).unwrap_or(u64::MAX))
}
