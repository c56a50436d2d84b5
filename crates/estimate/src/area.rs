// SPDX-License-Identifier: MIT OR Apache-2.0
//! The area of a module, computed from the counts of its cells.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::cells::CellKind;
use crate::error::EstimateError;

/// The resources of a module.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Area {
    /// The number of logic LUTs when small ones share a LUT6 with two outputs: Yosys' "estimated
    /// LCs".
    pub lut_logic_low: u64,
    /// The number of logic LUTs when none is shared, and of inverters.
    pub lut_logic_high: u64,
    /// The number of LUTs used as memory or shift register.
    pub lut_memory: u64,
    /// The number of LUTs used as memory or shift register when two `SRL16E` share a LUT, as Vivado
    /// packs them.
    pub lut_memory_packed: u64,
    /// The sum of `lut_logic_high` and `lut_memory`, comparable to Vivado's "CLB LUTs".
    pub lut_total: u64,
    /// The sum of `lut_logic_high` and `lut_memory_packed`.
    pub lut_total_packed: u64,
    /// The number of flip-flops.
    pub ff: u64,
    /// The carry logic in units of `CARRY4`; a `CARRY8` counts as two.
    pub carry: u64,
    /// The number of DSP blocks.
    pub dsp: u64,
    /// The block RAM in units of `RAMB18`; a `RAMB36` counts as two.
    pub bram18: u64,
    /// The number of UltraRAM blocks.
    pub uram: u64,
}

impl Area {
    /// Returns the area of a module's own cells.
    ///
    /// # Errors
    /// Fails with [`EstimateError::UnknownCell`] for the first cell that is not known.
    pub fn of_cells(module: &str, cells: &BTreeMap<String, u64>) -> Result<Self, EstimateError> {
        let mut area = Self::default();
        let (mut luts, mut inverters, mut shift_registers) = ([0; 7], 0, 0);
        for (cell, &count) in cells {
            let unknown = || EstimateError::UnknownCell {
                cell: cell.clone(),
                module: module.to_owned(),
                count,
            };
            match CellKind::from_type(cell).ok_or_else(unknown)? {
                CellKind::Lut(inputs) => luts[inputs] += count,
                CellKind::Inverter => inverters += count,
                CellKind::ShiftRegister16 => shift_registers += count,
                CellKind::Memory(each) => area.lut_memory += each * count,
                CellKind::FlipFlop => area.ff += count,
                CellKind::Carry(each) => area.carry += each * count,
                CellKind::Dsp => area.dsp += count,
                CellKind::BlockRam(each) => area.bram18 += each * count,
                CellKind::UltraRam => area.uram += count,
                CellKind::Free => {}
            }
        }
        area.lut_logic_low = shared_luts(luts);
        area.lut_logic_high = luts.iter().sum::<u64>() + inverters;
        area.lut_memory_packed = area.lut_memory + shift_registers.div_ceil(2);
        area.lut_memory += shift_registers;
        area.lut_total = area.lut_logic_high + area.lut_memory;
        area.lut_total_packed = area.lut_logic_high + area.lut_memory_packed;
        Ok(area)
    }

    /// Returns the area of `count` such modules.
    #[must_use]
    pub fn multiplied(self, count: u64) -> Self {
        self.zip(self, |value, _| value * count)
    }

    /// Returns the area of this and another module together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    fn zip(self, other: Self, f: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            lut_logic_low: f(self.lut_logic_low, other.lut_logic_low),
            lut_logic_high: f(self.lut_logic_high, other.lut_logic_high),
            lut_memory: f(self.lut_memory, other.lut_memory),
            lut_memory_packed: f(self.lut_memory_packed, other.lut_memory_packed),
            lut_total: f(self.lut_total, other.lut_total),
            lut_total_packed: f(self.lut_total_packed, other.lut_total_packed),
            ff: f(self.ff, other.ff),
            carry: f(self.carry, other.carry),
            dsp: f(self.dsp, other.dsp),
            bram18: f(self.bram18, other.bram18),
            uram: f(self.uram, other.uram),
        }
    }
}

