// SPDX-License-Identifier: MIT OR Apache-2.0
//! The classes of the regions of a camera, and the thresholds of each class.

use crate::{Camera, ClassMapError, RegionClass, SpatialFeature};

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

impl Camera {
    /// Returns the class that each region has until another map is set, row by row.
    #[must_use]
    pub fn configured_classes(&self) -> Vec<RegionClass> {
        match self.zones() {
            Some(zones) => zones.configured_classes().to_vec(),
            None => vec![RegionClass::Normal; self.regions() as usize],
        }
    }

    /// Returns the thresholds of the regions of a class. In a camera without zones they are the
    /// same for all classes.
    #[must_use]
    pub fn class_thresholds(&self, class: RegionClass) -> ClassThresholds<'_> {
        let own = ClassThresholds {
            features: self.features(),
            temporal_level: self.temporal().level,
            min_count: self.temporal().min_count,
            summary_level: self.periphery().map(|periphery| periphery.level),
        };
        let Some(zones) = self.zones() else { return own };
        match class {
            RegionClass::Normal | RegionClass::Always => own,
            RegionClass::Off => ClassThresholds { summary_level: zones.off_level, ..own },
            RegionClass::Keen => ClassThresholds {
                features: &zones.features,
                temporal_level: zones.temporal_level,
                min_count: zones.min_count,
                summary_level: zones.summary_level,
            },
        }
    }

    /// Checks a map: the classes of all regions, numbered row by row.
    ///
    /// # Errors
    /// Returns an error if there is not one class per region, or if the camera has no zones and a
    /// class is not [`RegionClass::Normal`].
    pub fn check_classes(&self, classes: &[RegionClass]) -> Result<(), ClassMapError> {
        let (given, regions) = (classes.len(), self.regions());
        if u32::try_from(given) != Ok(regions) {
            return Err(ClassMapError::Count { given, regions });
        }
        let mut others = classes.iter().enumerate();
        match others.find(|&(_, &class)| class != RegionClass::Normal) {
            Some((region, &class)) if self.zones().is_none() => {
                Err(ClassMapError::NoZones { region, class })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        CameraConfig, Decimal, FeatureKind, KeenConfig, KeenPeripheryConfig, KeenSpatialConfig,
        KeenTemporalConfig, ZonesConfig,
    };

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
        let zones = ZonesConfig { off_level: Some(255), keen, ..ZonesConfig::default() };
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
        let zones = ZonesConfig { off_level: Some(20), keen, ..ZonesConfig::default() };
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
            let zones = ZonesConfig { off_level, keen, ..ZonesConfig::default() };
            let error = camera(&format!("{FULL}{MEANS}"), zones);
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

    #[test]
    fn maps_that_do_not_fit_are_refused() {
        let mut config = CameraConfig::from_toml("frame={width=16,height=8}\n").unwrap();
        let plain = config.validate().unwrap();
        config.zones = Some(ZonesConfig::default());
        let zoned = config.validate().unwrap();
        let keen = [RegionClass::Normal, RegionClass::Keen];
        assert_eq!(plain.check_classes(&[RegionClass::Normal; 2]), Ok(()));
        assert_eq!(zoned.check_classes(&keen), Ok(()));
        let refused = Err(ClassMapError::NoZones { region: 1, class: RegionClass::Keen });
        assert_eq!(plain.check_classes(&keen), refused);
        for camera in [plain, zoned] {
            let refused = Err(ClassMapError::Count { given: 1, regions: 2 });
            assert_eq!(camera.check_classes(&keen[..1]), refused);
        }
    }
}
