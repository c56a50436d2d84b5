// SPDX-License-Identifier: MIT OR Apache-2.0
//! The implementation of [`crate::organization`] for pipelined designs.

use super::{PipelinedTiming, ports};
use crate::rules::{Array, Rules, Unit};
use crate::{Design, Interface, Organization, PipelinedDesign, Timing};

impl Rules for PipelinedDesign<'_> {
    fn unit(&self) -> Unit {
        Unit {
            name: Organization::Pipelined.unit_name(),
            module: "rpu",
            count: self.regions(),
            regions: 1,
            array: Array::Copies,
            split: "rpu",
        }
    }

    fn lone_unit(&self) -> Design {
        self.design().clone()
    }

    fn timing(&self) -> Timing {
        PipelinedTiming::of(*self).answers()
    }

    fn rpu_interface(&self) -> Interface {
        ports::rpu(self)
    }

    fn rcm_interface(&self) -> Interface {
        ports::rcm(self)
    }
}
