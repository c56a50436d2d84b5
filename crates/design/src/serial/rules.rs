// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for serial designs.

use super::{SerialTiming, ports::interface};
use crate::rules::{Array, Rules, Unit};
use crate::{Design, Interface, Organization, SerialDesign, Timing};

impl Rules for SerialDesign<'_> {
    fn unit(&self) -> Unit {
        Unit {
            name: Organization::Serial.unit_name(),
            module: "serial_lane",
            count: self.lanes(),
            regions: self.fold(),
            array: Array::Whole,
            // The sequencer is a part of the array, not of a lane.
            split: "rcm",
        }
    }

    fn lone_unit(&self) -> Design {
        self.one_lane()
    }

    fn timing(&self) -> Timing {
        SerialTiming::of(*self).answers()
    }

    fn rcm_interface(&self) -> Interface {
        interface(*self)
    }
}
