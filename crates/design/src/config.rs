// SPDX-License-Identifier: MIT OR Apache-2.0
//! The configuration file ([`DesignConfig`]): the tables of a camera and the table of the
//! hardware that computes it, with the paper's design as the default. A validated configuration
//! is identified by a short hash of its text ([`config_fingerprint`]).

use crate::HardwareConfig;
use crate::keys::HARDWARE_KEYS;
use foveate_camera::{CAMERA_KEYS, CameraConfig, ConfigError, ConfigKey, toml_text};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use toml::Table;

/// A whole configuration file. [`DesignConfig::validate`] checks it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DesignConfig {
    /// The tables that say what is computed: every table except `[hardware]`.
    #[serde(flatten)]
    pub camera: CameraConfig,
    /// The table `[hardware]`, which says what computes it.
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
        let hardware = table.remove_entry("hardware").into_iter().collect();
        let hardware = HardwareConfig::from_table(&hardware)?;
        Ok(Self { camera: CameraConfig::from_table(table)?, hardware })
    }
}

/// Version of the meaning of a configuration. It changes when an unchanged configuration means
/// something else.
const CONTRACT: &str = "foveate design 1\n";

/// Returns the first 64 bits of the SHA-256 of a validated configuration, as 16 hexadecimal digits.
pub(crate) fn config_fingerprint(config: &DesignConfig) -> String {
    let mut hash = Sha256::new();
    hash.update(CONTRACT);
    hash.update(config.to_toml());
    hash.finalize().iter().take(8).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
