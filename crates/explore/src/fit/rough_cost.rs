// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rough cost of a design before its synthesis, which only orders the designs that are
//! synthesized. The choice is made with the figures of Yosys.

use foveate_design::{DenoiseFilter, Design, FeatureKind, Hardware, RasterMemory};
use foveate_estimate::FpgaDevice;

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

/// Returns roughly the share of the device that a design takes. The constants are read from the
/// area table of 8x8 regions.
pub(super) fn rough_cost(design: &Design) -> f64 {
    let device = FpgaDevice::xcvu9p();
    let bits = f64::from(design.pixel_bits());
    let kinds = design.features().iter().map(|feature| feature.kind());
    let filter = relative_filter_cost(design.filter());
    match design.hardware() {
        Hardware::Pipelined(_) => {
            let features: f64 = kinds
                .map(|kind| match kind {
                    FeatureKind::Corner => 30.0,
                    FeatureKind::Edge
                    | FeatureKind::Mad
                    | FeatureKind::Variance
                    | FeatureKind::Range
                    | FeatureKind::Segment => 10.0,
                    FeatureKind::Surface => 20.0,
                    FeatureKind::Flow => unreachable!("pipelined refuses flow"),
                })
                .sum();
            let unit = 8.0 + features + 37.0 * filter;
            f64::from(design.regions()) * unit * bits / count_to_f64(device.lut)
        }
        Hardware::Serial(own) => {
            let array = design.with_hardware(own);
            let features: f64 = kinds
                .map(|kind| match kind {
                    FeatureKind::Edge => 2.0,
                    FeatureKind::Corner | FeatureKind::Segment => 3.5,
                    FeatureKind::Mad
                    | FeatureKind::Variance
                    | FeatureKind::Range
                    | FeatureKind::Surface
                    | FeatureKind::Flow => 6.0,
                })
                .sum();
            let lanes = f64::from(array.lanes());
            let logic = (2.5 + features + 0.5 * filter) * bits;
            let (luts, blocks) = array.lane_memory().resources();
            (300.0 + lanes * (logic + count_to_f64(luts))) / count_to_f64(device.lut)
                + lanes * count_to_f64(blocks) / count_to_f64(device.bram18)
        }
        // The constants are read from docs/organizations.md: a core with its memory, and the cost
        // of each pixel of a word.
        Hardware::Raster(own) => {
            let features: f64 = kinds
                .map(|kind| match kind {
                    FeatureKind::Edge => 11.0,
                    FeatureKind::Corner => 14.0,
                    FeatureKind::Mad
                    | FeatureKind::Variance
                    | FeatureKind::Range
                    | FeatureKind::Segment => 6.0,
                    FeatureKind::Surface => 10.0,
                    FeatureKind::Flow => unreachable!("raster refuses flow"),
                })
                .sum();
            let pixels = f64::from(own.pixels_per_clock);
            let logic = 380.0 + pixels * (2.0 + features + 17.0 * filter) * bits;
            let blocks = |memory: &RasterMemory| memory.total_bits().div_ceil(18_432);
            let blocks: u64 =
                RasterMemory::all_memories(design.with_hardware(own)).iter().map(blocks).sum();
            logic / count_to_f64(device.lut) + count_to_f64(blocks) / count_to_f64(device.bram18)
        }
    }
}
