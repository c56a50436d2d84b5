// SPDX-License-Identifier: MIT OR Apache-2.0
//! A random design as plain numbers. The oracle reads these numbers, never the `Design`.

use std::fmt::Write;

use foveate_camera::{
    Camera, Decimal, DenoiseFilter, FeatureKind, KeenConfig, KeenPeripheryConfig,
    KeenSpatialConfig, KeenTemporalConfig, ZonesConfig,
};
use foveate_design::{Design, DesignConfig, Organization};
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

#[derive(Clone, Debug)]
pub(crate) struct DesignParameters {
    pub(crate) width: i64,
    pub(crate) height: i64,
    pub(crate) bits: u32,
    pub(crate) side: i64,
    pub(crate) shared: bool,
    /// The name of the filter.
    pub(crate) filter: &'static str,
    pub(crate) features: Vec<FeatureParameters>,
    pub(crate) all_must_vote: bool,
    pub(crate) temporal_level: i64,
    pub(crate) temporal_min: i64,
    pub(crate) last_sent: bool,
    pub(crate) blank_irrelevant: bool,
    /// `render.irrelevant = "mean"` with this periphery. It overrides `blank_irrelevant`.
    pub(crate) periphery: Option<PeripheryParameters>,
    pub(crate) raw_payload: bool,
    pub(crate) constant: bool,
    /// `hardware.pipelining = "deep"`.
    pub(crate) deep: bool,
    /// The thresholds of zones, of a camera that has them.
    pub(crate) zones: Option<ZoneParameters>,
    /// The SRS of regions whose class leaves the votes out.
    pub(crate) forced_srs: Option<bool>,
}

/// The table `[periphery]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PeripheryParameters {
    pub(crate) blocks: i64,
    pub(crate) level: i64,
}

