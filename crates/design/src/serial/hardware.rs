// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a serial array, and the configurations that it supports.

use crate::{LaneMemoryKind, Organization, Pipelining, PixelFeed, SerialConfig};
use foveate_camera::{Camera, ConfigError, check_range};

/// Smallest side of a region in pixels.
const MIN_SIDE: u32 = 4;

/// The properties that only a serial array has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SerialHardware {
    /// Regions per lane K.
    pub fold: u32,
    /// The order in which pixels enter.
    pub feed: PixelFeed,
    /// The kind of memory of the lanes, if the configuration chooses it; see [`super::LaneMemory`].
    pub memory: Option<LaneMemoryKind>,
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
}

impl SerialHardware {
    /// Returns the properties, or an error if a key or a size is not valid.
    pub(crate) fn validate(
        own: &SerialConfig,
        pipelining: Pipelining,
        camera: &Camera,
    ) -> Result<Self, ConfigError> {
        let &SerialConfig { fold, feed, memory } = own;
        let (size, regions) = (camera.region_size(), camera.regions());
        if size < MIN_SIDE {
            let remedy = format!("use {MIN_SIDE}..=64, or \"pipelined\"");
            return Err(Organization::Serial.combination_error(
                "region.size",
                size.to_string(),
                &remedy,
            ));
        }
        let why = format!(" (the frame has {regions} regions); fold = {regions} makes one lane");
        check_range("hardware.fold", fold, 1..=regions, &why)?;
        Ok(Self { fold, feed: feed.unwrap_or_default(), memory, pipelining })
    }

    /// Returns the keys that only this organization has. `memory` is left out if the configuration
    /// does not choose it.
    pub(crate) fn config(&self) -> SerialConfig {
        SerialConfig { fold: self.fold, feed: Some(self.feed), memory: self.memory }
    }
}
