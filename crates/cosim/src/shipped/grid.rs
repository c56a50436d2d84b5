// SPDX-License-Identifier: MIT OR Apache-2.0
//! How much of a core its bench simulates: the same Verilog with other parameters.

use crate::error::CosimError;
use crate::level::Level;
use foveate_design::{Array, Design, Neighborhood};
use foveate_emit::Top;

/// Side of a region from which an array of nine is too slow in Icarus.
const LARGE_SIDE: u32 = 32;
/// Slots of a lane from which two full ones take too long.
const MANY_SLOTS: u32 = 1024;

/// The design for the grid that the bench of `top` simulates: of `rpu` one region or lane; of `rcm` the
/// whole frame, because widths, memories and counters follow from its size. Only where the array is
/// copies of `rpu`, or has more lanes than a simulator builds, it is a small grid: one with
/// more than two lanes and, where regions see their neighbors and are not large, with a region that has
/// neighbors on all sides.
pub(super) fn part(design: &Design, top: Top) -> Result<Design, CosimError> {
    match top {
        Top::Rpu => match design.unit().array {
            Array::Copies => Ok(Level::Rcm { columns: 1, rows: 1 }.design(design)?),
            Array::Whole => Ok(design.lone_unit()),
        },
        Top::Rcm if Level::is_whole_affordable(design) => Ok(design.clone()),
        Top::Rcm => {
            let (least, rows) = array(design);
            let part = |columns| Level::Rcm { columns, rows }.design(design);
            // The grid of a small array may be less than the organization takes.
            let taken = (least..design.columns()).find_map(|columns| part(columns).ok());
            Ok(taken.map_or_else(|| part(design.columns()), Ok)?)
        }
    }
}

fn array(design: &Design) -> (u32, u32) {
    let (columns, rows) = (design.columns(), design.rows());
    let least = match design.neighborhood() {
        Neighborhood::Shared if design.region_size() < LARGE_SIDE => 9,
        Neighborhood::Shared | Neighborhood::Isolated => 4,
    };
    let fold = design.slots();
    // Two full lanes and a third which is not, or one and some.
    let lanes = if fold <= MANY_SLOTS { 2 * fold + fold.div_ceil(2) } else { fold + least };
    let wanted = lanes.max(least).min(columns * rows);
    let side = (1..=columns).find(|side| side * side >= wanted).unwrap_or(columns);
    // A region can be lost where there is one row more than wait for the sink.
    let kept = design.timing().departure().kept_rows.map_or(0, |kept| kept + 1);
    let high = wanted.div_ceil(side).max(kept).min(rows);
    (wanted.div_ceil(high).min(columns), high)
}
