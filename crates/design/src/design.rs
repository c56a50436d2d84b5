// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated configuration: what is computed and what computes it, from which everything else is derived.

use std::ops::Deref;

use crate::{
    Bus, Config, Hardware, HardwareConfig, Organization, Pipelining, Thresholds, fingerprint,
};
use foveate_camera::Camera;

/// A design: a camera and the hardware that computes it. It answers every question that its camera answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    camera: Camera,
    hardware: Hardware,
    syncs: bool,
    thresholds: Thresholds,
}

impl Deref for Design {
    type Target = Camera;

    fn deref(&self) -> &Camera {
        &self.camera
    }
}

impl Design {
    /// What [`Config::validate`] has found valid, every key filled in.
    pub(crate) fn new(
        camera: Camera,
        hardware: Hardware,
        syncs: bool,
        thresholds: Thresholds,
    ) -> Self {
        Self { camera, hardware, syncs, thresholds }
    }

    /// What is computed.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The configuration with every key filled in.
    #[must_use]
    pub fn config(&self) -> Config {
        let hardware = HardwareConfig {
            // A default is left out, so that designs have the fingerprints from before there was the key.
            sync: self.syncs.then_some(true),
            thresholds: self.thresholds,
            ..self.hardware.config()
        };
        Config { camera: self.camera.config().clone(), hardware }
    }

    /// What computes it.
    #[must_use]
    pub fn hardware(&self) -> &Hardware {
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
        self.hardware.organization()
    }

    /// How finely the arithmetic is cut by registers.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        self.hardware.pipelining()
    }

    /// Whether the pixels of active regions leave the array or core.
    #[must_use]
    pub fn forwards(&self) -> bool {
        self.hardware.forwards()
    }

    /// How the array is connected to what is around it; see `docs/axi.md`.
    #[must_use]
    pub fn bus(&self) -> Bus {
        self.hardware.bus()
    }

    /// Whether the core stands on AXI.
    #[must_use]
    pub fn is_on_axi(&self) -> bool {
        match self.bus() {
            Bus::Ports => false,
            Bus::Axi => true,
        }
    }

    /// Whether the array is told where frames start, and finds them again; see `docs/sync.md`.
    #[must_use]
    pub fn syncs(&self) -> bool {
        self.syncs
    }

    /// The configuration with every key that its organization takes, also those that it leaves out while they have
    /// their default.
    #[must_use]
    pub fn spelled_out(&self) -> Config {
        let mut config = self.config();
        let hardware = &mut config.hardware;
        hardware.pipelining = Some(self.pipelining());
        hardware.forward = match self.hardware {
            Hardware::Pipelined(_) | Hardware::Serial(_) => None,
            Hardware::Raster(_) => Some(self.forwards()),
        };
        config
    }

    /// Where the thresholds come from.
    #[must_use]
    pub fn thresholds(&self) -> Thresholds {
        self.thresholds
    }
}
