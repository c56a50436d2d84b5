// SPDX-License-Identifier: MIT OR Apache-2.0
//! Configurations of serial designs.

use foveate_camera::{CameraConfig, SpatialConfig};
use foveate_design::{DesignConfig, Organization};

/// Returns a serial configuration with these features; all other keys are the paper's.
pub(crate) fn serial_config(features: &[SpatialConfig]) -> DesignConfig {
    let mut config =
        DesignConfig::from(CameraConfig { spatial: features.to_vec(), ..CameraConfig::default() });
    config.hardware.organization = Organization::Serial.into();
    config
}

pub(crate) fn serial_config_name(config: &DesignConfig, grid: (u32, u32)) -> String {
    let mut hardware = config.hardware.clone();
    let own = hardware.make_serial();
    format!(
        "{} {:?} {:?} fold {} of {}x{}",
        super::config_name(config),
        own.feed,
        own.memory,
        own.fold,
        grid.0,
        grid.1,
    )
}
