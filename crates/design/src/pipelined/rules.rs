// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for pipelined designs.

use super::{PipelinedTiming, ports};
use crate::organization::{ArrayStructure, ArrayUnit, OrganizationRules};
use crate::{CoreInterface, Design, DesignTiming, Organization, PipelinedDesign};

impl OrganizationRules for PipelinedDesign<'_> {
    fn unit(&self) -> ArrayUnit {
        ArrayUnit {
            name: Organization::Pipelined.unit_name(),
            module: "rpu",
            count: self.regions(),
            regions: 1,
            array: ArrayStructure::RpuCopies,
            area_module: "rpu",
        }
    }

    fn lone_unit(&self) -> Design {
        self.design().clone()
    }

    fn timing(&self) -> DesignTiming {
        PipelinedTiming::from_design(*self).to_design_timing()
    }

    fn rpu_interface(&self) -> CoreInterface {
        ports::rpu_interface(self)
    }

    fn rcm_interface(&self) -> CoreInterface {
        ports::rcm_interface(self)
    }
}
