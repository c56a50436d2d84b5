// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of each cell of a Xilinx netlist. A cell that is not in this list causes an error in
//! the caller.

/// The kind of a primitive cell of the UltraScale+ family, with its cost where it has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// A look-up table with this number of inputs, 1 to 6.
    Lut(usize),
    /// An inverter that was not merged into a look-up table.
    Inverter,
    /// A shift register of up to 16 bits; two fit in one memory LUT.
    ShiftRegister16,
    /// Distributed RAM or a long shift register in this number of memory LUTs.
    Memory(u64),
    /// A flip-flop.
    FlipFlop,
    /// Carry logic in units of `CARRY4`.
    Carry(u64),
    /// A DSP block.
    Dsp,
    /// Block RAM in units of `RAMB18`.
    BlockRam(u64),
    /// An UltraRAM block.
    UltraRam,
    /// A cell without an area of its own: a constant, a clock buffer, a multiplexer behind LUTs, or
    /// a note of Yosys.
    Free,
}

impl CellKind {
    /// Returns the kind of a cell by the name of its type; `None` if it is not known.
    #[must_use]
    pub fn from_type(cell: &str) -> Option<Self> {
        Some(match cell {
            "LUT1" => Self::Lut(1),
            "LUT2" => Self::Lut(2),
            "LUT3" => Self::Lut(3),
            "LUT4" => Self::Lut(4),
            "LUT5" => Self::Lut(5),
            "LUT6" | "LUT6_2" => Self::Lut(6),
            "INV" => Self::Inverter,
            "SRL16" | "SRL16E" => Self::ShiftRegister16,
            "SRLC16" | "SRLC16E" | "SRLC32E" | "RAM32X1S" | "RAM64X1S" => Self::Memory(1),
            "RAM32X1D" | "RAM64X1D" | "RAM128X1S" => Self::Memory(2),
            "RAM32M" | "RAM64M" | "RAM128X1D" | "RAM256X1S" => Self::Memory(4),
            "RAM32M16" | "RAM64M8" | "RAM64X8SW" | "RAM256X1D" | "RAM512X1S" => Self::Memory(8),
            "FDRE" | "FDSE" | "FDCE" | "FDPE" => Self::FlipFlop,
            "CARRY4" => Self::Carry(1),
            "CARRY8" => Self::Carry(2),
            "DSP48E1" | "DSP48E2" => Self::Dsp,
            "RAMB18E1" | "RAMB18E2" => Self::BlockRam(1),
            "RAMB36E1" | "RAMB36E2" => Self::BlockRam(2),
            "URAM288" | "URAM288_BASE" => Self::UltraRam,
            "MUXF7" | "MUXF8" | "MUXF9" | "BUFG" | "VCC" | "GND" | "$scopeinfo" => Self::Free,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_cells_have_no_kind() {
        for cell in ["LDCE", "$add", "LUT7", "rpu", "", "lut6"] {
            assert_eq!(CellKind::from_type(cell), None, "{cell}");
        }
    }

    #[test]
    fn memories_weigh_what_the_family_spends() {
        for (cell, luts) in [("RAM64X1S", 1), ("RAM128X1S", 2), ("RAM64M", 4), ("RAM64M8", 8)] {
            assert_eq!(CellKind::from_type(cell), Some(CellKind::Memory(luts)), "{cell}");
        }
    }
}