/// Returns the number of LUTs when small ones share a LUT6 with two outputs. A LUT1 shares it with
/// a LUT5, LUT4 or LUT3, a LUT2 with a LUT4 or LUT3, and the remaining LUT1 and LUT2 share it with
/// each other. The index of `luts` is the number of inputs. Yosys calls this number estimated LCs.
/// It is counted here because Yosys' own figure includes submodules in some versions and not in
/// others.
fn shared_luts(luts: [u64; 7]) -> u64 {
    let [_, mut ones, mut twos, threes, fours, fives, sixes] = luts;
    let pair_up = |large: u64, small: &mut u64| {
        let pairs = large.min(*small);
        *small -= pairs;
        large - pairs
    };
    pair_up(fives, &mut ones);
    for large in [fours, threes] {
        let unpaired = pair_up(large, &mut ones);
        pair_up(unpaired, &mut twos);
    }
    sixes + fives + fours + threes + (ones + twos).div_ceil(2)
}

/// Returns a quotient rounded to thousandths.
pub(crate) fn rounded_quotient(value: u64, unit: u64) -> f64 {
    let thousandths = (value * 1000 + unit / 2) / unit;
    f64::from(u32::try_from(thousandths).unwrap_or(u32::MAX)) / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(cells: &[(&str, u64)]) -> Area {
        let cells = cells.iter().map(|&(name, count)| (name.to_owned(), count)).collect();
        Area::of_cells("m", &cells).unwrap()
    }

    #[test]
    fn every_resource_is_counted() {
        let all = area(&[
            ("LUT6", 3),
            ("INV", 2),
            ("RAM64M8", 2),
            ("SRL16E", 5),
            ("SRLC32E", 1),
            ("FDRE", 7),
            ("FDSE", 1),
            ("CARRY4", 3),
            ("CARRY8", 1),
            ("DSP48E2", 2),
            ("RAMB18E2", 1),
            ("RAMB36E2", 1),
            ("URAM288", 1),
            ("MUXF7", 9),
        ]);
        let expected = Area {
            lut_logic_low: 3,
            lut_logic_high: 5,
            lut_memory: 22,
            lut_memory_packed: 20,
            lut_total: 27,
            lut_total_packed: 25,
            ff: 8,
            carry: 5,
            dsp: 2,
            bram18: 3,
            uram: 1,
        };
        assert_eq!(all, expected);
    }

    #[test]
    fn low_figure_shares_luts() {
        let low = |cells: &[(&str, u64)]| area(cells).lut_logic_low;
        assert_eq!(low(&[("LUT5", 2), ("LUT1", 1)]), 2);
        assert_eq!(low(&[("LUT5", 2), ("LUT2", 2)]), 3);
        assert_eq!(low(&[("LUT4", 1), ("LUT3", 1), ("LUT2", 3)]), 3);
        assert_eq!(low(&[("LUT3", 4)]), 4);
        // These are the figures of Yosys 0.23 for two modules of a real netlist.
        let rpu = [("LUT2", 9), ("LUT3", 5), ("LUT4", 1), ("LUT5", 3), ("LUT6", 2)];
        assert_eq!(low(&rpu), 13);
        let rcm = [("LUT2", 4), ("LUT3", 2), ("LUT4", 131), ("LUT5", 63), ("LUT6", 26)];
        assert_eq!(low(&rcm), 222);
    }

    #[test]
    fn an_unknown_cell_is_named() {
        let cells = BTreeMap::from([("LDCE".to_owned(), 3), ("LUT6".to_owned(), 1)]);
        let error = Area::of_cells("lane", &cells).unwrap_err().to_string();
        assert!(
            error.starts_with("module `lane` has 3 cells of the unknown type `LDCE`"),
            "{error}"
        );
    }

    #[test]
    fn areas_multiply_and_add() {
        let one = area(&[("LUT6", 3), ("SRL16E", 3), ("FDRE", 2)]);
        let sum = one.multiplied(3).plus(one);
        assert_eq!(sum, one.multiplied(4));
        assert_eq!((sum.lut_total, sum.lut_total_packed, sum.ff), (24, 20, 8));
    }
}
