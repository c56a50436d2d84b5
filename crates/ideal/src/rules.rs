// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds and decisions, with the decimal numbers of the configuration.

use foveate_camera::{
    Camera, CameraConfig, Decimal, FeatureKind, IrrelevantRendering, KeenConfig, KeenSpatialConfig,
    RegionAction, RegionClass, SpatialConfig, VoteCombination,
};

/// A spatial feature and its thresholds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FeatureRule {
    pub(crate) kind: FeatureKind,
    /// The level of a pixel in grey levels; 0 for a feature without a level.
    pub(crate) level: f64,
    /// The radius of the search in pixels; 0 for a feature without a search.
    pub(crate) radius: u32,
    /// The minimum score of a region, in the unit of the score.
    min_score: f64,
}

/// The thresholds of a class of regions.
#[derive(Clone, Debug)]
pub(crate) struct ClassRules {
    pub(crate) features: Vec<FeatureRule>,
    /// The temporal level: a pixel has changed if it differs by more grey levels than this.
    pub(crate) level: f64,
    min_count: f64,
    /// The level of summaries in grey levels; it has no meaning without summaries.
    summary_level: f64,
}

/// The rules that decide the relevance of a region and its action on the screen.
#[derive(Clone, Debug)]
pub(crate) struct DecisionRules {
    /// The thresholds of the configuration.
    pub(crate) own: ClassRules,
    /// The thresholds of keen regions, in a camera with zones.
    pub(crate) keen: Option<ClassRules>,
    off_level: f64,
    combine: VoteCombination,
    irrelevant: IrrelevantRendering,
}

impl DecisionRules {
    pub(crate) fn from_camera(camera: &Camera) -> Self {
        let config = camera.config();
        let own = ClassRules::from_config(config, None);
        let zones = config.zones.as_ref();
        let off_level = zones.and_then(|zones| zones.off_level);
        Self {
            keen: zones.map(|zones| ClassRules::from_config(config, Some(&zones.keen))),
            off_level: off_level.map_or(own.summary_level, f64::from),
            combine: camera.combine(),
            irrelevant: camera.irrelevant(),
            own,
        }
    }

    /// Returns the thresholds of a class.
    fn of_class(&self, class: RegionClass) -> &ClassRules {
        match (class, &self.keen) {
            (RegionClass::Keen, Some(keen)) => keen,
            _ => &self.own,
        }
    }

    pub(crate) fn srs(&self, class: RegionClass, scores: &[Vec<f64>], region: usize) -> bool {
        let rules = self.of_class(class).features.iter();
        let mut votes = rules.zip(scores).map(|(rule, all)| all[region] >= rule.min_score);
        match (class, self.combine) {
            (RegionClass::Off, _) => false,
            (RegionClass::Always, _) => true,
            (RegionClass::Normal | RegionClass::Keen, VoteCombination::Any) => {
                votes.any(|vote| vote)
            }
            (RegionClass::Normal | RegionClass::Keen, VoteCombination::All) => {
                votes.all(|vote| vote)
            }
        }
    }

    pub(crate) fn trs(&self, class: RegionClass, changed: f64) -> bool {
        changed >= self.of_class(class).min_count
    }

    pub(crate) fn summary_level(&self, class: RegionClass) -> f64 {
        match class {
            RegionClass::Off => self.off_level,
            RegionClass::Normal | RegionClass::Keen | RegionClass::Always => {
                self.of_class(class).summary_level
            }
        }
    }

    /// Returns the action for a region. It calls `is_summary_due` only where irrelevant regions
    /// send their means.
    pub(crate) fn action(
        &self,
        srs: bool,
        trs: bool,
        is_summary_due: impl FnOnce() -> bool,
    ) -> RegionAction {
        match (srs, trs, self.irrelevant) {
            (true, true, _) => RegionAction::Forward,
            (true, false, _) | (false, _, IrrelevantRendering::Hold) => RegionAction::Hold,
            (false, _, IrrelevantRendering::Zero) => RegionAction::Blank,
            (false, _, IrrelevantRendering::Mean) if is_summary_due() => RegionAction::Summarize,
            (false, _, IrrelevantRendering::Mean) => RegionAction::Hold,
        }
    }
}

impl ClassRules {
    /// Returns the thresholds of a configuration in which every key has its value. Keen thresholds
    /// take the place of them.
    fn from_config(config: &CameraConfig, keen: Option<&KeenConfig>) -> Self {
        let feature = |entry: &SpatialConfig| {
            let mut entries = keen.into_iter().flat_map(|keen| &keen.spatial);
            let keen = entries.find(|keen| keen.feature == entry.feature);
            FeatureRule::new(entry, keen)
        };
        let temporal = keen.map(|keen| &keen.temporal);
        let level = temporal.and_then(|keen| keen.level).or(config.temporal.level);
        let min_count = temporal.and_then(|keen| keen.min_count);
        let summary_level = keen.and_then(|keen| keen.periphery.level).or(config.periphery.level);
        Self {
            features: config.spatial.iter().map(feature).collect(),
            level: level.map_or(0.0, f64::from),
            min_count: f64::from(min_count.unwrap_or(config.temporal.min_count)),
            summary_level: summary_level.map_or(0.0, f64::from),
        }
    }
}

impl FeatureRule {
    fn new(entry: &SpatialConfig, keen: Option<&KeenSpatialConfig>) -> Self {
        let min_score = keen.and_then(|keen| keen.min_score).or(entry.min_score);
        let level = keen.and_then(|keen| keen.level).or(entry.level);
        Self {
            kind: entry.feature,
            level: f64::from(level.unwrap_or(0)),
            radius: entry.radius.unwrap_or(0),
            min_score: decimal_to_f64(min_score.expect("a camera has every key filled in")),
        }
    }
}

/// Returns the nearest `f64`. Every decimal is printed with digits that parse as a number.
fn decimal_to_f64(decimal: Decimal) -> f64 {
    decimal.to_string().parse().expect("a decimal is written as a number")
}
