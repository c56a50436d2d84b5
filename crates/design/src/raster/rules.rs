// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for raster designs.

use super::hardware::least_columns;
use super::{RasterTiming, ports::interface};
use crate::rules::{Array, Rules, Unit};
use crate::{Design, Interface, Organization, RasterDesign, Reference, Store, Timing};

/// Rows of regions of the lone core.
const LONE_ROWS: u32 = 3;

impl RasterDesign<'_> {
    /// Returns the number of pixels of a word, K.
    #[must_use]
    pub fn pixels_per_clock(&self) -> u32 {
        self.own().pixels_per_clock
    }

    /// Returns the memory of the frame store.
    #[must_use]
    pub fn store(&self) -> Store {
        self.own().store
    }

    /// Returns true if the scored pixels of every frame go to a store outside of the core and come
    /// back as the reference of the next frame. A reference of other pixels cannot be stored there.
    #[must_use]
    pub fn frames_are_kept_outside(&self) -> bool {
        match (self.store(), self.temporal().reference) {
            (Store::Block | Store::Ultra | Store::SinglePort, _) => false,
            (Store::External, Reference::Previous) => true,
            (Store::External, Reference::LastSent) => {
                unreachable!("such a store is refused with this reference")
            }
        }
    }
}

impl Rules for RasterDesign<'_> {
    fn unit(&self) -> Unit {
        Unit {
            name: Organization::Raster.unit_name(),
            module: "raster_core",
            count: 1,
            regions: self.regions(),
            array: Array::Whole,
            // Module `raster_core` has the parameters of the design only inside of module `rcm`.
            split: "rcm",
        }
    }

    /// Returns the core for the smallest frame that the organization supports.
    fn lone_unit(&self) -> Design {
        let size = self.region_size();
        let columns = least_columns(size, self.pixels_per_clock());
        let mut config = self.config();
        config.camera.frame.width = Some(columns * size);
        config.camera.frame.height = Some(LONE_ROWS * size);
        config.validate().expect("a raster design stays one with the smallest frame")
    }

    fn timing(&self) -> Timing {
        RasterTiming::of(*self).answers()
    }

    fn rcm_interface(&self) -> Interface {
        interface(*self)
    }
}
