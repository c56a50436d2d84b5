// SPDX-License-Identifier: MIT OR Apache-2.0
//! Validation: checks every range and combination of a configuration, and makes a design of it.

use crate::pipelined::PipelinedHardware;
use crate::raster::RasterHardware;
use crate::serial::SerialHardware;
use crate::support::check_support;
use crate::{Design, DesignConfig, Hardware, HardwareConfig, Organization};
use foveate_camera::{ConfigError, MAX_SIDE};

impl DesignConfig {
    /// Checks every range and combination, and returns the design.
    ///
    /// # Errors
    /// Returns an error that names the key, its value and the valid values.
    pub fn validate(&self) -> Result<Design, ConfigError> {
        self.validate_up_to(MAX_SIDE)
    }

    /// Returns the design for inputs of `width` x `height` pixels.
    ///
    /// # Errors
    /// Returns the errors of [`foveate_camera::CameraConfig::fit_frame`] and
    /// [`DesignConfig::validate`].
    pub fn validate_for_frames(&self, width: u32, height: u32) -> Result<Design, ConfigError> {
        let mut config = self.clone();
        config.camera.fit_frame(width, height)?;
        config.validate()
    }

    /// Checks as [`DesignConfig::validate`] does, for frames with sides up to `max_side` pixels.
    pub(crate) fn validate_up_to(&self, max_side: u32) -> Result<Design, ConfigError> {
        let camera = self.camera.validate_up_to(max_side)?;
        let asked = &self.hardware;
        check_support(asked, &camera)?;
        asked.refuse_foreign_keys()?;
        let hardware = match asked.organization {
            Organization::Pipelined => Hardware::Pipelined(PipelinedHardware::new(asked)),
            Organization::Serial => Hardware::Serial(SerialHardware::validate(asked, &camera)?),
            Organization::Raster => Hardware::Raster(RasterHardware::validate(asked, &camera)?),
        };
        let syncs = asked.sync.unwrap_or_default();
        Ok(Design::new(camera, hardware, syncs, asked.thresholds))
    }
}

impl HardwareConfig {
    /// Refuses the keys that only another organization has, whatever their values, and a fold above
    /// 1 where regions cannot share a unit.
    fn refuse_foreign_keys(&self) -> Result<(), ConfigError> {
        if self.fold != 1 && !self.organization.has_folding() {
            let remedy = "only the serial organization shares lanes; use 1";
            return Err(self.organization.combination_error(
                "hardware.fold",
                self.fold.to_string(),
                remedy,
            ));
        }
        let foreign = |(_, owner, value): &(&str, Organization, Option<String>)| {
            *owner != self.organization && value.is_some()
        };
        match self.owned_keys().into_iter().find(foreign) {
            None => Ok(()),
            Some((key, owner, value)) => {
                let remedy = format!(
                    "only the {owner} organization has it; leave the key out, or use organization \
                     = \"{owner}\""
                );
                Err(self.organization.combination_error(key, value.unwrap_or_default(), &remedy))
            }
        }
    }

    /// Returns the keys that only one organization has: the name, the organization, and the value
    /// if the key is written.
    fn owned_keys(&self) -> [(&'static str, Organization, Option<String>); 6] {
        use Organization::{Raster, Serial};
        let name = |name: &str| format!("\"{name}\"");
        [
            ("hardware.feed", Serial, self.feed.map(|feed| name(feed.name()))),
            ("hardware.memory", Serial, self.memory.map(|memory| name(memory.name()))),
            (
                "hardware.pixels_per_clock",
                Raster,
                self.pixels_per_clock.map(|pixels| pixels.to_string()),
            ),
            ("hardware.store", Raster, self.store.map(|store| name(store.name()))),
            ("hardware.forward", Raster, self.forward.map(|forward| forward.to_string())),
            ("hardware.interface", Raster, self.interface.map(|bus| name(bus.name()))),
        ]
    }
}

impl Organization {
    /// Returns the error for a `key` whose value the organization does not accept.
    pub(crate) fn combination_error(self, key: &str, value: String, remedy: &str) -> ConfigError {
        ConfigError::Combination {
            key: key.to_owned(),
            value,
            with: format!("organization = \"{self}\""),
            remedy: remedy.to_owned(),
        }
    }
}
