// SPDX-License-Identifier: MIT OR Apache-2.0
//! The validated design: one immutable value from which every other number is derived.

use std::ops::Deref;

use super::config;
use crate::{
    DesignConfig, Hardware, HardwareConfig, InterfaceKind, Organization, Pipelining,
    ThresholdSource,
};
use foveate_camera::Camera;

/// A design: a camera and the hardware that computes it. It dereferences to its camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    camera: Camera,
    hardware: Hardware,
    has_frame_sync: bool,
    threshold_source: ThresholdSource,
}

impl Deref for Design {
    type Target = Camera;

    fn deref(&self) -> &Camera {
        &self.camera
    }
}

impl Design {
    /// Makes a design of parts that [`DesignConfig::validate`] has checked and completed.
    pub(crate) fn new(
        camera: Camera,
        hardware: Hardware,
        has_frame_sync: bool,
        thresholds: ThresholdSource,
    ) -> Self {
        Self { camera, hardware, has_frame_sync, threshold_source: thresholds }
    }

    /// Returns the camera: what is computed.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the configuration that describes this design. Every key that applies is filled in,
    /// except `hardware.memory`, which is left out if the design follows its rule.
    #[must_use]
    pub fn config(&self) -> DesignConfig {
        let hardware = HardwareConfig {
            organization: self.hardware.organization_config(),
            pipelining: self.pipelining(),
            sync: self.has_frame_sync,
            thresholds: self.threshold_source,
        };
        DesignConfig { camera: self.camera.config().clone(), hardware }
    }

    /// Returns the hardware: what computes the camera.
    #[must_use]
    pub fn hardware(&self) -> &Hardware {
        &self.hardware
    }

    /// Returns the fingerprint of the design: 16 hexadecimal digits, equal for equal
    /// configurations.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        config::config_fingerprint(&self.config())
    }

    /// Returns the organization of the hardware.
    #[must_use]
    pub fn organization(&self) -> Organization {
        self.hardware.organization()
    }

    /// Returns the number of registers in the arithmetic.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        self.hardware.pipelining()
    }

    /// Returns true if the pixels of active regions leave the array or core.
    #[must_use]
    pub fn has_forwarding(&self) -> bool {
        self.hardware.has_forwarding()
    }

    /// Returns the interface by which the core is connected; see `docs/axi.md`.
    #[must_use]
    pub fn interface_kind(&self) -> InterfaceKind {
        self.hardware.interface_kind()
    }

    /// Returns true if the core has the AXI interface.
    #[must_use]
    pub fn is_on_axi(&self) -> bool {
        match self.interface_kind() {
            InterfaceKind::Ports => false,
            InterfaceKind::Axi => true,
        }
    }

    /// Returns true if the core has an input for the start of a frame and finds its frames again
    /// after an error; see `docs/sync.md`.
    #[must_use]
    pub fn has_frame_sync(&self) -> bool {
        self.has_frame_sync
    }

    /// Returns the source of the thresholds.
    #[must_use]
    pub fn threshold_source(&self) -> ThresholdSource {
        self.threshold_source
    }
}
