// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules that may be on top of a design: its unit, its array, and that on a bus.

use foveate_design::{Array, Bus, Design, Hardware, Interface, Port};

/// The module on top of a core on a bus, with the array inside.
pub const AXI_TOP: &str = "rcm_axi";
/// The port of its clock.
pub const AXI_CLOCK: &str = "aclk";
/// That of the other modules on top.
pub(crate) const CLOCK: &str = "clk_i";

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
    /// The modules that a core of the design has on top, the smaller first: one RPU and the array. A raster core is
    /// one for all regions, so it has no other.
    #[must_use]
    pub fn all_of(design: &Design) -> &'static [Self] {
        match design.hardware() {
            Hardware::Pipelined(_) | Hardware::Serial(_) => &[Self::Rpu, Self::Rcm],
            Hardware::Raster(_) => &[Self::Rcm],
        }
    }

    /// The top that is an array with this one inside: this one, where its module is an array of its own.
    #[must_use]
    pub fn array(self, design: &Design) -> Self {
        match (self, design.unit().array) {
            (Self::Rpu, Array::Whole) => Self::Rpu,
            (Self::Rpu, Array::Copies) | (Self::Rcm, Array::Copies | Array::Whole) => Self::Rcm,
        }
    }

    /// Whether a core of the design has a module `rpu` beside `rcm`.
    pub(crate) fn has_rpu(design: &Design) -> bool {
        Self::all_of(design).contains(&Self::Rpu)
    }

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

    /// Its interface.
    #[must_use]
    pub fn interface(self, design: &Design) -> Interface {
        match self {
            Self::Rpu => design.rpu_interface(),
            Self::Rcm => design.rcm_interface(),
        }
    }

    /// Its ports.
    #[must_use]
    pub fn ports(self, design: &Design) -> Vec<Port> {
        self.interface(design).ports()
    }
}

/// The module that somebody puts into a chip: the array, or that on a bus.
pub(crate) fn whole(design: &Design) -> &'static str {
    match design.bus() {
        Bus::Ports => Top::Rcm.module(),
        Bus::Axi => AXI_TOP,
    }
}

/// The port of its clock.
pub(crate) fn clock(design: &Design) -> &'static str {
    match design.bus() {
        Bus::Ports => CLOCK,
        Bus::Axi => AXI_CLOCK,
    }
}

/// The module that is placed unless something else is asked for: all of a core, but arrays of hundreds of RPUs fit no
/// such device.
pub(crate) fn placed(design: &Design) -> &'static str {
    match design.unit().array {
        _ if design.is_on_axi() => AXI_TOP,
        Array::Copies => Top::Rpu.module(),
        Array::Whole => Top::Rcm.module(),
    }
}