impl PeripheryParameters {
    /// Returns a periphery for regions of this side and pixels up to `max`, or `None`. Successive
    /// numbers go through all peripheries.
    pub(crate) fn from_number(number: usize, side: i64, max: i64) -> Option<Self> {
        let blocks = [None, Some(1), Some(2), Some(4)][number % 4]?;
        let level = [0, max / 8, max - 1][number / 4 % 3];
        (side % blocks == 0).then_some(Self { blocks, level })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct FeatureParameters {
    pub(crate) name: &'static str,
    pub(crate) level: i64,
    /// Minimum score in thousandths of hits, grey levels or squared grey levels.
    pub(crate) min_milli: i64,
    pub(crate) fraction_bits: u32,
    /// The radius of the search of `flow`.
    pub(crate) radius: i64,
}

/// The thresholds of zones.
#[derive(Clone, Debug)]
pub(crate) struct ZoneParameters {
    /// Levels and minima of `keen` regions, in the order of the features.
    pub(crate) features: Vec<(i64, i64)>,
    pub(crate) temporal_level: i64,
    pub(crate) temporal_min: i64,
    pub(crate) summary_level: i64,
    pub(crate) off_level: i64,
}

impl FeatureParameters {
    /// Returns true if the feature counts pixels, so that it has a level and a whole minimum.
    pub(crate) fn has_level(&self) -> bool {
        matches!(self.name, "edge" | "corner" | "segment")
    }
}

impl DesignParameters {
    /// Returns the design whose regions all have the class of this code.
    pub(crate) fn of_class(&self, code: u8) -> Self {
        let Some(zones) = &self.zones else {
            assert_eq!(code, 0, "a camera without zones has one class");
            return self.clone();
        };
        let mut own = self.clone();
        match code {
            0 => {}
            1 => {
                own.forced_srs = Some(false);
                own.periphery.iter_mut().for_each(|periphery| periphery.level = zones.off_level);
            }
            2 => {
                for (feature, keen) in own.features.iter_mut().zip(&zones.features) {
                    (feature.level, feature.min_milli) = *keen;
                }
                (own.temporal_level, own.temporal_min) = (zones.temporal_level, zones.temporal_min);
                own.periphery.iter_mut().for_each(|one| one.level = zones.summary_level);
            }
            3 => own.forced_srs = Some(true),
            other => panic!("there is no class {other}"),
        }
        own
    }

    pub(crate) fn pixel_max(&self) -> i64 {
        (1 << self.bits) - 1
    }

    pub(crate) fn region_pixels(&self) -> i64 {
        self.side * self.side
    }

    /// Returns true if the screen no longer shows the sent pixels of a region once it is
    /// irrelevant.
    pub(crate) fn drops_irrelevant_pixels(&self) -> bool {
        self.blank_irrelevant || self.periphery.is_some()
    }

    pub(crate) fn has_filter(&self) -> bool {
        self.filter != "none"
    }

    /// Returns true if a feature uses windows.
    pub(crate) fn has_feature_window(&self) -> bool {
        ["edge", "corner", "surface"].iter().any(|name| self.has_feature(name))
    }

    /// Returns true if a feature needs the pixels of a region a second time.
    pub(crate) fn has_second_pass(&self) -> bool {
        ["mad", "segment"].iter().any(|name| self.has_feature(name))
    }

    pub(crate) fn has_feature(&self, name: &str) -> bool {
        self.features.iter().any(|feature| feature.name == name)
    }

    pub(crate) fn columns(&self) -> i64 {
        (self.width + self.side - 1) / self.side
    }

    pub(crate) fn rows(&self) -> i64 {
        (self.height + self.side - 1) / self.side
    }

    /// Returns true if some region can be active without a reference. Otherwise `last-sent` would
    /// never store one.
    fn can_start_without_reference(&self) -> bool {
        let starts = |feature: &FeatureParameters| feature.name != "flow" || feature.min_milli == 0;
        if self.all_must_vote {
            self.features.iter().all(starts)
        } else {
            self.features.iter().any(starts) || self.features.len() > 1
        }
    }

    /// Returns the design with a minimum of 0 for `flow` where no region could be active without a
    /// reference.
    pub(crate) fn with_a_start(mut self) -> Self {
        if self.last_sent && !self.can_start_without_reference() {
            for feature in self.features.iter_mut().filter(|feature| feature.name == "flow") {
                feature.min_milli = 0;
            }
        }
        self
    }

    /// Returns the camera, for which no organization has to have its features.
    pub(crate) fn camera(&self) -> Camera {
        self.config()
            .camera
            .validate()
            .unwrap_or_else(|e| panic!("{e}\n{}\n{:?}", self.toml(), self.zones))
    }

    fn zones_config(&self, zones: &ZoneParameters) -> ZonesConfig {
        let number = |value: i64| u32::try_from(value).unwrap();
        let feature = |(own, &(level, min_milli)): (&FeatureParameters, _)| KeenSpatialConfig {
            feature: FeatureKind::ALL.iter().copied().find(|kind| kind.name() == own.name).unwrap(),
            level: own.has_level().then_some(number(level)),
            min_score: Some(Decimal::from_billionths(
                1_000_000 * u64::try_from(min_milli).unwrap(),
            )),
        };
        // Levels of summaries are keys only if there are summaries.
        let summaries = |level| self.periphery.map(|_| number(level));
        ZonesConfig {
            off_level: summaries(zones.off_level),
            keen: KeenConfig {
                spatial: self.features.iter().zip(&zones.features).map(feature).collect(),
                temporal: KeenTemporalConfig {
                    level: Some(number(zones.temporal_level)),
                    min_count: Some(number(zones.temporal_min)),
                },
                periphery: KeenPeripheryConfig { level: summaries(zones.summary_level) },
            },
            ..ZonesConfig::default()
        }
    }

    /// Returns the pipelined design.
    pub(crate) fn design(&self) -> Design {
        self.config().validate().unwrap_or_else(|e| panic!("{e}\n{}", self.toml()))
    }

    /// Returns the configuration of the pipelined design.
    pub(crate) fn config(&self) -> DesignConfig {
        let toml = self.toml();
        let config = DesignConfig::from_toml(&toml);
        let mut config = config.unwrap_or_else(|e| panic!("{e}\n{toml}"));
        config.camera.zones = self.zones.as_ref().map(|zones| self.zones_config(zones));
        config
    }

    fn toml(&self) -> String {
        let pick = |first: bool, a: &'static str, b: &'static str| if first { a } else { b };
        let mut text = format!(
            "[frame]\nwidth = {}\nheight = {}\npixel_bits = {}\n\
             [region]\nsize = {}\nneighborhood = \"{}\"\n[denoise]\nfilter = \"{}\"\n\
             [decision]\ncombine = \"{}\"\n\
             [temporal]\nlevel = {}\nmin_count = {}\nreference = \"{}\"\n\
             [render]\nirrelevant = \"{}\"\npayload = \"{}\"\n[hardware]\nthresholds = \"{}\"\n",
            self.width,
            self.height,
            self.bits,
            self.side,
            pick(self.shared, "shared", "isolated"),
            self.filter,
            pick(self.all_must_vote, "all", "any"),
            self.temporal_level,
            self.temporal_min,
            pick(self.last_sent, "last-sent", "previous"),
            if self.periphery.is_some() {
                "mean"
            } else {
                pick(self.blank_irrelevant, "zero", "hold")
            },
            pick(self.raw_payload, "raw", "denoised"),
            pick(self.constant, "constant", "runtime"),
        );
        if self.deep {
            text.push_str("pipelining = \"deep\"\n");
        }
        if let Some(PeripheryParameters { blocks, level }) = self.periphery {
            write!(text, "[periphery]\nblocks = {blocks}\nlevel = {level}\n").unwrap();
        }
        for feature in &self.features {
            let (whole, rest) = (feature.min_milli / 1000, feature.min_milli % 1000);
            let counts = feature.has_level();
            let fraction = if counts { String::new() } else { format!(".{rest:03}") };
            write!(text, "[[spatial]]\nfeature = \"{}\"\n", feature.name).unwrap();
            writeln!(text, "min_score = {whole}{fraction}").unwrap();
            if counts {
                writeln!(text, "level = {}", feature.level).unwrap();
            }
            if matches!(feature.name, "mad" | "segment") {
                writeln!(text, "mean_fraction_bits = {}", feature.fraction_bits).unwrap();
            }
            if feature.name == "flow" {
                writeln!(text, "radius = {}", feature.radius).unwrap();
            }
        }
        text
    }
}

/// Generates every kind of camera, with frames of about three regions.
pub(crate) fn arbitrary_cameras() -> impl Strategy<Value = DesignParameters> {
    arbitrary_parameters_with_sides(few_pixels(), FeatureKind::ALL.to_vec())
}

/// Generates every kind of camera with zones, with frames of about three regions.
pub(crate) fn arbitrary_zoned_cameras() -> impl Strategy<Value = DesignParameters> {
    with_zones(arbitrary_cameras())
}

/// Generates every kind of pipelined design with zones, with frames of about three regions.
pub(crate) fn arbitrary_zoned_parameters() -> impl Strategy<Value = DesignParameters> {
    with_zones(arbitrary_parameters())
}

/// Adds zones to designs.
fn with_zones(
    recipes: impl Strategy<Value = DesignParameters>,
) -> impl Strategy<Value = DesignParameters> {
    recipes.prop_flat_map(arbitrary_zones_of)
}

/// Generates the zones of a design.
pub(crate) fn arbitrary_zones_of(
    recipe: DesignParameters,
) -> impl Strategy<Value = DesignParameters> {
    let (side, bits, max) = (recipe.side, recipe.bits, recipe.pixel_max());
    let keen = |own: &FeatureParameters| {
        arbitrary_feature(own.name, side, bits, own.fraction_bits)
            .prop_map(|keen| (keen.level, keen.min_milli))
    };
    let features: Vec<_> = recipe.features.iter().map(keen).collect();
    let temporal = (small_numbers(max - 1), small_numbers(side * side));
    let levels = (small_numbers(max - 1), small_numbers(max));
    (features, temporal, levels).prop_map(move |(features, temporal, levels)| {
        let zones = ZoneParameters {
            features,
            temporal_level: temporal.0,
            temporal_min: temporal.1,
            summary_level: levels.0,
            off_level: levels.1,
        };
        DesignParameters { zones: Some(zones), ..recipe.clone() }
    })
}

/// Generates every kind of pipelined design, with frames of about three regions.
pub(crate) fn arbitrary_parameters() -> impl Strategy<Value = DesignParameters> {
    let kinds = Organization::Pipelined.feature_kinds();
    (arbitrary_parameters_with_sides(few_pixels(), kinds), any::<bool>())
        .prop_map(|(recipe, deep)| DesignParameters { deep, ..recipe })
}

/// Generates mostly small sides of regions.
fn few_pixels() -> impl Strategy<Value = i64> {
    prop_oneof![4 => select(vec![2i64, 3, 4, 5, 7, 8]), 1 => 2i64..=12]
}

/// Generates every kind of design with plain pipelining, for regions of these sides, with some of
/// these features.
pub(crate) fn arbitrary_parameters_with_sides(
    sides: impl Strategy<Value = i64>,
    kinds: Vec<FeatureKind>,
) -> impl Strategy<Value = DesignParameters> {
    let blocks = select(vec![None, None, Some(1i64), Some(2), Some(4)]);
    (without_periphery(sides, kinds), blocks).prop_flat_map(|(recipe, blocks)| {
        let blocks = blocks.filter(|blocks| recipe.side % blocks == 0);
        small_numbers(recipe.pixel_max() - 1).prop_map(move |level| DesignParameters {
            periphery: blocks.map(|blocks| PeripheryParameters { blocks, level }),
            ..recipe.clone()
        })
    })
}

fn without_periphery(
    sides: impl Strategy<Value = i64>,
    kinds: Vec<FeatureKind>,
) -> impl Strategy<Value = DesignParameters> {
    let names: Vec<_> = kinds.into_iter().map(FeatureKind::name).collect();
    let bits = prop_oneof![3 => select(vec![1u32, 2, 8, 10, 12, 16]), 1 => 1u32..=16];
    (sides, bits).prop_flat_map(move |(side, bits)| {
        let size = 1..=2 * side + 1;
        let names = subsequence(names.clone(), 1..=names.len()).prop_shuffle();
        let fraction_max = (0..).find(|bits| 1i64 << bits >= side * side).unwrap();
        // All features of a camera share one mean.
        let features = (names, 0u32..=fraction_max).prop_flat_map(move |(names, fraction_bits)| {
            let feature = |name| arbitrary_feature(name, side, bits, fraction_bits);
            names.into_iter().map(feature).collect::<Vec<_>>()
        });
        let filter = select(DenoiseFilter::NAMES);
        let switches = proptest::array::uniform7(any::<bool>());
        let max = (1i64 << bits) - 1;
        let temporal = (small_numbers(max - 1), small_numbers(side * side));
        ((size.clone(), size), features, filter, switches, temporal).prop_map(
            move |((width, height), features, filter, on, (temporal_level, temporal_min))| {
                let recipe = DesignParameters {
                    width,
                    height,
                    bits,
                    side,
                    shared: on[0],
                    filter,
                    features,
                    all_must_vote: on[1],
                    temporal_level,
                    temporal_min,
                    last_sent: false,
                    blank_irrelevant: on[3],
                    raw_payload: on[4],
                    constant: on[5] && on[6],
                    periphery: None,
                    deep: false,
                    zones: None,
                    forced_srs: None,
                };
                let last_sent = on[2] && recipe.can_start_without_reference();
                DesignParameters { last_sent, ..recipe }
            },
        )
    })
}

/// Generates mostly small numbers up to `max`, so that thresholds are both reached and missed.
fn small_numbers(max: i64) -> impl Strategy<Value = i64> {
    prop_oneof![2 => 0..=max.min(4), 2 => 0..=max / 4, 1 => 0..=max]
}

fn arbitrary_feature(
    name: &'static str,
    side: i64,
    bits: u32,
    fraction_bits: u32,
) -> BoxedStrategy<FeatureParameters> {
    let (max, n) = ((1i64 << bits) - 1, side * side);
    // The minimum score is a share of the pixel range or of its square, in thousandths, that some
    // region is sure to reach.
    let (level_max, minimum) = match name {
        "edge" => (6 * max - 1, small_numbers(n).prop_map(|hits| 1000 * hits).boxed()),
        "corner" => (max - 1, small_numbers(n).prop_map(|hits| 1000 * hits).boxed()),
        "mad" => (0, small_numbers(400).prop_map(move |permille| permille * max).boxed()),
        "range" => (0, small_numbers(900).prop_map(move |permille| permille * max).boxed()),
        "variance" => {
            (0, small_numbers(200).prop_map(move |permille| permille * max * max).boxed())
        }
        "surface" => (0, small_numbers(500).prop_map(move |permille| permille * max).boxed()),
        // Pixels of 1 bit are never on both sides of a mean without a fraction.
        "segment" if max == 1 && fraction_bits == 0 => (0, Just(0).boxed()),
        "segment" => {
            let levels = (max + 1) / 2 - i64::from(fraction_bits == 0);
            (levels - 1, small_numbers(n / 2).prop_map(|pixels| 1000 * pixels).boxed())
        }
        "flow" => (0, small_numbers(300).prop_map(move |permille| permille * max).boxed()),
        _ => panic!("`{name}` needs thresholds that some regions reach"),
    };
    (small_numbers(level_max), minimum, 1..=3i64.min(side - 1))
        .prop_map(move |(level, min_milli, radius)| FeatureParameters {
            name,
            level,
            min_milli,
            fraction_bits,
            radius,
        })
        .boxed()
}
