// SPDX-License-Identifier: MIT OR Apache-2.0
//! A fault in the emitted Verilog, and the design in which it is planted.

use crate::common::design;
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::{Design, DesignConfig};

/// A fault: one edit of one file, and the check of co-simulation that must find it.
pub(super) struct PlantedFault {
    /// The check that the fault proves.
    pub(super) check: &'static str,
    /// An output port at which the simulation must differ from the vectors.
    pub(super) port: &'static str,
    pub(super) design: FaultDesign,
    /// The module whose file is edited.
    pub(super) module: &'static str,
    /// The text that is replaced. The file must contain it exactly once.
    pub(super) from: &'static str,
    pub(super) to: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct FaultDesign {
    toml: &'static str,
    scope: FaultScope,
}

/// The hardware that is simulated with a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum FaultScope {
    /// One RPU, or one lane.
    Unit,
    /// An array with this grid of regions.
    Array(u32, u32),
    /// The array of the frame of the configuration.
    WholeFrame,
}

impl FaultDesign {
    pub(super) const fn unit(toml: &'static str) -> Self {
        Self { toml, scope: FaultScope::Unit }
    }

    pub(super) const fn array(toml: &'static str, (columns, rows): (u32, u32)) -> Self {
        Self { toml, scope: FaultScope::Array(columns, rows) }
    }

    pub(super) const fn whole_frame(toml: &'static str) -> Self {
        Self { toml, scope: FaultScope::WholeFrame }
    }

    pub(super) fn design(self) -> Design {
        let config = DesignConfig::from_toml(self.toml).unwrap();
        match self.scope {
            FaultScope::Unit => design(&config, (1, 1)),
            FaultScope::Array(columns, rows) => design(&config, (columns, rows)),
            FaultScope::WholeFrame => config.validate().unwrap(),
        }
    }

    pub(super) fn level(self) -> CosimLevel {
        match self.scope {
            FaultScope::Unit => CosimLevel::Rpu,
            FaultScope::Array(..) | FaultScope::WholeFrame => CosimLevel::Full,
        }
    }

    /// Returns the simulator. Icarus has unknown values, so that a missing reset shows at once.
    pub(super) fn simulator(self) -> Simulator {
        Simulator::Iverilog
    }
}
