// SPDX-License-Identifier: MIT OR Apache-2.0
//! Validation: checks every range and combination of a configuration, and makes a design of it.

use super::organization::check_support;
use crate::pipelined::PipelinedHardware;
use crate::raster::RasterHardware;
use crate::serial::SerialHardware;
use crate::{Design, DesignConfig, Hardware, HardwareConfig, Organization, OrganizationConfig};
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
        let HardwareConfig { organization, pipelining, sync, thresholds } = &self.hardware;
        check_support(&self.hardware, &camera)?;
        let hardware = match organization {
            OrganizationConfig::Pipelined => {
                Hardware::Pipelined(PipelinedHardware { pipelining: *pipelining })
            }
            OrganizationConfig::Serial(own) => {
                Hardware::Serial(SerialHardware::validate(own, *pipelining, &camera)?)
            }
            OrganizationConfig::Raster(own) => {
                Hardware::Raster(RasterHardware::validate(own, *pipelining, &camera)?)
            }
        };
        Ok(Design::new(camera, hardware, *sync, *thresholds))
    }
}

impl Organization {
    /// Returns the error for a fold above 1 where regions cannot share a unit.
    pub(crate) fn folding_error(self, fold: String) -> ConfigError {
        let remedy = "only the serial organization shares lanes; use 1";
        self.combination_error("hardware.fold", fold, remedy)
    }

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
