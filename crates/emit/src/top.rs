// SPDX-License-Identifier: MIT OR Apache-2.0
//! The module that is on top of a design ([`Top`], or [`AXI_TOP`] for a core on AXI), and the
//! leaf beside it that finds the frames of a stream again ([`FrameSync`]).

use super::class_map::has_normal_map;
use foveate_design::{ArrayStructure, CoreInterface, Design, Hardware, InterfaceKind, Port};

/// The top module of a core on AXI, which contains the array.
pub const AXI_TOP: &str = "rcm_axi";

/// The clock port of [`AXI_TOP`].
pub const AXI_CLOCK: &str = "aclk";

/// The clock port of the tops without a bus.
pub(crate) const CLOCK: &str = "clk_i";

/// A parameter of a module and its value.
pub type Parameter = (&'static str, u32);

/// The module on top of a design without a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Top {
    /// One regional processing unit, module `rpu`.
    Rpu,
    /// The whole array, module `rcm`.
    Rcm,
}

impl Top {
    /// Returns the tops of a core of the design, the smaller first: one RPU and the array. A raster
    /// core serves all regions, so it has only one top.
    #[must_use]
    pub fn all_of(design: &Design) -> &'static [Self] {
        match design.hardware() {
            Hardware::Pipelined(_) | Hardware::Serial(_) => &[Self::Rpu, Self::Rcm],
            Hardware::Raster(_) => &[Self::Rcm],
        }
    }

    /// Returns the top that contains this one as an array: this top itself, if its module is an
    /// array of its own.
    #[must_use]
    pub fn array_top(self, design: &Design) -> Self {
        match (self, design.unit().array) {
            (Self::Rpu, ArrayStructure::SharedLogic) => Self::Rpu,
            (Self::Rpu, ArrayStructure::RpuCopies)
            | (Self::Rcm, ArrayStructure::RpuCopies | ArrayStructure::SharedLogic) => Self::Rcm,
        }
    }

    /// Returns whether a core of the design has a module `rpu` in addition to `rcm`.
    pub(crate) fn has_rpu(design: &Design) -> bool {
        Self::all_of(design).contains(&Self::Rpu)
    }

    /// Returns the name of the module.
    #[must_use]
    pub fn module(self) -> &'static str {
        match self {
            Self::Rpu => "rpu",
            Self::Rcm => "rcm",
        }
    }

    /// Returns the parameters with their values in the design, which are the defaults in its
    /// Verilog. The widths of the array's ports depend on them. A first map of classes is left out
    /// unless all of its regions are normal.
    #[must_use]
    pub fn parameters(self, design: &Design) -> Vec<Parameter> {
        match self {
            Self::Rpu => Vec::new(),
            Self::Rcm => {
                let grid = [("COLUMNS", design.columns()), ("ROWS", design.rows())];
                let normal_map = has_normal_map(design).then_some(("CLASSES", 0));
                grid.into_iter().chain(normal_map).collect()
            }
        }
    }

    /// Returns the interface of the module.
    #[must_use]
    pub fn interface(self, design: &Design) -> CoreInterface {
        match self {
            Self::Rpu => design.rpu_interface(),
            Self::Rcm => design.rcm_interface(),
        }
    }

    /// Returns the ports of the module.
    #[must_use]
    pub fn ports(self, design: &Design) -> Vec<Port> {
        self.interface(design).ports()
    }
}

/// Returns the module that a user integrates into a chip: the array, or the core on AXI.
pub(crate) fn core_top(design: &Design) -> &'static str {
    match design.interface_kind() {
        InterfaceKind::Ports => Top::Rcm.module(),
        InterfaceKind::Axi => AXI_TOP,
    }
}

/// Returns the clock port of the module that a user integrates into a chip.
pub(crate) fn core_clock(design: &Design) -> &'static str {
    match design.interface_kind() {
        InterfaceKind::Ports => CLOCK,
        InterfaceKind::Axi => AXI_CLOCK,
    }
}

/// Returns the module that is placed if the user names none. This is the whole core, except for
/// arrays of RPUs: hundreds of RPUs fit into none of the devices.
pub(crate) fn placed_top(design: &Design) -> &'static str {
    match design.unit().array {
        _ if design.is_on_axi() => AXI_TOP,
        ArrayStructure::RpuCopies => Top::Rpu.module(),
        ArrayStructure::SharedLogic => Top::Rcm.module(),
    }
}

/// The values for the instance of `frame_sync` in the template of a top.
pub(crate) struct FrameSync {
    /// The number of beats of a frame, in terms of the grid.
    pub(crate) beats: String,
    /// True if the array behind `frame_sync` takes a beat at every clock.
    pub(crate) is_always_open: bool,
}

impl FrameSync {
    /// Returns the values for an array that takes a beat at every clock; `None` without
    /// `hardware.sync`.
    pub(crate) fn without_ready(design: &Design, beats: String) -> Option<Self> {
        design.has_frame_sync().then_some(Self { beats, is_always_open: true })
    }

    /// Returns the values for an array or core with a ready output; `None` without `hardware.sync`.
    pub(crate) fn with_ready(design: &Design, beats: String) -> Option<Self> {
        design.has_frame_sync().then_some(Self { beats, is_always_open: false })
    }
}

/// Returns the signal that the valid input of the array or core is connected to.
pub(crate) fn valid_signal(design: &Design) -> &'static str {
    if design.has_frame_sync() { "beat" } else { "valid_i" }
}

/// Returns the signal that the ready output of the array or core is connected to.
pub(crate) fn ready_signal(design: &Design) -> &'static str {
    if design.has_frame_sync() { "open" } else { "ready_o" }
}
