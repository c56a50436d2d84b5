// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated configuration: what is computed and what computes it, from which everything else is derived.

use std::ops::Deref;

use crate::{
    Config, Feed, HardwareConfig, Organization, Pipelining, Store, Thresholds, fingerprint,
};
use foveate_camera::Camera;

/// A design: a camera and the hardware that computes it. It answers every question that its camera answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    camera: Camera,
    hardware: HardwareConfig,
}

impl Deref for Design {
    type Target = Camera;

    fn deref(&self) -> &Camera {
        &self.camera
    }
}

impl Design {
    /// What [`Config::validate`] has found valid, every key filled in.
    pub(crate) fn new(camera: Camera, hardware: HardwareConfig) -> Self {
        Self { camera, hardware }
    }

    /// What is computed.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The configuration with every key filled in.
    #[must_use]
    pub fn config(&self) -> Config {
        Config { camera: self.camera.config().clone(), hardware: self.hardware.clone() }
    }

    /// `[hardware]` with every key filled in.
    #[must_use]
    pub fn hardware(&self) -> &HardwareConfig {
        &self.hardware
    }

    /// A short name: 16 hexadecimal digits, equal for equal configurations.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        fingerprint::of(&self.config())
    }

    /// The structure of the array.
    #[must_use]
    pub fn organization(&self) -> Organization {
        self.hardware.organization
    }

    /// Regions per lane K: 1 for `pipelined`, where an RPU has but one.
    #[must_use]
    pub fn fold(&self) -> u32 {
        self.hardware.fold
    }

    /// How pixels enter; `pipelined` is always fed in parallel.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.hardware.feed.unwrap_or_default()
    }

    /// Pixels of a word K of the raster organization; 1 in the others.
    #[must_use]
    pub fn pixels_per_clock(&self) -> u32 {
        self.hardware.pixels_per_clock.unwrap_or(1)
    }

    /// How finely the arithmetic of the raster organization is cut by registers.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        self.hardware.pipelining.unwrap_or_default()
    }

    /// Where the frame store of the raster organization is, and of what it is built.
    #[must_use]
    pub fn store(&self) -> Store {
        self.hardware.store.unwrap_or_default()
    }

    /// Whether the pixels of active regions leave the array or core.
    #[must_use]
    pub fn forwards(&self) -> bool {
        self.hardware.forward.unwrap_or(true)
    }

    /// Whether the array is told where frames start, and finds them again; see `docs/sync.md`.
    #[must_use]
    pub fn syncs(&self) -> bool {
        self.hardware.sync.unwrap_or(false)
    }

    /// The configuration with every key that its organization takes, also those that it leaves out while they have
    /// their default.
    #[must_use]
    pub fn spelled_out(&self) -> Config {
        let mut config = self.config();
        let hardware = &mut config.hardware;
        hardware.pipelining = Some(self.pipelining());
        // What has a frame store may forward.
        hardware.forward = hardware.store.map(|_| self.forwards());
        config
    }

    /// Where the thresholds come from.
    #[must_use]
    pub fn thresholds(&self) -> Thresholds {
        self.hardware.thresholds
    }
}
