// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones: the thresholds of each class of regions.

use crate::ranges::{check_range, largest_level};
use crate::validation::check_temporal_thresholds;
use crate::{
    Camera, CameraConfig, ConfigError, KeenSpatialConfig, Periphery, RegionClass, SpatialConfig,
    SpatialFeature, TemporalParameters, ZonesConfig,
};

/// The thresholds of a class of regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassThresholds<'a> {
    /// The features with their thresholds, in the order of the camera.
    pub features: &'a [SpatialFeature],
    /// The per-pixel threshold of the temporal score, in grey levels.
    pub temporal_level: u32,
    /// The per-region threshold of the temporal score, in pixels.
    pub min_count: u32,
    /// The level of summaries in grey levels, or `None` if irrelevant regions send no summaries.
    pub summary_level: Option<u32>,
}

/// The thresholds that a camera with zones has in addition to those of every camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Zones {
    features: Vec<SpatialFeature>,
    temporal_level: u32,
    min_count: u32,
    summary_level: Option<u32>,
    off_level: Option<u32>,
}

impl Zones {
    /// Checks the zones of a configuration whose other keys have been checked and filled in.
    pub(crate) fn resolve(
        config: &CameraConfig,
        zones: &ZonesConfig,
        temporal: TemporalParameters,
        periphery: Option<Periphery>,
    ) -> Result<Self, ConfigError> {
        let keen = &zones.keen;
        check_keen_features(config, &keen.spatial)?;
        let resolve = |entry: &SpatialConfig| {
            let index = keen.spatial.iter().position(|own| own.feature == entry.feature);
            let entry = with_keen_thresholds(entry, index.map(|index| &keen.spatial[index]));
            let path = format!("zones.keen.spatial[{}]", index.unwrap_or_default());
            let n = u64::from(config.region.size).pow(2);
            SpatialFeature::resolve(&entry, &path, n, config.frame.pixel_bits)
        };
        let features = config.spatial.iter().map(resolve).collect::<Result<_, _>>()?;
        let min_count = keen.temporal.min_count.unwrap_or(temporal.min_count);
        let temporal_level = keen.temporal.level.unwrap_or(temporal.level);
        check_temporal_thresholds(config, "zones.keen.temporal", temporal_level, min_count)?;
        let pixel_max = (1 << config.frame.pixel_bits) - 1;
        let levels = [
            ("zones.keen.periphery.level", keen.periphery.level, largest_level(pixel_max, false)),
            ("zones.off_level", zones.off_level, pixel_max),
        ];
        let check = |(key, level, largest)| check_summary_level(config, key, level, largest);
        levels.into_iter().try_for_each(check)?;
        let level = |own: Option<u32>| periphery.map(|periphery| own.unwrap_or(periphery.level));
        Ok(Self {
            features,
            temporal_level,
            min_count,
            summary_level: level(keen.periphery.level),
            off_level: level(zones.off_level),
        })
    }
}

