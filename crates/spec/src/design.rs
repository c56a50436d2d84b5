// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated configuration: one immutable value from which everything else is derived.

use std::ops::RangeInclusive;

use crate::width::index_bits;
use crate::{
    Combine, Config, FeatureKind, Filter, Irrelevant, Neighborhood, Organization, Payload,
    Reference, SpatialConfig, SpatialFeature, SpecError, Thresholds, Timing, bits_for, fingerprint,
};

/// Frame size where the configuration leaves it out.
const DEFAULT_SIDE: u32 = 224;
/// Largest frame side; keeps every count of regions and pixels far inside 32 bits.
const MAX_SIDE: u32 = 16_384;
/// Most regions of a frame: those of the largest frame at 8x8 pixels. What a model keeps per region
/// then stays within memory.
const MAX_REGIONS: u32 = 1 << 22;

/// A design: a configuration that has been checked, with every number that follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    config: Config,
    width: u32,
    height: u32,
    features: Vec<SpatialFeature>,
    temporal: Temporal,
}

/// The temporal score with its thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Temporal {
    /// A pixel has changed when it differs by more than this.
    pub level: u32,
    /// TRS from this count on.
    pub min_count: u32,
    /// What a frame is compared with.
    pub reference: Reference,
}

impl Config {
    /// Checks every range and combination.
    ///
    /// # Errors
    /// Names the key, its value and what would be valid.
    pub fn validate(&self) -> Result<Design, SpecError> {
        let width = self.frame.width.unwrap_or(DEFAULT_SIDE);
        let height = self.frame.height.unwrap_or(DEFAULT_SIDE);
        in_range("frame.width", width, 1..=MAX_SIDE, "")?;
        in_range("frame.height", height, 1..=MAX_SIDE, "")?;
        in_range("frame.pixel_bits", self.frame.pixel_bits, 1..=16, "")?;
        in_range("region.size", self.region.size, 2..=64, "")?;
        self.check_regions(width, height)?;
        let n = self.region.size * self.region.size;
        let pixel_max = (1 << self.frame.pixel_bits) - 1;
        let pixels = format!(" for pixels of {} bits", self.frame.pixel_bits);
        in_range("temporal.level", self.temporal.level, 0..=pixel_max, &pixels)?;
        let region = format!(" for regions of {n} pixels");
        in_range("temporal.min_count", self.temporal.min_count, 0..=n, &region)?;
        self.check_hardware()?;
        self.check_features()?;
        let mut config = self.clone();
        config.spatial = self.spatial.iter().map(SpatialConfig::with_defaults).collect();
        let resolve = |(index, entry)| SpatialFeature::resolve(entry, index, n.into(), pixel_max);
        let features = config.spatial.iter().enumerate().map(resolve).collect::<Result<_, _>>()?;
        (config.frame.width, config.frame.height) = (Some(width), Some(height));
        let temporal = Temporal {
            level: self.temporal.level,
            min_count: self.temporal.min_count,
            reference: self.temporal.reference,
        };
        Ok(Design { config, width, height, features, temporal })
    }

    /// Takes the frame size from an input of `width` x `height` pixels.
    ///
    /// # Errors
    /// When the configuration names another size.
    pub fn fit_frame(&mut self, width: u32, height: u32) -> Result<(), SpecError> {
        let frame = &mut self.frame;
        for (key, own, given) in
            [("width", &mut frame.width, width), ("height", &mut frame.height, height)]
        {
            if let Some(own) = *own
                && own != given
            {
                return Err(SpecError::Combination {
                    key: format!("frame.{key}"),
                    value: own.to_string(),
                    with: format!("an input of {width}x{height} pixels"),
                    remedy: "leave the key out to take the size from the input".to_owned(),
                });
            }
            *own = Some(given);
        }
        Ok(())
    }

