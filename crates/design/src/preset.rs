// SPDX-License-Identifier: MIT OR Apache-2.0
//! Named configurations as a starting point.

use crate::DesignConfig;
use foveate_camera::ConfigError;

/// A named configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name of the preset on the command line.
    pub name: &'static str,
    /// Purpose of the preset in one line.
    pub summary: &'static str,
    /// The keys that differ from the defaults, as TOML.
    pub toml: &'static str,
}

/// Every preset; the first is the default.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "paper",
        summary: "the paper's design: 8x8 regions, median, edges, previous frame as reference",
        toml: "",
    },
    Preset {
        name: "bare",
        summary: "edges without denoising: the design of the paper's area table",
        toml: "[denoise]\nfilter = \"none\"\n",
    },
    Preset {
        name: "corner",
        summary: "corners (FAST 5/8) instead of edges",
        toml: "[[spatial]]\nfeature = \"corner\"\nmin_score = 2\n",
    },
    Preset {
        name: "mad",
        summary: "mean absolute deviation instead of edges, exact mean",
        toml: "[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 6\n",
    },
    Preset {
        name: "steady",
        summary: "the paper's scores against the pixels that were sent last, and held: cannot drift",
        toml: "[temporal]\nreference = \"last-sent\"\n\n[render]\nirrelevant = \"hold\"\n",
    },
    Preset {
        name: "fovea",
        summary: "pixels where it matters and the means of 2x2 blocks elsewhere, without denoising",
        toml: FOVEA,
    },
    Preset {
        name: "seamless",
        summary: "windows that see the neighboring regions: equal to whole-frame processing",
        toml: "[region]\nneighborhood = \"shared\"\n",
    },
    Preset {
        name: "serial",
        summary: "the paper's scores from small lanes under one sequencer, one region per lane",
        toml: "[hardware]\norganization = \"serial\"\n",
    },
    Preset {
        name: "raster",
        summary: "the paper's scores in one core for ordinary video: 640x480 pixels row by row, one per clock",
        toml: "[frame]\nwidth = 640\nheight = 480\n\n[hardware]\norganization = \"raster\"\nsync = true\n",
    },
];

/// The TOML of `fovea`. Its thresholds come from measurements, which docs/guides/indexes.md shows.
const FOVEA: &str = r#"[denoise]
filter = "none"

[[spatial]]
feature = "edge"
min_score = 4

[temporal]
level = 16
reference = "last-sent"

[render]
irrelevant = "mean"

[periphery]
level = 1
"#;

impl Preset {
    /// Returns the preset of that name.
    ///
    /// # Errors
    /// Returns an error that lists the names of all presets if there is no preset of that name.
    pub fn find(name: &str) -> Result<&'static Self, ConfigError> {
        PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| {
            ConfigError::UnknownPreset {
                name: name.to_owned(),
                known: PRESETS.iter().map(|p| p.name).collect::<Vec<_>>().join(", "),
            }
        })
    }

    /// Returns the configuration of the preset.
    ///
    /// # Errors
    /// Returns no error for the presets of this crate, which a test proves.
    pub fn config(&self) -> Result<DesignConfig, ConfigError> {
        DesignConfig::from_toml(self.toml)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Organization;
    use foveate_camera::{IrrelevantRendering, ReferencePolicy};

    /// The compiler does not check that a new name has a preset.
    #[test]
    fn every_organization_reference_and_way_to_show_has_a_preset() {
        let configs: Vec<DesignConfig> =
            PRESETS.iter().map(|preset| preset.config().unwrap()).collect();
        let some = |holds: &dyn Fn(&DesignConfig) -> bool| configs.iter().any(holds);
        for &own in Organization::ALL {
            assert!(some(&|config| config.hardware.organization.kind() == own), "{own}");
        }
        for &own in ReferencePolicy::ALL {
            assert!(some(&|config| config.camera.temporal.reference == own), "{own}");
        }
        for &own in IrrelevantRendering::ALL {
            assert!(some(&|config| config.camera.render.irrelevant == own), "{own}");
        }
    }
}
