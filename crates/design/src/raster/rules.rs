// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for raster designs.

use super::hardware::min_columns;
use super::{RasterTiming, ports::interface};
use crate::organization::{ArrayStructure, ArrayUnit, OrganizationRules};
use crate::{CoreInterface, Design, DesignTiming, FrameStoreKind, Organization, RasterDesign};
use foveate_camera::ReferencePolicy;

/// Rows of regions of the lone core.
const LONE_ROWS: u32 = 3;

impl RasterDesign<'_> {
    /// Returns the number of pixels of a word, K.
    #[must_use]
    pub fn pixels_per_clock(&self) -> u32 {
        self.own_hardware().pixels_per_clock
    }

    /// Returns the memory of the frame store.
    #[must_use]
    pub fn store(&self) -> FrameStoreKind {
        self.own_hardware().store
    }

    /// Returns true if the scored pixels of every frame go to a store outside of the core and come
    /// back as the reference of the next frame. A reference of other pixels cannot be stored there.
    #[must_use]
    pub fn has_external_store(&self) -> bool {
        match (self.store(), self.temporal().reference) {
            (FrameStoreKind::Block | FrameStoreKind::Ultra | FrameStoreKind::SinglePort, _) => {
                false
            }
            (FrameStoreKind::External, ReferencePolicy::Previous) => true,
            (FrameStoreKind::External, ReferencePolicy::LastSent) => {
                unreachable!("such a store is refused with this reference")
            }
        }
    }
}

impl OrganizationRules for RasterDesign<'_> {
    fn unit(&self) -> ArrayUnit {
        ArrayUnit {
            name: Organization::Raster.unit_name(),
            module: "raster_core",
            count: 1,
            regions: self.regions(),
            array: ArrayStructure::SharedLogic,
            // Module `raster_core` has the parameters of the design only inside of module `rcm`.
            area_module: "rcm",
        }
    }

    /// Returns the core for the smallest frame that the organization supports.
    fn lone_unit(&self) -> Design {
        let size = self.region_size();
        let columns = min_columns(size, self.pixels_per_clock());
        let mut config = self.config();
        config.camera.resize_frame(columns * size, LONE_ROWS * size);
        config.validate().expect("a raster design stays one with the smallest frame")
    }

    fn timing(&self) -> DesignTiming {
        RasterTiming::from_design(*self).to_design_timing()
    }

    fn rcm_interface(&self) -> CoreInterface {
        interface(*self)
    }
}
