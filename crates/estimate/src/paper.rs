// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's table, and what a design is of it.

use serde::{Deserialize, Serialize};

use crate::area::{Area, quotient};

/// A row of the paper's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PaperRow {
    /// LUTs, those used as memory included.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
    /// LUTs used as memory.
    pub lutram: u64,
}

/// The paper's RPU, 8x8 pixels.
pub const PAPER_RPU: PaperRow = PaperRow { lut: 183, ff: 90, lutram: 16 };
/// The paper's RCM, 224x224 pixels.
pub const PAPER_RCM: PaperRow = PaperRow { lut: 143_472, ff: 70_562, lutram: 12_544 };
/// The number of regions of the paper's RCM.
pub const PAPER_REGIONS: u64 = 784;

/// Figures divided by the paper's; below 1 is smaller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ratios {
    /// `lut_total` by the paper's LUTs.
    pub lut_total: f64,
    /// `lut_total_packed` by the paper's LUTs.
    pub lut_total_packed: f64,
    /// Flip-flops.
    pub ff: f64,
    /// `lut_memory` by the paper's LUTRAM.
    pub lut_memory: f64,
    /// `lut_memory_packed` by the paper's LUTRAM.
    pub lut_memory_packed: f64,
}

/// The paper's row and what the design is of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BesidePaper {
    /// The paper's figures.
    pub paper: PaperRow,
    /// The design's figures divided by them.
    pub ratio: Ratios,
}

impl BesidePaper {
    pub(crate) fn new(area: &Area, paper: PaperRow) -> Self {
        let ratio = Ratios {
            lut_total: quotient(area.lut_total, paper.lut),
            lut_total_packed: quotient(area.lut_total_packed, paper.lut),
            ff: quotient(area.ff, paper.ff),
            lut_memory: quotient(area.lut_memory, paper.lutram),
            lut_memory_packed: quotient(area.lut_memory_packed, paper.lutram),
        };
        Self { paper, ratio }
    }
}

/// The paper's table beside the design.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Paper {
    /// The RPU.
    pub rpu: BesidePaper,
    /// The RCM; absent unless the design has as many regions as the paper's.
    pub rcm: Option<BesidePaper>,
}
