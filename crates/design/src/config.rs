// SPDX-License-Identifier: MIT OR Apache-2.0
//! The configuration file as serde types: that of a camera, and what computes it. The defaults are the paper's
//! design.

use crate::{
    Bus, Feed, MemoryKind, Organization, Pipelining, Store, Thresholds, keys::HARDWARE_KEYS,
};
use foveate_camera::{CAMERA_KEYS, CameraConfig, ConfigError, Key, text};
use serde::{Deserialize, Serialize};
use toml::Table;

/// A whole configuration, as written in a file; see [`Config::validate`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// What is computed: every table but the last.
    #[serde(flatten)]
    pub camera: CameraConfig,
    /// What computes it.
    #[serde(default)]
    pub hardware: HardwareConfig,
}

impl Config {
    /// Reads a configuration; keys that are left out have their defaults.
    ///
    /// # Errors
    /// As [`CameraConfig::from_toml`].
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        Self::from_toml_with(text, &[] as &[&str])
    }

    /// Reads a configuration and applies `overrides`, as [`CameraConfig::from_toml_with`].
    ///
    /// # Errors
    /// As [`CameraConfig::from_toml_with`].
    pub fn from_toml_with<S: AsRef<str>>(text: &str, overrides: &[S]) -> Result<Self, ConfigError> {
        text::read(text, overrides)
    }

    /// The configuration as a TOML file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        text::write(self)
    }

    /// The same design at `bits` bits per pixel, as [`CameraConfig::at_depth`].
    #[must_use]
    pub fn at_depth(&self, bits: u32) -> Self {
        Self { camera: self.camera.at_depth(bits), hardware: self.hardware.clone() }
    }
}

/// That camera, with the default hardware.
impl From<CameraConfig> for Config {
    fn from(camera: CameraConfig) -> Self {
        Self { camera, hardware: HardwareConfig::default() }
    }
}

impl text::AsToml for Config {
    fn keys() -> impl Iterator<Item = &'static Key> {
        CAMERA_KEYS.iter().chain(HARDWARE_KEYS)
    }

    fn from_table(mut table: Table) -> Result<Self, ConfigError> {
        /// What is left of the file.
        #[derive(Deserialize)]
        struct Rest {
            #[serde(default)]
            hardware: HardwareConfig,
        }
        let hardware = table.remove_entry("hardware").into_iter().collect();
        let Rest { hardware } = text::read_table(Self::keys(), hardware)?;
        Ok(Self { camera: CameraConfig::from_table(table)?, hardware })
    }

    fn at_depth(&self, bits: u32) -> Self {
        Self::at_depth(self, bits)
    }
}

/// `[hardware]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HardwareConfig {
    /// The structure of the array.
    pub organization: Organization,
    /// Regions per lane K of the serial organization, 1..=M; 1 for `pipelined`.
    pub fold: u32,
    /// The way in which pixels enter the serial organization; left out it is `parallel`. Only a serial design has
    /// it, and others refuse it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feed: Option<Feed>,
    /// Of what the memories of the serial organization's lanes are built, which sets its cycle counts.
    /// Left out it is distributed while that takes at most 128 memory LUTs, block above; see
    /// [`crate::LaneMemory`]. `pipelined` has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<MemoryKind>,
    /// Pixels that the raster organization takes at a clock, K: 1, 2 or 4; left out it is 1. Only a raster
    /// design has it, as `store` and `forward`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels_per_clock: Option<u32>,
    /// How finely the arithmetic is cut by registers; left out it is `plain`. A pipelined or serial design has it
    /// only where it is `deep`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pipelining: Option<Pipelining>,
    /// Where the frame store of the raster organization is, and of what it is built; left out it is `block`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub store: Option<Store>,
    /// Whether the pixels of active regions leave a raster core; left out they do. A design has it only where
    /// they do not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward: Option<bool>,
    /// How the core is connected to what is around it; left out it is by ports. A design has it only where it is by a
    /// bus.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interface: Option<Bus>,
    /// Whether the core is told where frames start, and finds them again; left out it is not. A design has it only
    /// where it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sync: Option<bool>,
    /// Whether thresholds are inputs of the core or constants in it.
    pub thresholds: Thresholds,
}

impl Default for HardwareConfig {
    fn default() -> Self {
        Self {
            organization: Organization::default(),
            fold: 1,
            feed: None,
            memory: None,
            pixels_per_clock: None,
            pipelining: None,
            store: None,
            forward: None,
            interface: None,
            sync: None,
            thresholds: Thresholds::Runtime,
        }
    }
}
