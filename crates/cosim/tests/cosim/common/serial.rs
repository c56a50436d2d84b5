// SPDX-License-Identifier: MIT OR Apache-2.0
//! Configurations of serial designs.

use foveate_design::{CameraConfig, DesignConfig, Organization, SpatialConfig};

/// Returns a serial configuration with these features; all other keys are the paper's.
pub(crate) fn serial_config(features: &[SpatialConfig]) -> DesignConfig {
    let mut config =
        DesignConfig::from(CameraConfig { spatial: features.to_vec(), ..CameraConfig::default() });
    config.hardware.organization = Organization::Serial;
    config
}

/// Returns the name of a serial configuration and its grid.
pub(crate) fn serial_config_name(config: &DesignConfig, grid: (u32, u32)) -> String {
    format!(
        "{} {:?} {:?} fold {} of {}x{}",
        super::config_name(config),
        config.hardware.feed,
        config.hardware.memory,
        config.hardware.fold,
        grid.0,
        grid.1,
    )
}
