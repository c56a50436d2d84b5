// SPDX-License-Identifier: MIT OR Apache-2.0
//! Validation: checks every range and combination of a configuration, and makes a camera of it.

use crate::base_classes::BaseClasses;
use crate::class_areas::check_areas;
use crate::temporal_thresholds::check_temporal_thresholds;
use crate::{
    Camera, CameraConfig, ConfigError, Decimal, FeatureKind, Periphery, ReferencePolicy,
    SpatialConfig, SpatialFeature, TemporalParameters, VoteCombination, Zones,
};
use crate::{MAX_SIDE, PIXEL_BITS, REGION_SIZES, check_range};

/// Largest number of regions of a frame: that of the largest frame with regions of 8x8 pixels. The
/// limit keeps the state that a model stores per region within memory.
const MAX_REGIONS: u32 = 1 << 22;

impl CameraConfig {
    /// Checks every range and combination, and returns the camera.
    ///
    /// # Errors
    /// Returns an error that names the key, its value and the valid values.
    pub fn validate(&self) -> Result<Camera, ConfigError> {
        self.validate_up_to(MAX_SIDE)
    }

    /// Checks as [`CameraConfig::validate`] does, for frames with sides up to `max_side` pixels.
    ///
    /// # Errors
    /// Returns the errors of [`CameraConfig::validate`].
    pub fn validate_up_to(&self, max_side: u32) -> Result<Camera, ConfigError> {
        let (width, height) = self.frame.size_or_default();
        check_range("frame.width", width, 1..=max_side, "")?;
        check_range("frame.height", height, 1..=max_side, "")?;
        check_range("frame.pixel_bits", self.frame.pixel_bits, PIXEL_BITS, "")?;
        check_range("region.size", self.region.size, REGION_SIZES, "")?;
        self.check_regions(width, height)?;
        let n = self.region.size * self.region.size;
        let level = self.temporal.level_or_default(self.frame.pixel_bits);
        check_temporal_thresholds(self, "temporal", level, self.temporal.min_count)?;
        self.check_features()?;
        let mut config = self.clone();
        config.temporal.level = Some(level);
        let bits = self.frame.pixel_bits;
        config.spatial = self.spatial.iter().map(|entry| entry.with_defaults(bits)).collect();
        let resolve = |(index, entry)| {
            SpatialFeature::resolve(entry, &format!("spatial[{index}]"), n.into(), bits)
        };
        let features = config.spatial.iter().enumerate().map(resolve).collect::<Result<_, _>>()?;
        config.check_means()?;
        config.check_displacement()?;
        (config.frame.width, config.frame.height) = (Some(width), Some(height));
        let periphery = Periphery::resolve(self)?;
        config.periphery.blocks = periphery.map(|periphery| periphery.blocks);
        config.periphery.level = periphery.map(|periphery| periphery.level);
        let temporal = TemporalParameters {
            level,
            min_count: self.temporal.min_count,
            reference: self.temporal.reference,
        };
        let zones = match &self.zones {
            None => None,
            Some(table) => {
                check_areas(self, &table.areas, (width, height))?;
                let base = BaseClasses::resolve(self, table, (width, height))?;
                let zones = Zones::resolve(&config, table, &base, periphery)?;
                config.zones =
                    Some(zones.completed_table(table, width.div_ceil(config.region.size)));
                Some(zones)
            }
        };
        Ok(Camera::new(config, (width, height), features, temporal, (periphery, zones)))
    }

    /// Returns the camera for inputs of `width` x `height` pixels.
    ///
    /// # Errors
    /// Returns the errors of [`CameraConfig::fit_frame`] and [`CameraConfig::validate`].
    pub fn validate_for_frames(&self, width: u32, height: u32) -> Result<Camera, ConfigError> {
        let mut config = self.clone();
        config.fit_frame(width, height)?;
        config.validate()
    }

