// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks every range and combination of a configuration, and makes it a design.

use std::ops::RangeInclusive;

use crate::depth::{self, DEFAULT_BITS};
use crate::rules::Grid;
use crate::{
    Config, Design, DesignError, FeatureKind, HardwareConfig, Pipelining, SpatialFeature, Temporal,
};

/// Frame size where the configuration leaves it out.
const DEFAULT_SIDE: u32 = 224;
/// Largest frame side; keeps every count of regions and pixels far inside 32 bits.
pub(crate) const MAX_SIDE: u32 = 16_384;
/// Most regions of a frame: those of the largest frame at 8x8 pixels. What a model keeps per region
/// then stays within memory.
const MAX_REGIONS: u32 = 1 << 22;

impl Config {
    /// Checks every range and combination.
    ///
    /// # Errors
    /// Names the key, its value and what would be valid.
    pub fn validate(&self) -> Result<Design, DesignError> {
        self.validate_up_to(MAX_SIDE)
    }

    /// As [`Config::validate`], for frames with sides up to `max_side`.
    pub(crate) fn validate_up_to(&self, max_side: u32) -> Result<Design, DesignError> {
        let width = self.frame.width.unwrap_or(DEFAULT_SIDE);
        let height = self.frame.height.unwrap_or(DEFAULT_SIDE);
        in_range("frame.width", width, 1..=max_side, "")?;
        in_range("frame.height", height, 1..=max_side, "")?;
        in_range("frame.pixel_bits", self.frame.pixel_bits, 1..=16, "")?;
        in_range("region.size", self.region.size, 2..=64, "")?;
        let regions = self.check_regions(width, height)?;
        let rules = self.hardware.organization.rules();
        let size = self.region.size;
        let reference = self.temporal.reference;
        let grid = Grid { width, size, columns: width.div_ceil(size), regions, reference };
        let mut hardware = rules.hardware(&self.hardware, &grid)?;
        // The default is left out, so that designs have the fingerprints from before there was this key.
        hardware.sync = hardware.sync.filter(|&sync| sync);
        let n = self.region.size * self.region.size;
        let pixel_max = (1 << self.frame.pixel_bits) - 1;
        let level = self.temporal_level(pixel_max)?;
        let region = format!(" for regions of {n} pixels");
        in_range("temporal.min_count", self.temporal.min_count, 0..=n, &region)?;
        self.check_features()?;
        let mut config = self.clone();
        config.temporal.level = Some(level);
        let bits = self.frame.pixel_bits;
        config.spatial = self.spatial.iter().map(|entry| entry.with_defaults(bits)).collect();
        let resolve = |(index, entry)| SpatialFeature::resolve(entry, index, n.into(), bits);
        let features = config.spatial.iter().enumerate().map(resolve).collect::<Result<_, _>>()?;
        config.hardware = hardware;
        (config.frame.width, config.frame.height) = (Some(width), Some(height));
        let temporal = Temporal {
            level,
            min_count: self.temporal.min_count,
            reference: self.temporal.reference,
        };
        Ok(Design::new(config, (width, height), features, temporal))
    }

    /// The design for inputs of `width` x `height` pixels.
    ///
    /// # Errors
    /// As [`Config::fit_frame`] and [`Config::validate`].
    pub fn for_frames(&self, width: u32, height: u32) -> Result<Design, DesignError> {
        let mut config = self.clone();
        config.fit_frame(width, height)?;
        config.validate()
    }

    /// Takes the frame size from an input of `width` x `height` pixels.
    ///
    /// # Errors
    /// When the configuration names another size.
    pub fn fit_frame(&mut self, width: u32, height: u32) -> Result<(), DesignError> {
        let frame = &mut self.frame;
        for (key, own, given) in
            [("width", &mut frame.width, width), ("height", &mut frame.height, height)]
        {
            if let Some(own) = *own
                && own != given
            {
                return Err(DesignError::Combination {
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

    /// The regions of the frame.
    fn check_regions(&self, width: u32, height: u32) -> Result<u32, DesignError> {
        let size = self.region.size;
        let regions = width.div_ceil(size) * height.div_ceil(size);
        if regions <= MAX_REGIONS {
            return Ok(regions);
        }
        Err(DesignError::Combination {
            key: "region.size".to_owned(),
            value: size.to_string(),
            with: format!("a frame of {width}x{height} pixels, which has {regions} regions"),
            remedy: format!(
                "at most {MAX_REGIONS} regions are allowed; use larger regions or a smaller frame"
            ),
        })
    }

    /// The level of the temporal score: one that pixels can differ by more than, unless no pixel has to.
    fn temporal_level(&self, pixel_max: u32) -> Result<u32, DesignError> {
        let bits = self.frame.pixel_bits;
        let level = self.temporal.level_at(bits);
        let largest = if self.temporal.min_count == 0 { pixel_max } else { pixel_max - 1 };
        let scaled = depth::level(level, DEFAULT_BITS, bits);
        let hint = depth::hint(&level, &scaled, scaled <= largest, bits);
        let why = format!(" for pixels of {bits} bits, which differ by at most {pixel_max}{hint}");
        in_range("temporal.level", level, 0..=largest, &why).map(|()| level)
    }

    fn check_features(&self) -> Result<(), DesignError> {
        if self.spatial.is_empty() {
            return Err(DesignError::Range {
                key: "spatial".to_owned(),
                value: "[]".to_owned(),
                valid: format!("1..={} features", FeatureKind::COUNT),
            });
        }
        for (index, entry) in self.spatial.iter().enumerate() {
            if self.spatial.iter().take(index).any(|earlier| earlier.feature == entry.feature) {
                return Err(DesignError::Combination {
                    key: format!("spatial[{index}].feature"),
                    value: format!("\"{}\"", entry.feature),
                    with: "another entry for the same feature".to_owned(),
                    remedy: "list each feature once".to_owned(),
                });
            }
        }
        Ok(())
    }
}

impl HardwareConfig {
    /// Refuses the keys that only the raster organization has.
    pub(crate) fn refuse_raster_keys(&self) -> Result<(), DesignError> {
        let given = [
            ("hardware.pixels_per_clock", self.pixels_per_clock.map(|pixels| pixels.to_string())),
            ("hardware.store", self.store.map(|store| format!("\"{store}\""))),
            ("hardware.forward", self.forward.map(|forward| forward.to_string())),
        ];
        match given.into_iter().find_map(|(key, value)| Some((key, value?))) {
            None => Ok(()),
            Some((key, value)) => {
                let remedy = "only the raster organization has it; leave the key out";
                Err(self.clash(key, value, remedy))
            }
        }
    }

    /// The pipelining as a key of a design that may be without it. The default is left out, so that designs have the
    /// fingerprints from before there was this key.
    pub(crate) fn deep_pipelining(&self) -> Option<Pipelining> {
        self.pipelining.filter(|&pipelining| pipelining != Pipelining::Plain)
    }

    /// The error for a `key` whose value the organization does not take.
    pub(crate) fn clash(&self, key: &str, value: String, remedy: &str) -> DesignError {
        DesignError::Combination {
            key: key.to_owned(),
            value,
            with: format!("organization = \"{}\"", self.organization),
            remedy: remedy.to_owned(),
        }
    }
}

/// `why` follows the range in the message.
pub(crate) fn in_range(
    key: &str,
    value: u32,
    range: RangeInclusive<u32>,
    why: &str,
) -> Result<(), DesignError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(DesignError::Range {
        key: key.to_owned(),
        value: value.to_string(),
        valid: format!("{}..={}{why}", range.start(), range.end()),
    })
}
