// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a serial array, and the configurations that it supports.

use crate::{HardwareConfig, LaneMemoryKind, Organization, Pipelining, PixelFeed};
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
    pub(crate) fn validate(asked: &HardwareConfig, camera: &Camera) -> Result<Self, ConfigError> {
        let &HardwareConfig { fold, feed, memory, pipelining, .. } = asked;
        let (size, regions) = (camera.region_size(), camera.regions());
        if size < MIN_SIDE {
            let remedy = format!("use {MIN_SIDE}..=64, or \"pipelined\"");
            return Err(asked.organization.combination_error(
                "region.size",
                size.to_string(),
                &remedy,
            ));
        }
        let why = format!(" (the frame has {regions} regions); fold = {regions} makes one lane");
        check_range("hardware.fold", fold, 1..=regions, &why)?;
        Ok(Self {
            fold,
            feed: feed.unwrap_or_default(),
            memory,
            pipelining: pipelining.unwrap_or_default(),
        })
    }

    /// Returns the table `[hardware]`. `pipelining` is left out while it has its default, so that
    /// the fingerprint of a design is the same as before the key existed.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Serial,
            fold: self.fold,
            feed: Some(self.feed),
            memory: self.memory,
            pipelining: self.pipelining.non_default(),
            ..HardwareConfig::default()
        }
    }
}
