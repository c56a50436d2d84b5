// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report: areas, share of the device, and the paper's figures beside them.

use serde::{Deserialize, Serialize};

use crate::area::Area;
use crate::error::EstimateError;
use crate::levels::LogicPath;

/// The version of the JSON report. It grows when a field changes its meaning or goes away.
pub const FORMAT_VERSION: u32 = 1;

/// What a device has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Device {
    /// The name of the part.
    pub name: String,
    /// LUTs.
    pub lut: u64,
    /// LUTs that can be memory.
    pub lut_memory: u64,
    /// Flip-flops.
    pub ff: u64,
    /// DSP blocks.
    pub dsp: u64,
    /// Block RAM in units of `RAMB18`.
    pub bram18: u64,
}

/// The XCVU9P of the VCU118 board: name, LUTs, memory LUTs, flip-flops, DSP blocks, RAMB18.
pub const XCVU9P: (&str, [u64; 5]) = ("XCVU9P", [1_182_240, 591_840, 2_364_480, 6_840, 2 * 2_160]);

impl Device {
    /// The paper's device.
    #[must_use]
    pub fn xcvu9p() -> Self {
        let (name, [lut, lut_memory, ff, dsp, bram18]) = XCVU9P;
        Self { name: name.to_owned(), lut, lut_memory, ff, dsp, bram18 }
    }
}

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
    fn new(area: &Area, paper: PaperRow) -> Self {
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

/// The part of the device that the RCM takes, in percent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Of the LUTs, by `lut_total`.
    pub lut: f64,
    /// Of the LUTs that can be memory, by `lut_memory`.
    pub lut_memory: f64,
    /// Of the flip-flops.
    pub ff: f64,
    /// Of the DSP blocks.
    pub dsp: f64,
    /// Of the block RAM.
    pub bram: f64,
}

impl Share {
    fn new(area: &Area, device: &Device) -> Self {
        Self {
            lut: quotient(area.lut_total * 100, device.lut),
            lut_memory: quotient(area.lut_memory * 100, device.lut_memory),
            ff: quotient(area.ff * 100, device.ff),
            dsp: quotient(area.dsp * 100, device.dsp),
            bram: quotient(area.bram18 * 100, device.bram18),
        }
    }
}

/// What made the figures.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ToolRecord {
    /// `Yosys`.
    pub name: String,
    /// Its version as it says itself.
    pub version: String,
    /// The synthesis command.
    pub flags: String,
}

/// A leaf module, synthesized apart from the others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeafArea {
    /// The module.
    pub module: String,
    /// Its parameters as `NAME=VALUE`.
    pub parameters: Vec<String>,
    /// How many of it one RPU has.
    pub instances: u64,
    /// The area of one instance, without the modules inside it.
    pub area: Area,
}

/// The longest paths, in logic levels.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Paths {
    /// That of one RPU or lane alone, from and to its ports too.
    pub rpu: LogicPath,
    /// That of the RCM, through RPUs and lanes.
    pub rcm: LogicPath,
}

/// Areas as they are measured.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Areas {
    pub(crate) unit: Area,
    pub(crate) glue: Area,
    pub(crate) array: Area,
}

/// What was synthesized.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rtl {
    pub(crate) sha256: String,
    pub(crate) rpu_sha256: String,
}

/// The area of a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// What made the figures.
    pub tool: ToolRecord,
    /// The hash of the RTL: that of `sha256sum` over all files in the order of their names. A
    /// co-simulation of the whole array says the same.
    pub rtl_sha256: String,
    /// The same of the RTL of one RPU. A co-simulation of it says the same.
    pub rpu_sha256: String,
    /// The device of the shares.
    pub device: Device,
    /// The number of regions.
    pub regions: u64,
    /// One RPU, or one lane, its leaves flattened.
    pub rpu: Area,
    /// What the RCM has beside its RPUs or lanes.
    pub rcm_glue: Area,
    /// The RCM: glue and all RPUs or lanes.
    pub rcm: Area,
    /// The longest paths.
    pub paths: Paths,
    /// The share of the device that the RCM takes.
    pub share: Share,
    /// The paper's table.
    pub paper: Paper,
    /// The leaves of an RPU, or of the array, and its own glue; empty if not asked for. They do not add
    /// up to it, because logic is optimized across leaves.
    pub leaves: Vec<LeafArea>,
}

