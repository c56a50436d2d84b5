// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks every range and combination of a configuration, and makes it a design.

use crate::{Config, Design, HardwareConfig, Pipelining};
use foveate_camera::{Camera, ConfigError, MAX_SIDE};

impl Config {
    /// Checks every range and combination.
    ///
    /// # Errors
    /// Names the key, its value and what would be valid.
    pub fn validate(&self) -> Result<Design, ConfigError> {
        self.validate_up_to(MAX_SIDE)
    }

    /// As [`Config::validate`], for frames with sides up to `max_side`.
    pub(crate) fn validate_up_to(&self, max_side: u32) -> Result<Design, ConfigError> {
        let camera = self.camera.validate_up_to(max_side)?;
        let hardware = self.hardware.for_camera(&camera)?;
        Ok(Design::new(camera, hardware))
    }
}

impl HardwareConfig {
    /// `[hardware]` of that camera, its keys filled in.
    fn for_camera(&self, camera: &Camera) -> Result<Self, ConfigError> {
        let mut hardware = self.organization.rules().hardware(self, camera)?;
        // The default is left out, so that designs have the fingerprints from before there was this key.
        hardware.sync = hardware.sync.filter(|&sync| sync);
        Ok(hardware)
    }

    /// Refuses the keys that only the raster organization has.
    pub(crate) fn refuse_raster_keys(&self) -> Result<(), ConfigError> {
        let given = [
            ("hardware.pixels_per_clock", self.pixels_per_clock.map(|pixels| pixels.to_string())),
            ("hardware.store", self.store.map(|store| format!("\"{store}\""))),
            ("hardware.forward", self.forward.map(|forward| forward.to_string())),
        ];
        match given.into_iter().find_map(|(key, value)| Some((key, value?))) {
            None => Ok(()),
            Some((key, value)) => {
                let remedy = "only the raster organization has it; leave the key out";
                Err(self.clash(key, value, remedy))
            }
        }
    }

    /// The pipelining as a key of a design that may be without it. The default is left out, so that designs have the
    /// fingerprints from before there was this key.
    pub(crate) fn deep_pipelining(&self) -> Option<Pipelining> {
        self.pipelining.filter(|&pipelining| pipelining != Pipelining::Plain)
    }

    /// The error for a `key` whose value the organization does not take.
    pub(crate) fn clash(&self, key: &str, value: String, remedy: &str) -> ConfigError {
        ConfigError::Combination {
            key: key.to_owned(),
            value,
            with: format!("organization = \"{}\"", self.organization),
            remedy: remedy.to_owned(),
        }
    }
}
