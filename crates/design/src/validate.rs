// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks every range and combination of a configuration, and makes it a design.

use crate::takes::taken;
use crate::{Bus, Config, Design, Hardware, HardwareConfig, Organization};
use foveate_camera::{ConfigError, MAX_SIDE};

impl Config {
    /// Checks every range and combination.
    ///
    /// # Errors
    /// Names the key, its value and what would be valid.
    pub fn validate(&self) -> Result<Design, ConfigError> {
        self.validate_up_to(MAX_SIDE)
    }

    /// The design for inputs of `width` x `height` pixels.
    ///
    /// # Errors
    /// As [`foveate_camera::CameraConfig::fit_frame`] and [`Config::validate`].
    pub fn for_frames(&self, width: u32, height: u32) -> Result<Design, ConfigError> {
        let mut config = self.clone();
        config.camera.fit_frame(width, height)?;
        config.validate()
    }

    /// As [`Config::validate`], for frames with sides up to `max_side`.
    pub(crate) fn validate_up_to(&self, max_side: u32) -> Result<Design, ConfigError> {
        let camera = self.camera.validate_up_to(max_side)?;
        let asked = &self.hardware;
        let hardware = match asked.organization {
            Organization::Pipelined => Hardware::Pipelined(taken(asked, &camera)?),
            Organization::Serial => Hardware::Serial(taken(asked, &camera)?),
            Organization::Raster => Hardware::Raster(taken(asked, &camera)?),
        };
        let syncs = asked.sync.unwrap_or_default();
        Ok(Design::new(camera, hardware, syncs, asked.thresholds))
    }
}

impl HardwareConfig {
    /// Refuses the keys that only the raster organization has.
    pub(crate) fn refuse_raster_keys(&self) -> Result<(), ConfigError> {
        let alone = "only the raster organization has it; leave the key out";
        // Whoever asks for a bus wants a core on it, and need not know which organization that is.
        let bus = "only the raster organization has it, with the same results; use organization \
                   = \"raster\", or leave the key out";
        let given = [
            (
                "hardware.pixels_per_clock",
                self.pixels_per_clock.map(|pixels| pixels.to_string()),
                alone,
            ),
            ("hardware.store", self.store.map(|store| format!("\"{store}\"")), alone),
            ("hardware.forward", self.forward.map(|forward| forward.to_string()), alone),
            ("hardware.interface", self.bus_beside_ports().map(|bus| format!("\"{bus}\"")), bus),
        ];
        match given.into_iter().find_map(|(key, value, remedy)| Some((key, value?, remedy))) {
            None => Ok(()),
            Some((key, value, remedy)) => Err(self.clash(key, value, remedy)),
        }
    }

    /// The interface, where it is another than ports, which every organization has.
    fn bus_beside_ports(&self) -> Option<Bus> {
        self.interface.filter(|&bus| bus != Bus::Ports)
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
