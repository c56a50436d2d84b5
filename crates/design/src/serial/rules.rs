// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for serial designs.

use super::SerialTiming;
use super::ports::interface;
use crate::organization::{ArrayStructure, ArrayUnit, OrganizationRules};
use crate::{CoreInterface, Design, DesignTiming, Organization, SerialDesign};

impl OrganizationRules for SerialDesign<'_> {
    fn unit(&self) -> ArrayUnit {
        ArrayUnit {
            name: Organization::Serial.unit_name(),
            module: "serial_lane",
            count: self.lanes(),
            regions: self.fold(),
            array: ArrayStructure::SharedLogic,
            // The sequencer is a part of the array, not of a lane.
            area_module: "rcm",
        }
    }

    fn lone_unit(&self) -> Design {
        self.single_lane_design()
    }

    fn timing(&self) -> DesignTiming {
        SerialTiming::from_design(*self).to_design_timing()
    }

    fn rcm_interface(&self) -> CoreInterface {
        interface(*self)
    }
}
