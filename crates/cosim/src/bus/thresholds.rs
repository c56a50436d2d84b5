// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of thresholds that are written while frames come: each value must show whether
//! the core has taken it over, so each threshold decides once ([`threshold_sweep`]). A
//! [`ThresholdKey`] is one threshold of a design: its register, its value in a configuration,
//! and its copy to another.

use foveate_camera::{
    Camera, Decimal, FeatureKind, KeenConfig, KeenSpatialConfig, RegionClass, VoteCombination,
};
use foveate_design::{Design, DesignConfig, ThresholdSource};

/// Returns the design with other thresholds: once with a lower temporal level, once with a temporal
/// level whose highest bit is set. Returns an empty list if thresholds are constants.
pub(super) fn other_threshold_designs(design: &Design) -> Vec<Design> {
    match design.threshold_source() {
        ThresholdSource::Constant => return Vec::new(),
        ThresholdSource::Runtime => {}
    }
    let level = design.temporal().level;
    let lower = if level == 0 { 1 } else { level / 2 };
    let highest = level | 1 << (design.pixel_bits() - 1);
    [lower, highest].into_iter().map(|level| with_level(design, level)).collect()
}

/// Returns the design with the temporal level `level` and with another value in every other
/// threshold register, or no check could see whether the register is taken over. A threshold keeps
/// its value if the other value is not valid.
fn with_level(design: &Design, level: u32) -> Design {
    let mut wanted = design.config();
    let most = (1_u32 << design.pixel_bits()) - 1;
    let other_level = |level: u32| match level {
        0 => 1,
        // Noise has relevant regions at every level and every minimum.
        _ if level <= most / 2 => 2 * level,
        _ => level / 2,
    };
    let camera = &mut wanted.camera;
    camera.temporal.level = Some(level);
    camera.temporal.min_count = if camera.temporal.min_count > 1 { 1 } else { 3 };
    camera.periphery.level = camera.periphery.level.map(other_level);
    for feature in &mut camera.spatial {
        feature.level = feature.level.map(other_level);
        let min = feature.min_score.and_then(|min| u64::try_from(min.ceil_times(1)).ok());
        feature.min_score =
            min.map(|min| Decimal::from_whole(if min > 1 { min / 2 } else { min + 1 }));
    }
    let keys = ThresholdKey::all_of(design);
    keys.into_iter().fold(design.clone(), |design, key| {
        let mut config = design.config();
        key.copy_value(&wanted, &mut config);
        config.validate().unwrap_or(design)
    })
}

/// Returns thresholds of a class for a sequence of noise frames whose regions have that class, one
/// set for each frame. Every threshold decides once: it alone differs from the thresholds of the
/// frame before, and all decisions depend on it.
pub(super) fn threshold_sweep(design: &Design, class: RegionClass) -> Vec<Design> {
    match design.threshold_source() {
        ThresholdSource::Constant => return Vec::new(),
        ThresholdSource::Runtime => {}
    }
    let configs = match class {
        RegionClass::Normal => {
            let designs = camera_sweep(design).into_iter().filter_map(|mut config| {
                keep_class_thresholds(design, &mut config);
                config.validate().ok()
            });
            return designs.collect();
        }
        _ if design.zones().is_none() => return Vec::new(),
        RegionClass::Always => return Vec::new(),
        RegionClass::Keen => camera_sweep(design),
        RegionClass::Off => summary_sweep(design),
    };
    configs.iter().map(|config| with_class_thresholds(design, class, config)).collect()
}

/// Returns configurations of a camera in which each of its thresholds decides.
fn camera_sweep(design: &Design) -> Vec<DesignConfig> {
    let all_active = all_active(design);
    let mut configs = vec![all_active.clone()];
    for place in 0..design.features().len() {
        configs.extend(feature_sweep(design, &all_active, place));
    }
    configs.push(all_active.clone());
    configs.extend(temporal_sweep(design, &all_active));
    configs.extend(summary_sweep(design));
    configs
}

/// Returns configurations in which no region is relevant: none sends means again, and all do. There
/// are none for a camera without means.
fn summary_sweep(design: &Design) -> Vec<DesignConfig> {
    if design.periphery().is_none() {
        return Vec::new();
    }
    let mut irrelevant = all_active(design);
    (0..design.features().len()).for_each(|place| disable_feature(design, &mut irrelevant, place));
    let mut restless = irrelevant.clone();
    restless.camera.periphery.level = Some(0);
    vec![irrelevant, restless]
}

/// Returns a configuration with which every region is active whatever it shows, and no mean differs
/// by more than the level.
fn all_active(design: &Design) -> DesignConfig {
    let (mut config, most) = (design.config(), design.pixel_max());
    config.camera.spatial.iter_mut().for_each(|one| one.min_score = Some(Decimal::from_whole(0)));
    config.camera.temporal.min_count = 0;
    config.camera.temporal.level = Some(most.saturating_sub(1));
    config.camera.periphery.level = config.camera.periphery.level.map(|_| most.saturating_sub(1));
    config
}

/// Sets the level and the minimum of a feature to their largest values, with which it votes for
/// hardly any region.
fn disable_feature(design: &Design, config: &mut DesignConfig, place: usize) {
    let (entry, feature) = (&mut config.camera.spatial[place], &design.features()[place]);
    entry.level = feature.largest_level();
    entry.min_score = Some(feature.largest_min_score());
}

