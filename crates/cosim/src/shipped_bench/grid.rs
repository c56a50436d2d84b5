// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of a core that its bench simulates: the same Verilog with other parameters.

use crate::error::CosimError;
use crate::level::CosimLevel;
use foveate_camera::Neighborhood;
use foveate_design::{ArrayStructure, Design};
use foveate_emit::Top;

/// The smallest side of a region at which an array of nine is too slow in Icarus.
const LARGE_SIDE: u32 = 32;
/// The largest number of slots per lane at which two full lanes are simulated.
const MANY_SLOTS: u32 = 1024;

/// Returns the design for the grid that the bench of `top` simulates: for `rpu` one region or lane,
/// for `rcm` the whole frame, because widths, memories and counters follow from its size. If the
/// array is copies of `rpu`, or has more lanes than a simulator can build, the grid of `rcm` is
/// small. It has more than two lanes and, with `shared` neighborhoods and small regions, a region
/// with neighbors on all sides.
pub(super) fn bench_design(design: &Design, top: Top) -> Result<Design, CosimError> {
    match top {
        Top::Rpu => match design.unit().array {
            ArrayStructure::RpuCopies => {
                Ok(CosimLevel::Rcm { columns: 1, rows: 1 }.design(design)?)
            }
            ArrayStructure::SharedLogic => Ok(design.lone_unit()),
        },
        Top::Rcm if CosimLevel::is_whole_affordable(design) => Ok(design.clone()),
        Top::Rcm => {
            let (least, rows) = grid_size(design);
            let part = |columns| CosimLevel::Rcm { columns, rows }.design(design);
            // The grid of a small array may be smaller than the organization allows.
            let taken = (least..design.columns()).find_map(|columns| part(columns).ok());
            Ok(taken.map_or_else(|| part(design.columns()), Ok)?)
        }
    }
}

fn grid_size(design: &Design) -> (u32, u32) {
    let (columns, rows) = (design.columns(), design.rows());
    let least = match design.neighborhood() {
        Neighborhood::Shared if design.region_size() < LARGE_SIDE => 9,
        Neighborhood::Shared | Neighborhood::Isolated => 4,
    };
    let fold = design.slots();
    // The array has two full lanes and a third one that is half full, or one full lane and some
    // slots.
    let lanes = if fold <= MANY_SLOTS { 2 * fold + fold.div_ceil(2) } else { fold + least };
    let wanted = lanes.max(least).min(columns * rows);
    let side = (1..=columns).find(|side| side * side >= wanted).unwrap_or(columns);
    // A region can be lost only if the array has one row more than wait for the sink.
    let kept = design.timing().departure().buffered_rows.map_or(0, |kept| kept + 1);
    let high = wanted.div_ceil(side).max(kept).min(rows);
    (wanted.div_ceil(high).min(columns), high)
}
