// SPDX-License-Identifier: MIT OR Apache-2.0
//! The configuration file as serde types: the tables of a camera, and the table of the hardware
//! that computes it. The defaults are those of the paper's design.

use crate::{
    FrameStoreKind, InterfaceKind, LaneMemoryKind, Organization, Pipelining, PixelFeed,
    ThresholdSource, keys::HARDWARE_KEYS,
};
use foveate_camera::{CAMERA_KEYS, CameraConfig, ConfigError, ConfigKey, toml_text};
use serde::{Deserialize, Serialize};
use toml::Table;

/// A whole configuration file. [`DesignConfig::validate`] checks it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DesignConfig {
    /// The tables that say what is computed: every table except `[hardware]`.
    #[serde(flatten)]
    pub camera: CameraConfig,
    /// The table `[hardware]`, which says what computes it.
    #[serde(default)]
    pub hardware: HardwareConfig,
}

impl DesignConfig {
    /// Reads a configuration. Keys that are left out have their defaults.
    ///
    /// # Errors
    /// Returns the errors of [`CameraConfig::from_toml`].
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        Self::from_toml_with(text, &[] as &[&str])
    }

    /// Reads a configuration and applies `overrides`, by the rules of
    /// [`CameraConfig::from_toml_with`].
    ///
    /// # Errors
    /// Returns the errors of [`CameraConfig::from_toml_with`].
    pub fn from_toml_with<S: AsRef<str>>(text: &str, overrides: &[S]) -> Result<Self, ConfigError> {
        toml_text::read(text, overrides)
    }

    /// Returns the text of the configuration as a TOML file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml_text::write(self)
    }

    /// Returns the configuration at `bits` bits per pixel, scaled by the rules of
    /// [`CameraConfig::scaled_to_depth`].
    #[must_use]
    pub fn scaled_to_depth(&self, bits: u32) -> Self {
        Self { camera: self.camera.scaled_to_depth(bits), hardware: self.hardware.clone() }
    }
}

/// Combines the camera with the default hardware.
impl From<CameraConfig> for DesignConfig {
    fn from(camera: CameraConfig) -> Self {
        Self { camera, hardware: HardwareConfig::default() }
    }
}

impl toml_text::TomlConfig for DesignConfig {
    fn keys() -> impl Iterator<Item = &'static ConfigKey> {
        CAMERA_KEYS.iter().chain(HARDWARE_KEYS)
    }

    fn from_table(mut table: Table) -> Result<Self, ConfigError> {
        /// The table of the file that is not part of the camera.
        #[derive(Deserialize)]
        struct HardwareTable {
            #[serde(default)]
            hardware: HardwareConfig,
        }
        let hardware = table.remove_entry("hardware").into_iter().collect();
        let HardwareTable { hardware } = toml_text::read_table(Self::keys(), hardware)?;
        Ok(Self { camera: CameraConfig::from_table(table)?, hardware })
    }

    fn scaled_to_depth(&self, bits: u32) -> Self {
        Self::scaled_to_depth(self, bits)
    }
}

/// The table `[hardware]`: the organization and its properties.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HardwareConfig {
    /// The structure of the hardware.
    pub organization: Organization,
    /// Regions per lane K of the serial organization, 1..=M. Other organizations accept only 1, the
    /// default.
    pub fold: u32,
    /// The order in which pixels enter the serial organization. If the key is left out, it is
    /// `parallel`. Other organizations refuse the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feed: Option<PixelFeed>,
    /// The kind of memory of the lanes of the serial organization, which affects its cycle counts.
    /// If the key is left out, the memory is distributed where that takes at most 128 memory LUTs,
    /// else block; see [`crate::LaneMemory`]. Other organizations refuse the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<LaneMemoryKind>,
    /// Pixels that the raster organization takes per clock, K: 1, 2 or 4. If the key is left out,
    /// it is 1. Other organizations refuse the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels_per_clock: Option<u32>,
    /// The number of registers in the arithmetic. If the key is left out, it is `plain`. In the
    /// configuration of a validated pipelined or serial design the key is present only with the
    /// value `deep`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pipelining: Option<Pipelining>,
    /// The memory of the frame store of the raster organization. If the key is left out, it is
    /// `block`. Other organizations refuse the key.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub store: Option<FrameStoreKind>,
    /// True if the pixels of active regions leave a raster core. If the key is left out, they do.
    /// Other organizations refuse the key. In the configuration of a validated design the key is
    /// present only with the value `false`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward: Option<bool>,
    /// The interface of the core. If the key is left out, the core has plain ports. Only the raster
    /// organization accepts the key. In the configuration of a validated design the key is present
    /// only for a core on AXI.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interface: Option<InterfaceKind>,
    /// True if the core has an input that marks the start of a frame and finds its frames again
    /// after an error. If the key is left out, it is false. In the configuration of a validated
    /// design the key is present only with the value `true`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sync: Option<bool>,
    /// The source of the thresholds: input ports, or constants in the core.
    pub thresholds: ThresholdSource,
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
            thresholds: ThresholdSource::Runtime,
        }
    }
}