/// Returns configurations in which the feature with index `place` alone decides which regions are
/// relevant: none, all by its minimum, none, and all by its level.
fn feature_sweep(design: &Design, all_active: &DesignConfig, place: usize) -> Vec<DesignConfig> {
    let mut alone = all_active.clone();
    match design.combine() {
        VoteCombination::All => {}
        VoteCombination::Any => {
            let others = (0..design.features().len()).filter(|&other| other != place);
            others.for_each(|other| disable_feature(design, &mut alone, other));
        }
    }
    disable_feature(design, &mut alone, place);
    let with_min = |config: &DesignConfig, min| {
        let mut config = config.clone();
        config.camera.spatial[place].min_score = Some(Decimal::from_whole(min));
        config
    };
    let mut configs = vec![alone.clone(), with_min(&alone, 0)];
    if design.features()[place].level().is_some() {
        // Even noise of 1-bit pixels reaches the largest level here and there, so one pixel is not
        // enough.
        let strict = with_min(&alone, u64::from(design.region_pixels() / 8).max(1));
        let mut lenient = strict.clone();
        lenient.camera.spatial[place].level = Some(0);
        configs.extend([strict, lenient]);
    }
    configs
}

/// Returns configurations in which the temporal score alone decides: none are active by the
/// minimum, and all by the level.
fn temporal_sweep(design: &Design, all_active: &DesignConfig) -> [DesignConfig; 3] {
    let with = |min_count, level| {
        let mut config = all_active.clone();
        config.camera.temporal.min_count = min_count;
        config.camera.temporal.level = level;
        config
    };
    let (pixels, most) = (design.region_pixels(), all_active.camera.temporal.level);
    [with(pixels, most), with(pixels / 2, most), with(pixels / 2, Some(0))]
}

/// A threshold with different values in some designs, for the question what a frame would come to
/// if the register had not been taken over.
pub(super) struct StaleThreshold<'a> {
    pub(super) register: String,
    key: ThresholdKey,
    designs: &'a [Design],
}

impl<'a> StaleThreshold<'a> {
    pub(super) fn all_of(designs: &'a [Design]) -> Vec<Self> {
        let differs = |key: &ThresholdKey| {
            designs.iter().any(|design| {
                let (own, mut mixed) = (design.config(), design.config());
                key.copy_value(&designs[0].config(), &mut mixed);
                own != mixed
            })
        };
        let of = |key: ThresholdKey| Self { register: key.register(&designs[0]), key, designs };
        ThresholdKey::all_of(&designs[0]).into_iter().filter(differs).map(of).collect()
    }

    /// Returns the camera of design `now` with this threshold of design `before`, or `None` if the
    /// two values are equal or the mix is not valid.
    pub(super) fn camera_with_stale_value(&self, now: usize, before: usize) -> Option<Camera> {
        let own = self.designs[now].config();
        let mut mixed = own.clone();
        self.key.copy_value(&self.designs[before].config(), &mut mixed);
        let design = (mixed != own).then(|| mixed.validate().ok()).flatten()?;
        Some(Camera::clone(&design))
    }
}

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

    /// Returns the value of the threshold, which is that of the camera if its class does not set
    /// it.
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

/// Writes the thresholds that classes have in `design` into `config`, so that they do not follow
/// those of the camera.
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

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::Organization;

    /// Returns the thresholds that differ between two designs.
    fn differing_thresholds(design: &Design, before: &Design) -> Vec<ThresholdKey> {
        let differs = |key: &ThresholdKey| {
            let mut mixed = design.config();
            key.copy_value(&before.config(), &mut mixed);
            mixed != design.config()
        };
        ThresholdKey::all_of(design).into_iter().filter(differs).collect()
    }

    #[test]
    fn each_threshold_differs_alone_from_one_frame_to_the_next() {
        let features = Organization::Raster.feature_kinds().into_iter();
        let features = features.map(|name| format!("{{feature='{name}'}}"));
        let list = features.collect::<Vec<_>>().join(",");
        // With fewer than 3 bits `segment` has only one valid level.
        for (bits, combine, irrelevant) in
            [(8, "any", "mean"), (8, "all", "zero"), (3, "any", "hold"), (16, "all", "mean")]
        {
            let toml = format!(
                "spatial=[{list}]\nframe.pixel_bits={bits}\ndecision.combine='{combine}'\n\
                 render.irrelevant='{irrelevant}'\nhardware.organization='raster'\nzones={{}}\n"
            );
            let design = DesignConfig::from_toml(&toml).unwrap().validate().unwrap();
            let alone: Vec<_> = RegionClass::ALL
                .iter()
                .map(|&class| threshold_sweep(&design, class))
                .flat_map(|steps| {
                    let pairs = steps.windows(2);
                    pairs.map(|pair| differing_thresholds(&pair[1], &pair[0])).collect::<Vec<_>>()
                })
                .filter(|keys| keys.len() == 1)
                .flatten()
                .collect();
            for key in ThresholdKey::all_of(&design) {
                assert!(alone.contains(&key), "{toml}: {key:?} is not among {alone:?}");
            }
        }
    }
}