impl Report {
    /// Puts the measured areas beside device and paper.
    pub(crate) fn new(
        tool: ToolRecord,
        rtl: Rtl,
        regions: u64,
        areas: Areas,
        paths: Paths,
        leaves: Vec<LeafArea>,
    ) -> Self {
        let device = Device::xcvu9p();
        let Areas { unit, glue, array } = areas;
        let share = Share::new(&array, &device);
        let paper = Paper {
            rpu: BesidePaper::new(&unit, PAPER_RPU),
            rcm: (regions == PAPER_REGIONS).then(|| BesidePaper::new(&array, PAPER_RCM)),
        };
        Self {
            format_version: FORMAT_VERSION,
            tool,
            rtl_sha256: rtl.sha256,
            rpu_sha256: rtl.rpu_sha256,
            device,
            regions,
            rpu: unit,
            rcm_glue: glue,
            rcm: array,
            paths,
            share,
            paper,
            leaves,
        }
    }

    /// The report as indented JSON with a final line break.
    ///
    /// # Errors
    /// When it cannot be serialized, which no report of this crate causes.
    pub fn to_json(&self) -> Result<String, EstimateError> {
        serde_json::to_string_pretty(self).map(|text| text + "\n").map_err(EstimateError::Json)
    }
}

/// A quotient rounded to thousandths.
fn quotient(value: u64, unit: u64) -> f64 {
    let thousandths = (value * 1000 + unit / 2) / unit;
    f64::from(u32::try_from(thousandths).unwrap_or(u32::MAX)) / 1000.0
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A report with round figures, for the tests of its renderings.
    pub(crate) fn example(regions: u64) -> Report {
        let rpu = Area {
            lut_logic_low: 90,
            lut_logic_high: 120,
            lut_memory: 40,
            lut_memory_packed: 32,
            lut_total: 160,
            lut_total_packed: 152,
            ff: 80,
            carry: 12,
            dsp: 0,
            bram18: 1,
            uram: 0,
        };
        let glue = Area {
            lut_logic_low: 2,
            lut_logic_high: 3,
            lut_total: 3,
            lut_total_packed: 3,
            ..Area::default()
        };
        let tool = ToolRecord {
            name: "Yosys".into(),
            version: "Yosys 0.23".into(),
            flags: "synth_xilinx".into(),
        };
        let leaf = |module: &str, parameters: &[&str], instances| LeafArea {
            module: module.into(),
            parameters: parameters.iter().map(|&text| text.to_owned()).collect(),
            instances,
            area: rpu,
        };
        let leaves = vec![leaf("rpu", &[], 1), leaf("median", &["WIDTH=8", "SIDE=8"], 2)];
        let areas = Areas { unit: rpu, glue, array: rpu.times(regions).plus(glue) };
        let path = LogicPath {
            levels: 3,
            carry4: 2,
            from: "slot_q[1]".into(),
            to: "count_q[0] (FDRE.D)".into(),
            through: ["LUT6", "CARRY4", "CARRY4", "LUT2"].map(str::to_owned).to_vec(),
        };
        let paths = Paths { rpu: path.clone(), rcm: path };
        let rtl = Rtl { sha256: "00".into(), rpu_sha256: "01".into() };
        Report::new(tool, rtl, regions, areas, paths, leaves)
    }

    #[test]
    fn the_paper_is_set_beside() {
        let report = example(784);
        assert_eq!(report.rcm.lut_total, 784 * 160 + 3);
        assert!((report.paper.rpu.ratio.lut_total - 0.874).abs() < 1e-9);
        assert!((report.share.lut - 10.611).abs() < 1e-9, "{}", report.share.lut);
        assert!(report.paper.rcm.is_some());
        assert!(example(4).paper.rcm.is_none());
    }

    #[test]
    fn json_reads_back() {
        let report = example(784);
        let json = report.to_json().unwrap();
        assert!(json.contains("\"format_version\": 1"));
        assert_eq!(serde_json::from_str::<Report>(&json).unwrap(), report);
    }
}
