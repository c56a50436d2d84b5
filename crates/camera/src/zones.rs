// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones: the thresholds of each class of regions.

use std::sync::Arc;

use crate::base_classes::{BaseClasses, text_of_classes};
use crate::class_areas::classes_of_areas;
use crate::ranges::{check_range, largest_level};
use crate::temporal_thresholds::check_temporal_thresholds;
use crate::{
    CameraConfig, ConfigError, IrrelevantRendering, KeenSpatialConfig, Periphery, RegionClass,
    SpatialConfig, SpatialFeature, ZonesConfig,
};

/// The thresholds that a camera with zones has in addition to those of every camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Zones {
    pub(crate) features: Vec<SpatialFeature>,
    pub(crate) temporal_level: u32,
    pub(crate) min_count: u32,
    pub(crate) summary_level: Option<u32>,
    pub(crate) off_level: Option<u32>,
    /// The classes of the regions by the configuration, row by row.
    classes: Arc<[RegionClass]>,
}

impl Zones {
    /// Returns the table with one class per region in place of classes of pixels and of areas. A
    /// table that has areas and no classes is returned as it is, because areas are easier to read.
    pub(crate) fn completed_table(&self, zones: &ZonesConfig, columns: u32) -> ZonesConfig {
        if zones.classes.is_empty() {
            return zones.clone();
        }
        let classes = text_of_classes(&self.classes, columns);
        ZonesConfig { classes, areas: Vec::new(), ..zones.clone() }
    }

    /// Returns the classes of the regions that follow from the configuration, row by row.
    #[must_use]
    pub fn configured_classes(&self) -> &[RegionClass] {
        &self.classes
    }

    /// Checks the zones of a configuration whose other keys have been checked and filled in.
    pub(crate) fn resolve(
        config: &CameraConfig,
        zones: &ZonesConfig,
        base: &BaseClasses,
        periphery: Option<Periphery>,
    ) -> Result<Self, ConfigError> {
        let keen = &zones.keen;
        check_keen_features(config, &keen.spatial)?;
        let resolve = |entry: &SpatialConfig| {
            let index = keen.spatial.iter().position(|own| own.feature == entry.feature);
            let entry = with_keen_thresholds(entry, index.map(|index| &keen.spatial[index]));
            let path = format!("zones.keen.spatial[{}]", index.unwrap_or_default());
            let n = u64::from(config.region.size).pow(2);
            let has_own_level = index.is_none_or(|index| keen.spatial[index].level.is_some());
            let resolved = SpatialFeature::resolve(&entry, &path, n, config.frame.pixel_bits);
            resolved.map_err(|error| match has_own_level {
                true => error,
                false => naming_inherited_level(error, "spatial.level"),
            })
        };
        let features = config.spatial.iter().map(resolve).collect::<Result<_, _>>()?;
        let min_count = keen.temporal.min_count.unwrap_or(config.temporal.min_count);
        let own_level = config.temporal.level_or_default(config.frame.pixel_bits);
        let temporal_level = keen.temporal.level.unwrap_or(own_level);
        check_temporal_thresholds(config, "zones.keen.temporal", temporal_level, min_count)
            .map_err(|error| match keen.temporal.level {
                None => naming_inherited_level(error, "temporal.level"),
                Some(_) => error,
            })?;
        let pixel_max = (1 << config.frame.pixel_bits) - 1;
        let levels = [
            ("zones.keen.periphery.level", keen.periphery.level, largest_level(pixel_max, false)),
            ("zones.off_level", zones.off_level, pixel_max),
        ];
        let check = |(key, level, largest)| check_summary_level(config, key, level, largest);
        levels.into_iter().try_for_each(check)?;
        let size = (config.frame.width.unwrap_or(0), config.frame.height.unwrap_or(0));
        let classes = classes_of_areas(base, &zones.areas, size, config.region.size);
        let level = |own: Option<u32>| periphery.map(|periphery| own.unwrap_or(periphery.level));
        Ok(Self {
            features,
            temporal_level,
            min_count,
            summary_level: level(keen.periphery.level),
            off_level: level(zones.off_level),
            classes: classes.into(),
        })
    }
}

/// Adds to the error of a level of keen regions which key it comes from, because the keen key is
/// left out.
fn naming_inherited_level(error: ConfigError, own_key: &str) -> ConfigError {
    match error {
        ConfigError::Range { key, value, valid } if key.ends_with(".level") => {
            let valid = format!(
                "{valid}; keen regions have it from `{own_key}`, give them a level of their own"
            );
            ConfigError::Range { key, value, valid }
        }
        other => other,
    }
}

/// Refuses keen thresholds of a feature that the camera does not have, and of one feature twice.
fn check_keen_features(
    config: &CameraConfig,
    entries: &[KeenSpatialConfig],
) -> Result<(), ConfigError> {
    for (index, entry) in entries.iter().enumerate() {
        let is_same = |feature| feature == entry.feature;
        let (with, remedy) = if entries[..index].iter().any(|earlier| is_same(earlier.feature)) {
            ("another entry for the same feature", "list each feature once")
        } else if !config.spatial.iter().any(|own| is_same(own.feature)) {
            (
                "a camera without this feature",
                "leave the entry out, or add the feature to `spatial`",
            )
        } else {
            continue;
        };
        return Err(ConfigError::Combination {
            key: format!("zones.keen.spatial[{index}].feature"),
            value: format!("\"{}\"", entry.feature),
            with: with.to_owned(),
            remedy: remedy.to_owned(),
        });
    }
    Ok(())
}

/// Returns an entry of the camera with the thresholds of `keen` regions.
fn with_keen_thresholds(entry: &SpatialConfig, keen: Option<&KeenSpatialConfig>) -> SpatialConfig {
    SpatialConfig {
        level: keen.and_then(|keen| keen.level).or(entry.level),
        min_score: keen.and_then(|keen| keen.min_score).or(entry.min_score),
        ..entry.clone()
    }
}

/// Checks a level of summaries, which is valid only if irrelevant regions send means.
fn check_summary_level(
    config: &CameraConfig,
    key: &str,
    level: Option<u32>,
    largest: u32,
) -> Result<(), ConfigError> {
    let Some(level) = level else { return Ok(()) };
    match config.render.irrelevant {
        IrrelevantRendering::Zero | IrrelevantRendering::Hold => {
            return Err(Periphery::without_means_error(config, key, level));
        }
        IrrelevantRendering::Mean => {}
    }
    let why = format!(" for pixels of {} bits", config.frame.pixel_bits);
    check_range(key, level, 0..=largest, &why)
}