    fn check_regions(&self, width: u32, height: u32) -> Result<(), SpecError> {
        let size = self.region.size;
        let regions = width.div_ceil(size) * height.div_ceil(size);
        if regions <= MAX_REGIONS {
            return Ok(());
        }
        Err(SpecError::Combination {
            key: "region.size".to_owned(),
            value: size.to_string(),
            with: format!("a frame of {width}x{height} pixels, which has {regions} regions"),
            remedy: format!("{MAX_REGIONS} regions are the most; enlarge regions or cut the frame"),
        })
    }

    fn check_features(&self) -> Result<(), SpecError> {
        if self.spatial.is_empty() {
            return Err(SpecError::Range {
                key: "spatial".to_owned(),
                value: "[]".to_owned(),
                valid: "one to four features".to_owned(),
            });
        }
        for (index, entry) in self.spatial.iter().enumerate() {
            if self.spatial.iter().take(index).any(|earlier| earlier.feature == entry.feature) {
                return Err(SpecError::Combination {
                    key: format!("spatial[{index}].feature"),
                    value: format!("\"{}\"", entry.feature),
                    with: "another entry for the same feature".to_owned(),
                    remedy: "list each feature once".to_owned(),
                });
            }
        }
        Ok(())
    }

    fn check_hardware(&self) -> Result<(), SpecError> {
        let clash = |key: &str, value: String, remedy: &str| SpecError::Combination {
            key: format!("hardware.{key}"),
            value,
            with: "this version".to_owned(),
            remedy: remedy.to_owned(),
        };
        match self.hardware.organization {
            Organization::Pipelined => {}
            Organization::Serial => {
                let remedy = "the serial organization is not there yet; use \"pipelined\"";
                return Err(clash("organization", "\"serial\"".to_owned(), remedy));
            }
        }
        if self.hardware.fold != 1 {
            let remedy = "only the serial organization folds; use 1";
            return Err(SpecError::Combination {
                key: "hardware.fold".to_owned(),
                value: self.hardware.fold.to_string(),
                with: "organization = \"pipelined\"".to_owned(),
                remedy: remedy.to_owned(),
            });
        }
        Ok(())
    }
}

/// `why` follows the range in the message.
fn in_range(key: &str, value: u32, range: RangeInclusive<u32>, why: &str) -> Result<(), SpecError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(SpecError::Range {
        key: key.to_owned(),
        value: value.to_string(),
        valid: format!("{}..={}{why}", range.start(), range.end()),
    })
}

/// What the configuration says.
impl Design {
    /// The configuration with every key filled in.
    #[must_use]
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Frame width W in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Frame height H in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Bits per pixel P.
    #[must_use]
    pub fn pixel_bits(&self) -> u32 {
        self.config.frame.pixel_bits
    }

    /// Side of a region N in pixels.
    #[must_use]
    pub fn region_size(&self) -> u32 {
        self.config.region.size
    }

    /// What windows see beyond a region's border.
    #[must_use]
    pub fn neighborhood(&self) -> Neighborhood {
        self.config.region.neighborhood
    }

    /// The filter in front of every score.
    #[must_use]
    pub fn filter(&self) -> Filter {
        self.config.denoise.filter
    }

    /// The spatial features, in the order of the configuration.
    #[must_use]
    pub fn features(&self) -> &[SpatialFeature] {
        &self.features
    }

    /// How their votes become SRS.
    #[must_use]
    pub fn combine(&self) -> Combine {
        self.config.decision.combine
    }

    /// The temporal score.
    #[must_use]
    pub fn temporal(&self) -> &Temporal {
        &self.temporal
    }

    /// What is shown where SRS is 0.
    #[must_use]
    pub fn irrelevant(&self) -> Irrelevant {
        self.config.render.irrelevant
    }

    /// Which pixels an active region forwards.
    #[must_use]
    pub fn payload(&self) -> Payload {
        self.config.render.payload
    }

    /// The structure of the array.
    #[must_use]
    pub fn organization(&self) -> Organization {
        self.config.hardware.organization
    }