    /// Sets the frame size to that of an input of `width` x `height` pixels.
    ///
    /// # Errors
    /// Returns an error if the configuration names another size.
    pub fn fit_frame(&mut self, width: u32, height: u32) -> Result<(), ConfigError> {
        let frame = &mut self.frame;
        for (key, own, given) in
            [("width", &mut frame.width, width), ("height", &mut frame.height, height)]
        {
            if let Some(own) = *own
                && own != given
            {
                return Err(ConfigError::Combination {
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

    /// Sets another frame size. The classes and areas of zones are left out, because they belong to
    /// a frame of the old size; all regions are then normal.
    pub fn resize_frame(&mut self, width: u32, height: u32) {
        (self.frame.width, self.frame.height) = (Some(width), Some(height));
        if let Some(zones) = &mut self.zones {
            zones.classes.clear();
            zones.areas.clear();
        }
    }

    /// Refuses a frame with too many regions.
    fn check_regions(&self, width: u32, height: u32) -> Result<(), ConfigError> {
        let size = self.region.size;
        let regions = width.div_ceil(size) * height.div_ceil(size);
        if regions <= MAX_REGIONS {
            return Ok(());
        }
        Err(ConfigError::Combination {
            key: "region.size".to_owned(),
            value: size.to_string(),
            with: format!("a frame of {width}x{height} pixels, which has {regions} regions"),
            remedy: format!(
                "at most {MAX_REGIONS} regions are allowed; use larger regions or a smaller frame"
            ),
        })
    }

    fn check_features(&self) -> Result<(), ConfigError> {
        if self.spatial.is_empty() {
            return Err(ConfigError::Range {
                key: "spatial".to_owned(),
                value: "[]".to_owned(),
                valid: format!("1..={} features", FeatureKind::COUNT),
            });
        }
        for (index, entry) in self.spatial.iter().enumerate() {
            if self.spatial.iter().take(index).any(|earlier| earlier.feature == entry.feature) {
                return Err(ConfigError::Combination {
                    key: format!("spatial[{index}].feature"),
                    value: format!("\"{}\"", entry.feature),
                    with: "another entry for the same feature".to_owned(),
                    remedy: "list each feature once".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// Refuses features that would need two different means of the same pixels. Every key must have
    /// its value or its default.
    fn check_means(&self) -> Result<(), ConfigError> {
        let mut entries = (self.spatial.iter().enumerate())
            .filter_map(|(index, entry)| Some((index, entry.feature, entry.mean_fraction_bits?)));
        let Some((first_index, first_feature, first_bits)) = entries.next() else { return Ok(()) };
        match entries.find(|&(_, _, bits)| bits != first_bits) {
            None => Ok(()),
            Some((index, _, bits)) => Err(ConfigError::Combination {
                key: format!("spatial[{index}].mean_fraction_bits"),
                value: bits.to_string(),
                with: format!(
                    "`spatial[{first_index}].mean_fraction_bits` = {first_bits} of \
                     `{first_feature}`"
                ),
                remedy: "all features of a camera use one mean; give both keys the same value"
                    .to_owned(),
            }),
        }
    }

    /// Refuses a displacement from a reference that no region would ever have: with `last-sent` a
    /// region has a reference once it was active, and without a reference `flow` does not vote.
    /// Every key must have its value or its default.
    fn check_displacement(&self) -> Result<(), ConfigError> {
        let needs_motion = |entry: &SpatialConfig| {
            entry.feature.is_displacement() && entry.min_score != Some(Decimal::from_whole(0))
        };
        let mut entries = self.spatial.iter().enumerate();
        let Some((index, entry)) = entries.find(|(_, entry)| needs_motion(entry)) else {
            return Ok(());
        };
        if !self.references_need_displacement() {
            return Ok(());
        }
        Err(ConfigError::Combination {
            key: format!("spatial[{index}].feature"),
            value: format!("\"{}\"", entry.feature),
            with: "`temporal.reference` = \"last-sent\" unless another feature can vote alone: a \
                   region has no reference before it has been active"
                .to_owned(),
            remedy: "use reference = \"previous\", add another feature with combine = \"any\", or \
                     set a `min_score` of 0"
                .to_owned(),
        })
    }

    /// Returns true if no region has a reference before the feature `flow`, which is one of the
    /// features, has voted.
    pub(crate) fn references_need_displacement(&self) -> bool {
        match (self.temporal.reference, self.decision.combine) {
            (ReferencePolicy::Previous, _) => false,
            (ReferencePolicy::LastSent, VoteCombination::Any) => self.spatial.len() == 1,
            (ReferencePolicy::LastSent, VoteCombination::All) => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displacement_needs_a_region_that_is_sent_without_it() {
        let checked = |spatial: &str, more: &[&str]| {
            let keys = [&[spatial, "temporal.reference=\"last-sent\""], more].concat();
            CameraConfig::from_toml_with("", &keys).and_then(|config| config.validate()).map(|_| ())
        };
        const ALONE: &str = "spatial=[{feature=\"flow\"}]";
        const BESIDE_EDGE: &str = "spatial=[{feature=\"edge\"},{feature=\"flow\"}]";
        const ALWAYS: &str = "spatial=[{feature=\"edge\"},{feature=\"flow\",min_score=0}]";
        let all = ["decision.combine=\"all\""];
        for (spatial, more) in [(ALONE, &[][..]), (BESIDE_EDGE, &all)] {
            let error = checked(spatial, more).unwrap_err().to_string();
            assert!(error.contains("last-sent") && error.contains("min_score"), "{error}");
        }
        assert_eq!(checked(BESIDE_EDGE, &[]), Ok(()));
        assert_eq!(checked(ALWAYS, &all), Ok(()));
    }

    #[test]
    fn features_share_one_mean() {
        let camera = |bits: [Option<u32>; 2]| {
            let kinds = [FeatureKind::Segment, FeatureKind::Mad];
            let entry = |(kind, mean_fraction_bits)| SpatialConfig {
                mean_fraction_bits,
                ..SpatialConfig::new(kind)
            };
            let spatial = kinds.into_iter().zip(bits).map(entry).collect();
            CameraConfig { spatial, ..CameraConfig::default() }.validate()
        };
        // A key that is left out is 0.
        for bits in [[None, None], [Some(0), None], [None, Some(0)], [Some(3), Some(3)]] {
            assert!(camera(bits).is_ok(), "{bits:?}");
        }
        for bits in [[Some(2), Some(3)], [Some(1), None], [None, Some(6)]] {
            let error = camera(bits).unwrap_err().to_string();
            assert!(error.contains("all features of a camera use one mean"), "{bits:?}: {error}");
        }
    }
}
