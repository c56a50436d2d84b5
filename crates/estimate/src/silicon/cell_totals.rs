// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cells of a module, added up: their number, their area, and the part of the flip-flops.

use serde::{Deserialize, Serialize};

use super::error::SiliconError;
use super::library::{CellRole, LibertyLibrary};
use crate::netlist::AreaNetlist;
use crate::speed::count_to_f64;

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
    /// Adds up the cells of a module and of all modules inside it, except for the modules
    /// `without`.
    pub(super) fn of_module(
        netlist: &AreaNetlist,
        library: &LibertyLibrary,
        top: &str,
        without: &[&str],
    ) -> Result<Self, SiliconError> {
        let counts = netlist.instances(top, without)?;
        let own = counts.iter().filter(|(name, _)| !without.contains(&name.as_str()));
        let all = std::iter::once((top, 1)).chain(own.map(|(name, &count)| (name.as_str(), count)));
        let mut total = Self::default();
        for (name, times) in all {
            total = total.plus(Self::of_own_cells(netlist, library, name)?, times);
        }
        Ok(total)
    }

    /// Adds up the cells of a module without the modules inside it.
    pub(super) fn of_own_cells(
        netlist: &AreaNetlist,
        library: &LibertyLibrary,
        name: &str,
    ) -> Result<Self, SiliconError> {
        let module = netlist.module(name)?;
        let mut total = Self::default();
        for (cell, &count) in &module.cells {
            total.add(library, (&module.source_name, cell), count)?;
        }
        Ok(total)
    }

    fn add(
        &mut self,
        library: &LibertyLibrary,
        (module, name): (&str, &str),
        count: u64,
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
        let area = area * count_to_f64(count);
        self.cells += count;
        self.area_um2 += area;
        if cell.role == CellRole::FlipFlop {
            self.flip_flops += count;
            self.flip_flop_area_um2 += area;
        }
        Ok(())
    }

    /// Returns the sum of this and `times` others.
    #[must_use]
    pub fn plus(self, other: Self, times: u64) -> Self {
        let factor = count_to_f64(times);
        Self {
            cells: self.cells + other.cells * times,
            flip_flops: self.flip_flops + other.flip_flops * times,
            area_um2: self.area_um2 + other.area_um2 * factor,
            flip_flop_area_um2: self.flip_flop_area_um2 + other.flip_flop_area_um2 * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn totals(types: &[&str]) -> Result<CellTotals, SiliconError> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.lib");
        let cells =
            "cell (DFF) { area : 20; ff (IQ, IQN) { } } cell (INV) { area : 3.5; } cell (RAW) { }";
        std::fs::write(&path, format!("library (a) {{ {cells} }}")).unwrap();
        let cells: serde_json::Map<_, _> = types
            .iter()
            .enumerate()
            .map(|(at, kind)| (format!("c{at}"), serde_json::json!({ "type": kind })))
            .collect();
        let inner = serde_json::json!({ "cells": { "d": { "type": "DFF" } } });
        let json = serde_json::json!({ "modules": { "top": { "cells": cells }, "inner": inner } });
        let netlist = AreaNetlist::parse("netlist", json.to_string().as_bytes()).unwrap();
        CellTotals::of_module(&netlist, &LibertyLibrary::read(&path)?, "top", &[])
    }

    #[test]
    fn cells_of_all_modules_are_added_up() {
        let found = totals(&["INV", "INV", "DFF", "inner", "inner"]).unwrap();
        assert_eq!((found.cells, found.flip_flops), (5, 3));
        assert_eq!((found.area_um2, found.flip_flop_area_um2), (67.0, 60.0));
    }

    #[test]
    fn cells_without_an_area_and_unmapped_cells_are_errors() {
        let message = totals(&["INV", "$_DLATCH_P_", "$_DLATCH_P_"]).unwrap_err().to_string();
        assert!(message.contains("`top` has 2 cells `$_DLATCH_P_`"), "{message}");
        let message = totals(&["RAW"]).unwrap_err().to_string();
        assert!(message.contains("the cell `RAW` of the library `a` has no area"), "{message}");
    }
}
