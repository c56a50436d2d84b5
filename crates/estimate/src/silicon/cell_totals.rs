// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cells of a module, added up: their number, their area, and the part of the flip-flops.

use serde::{Deserialize, Serialize};

use super::error::SiliconError;
use super::library::{CellRole, LibertyLibrary};
use crate::netlist::AreaNetlist;

/// The cells of a module with all that is inside, without memories that are not mapped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellTotals {
    /// The number of cells.
    pub cells: u64,
    /// The number of flip-flops among them.
    pub flip_flops: u64,
    /// The area of all cells in square micrometres.
    pub area_um2: f64,
    /// The area of the flip-flops in square micrometres.
    pub flip_flop_area_um2: f64,
}

impl CellTotals {
    /// Adds up the cells of a module and of all modules inside it, except for the modules `without`.
    pub(super) fn of_module(
        netlist: &AreaNetlist,
        library: &LibertyLibrary,
        top: &str,
        without: &[&str],
    ) -> Result<Self, SiliconError> {
        let unusable = |reason: String| SiliconError::Netlist { reason };
        let counts =
            netlist.instances(top, without).map_err(|error| unusable(error.to_string()))?;
        let own = counts.iter().filter(|(name, _)| !without.contains(&name.as_str()));
        let all = std::iter::once((top, 1)).chain(own.map(|(name, &count)| (name.as_str(), count)));
        let mut total = Self::default();
        for (name, times) in all {
            let module = netlist.module(name).map_err(|error| unusable(error.to_string()))?;
            for (cell, &count) in &module.cells {
                total.add(library, (&module.source_name, cell), count, times)?;
            }
        }
        Ok(total)
    }

    fn add(
        &mut self,
        library: &LibertyLibrary,
        (module, name): (&str, &str),
        count: u64,
        times: u64,
    ) -> Result<(), SiliconError> {
        let Some(cell) = library.cells.get(name) else {
            return Err(SiliconError::Unmapped {
                module: module.to_owned(),
                cell: name.to_owned(),
                count,
                library: library.name.clone(),
            });
        };
        let area = cell.area.ok_or_else(|| SiliconError::NoArea {
            cell: name.to_owned(),
            library: library.name.clone(),
        })?;
        #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 cells")]
        let area = area * (count * times) as f64;
        self.cells += count * times;
        self.area_um2 += area;
        if cell.role == CellRole::FlipFlop {
            self.flip_flops += count * times;
            self.flip_flop_area_um2 += area;
        }
        Ok(())
    }

    /// Returns the sum of this and `times` others.
    #[must_use]
    pub fn plus(self, other: Self, times: u64) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 units")]
        let factor = times as f64;
        Self {
            cells: self.cells + other.cells * times,
            flip_flops: self.flip_flops + other.flip_flops * times,
            area_um2: self.area_um2 + other.area_um2 * factor,
            flip_flop_area_um2: self.flip_flop_area_um2 + other.flip_flop_area_um2 * factor,
        }
    }
}
