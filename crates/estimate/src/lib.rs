// SPDX-License-Identifier: MIT OR Apache-2.0
//! Estimates area and logic levels of a Foveate design with Yosys, and compares them with the
//! paper's table.
//!
//! [`estimate`] synthesizes the array with the RPU kept as one module. The leaves are flattened
//! into the RPU, so they share logic. The array is not flattened, so 784 RPUs take the time of one.
//! A second run keeps all leaves separate and shows the area of each.
//!
//! The figures are Yosys estimates. Vivado packs better; published ratios of the two are 1.5 to 2.3
//! in LUTs. Use the figures to compare one design with another.

mod area;
mod bus;
mod cells;
mod comparison;
mod device;
mod error;
mod estimate_job;
mod fold_search;
mod leaf_areas;
mod logic_levels;
mod netlist;
mod paper;
mod render;
mod report;
mod routing;
mod silicon;
mod speed;

pub use area::Area;
pub use bus::{BusArea, PartArea};
pub use cells::CellKind;
pub use comparison::{ComparedDesign, DesignComparison, SkippedDesign};
pub use device::{DeviceShare, FpgaDevice, XCVU9P};
pub use error::EstimateError;
pub use estimate_job::{EstimateJob, estimate};
pub use fold_search::{FoldCost, cheapest_fold};
pub use logic_levels::LogicPath;
pub use paper::{
    PAPER_RCM, PAPER_REGIONS, PAPER_RPU, PaperComparison, PaperRatios, PaperReport, PaperRow,
};
pub use render::ramb36;
pub use report::{AreaReport, FORMAT_VERSION, LeafArea, LongestPaths};
pub use routing::{
    ClockStatistics, CriticalPath, DeviceResult, PathEnd, PlacementResult, ROUTE_DEVICES,
    ROUTE_FORMAT_VERSION, ResourceShortage, ResourceUse, RouteDevice, RouteJob, RouteReport,
    place_and_route,
};
pub use silicon::{
    CellModel, CellModels, CellPin, CellTotals, FlatNetlist, FlipFlopState, HIGH_NET,
    InternalEnergy, LOW_NET, LibertyLibrary, LibraryFigures, LogicFunction, LookupTable,
    MacroChoice, MemoryFigures, MemoryTotals, NOT_INCLUDED, NetlistGate, OutputTransition,
    SILICON_FORMAT_VERSION, SiliconError, SiliconJob, SiliconLeaf, SiliconPath, SiliconReport,
    TimingSense, UnitFigures, check_libraries, gate_netlist, map_to_silicon, map_unit,
};
pub use speed::{ClockEstimate, FrameRate, count_to_f64, most_clocks_per_frame};
