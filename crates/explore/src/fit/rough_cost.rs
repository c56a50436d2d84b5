// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rough cost of a design before its synthesis, which only orders the designs that are
//! synthesized. The choice is made with the figures of Yosys.

use foveate_camera::DenoiseFilter;
use foveate_design::{Design, FeatureHardware, Hardware, RasterMemory};
use foveate_estimate::FpgaDevice;

use super::FitRequest;
use super::cost_objective::CostObjective;
use crate::row::count_to_f64;

/// Returns roughly the cost of a filter, as a multiple of the cost of the median.
fn relative_filter_cost(filter: DenoiseFilter) -> f64 {
    match filter {
        DenoiseFilter::None => 0.0,
        DenoiseFilter::Binomial3x3 => 0.5,
        DenoiseFilter::Median3x3 => 1.0,
        DenoiseFilter::Switching3x3 => 1.2,
    }
}

/// The rule by which designs are compared before their synthesis.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoughCostModel {
    objective: CostObjective,
    /// The largest memory in bits that becomes flip-flops.
    memory_limit: u64,
    /// True if there are macros for larger memories.
    has_macros: bool,
}

impl RoughCostModel {
    pub(super) fn of_request(request: &FitRequest<'_>) -> Self {
        let process = request.process;
        Self {
            objective: request.cheapest,
            memory_limit: process.map_or(0, |process| process.memory_limit),
            has_macros: process.is_some_and(|process| !process.macros.is_empty()),
        }
    }

    /// Returns roughly the cost of a design: the share of the FPGA, gate equivalents, or gate
    /// equivalents times clocks of a frame.
    pub(super) fn cost(self, design: &Design) -> f64 {
        match self.objective {
            CostObjective::Bytes | CostObjective::Area => rough_share(design),
            CostObjective::Mm2 => self.gates(design),
            // Most of the energy is that of the clock at flip-flops, which most gates are.
            CostObjective::Energy => {
                self.gates(design) * count_to_f64(design.timing().clocks_per_frame())
            }
        }
    }

    /// Returns roughly the area of a design in the cells of a process, in gate equivalents. The
    /// constants are read from `foveate estimate --liberty` for the presets `paper`, `bare` and
    /// `serial`.
    fn gates(self, design: &Design) -> f64 {
        /// A bit of a reference that is a shift register.
        const SHIFTED_BIT: f64 = 6.6;
        /// The logic of a LUT, with the flip-flop that goes with most of them.
        const LUT: f64 = 12.0;
        let memories = match design.hardware() {
            Hardware::Pipelined(_) => {
                let pixels = f64::from(design.width()) * f64::from(design.height());
                SHIFTED_BIT * pixels * f64::from(design.pixel_bits())
            }
            Hardware::Serial(own) => {
                let array = design.with_hardware(own);
                let bits = u64::from(design.pixel_bits()) * array.lane_memory().depth;
                f64::from(array.lanes()) * self.memory_gates(bits)
            }
            Hardware::Raster(own) => {
                let memories = RasterMemory::all_memories(design.with_hardware(own));
                memories.iter().map(|memory| self.memory_gates(memory.total_bits())).sum()
            }
        };
        memories + LUT * rough_logic_luts(design)
    }

    /// Returns roughly the area of a memory in gate equivalents.
    fn memory_gates(self, bits: u64) -> f64 {
        /// A bit of a memory of flip-flops, with its part of the decoder.
        const FLIP_FLOP_BIT: f64 = 8.0;
        /// A bit of a memory macro.
        const MACRO_BIT: f64 = 1.0;
        /// A bit of a memory without a macro, so that designs whose area will not be known come
        /// last.
        const UNKNOWN_BIT: f64 = 1000.0;
        let bit = match bits <= self.memory_limit {
            true => FLIP_FLOP_BIT,
            false if self.has_macros => MACRO_BIT,
            false => UNKNOWN_BIT,
        };
        bit * count_to_f64(bits)
    }
}

/// Returns roughly the share of the device that a design takes.
fn rough_share(design: &Design) -> f64 {
    let device = FpgaDevice::xcvu9p();
    let logic = rough_logic_luts(design);
    let (luts, blocks) = match design.hardware() {
        Hardware::Pipelined(_) => (0, 0),
        Hardware::Serial(own) => {
            let array = design.with_hardware(own);
            let (luts, blocks) = array.lane_memory().resources();
            let lanes = u64::from(array.lanes());
            (lanes * luts, lanes * blocks)
        }
        Hardware::Raster(own) => {
            let memories = RasterMemory::all_memories(design.with_hardware(own));
            (0, memories.iter().map(|memory| memory.total_bits().div_ceil(18_432)).sum())
        }
    };
    (logic + count_to_f64(luts)) / count_to_f64(device.lut)
        + count_to_f64(blocks) / count_to_f64(device.bram18)
}

/// Returns roughly the LUTs of a design without its memories. The constants are read from the area
/// table of 8x8 regions, and for raster cores from docs/organizations.md.
fn rough_logic_luts(design: &Design) -> f64 {
    let bits = f64::from(design.pixel_bits());
    let kinds = design.features().iter().map(|feature| feature.kind());
    let filter = relative_filter_cost(design.filter());
    match design.hardware() {
        Hardware::Pipelined(_) => {
            let features: f64 =
                kinds.map(|kind| FeatureHardware::in_pipelined(kind).rough_luts).sum();
            f64::from(design.regions()) * (8.0 + features + 37.0 * filter) * bits
        }
        Hardware::Serial(own) => {
            let features: f64 = kinds.map(|kind| FeatureHardware::in_serial(kind).rough_luts).sum();
            let lanes = f64::from(design.with_hardware(own).lanes());
            300.0 + lanes * (2.5 + features + 0.5 * filter) * bits
        }
        // A core, and the cost of each pixel of a word.
        Hardware::Raster(own) => {
            let features: f64 = kinds.map(|kind| FeatureHardware::in_raster(kind).rough_luts).sum();
            let pixels = f64::from(own.pixels_per_clock);
            380.0 + pixels * (2.0 + features + 17.0 * filter) * bits
        }
    }
}
