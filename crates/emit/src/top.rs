// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two modules that may be on top of a design.

use foveate_design::{Design, Port};

/// A parameter of a module and its value.
pub type Parameter = (&'static str, u32);

/// Which module is on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Top {
    /// One regional processing unit, module `rpu`.
    Rpu,
    /// The whole array, module `rcm`.
    Rcm,
}

impl Top {
    /// Name of the module.
    #[must_use]
    pub fn module(self) -> &'static str {
        match self {
            Self::Rpu => "rpu",
            Self::Rcm => "rcm",
        }
    }

    /// Its parameters with the values of the design, which are their defaults in its Verilog. The
    /// widths of the array's ports follow from them.
    #[must_use]
    pub fn parameters(self, design: &Design) -> Vec<Parameter> {
        match self {
            Self::Rpu => Vec::new(),
            Self::Rcm => vec![("COLUMNS", design.columns()), ("ROWS", design.rows())],
        }
    }

    /// Its ports.
    #[must_use]
    pub fn ports(self, design: &Design) -> Vec<Port> {
        match self {
            Self::Rpu => design.rpu_ports(),
            Self::Rcm => design.rcm_ports(),
        }
    }
}