impl Camera {
    /// Returns the thresholds of the regions of a class. In a camera without zones they are the same
    /// for all classes.
    #[must_use]
    pub fn class_thresholds(&self, class: RegionClass) -> ClassThresholds<'_> {
        let own = ClassThresholds {
            features: self.features(),
            temporal_level: self.temporal().level,
            min_count: self.temporal().min_count,
            summary_level: self.periphery().map(|periphery| periphery.level),
        };
        match (class, self.zones()) {
            (RegionClass::Normal | RegionClass::Always, _) | (_, None) => own,
            (RegionClass::Off, Some(zones)) => {
                ClassThresholds { summary_level: zones.off_level, ..own }
            }
            (RegionClass::Keen, Some(zones)) => ClassThresholds {
                features: &zones.features,
                temporal_level: zones.temporal_level,
                min_count: zones.min_count,
                summary_level: zones.summary_level,
            },
        }
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
    if config.render.irrelevant != crate::IrrelevantRendering::Mean {
        return Err(Periphery::without_means_error(config, key, level));
    }
    let why = format!(" for pixels of {} bits", config.frame.pixel_bits);
    check_range(key, level, 0..=largest, &why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::KeenPeripheryConfig;
    use crate::{Decimal, FeatureKind, KeenConfig, KeenTemporalConfig};

    const FULL: &str = "spatial = [{ feature = \"edge\", level = 90, min_score = 6 }, \
                        { feature = \"mad\", min_score = 5 }]\n\
                        temporal = { level = 9, min_count = 4 }\n";
    const MEANS: &str = "render = { irrelevant = \"mean\" }\nperiphery = { level = 3 }\n";

    fn keen_edge(level: Option<u32>, min_score: Option<u64>) -> KeenSpatialConfig {
        let min_score = min_score.map(Decimal::from_whole);
        KeenSpatialConfig { feature: FeatureKind::Edge, level, min_score }
    }

    fn camera(text: &str, zones: ZonesConfig) -> Result<Camera, String> {
        let mut config = CameraConfig::from_toml(text).map_err(|error| error.to_string())?;
        config.zones = Some(zones);
        config.validate().map_err(|error| error.to_string())
    }

    #[test]
    fn every_class_has_its_thresholds() {
        let keen = KeenConfig {
            spatial: vec![keen_edge(Some(40), Some(2))],
            temporal: KeenTemporalConfig { level: Some(2), min_count: Some(1) },
            periphery: KeenPeripheryConfig { level: Some(1) },
        };
        let zones = ZonesConfig { off_level: Some(255), keen };
        let camera = camera(&format!("{FULL}{MEANS}"), zones).unwrap();
        let found = |class| {
            let thresholds = camera.class_thresholds(class);
            let [edge, mad] = thresholds.features else { panic!("{thresholds:?}") };
            let temporal = (thresholds.temporal_level, thresholds.min_count);
            ((edge.level(), edge.min_score(), mad.min_score()), temporal, thresholds.summary_level)
        };
        let normal = ((Some(90), 6, 5 * 64), (9, 4), Some(3));
        assert_eq!(found(RegionClass::Normal), normal);
        assert_eq!(found(RegionClass::Always), normal);
        assert_eq!(found(RegionClass::Off), (normal.0, normal.1, Some(255)));
        assert_eq!(found(RegionClass::Keen), ((Some(40), 2, 5 * 64), (2, 1), Some(1)));
    }

    #[test]
    fn thresholds_that_are_left_out_are_those_of_the_camera() {
        for text in [FULL.to_owned(), format!("{FULL}{MEANS}")] {
            let camera = camera(&text, ZonesConfig::default()).unwrap();
            let normal = camera.class_thresholds(RegionClass::Normal);
            for &class in RegionClass::ALL {
                assert_eq!(camera.class_thresholds(class), normal, "{class}");
            }
        }
    }

    #[test]
    fn thresholds_follow_the_depth() {
        let keen = KeenConfig {
            spatial: vec![keen_edge(Some(40), Some(2))],
            temporal: KeenTemporalConfig { level: Some(2), min_count: Some(1) },
            periphery: KeenPeripheryConfig { level: Some(1) },
        };
        let zones = ZonesConfig { off_level: Some(20), keen };
        let camera = camera(&format!("{FULL}{MEANS}"), zones).unwrap();
        let deep = camera.config().scaled_to_depth(10).validate().unwrap();
        let keen = deep.class_thresholds(RegionClass::Keen);
        assert_eq!((keen.temporal_level, keen.min_count, keen.summary_level), (8, 1, Some(4)));
        assert_eq!((keen.features[0].level(), keen.features[0].min_score()), (Some(160), 2));
        assert_eq!(deep.class_thresholds(RegionClass::Off).summary_level, Some(80));
    }

    #[test]
    fn thresholds_that_do_not_fit_are_refused_by_name() {
        let spatial = |entry| KeenConfig { spatial: vec![entry], ..KeenConfig::default() };
        let corner = KeenSpatialConfig { feature: FeatureKind::Corner, ..keen_edge(None, None) };
        let mad = KeenSpatialConfig { feature: FeatureKind::Mad, ..keen_edge(Some(3), None) };
        let temporal = |level, min_count| KeenConfig {
            temporal: KeenTemporalConfig { level, min_count },
            ..KeenConfig::default()
        };
        let summary = |level| KeenConfig {
            periphery: KeenPeripheryConfig { level: Some(level) },
            ..KeenConfig::default()
        };
        let twice = KeenConfig { spatial: vec![keen_edge(None, None); 2], ..KeenConfig::default() };
        for (off_level, keen, words) in [
            (None, spatial(keen_edge(Some(1530), None)), "zones.keen.spatial[0].level` = 1530"),
            (None, spatial(keen_edge(None, Some(65))), "zones.keen.spatial[0].min_score` = 65"),
            (None, spatial(corner), "a camera without this feature"),
            (None, spatial(mad), "zones.keen.spatial[0].level` = 3"),
            (None, twice, "zones.keen.spatial[1].feature"),
            (None, temporal(Some(255), None), "zones.keen.temporal.level` = 255"),
            (None, temporal(None, Some(65)), "zones.keen.temporal.min_count` = 65"),
            (None, summary(255), "zones.keen.periphery.level` = 255"),
            (Some(256), KeenConfig::default(), "zones.off_level` = 256"),
        ] {
            let error = camera(&format!("{FULL}{MEANS}"), ZonesConfig { off_level, keen });
            let error = error.unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        for zones in [
            ZonesConfig { off_level: Some(1), ..ZonesConfig::default() },
            ZonesConfig { keen: summary(1), ..ZonesConfig::default() },
        ] {
            let error = camera(FULL, zones).unwrap_err();
            assert!(error.contains("render.irrelevant = \"zero\""), "{error}");
        }
    }
}
