// SPDX-License-Identifier: MIT OR Apache-2.0
//! One threshold of a design: its register, its value in a configuration, and its copy to another.

use foveate_camera::{Decimal, FeatureKind, KeenConfig, KeenSpatialConfig, RegionClass};
use foveate_design::{Design, DesignConfig};

/// A threshold of a class of regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ThresholdKey {
    /// `Normal` for the thresholds that every design has.
    class: RegionClass,
    kind: ThresholdKind,
}

/// A threshold that every class may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ThresholdKind {
    /// The level of the feature with this index among those of the camera.
    Level(usize),
    /// The minimum score of the feature with this index.
    MinScore(usize),
    TemporalLevel,
    TemporalMinCount,
    SummaryLevel,
}

impl ThresholdKind {
    /// Returns all thresholds of a class of regions with thresholds of its own.
    fn all_of(design: &Design) -> impl Iterator<Item = Self> {
        let features = design.features().iter().enumerate();
        let of_features = features.flat_map(|(place, feature)| {
            let level = feature.level().map(|_| Self::Level(place));
            level.into_iter().chain([Self::MinScore(place)])
        });
        let summary = design.periphery().map(|_| Self::SummaryLevel);
        of_features.chain([Self::TemporalLevel, Self::TemporalMinCount]).chain(summary)
    }
}

impl ThresholdKey {
    pub(super) fn all_of(design: &Design) -> Vec<Self> {
        let of_class = |class| ThresholdKind::all_of(design).map(move |kind| Self { class, kind });
        let mut keys: Vec<_> = of_class(RegionClass::Normal).collect();
        if design.zones().is_some() {
            keys.extend(of_class(RegionClass::Keen));
            let is_level = |key: &Self| key.kind == ThresholdKind::SummaryLevel;
            keys.extend(of_class(RegionClass::Off).filter(is_level));
        }
        keys
    }

    pub(super) fn register(self, design: &Design) -> String {
        let feature = |place: usize| -> FeatureKind { design.features()[place].kind() };
        let own = match self.kind {
            ThresholdKind::Level(place) => format!("{}_level", feature(place).name()),
            ThresholdKind::MinScore(place) => format!("{}_min", feature(place).name()),
            ThresholdKind::TemporalLevel => "temporal_level".to_owned(),
            ThresholdKind::TemporalMinCount => "temporal_min".to_owned(),
            ThresholdKind::SummaryLevel => "summary_level".to_owned(),
        };
        match self.class {
            RegionClass::Normal | RegionClass::Always => own,
            RegionClass::Off | RegionClass::Keen => format!("{}_{own}", self.class),
        }
    }

    /// Copies this threshold from one configuration to another, if its value is another one there.
    pub(super) fn copy_value(self, from: &DesignConfig, to: &mut DesignConfig) {
        let value = self.value(from);
        if self.value(to) != value {
            self.set_value(to, value);
        }
    }

    /// Returns the value of the threshold, which is that of the camera if its class does not set it.
    fn value(self, config: &DesignConfig) -> Option<Decimal> {
        let own = match (self.class, &config.camera.zones) {
            (RegionClass::Keen, Some(zones)) => self.kind.keen_value(config, &zones.keen),
            (RegionClass::Off, Some(zones)) => zones.off_level.map(whole),
            _ => None,
        };
        own.or_else(|| self.kind.camera_value(config))
    }

    fn set_value(self, config: &mut DesignConfig, value: Option<Decimal>) {
        let level = value.and_then(|value| value.as_whole()?.try_into().ok());
        match self.class {
            RegionClass::Normal | RegionClass::Always => {
                self.kind.set_camera_value(config, value, level);
            }
            RegionClass::Keen => self.kind.set_keen_value(config, value, level),
            RegionClass::Off => config.camera.zones.get_or_insert_default().off_level = level,
        }
    }
}

impl ThresholdKind {
    fn camera_value(self, config: &DesignConfig) -> Option<Decimal> {
        let camera = &config.camera;
        match self {
            Self::Level(place) => camera.spatial[place].level.map(whole),
            Self::MinScore(place) => camera.spatial[place].min_score,
            Self::TemporalLevel => camera.temporal.level.map(whole),
            Self::TemporalMinCount => Some(whole(camera.temporal.min_count)),
            Self::SummaryLevel => camera.periphery.level.map(whole),
        }
    }

    fn set_camera_value(self, to: &mut DesignConfig, value: Option<Decimal>, level: Option<u32>) {
        let to = &mut to.camera;
        match self {
            Self::Level(place) => to.spatial[place].level = level,
            Self::MinScore(place) => to.spatial[place].min_score = value,
            Self::TemporalLevel => to.temporal.level = level,
            Self::TemporalMinCount => to.temporal.min_count = level.unwrap_or_default(),
            Self::SummaryLevel => to.periphery.level = level,
        }
    }

    fn keen_value(self, config: &DesignConfig, keen: &KeenConfig) -> Option<Decimal> {
        let entry = |place: usize| {
            let feature = config.camera.spatial[place].feature;
            keen.spatial.iter().find(|entry| entry.feature == feature)
        };
        match self {
            Self::Level(place) => entry(place)?.level.map(whole),
            Self::MinScore(place) => entry(place)?.min_score,
            Self::TemporalLevel => keen.temporal.level.map(whole),
            Self::TemporalMinCount => keen.temporal.min_count.map(whole),
            Self::SummaryLevel => keen.periphery.level.map(whole),
        }
    }

    fn set_keen_value(self, to: &mut DesignConfig, value: Option<Decimal>, level: Option<u32>) {
        let camera = &mut to.camera;
        let keen = &mut camera.zones.get_or_insert_default().keen;
        match self {
            Self::Level(place) => keen_entry(keen, camera.spatial[place].feature).level = level,
            Self::MinScore(place) => {
                keen_entry(keen, camera.spatial[place].feature).min_score = value;
            }
            Self::TemporalLevel => keen.temporal.level = level,
            Self::TemporalMinCount => keen.temporal.min_count = level,
            Self::SummaryLevel => keen.periphery.level = level,
        }
    }
}

/// Returns the keen thresholds of a feature, which are added if there are none.
fn keen_entry(keen: &mut KeenConfig, feature: FeatureKind) -> &mut KeenSpatialConfig {
    let known = keen.spatial.iter().position(|entry| entry.feature == feature);
    let place = known.unwrap_or_else(|| {
        keen.spatial.push(KeenSpatialConfig { feature, level: None, min_score: None });
        keen.spatial.len() - 1
    });
    &mut keen.spatial[place]
}

fn whole(value: u32) -> Decimal {
    Decimal::from_whole(value.into())
}

/// Writes the thresholds that classes have in `design` into `config`, so that they do not follow those
/// of the camera.
pub(super) fn keep_class_thresholds(design: &Design, config: &mut DesignConfig) {
    let own = design.config();
    let keys = ThresholdKey::all_of(design).into_iter();
    for key in keys.filter(|key| key.class != RegionClass::Normal) {
        key.set_value(config, key.value(&own));
    }
}

/// Returns a design in which the thresholds of a class are those that `config` has for the camera.
/// Thresholds that are not valid stay.
pub(super) fn with_class_thresholds(
    design: &Design,
    class: RegionClass,
    config: &DesignConfig,
) -> Design {
    let own = ThresholdKey::all_of(design).into_iter().filter(|key| key.class == class);
    own.fold(design.clone(), |design, key| {
        let mut wanted = design.config();
        key.set_value(&mut wanted, key.kind.camera_value(config));
        wanted.validate().unwrap_or(design)
    })
}