    /// Where the thresholds come from.
    #[must_use]
    pub fn thresholds(&self) -> Thresholds {
        self.config.hardware.thresholds
    }
}

/// What follows from it.
impl Design {
    /// Largest pixel, 2^P - 1.
    #[must_use]
    pub fn pixel_max(&self) -> u32 {
        (1 << self.pixel_bits()) - 1
    }

    /// Pixels of a region, n = N * N.
    #[must_use]
    pub fn region_pixels(&self) -> u32 {
        self.region_size() * self.region_size()
    }

    /// Regions side by side.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.width.div_ceil(self.region_size())
    }

    /// Regions one below the other.
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.height.div_ceil(self.region_size())
    }

    /// Regions of a frame, M.
    #[must_use]
    pub fn regions(&self) -> u32 {
        self.columns() * self.rows()
    }

    /// The feature of that kind, if the design has it.
    #[must_use]
    pub fn feature(&self, kind: FeatureKind) -> Option<&SpatialFeature> {
        self.features.iter().find(|feature| feature.kind() == kind)
    }

    /// Whether any feature looks at 3x3 windows.
    #[must_use]
    pub fn has_feature_window(&self) -> bool {
        self.features.iter().any(|feature| feature.kind().has_window())
    }

    /// Whether any feature needs the region a second time.
    #[must_use]
    pub fn has_second_pass(&self) -> bool {
        self.features.iter().any(|feature| feature.kind().has_second_pass())
    }

    /// Whether raw pixels are forwarded that differ from those scored.
    #[must_use]
    pub fn keeps_raw(&self) -> bool {
        self.payload() == Payload::Raw && self.filter() != Filter::None
    }

    /// Pixels of halo r that a region's stream carries on each side: one per 3x3 window in a row,
    /// none for isolated regions.
    #[must_use]
    pub fn halo(&self) -> u32 {
        match self.neighborhood() {
            Neighborhood::Isolated => 0,
            Neighborhood::Shared => {
                u32::from(self.filter() != Filter::None) + u32::from(self.has_feature_window())
            }
        }
    }

    /// Whether an RPU must know its place: with two windows in a row the second repeats *denoised*
    /// pixels at the frame's border, which a halo of repeated raw pixels cannot give.
    #[must_use]
    pub fn needs_border(&self) -> bool {
        self.halo() == 2
    }

    /// Side of the square of pixels that is streamed per region, N + 2r.
    #[must_use]
    pub fn stream_side(&self) -> u32 {
        self.region_size() + 2 * self.halo()
    }

    /// Side of the square of pixels that the median window gives, or the stream itself without one;
    /// the feature window takes it.
    #[must_use]
    pub fn denoised_side(&self) -> u32 {
        let consumed = u32::from(self.halo() > 0 && self.filter() != Filter::None);
        self.stream_side() - 2 * consumed
    }

    /// Bits of the sum of a region's pixels.
    #[must_use]
    pub fn pixel_sum_bits(&self) -> u32 {
        bits_for(u64::from(self.region_pixels()) * u64::from(self.pixel_max()))
    }

    /// Pixels that are streamed per region and frame.
    #[must_use]
    pub fn stream_pixels(&self) -> u32 {
        self.stream_side() * self.stream_side()
    }

    /// Bits of a count of pixels, 0..=n.
    #[must_use]
    pub fn count_bits(&self) -> u32 {
        bits_for(self.region_pixels().into())
    }

    /// Bits of the number of a pixel in its region, 0..n.
    #[must_use]
    pub fn slot_bits(&self) -> u32 {
        index_bits(self.region_pixels().into())
    }

    /// Latencies.
    #[must_use]
    pub fn timing(&self) -> Timing {
        Timing::of(self)
    }

    /// A short name: 16 hexadecimal digits, equal for equal configurations.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        fingerprint::of(&self.config)
    }
}
