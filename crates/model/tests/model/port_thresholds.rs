// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds at the ports of a core, with or without zones, and designs with other thresholds.

use foveate_camera::{Camera, FeatureKind, RegionClass};
use foveate_model::{ClassMapInputs, ThresholdInputs, ZoneInputs};

use crate::frames::SeededRandom;
use crate::parameters::{DesignParameters, ZoneParameters};

/// The values of all threshold inputs of a core, with or without zones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortThresholds {
    pub(crate) own: ThresholdInputs,
    keen: ThresholdInputs,
    off_summary_level: u32,
}

impl From<ThresholdInputs> for PortThresholds {
    /// Makes inputs that are the same for all classes.
    fn from(own: ThresholdInputs) -> Self {
        Self { own, keen: own, off_summary_level: own.summary_level }
    }
}

impl PortThresholds {
    /// Returns the thresholds of the configuration.
    pub(crate) fn of_camera(camera: &Camera) -> Self {
        let of_class = |class| ThresholdInputs::of_class(camera, class);
        Self {
            own: of_class(RegionClass::Normal),
            keen: of_class(RegionClass::Keen),
            off_summary_level: of_class(RegionClass::Off).summary_level,
        }
    }

    /// Returns the values that a bench applies: the thresholds of a design, or arbitrary values if
    /// they are constants of the core.
    pub(crate) fn applied(recipe: &DesignParameters) -> Self {
        if !recipe.constant {
            return Self::of_camera(&recipe.camera());
        }
        let arbitrary = ThresholdInputs {
            level: [1; FeatureKind::COUNT],
            min_score: [1; FeatureKind::COUNT],
            temporal_level: 0,
            temporal_min_count: 1,
            summary_level: 0,
        };
        arbitrary.into()
    }

    /// Returns small random values that are the same for all classes.
    pub(crate) fn random(random: &mut SeededRandom) -> Self {
        let own = ThresholdInputs {
            temporal_level: random.below(2) as u32,
            temporal_min_count: random.below(5) as u32,
            summary_level: random.below(2) as u32,
            level: [random.below(9) as u32; FeatureKind::COUNT],
            min_score: [random.below(9) as u64; FeatureKind::COUNT],
        };
        own.into()
    }

    /// Returns the inputs that only a core with zones has.
    pub(crate) fn zone_inputs(&self, map: ClassMapInputs) -> ZoneInputs<'_> {
        let Self { keen, off_summary_level, .. } = self;
        ZoneInputs { classes: &[], map, keen, off_summary_level: *off_summary_level }
    }
}

impl DesignParameters {
    /// Returns the design with smaller thresholds, mostly. Constants of the core stay.
    pub(crate) fn with_other_thresholds(&self, seed: u64) -> Self {
        let mut recipe = self.clone();
        let mut random = SeededRandom(seed);
        if recipe.constant || random.below(3) == 0 {
            return recipe;
        }
        for feature in &mut recipe.features {
            feature.level /= 1 + random.below(3);
            // The threshold stays a whole number, as counts of hits must be.
            feature.min_milli = feature.min_milli / (1 + random.below(3)) / 1000 * 1000;
        }
        recipe.temporal_level /= 1 + random.below(3);
        recipe.temporal_min /= 1 + random.below(3);
        if let Some(periphery) = &mut recipe.periphery {
            periphery.level /= 1 + random.below(3);
        }
        if let Some(zones) = &mut recipe.zones {
            zones.reduce(&mut random);
        }
        recipe
    }
}

impl ZoneParameters {
    /// Divides the thresholds by small random numbers.
    fn reduce(&mut self, random: &mut SeededRandom) {
        for (level, min_milli) in &mut self.features {
            *level /= 1 + random.below(3);
            // The threshold stays a whole number, as counts of hits must be.
            *min_milli = *min_milli / (1 + random.below(3)) / 1000 * 1000;
        }
        self.temporal_level /= 1 + random.below(3);
        self.temporal_min /= 1 + random.below(3);
        self.summary_level /= 1 + random.below(3);
        self.off_level /= 1 + random.below(3);
    }
}
