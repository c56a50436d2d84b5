// SPDX-License-Identifier: MIT OR Apache-2.0
//! The module that is on top of a design ([`Top`], or [`AXI_TOP`] for a core on AXI), and what
//! stands in it beside the array or core: the leaf that finds the frames of a stream again
//! ([`FrameSync`]), and the memory of classes ([`class_connections`]), in whose place a design
//! without zones has constants.

use super::camera_flags::threshold_signal;
use foveate_camera::RegionClass;
use foveate_design::{
    ArrayStructure, CLASSES_PER_WORD, CoreInterface, Design, Hardware, InterfaceKind, Port,
    PortRole, class_word, keen_role,
};

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

/// Bits of the number of a word of the map, in terms of the grid. They are at least 1.
const ADDRESS_BITS: &str = "(COLUMNS*ROWS > 32 ? $clog2((COLUMNS*ROWS+15)/16) : 1)";

/// Returns the range of the port with the number of a word of the map.
pub(crate) fn class_address_range() -> String {
    debug_assert_eq!(CLASSES_PER_WORD, 16);
    format!("[{ADDRESS_BITS}-1:0]")
}

/// Returns the map of the configuration as a constant of the Verilog with the classes of a row of
/// regions in each line, or `None` for a design without zones.
pub(crate) fn first_map(design: &Design) -> Option<String> {
    let classes = design.zones()?.configured_classes();
    if has_normal_map(design) {
        return Some("0".to_owned());
    }
    let rows: Vec<_> = classes.chunks(columns(design)).rev().map(row_constant).collect();
    Some(format!("{{\n        {}\n    }}", rows.join(",\n        ")))
}

/// Returns true if the design has a memory of classes whose first map has only normal regions.
pub(crate) fn has_normal_map(design: &Design) -> bool {
    let is_normal =
        |classes: &[RegionClass]| classes.iter().all(|&class| class == RegionClass::Normal);
    design.has_class_memory()
        && design.zones().is_some_and(|zones| is_normal(zones.configured_classes()))
}

fn columns(design: &Design) -> usize {
    usize::try_from(design.columns()).expect("a row of regions is in memory")
}

/// Returns the classes of a row of regions as a hexadecimal constant, that of the first region in
/// the lowest bits.
fn row_constant(classes: &[RegionClass]) -> String {
    let digits: Vec<_> =
        classes.chunks(2).rev().map(|pair| format!("{:x}", class_word(pair))).collect();
    format!("{}'h{}", 2 * classes.len(), digits.concat())
}

/// Returns the parameters of the memory of classes.
pub(crate) fn class_parameters(design: &Design) -> Vec<(String, String)> {
    let zones = design.zones().map(|_| {
        [
            ("ZONES", "1".to_owned()),
            ("CLASS_ADDRESS_BITS", ADDRESS_BITS.to_owned()),
            ("CLASSES", "CLASSES".to_owned()),
        ]
    });
    zones.into_iter().flatten().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Returns the ports of the memory of classes, and the signals connected to them.
pub(crate) fn class_connections(design: &Design) -> [(&'static str, &'static str); 5] {
    match design.zones() {
        Some(_) => {
            ["zone_write_i", "zone_address_i", "zone_word_i", "zone_commit_i", "zone_pending_o"]
                .map(|port| (port, port))
        }
        None => [
            ("zone_write_i", "1'b0"),
            ("zone_address_i", "1'b0"),
            ("zone_word_i", "32'd0"),
            ("zone_commit_i", "1'b0"),
            ("zone_pending_o", "unused_zone_pending"),
        ],
    }
}

/// Returns the signal of the keen threshold that takes the place of this one. Without zones it is
/// the signal of this threshold.
pub(crate) fn keen_signal(design: &Design, role: PortRole) -> String {
    threshold_signal(design, design.zones().map_or(role, |_| keen_role(role)))
}

/// Returns the signals of the summary level of keen regions and of regions that are off.
pub(crate) fn class_summary_levels(design: &Design) -> [String; 2] {
    match (design.periphery(), design.zones()) {
        (None, _) => [0, 0].map(|_: u32| format!("{}'d0", design.pixel_bits())),
        (Some(_), None) => [PortRole::SummaryLevel; 2].map(|role| threshold_signal(design, role)),
        (Some(_), Some(_)) => [PortRole::KeenSummaryLevel, PortRole::OffSummaryLevel]
            .map(|role| threshold_signal(design, role)),
    }
}
