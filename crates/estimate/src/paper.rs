// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's table, and the figures of a design as ratios to it.

use serde::{Deserialize, Serialize};

use crate::area::{Area, rounded_quotient};

/// A row of the paper's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PaperRow {
    /// The number of LUTs, including those used as memory.
    pub lut: u64,
    /// The number of flip-flops.
    pub ff: u64,
    /// The number of LUTs used as memory.
    pub lutram: u64,
}

/// The paper's RPU, for 8x8 pixels.
pub const PAPER_RPU: PaperRow = PaperRow { lut: 183, ff: 90, lutram: 16 };
/// The paper's RCM, for 224x224 pixels.
pub const PAPER_RCM: PaperRow = PaperRow { lut: 143_472, ff: 70_562, lutram: 12_544 };
/// The number of regions of the paper's RCM.
pub const PAPER_REGIONS: u64 = 784;

/// The figures of a design divided by the paper's; a ratio below 1 means that the design is
/// smaller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PaperRatios {
    /// The ratio of `lut_total` to the paper's LUTs.
    pub lut_total: f64,
    /// The ratio of `lut_total_packed` to the paper's LUTs.
    pub lut_total_packed: f64,
    /// The ratio of flip-flops.
    pub ff: f64,
    /// The ratio of `lut_memory` to the paper's LUTRAM.
    pub lut_memory: f64,
    /// The ratio of `lut_memory_packed` to the paper's LUTRAM.
    pub lut_memory_packed: f64,
}

/// A row of the paper's table, and the ratios of the design to it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PaperComparison {
    /// The paper's figures.
    pub paper: PaperRow,
    /// The design's figures divided by the paper's.
    pub ratio: PaperRatios,
}

impl PaperComparison {
    pub(crate) fn new(area: &Area, paper: PaperRow) -> Self {
        let ratio = PaperRatios {
            lut_total: rounded_quotient(area.lut_total, paper.lut),
            lut_total_packed: rounded_quotient(area.lut_total_packed, paper.lut),
            ff: rounded_quotient(area.ff, paper.ff),
            lut_memory: rounded_quotient(area.lut_memory, paper.lutram),
            lut_memory_packed: rounded_quotient(area.lut_memory_packed, paper.lutram),
        };
        Self { paper, ratio }
    }
}

/// The comparison of a design with the paper's table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PaperReport {
    /// The comparison of the RPU.
    pub rpu: PaperComparison,
    /// The comparison of the RCM; absent unless the design has as many regions as the paper's.
    pub rcm: Option<PaperComparison>,
}
