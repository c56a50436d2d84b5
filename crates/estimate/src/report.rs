// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report: areas, shares of the device, and the comparison with the paper.

use serde::{Deserialize, Serialize};

use super::speed::ClockEstimate;
use crate::area::Area;
use crate::bus::BusArea;
use crate::device::{DeviceShare, FpgaDevice};
use crate::logic_levels::LogicPath;
use crate::paper::{PAPER_RCM, PAPER_REGIONS, PAPER_RPU, PaperComparison, PaperReport};
use crate::speed::FrameRate;
use foveate_tools::ToolRecord;

/// The version of the JSON report. It grows when a field changes its meaning or is removed.
pub const FORMAT_VERSION: u32 = 1;

/// The area of a leaf module that was synthesized separately.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeafArea {
    /// The name of the module.
    pub module: String,
    /// The parameters as `NAME=VALUE`.
    pub parameters: Vec<String>,
    /// The number of instances in the module whose leaves are listed.
    pub instances: u64,
    /// The area of one instance, without the modules inside it.
    pub area: Area,
}

/// The longest paths, in logic levels.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LongestPaths {
    /// The longest path of one RPU or lane alone, from and to its ports, too.
    pub rpu: LogicPath,
    /// The longest path of the RCM, through RPUs and lanes.
    pub rcm: LogicPath,
}

/// The longest paths, and the clock estimated from the slowest path.
#[derive(Debug, Clone, Default)]
pub(crate) struct MeasuredTiming {
    pub(crate) paths: LongestPaths,
    pub(crate) clock: Option<ClockEstimate>,
    pub(crate) clocks_per_frame: u64,
}

#[derive(Debug, Clone, Default)]
pub(crate) struct MeasuredAreas {
    pub(crate) unit: Area,
    pub(crate) glue: Area,
    pub(crate) array: Area,
    pub(crate) bus: Option<BusArea>,
}

/// The name and number of the units of an array.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct UnitCount {
    pub(crate) name: String,
    pub(crate) count: u64,
}

/// The hashes of the synthesized RTL.
#[derive(Debug, Clone, Default)]
pub(crate) struct RtlHashes {
    pub(crate) sha256: String,
    pub(crate) rpu_sha256: String,
}

/// The area of a design, with its paths, clock and speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AreaReport {
    /// The version of the format, [`FORMAT_VERSION`].
    pub format_version: u32,
    /// The tool that made the figures.
    pub tool: ToolRecord,
    /// The hash of the RTL: that of the output of `sha256sum` over all files in the order of their
    /// names. A co-simulation of the whole array reports the same hash.
    pub rtl_sha256: String,
    /// The hash of the RTL of one RPU. A co-simulation of one RPU reports the same hash.
    pub rpu_sha256: String,
    /// The device that the shares refer to.
    pub device: FpgaDevice,
    /// The number of regions.
    pub regions: u64,
    /// The name of the unit: `RPU`, one per region, or `lane`.
    pub unit: String,
    /// The number of units.
    pub units: u64,
    /// The area of one RPU or lane, with its leaves flattened.
    pub rpu: Area,
    /// The area of the RCM without its RPUs or lanes.
    pub rcm_glue: Area,
    /// The area of the RCM: glue and all RPUs or lanes.
    pub rcm: Area,
    /// The area of the core on AXI, with the RCM inside; `None` without a bus.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bus: Option<BusArea>,
    /// The longest paths.
    pub paths: LongestPaths,
    /// The clock that the RCM, or the core on AXI, is expected to reach; `None` if it has no logic
    /// between registers.
    #[serde(default)]
    pub clock: Option<ClockEstimate>,
    /// The clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// The frames per second at the estimated clock or at a given one; `None` without a clock.
    pub speed: Option<FrameRate>,
    /// The share of the device that the RCM, or the core on AXI, takes.
    pub share: DeviceShare,
    /// The comparison with the paper's table.
    pub paper: PaperReport,
    /// The leaves of an RPU, of the array or of the core on AXI, and the module's own glue; empty
    /// unless requested. Their sum differs from the whole, because logic is optimized across
    /// leaves.
    pub leaves: Vec<LeafArea>,
}

impl AreaReport {
    /// Makes a report from the measured areas, with the shares of the device and the comparison
    /// with the paper.
    pub(crate) fn new(
        tool: ToolRecord,
        rtl: RtlHashes,
        regions: u64,
        units: UnitCount,
        areas: MeasuredAreas,
        timing: MeasuredTiming,
        leaves: Vec<LeafArea>,
    ) -> Self {
        let device = FpgaDevice::xcvu9p();
        let MeasuredAreas { unit, glue, array, bus } = areas;
        let MeasuredTiming { paths, clock, clocks_per_frame } = timing;
        let share = DeviceShare::new(bus.as_ref().map_or(&array, |bus| &bus.whole), &device);
        let paper = PaperReport {
            rpu: PaperComparison::new(&unit, PAPER_RPU),
            rcm: (regions == PAPER_REGIONS).then(|| PaperComparison::new(&array, PAPER_RCM)),
        };
        Self {
            format_version: FORMAT_VERSION,
            tool,
            rtl_sha256: rtl.sha256,
            rpu_sha256: rtl.rpu_sha256,
            device,
            regions,
            unit: units.name,
            units: units.count,
            rpu: unit,
            rcm_glue: glue,
            rcm: array,
            bus,
            paths,
            speed: clock
                .as_ref()
                .map(|clock| FrameRate::at_estimated_clock(clock, clocks_per_frame)),
            clock,
            clocks_per_frame,
            share,
            paper,
            leaves,
        }
    }

    /// Returns the area of the whole design: the core on AXI, else the RCM.
    #[must_use]
    pub fn whole_area(&self) -> &Area {
        self.bus.as_ref().map_or(&self.rcm, |bus| &bus.whole)
    }

    /// Returns the logic levels of the longest of all paths.
    #[must_use]
    pub fn levels(&self) -> u32 {
        let bus = self.bus.as_ref().map_or(0, |bus| bus.path.levels);
        self.paths.rcm.levels.max(self.paths.rpu.levels).max(bus)
    }

    /// Returns the report with the frames per second at a clock in MHz, if one is given.
    #[must_use]
    pub fn with_clock(mut self, mhz: Option<f64>) -> Self {
        let given = mhz.map(|mhz| FrameRate::at_given_clock(mhz, self.clocks_per_frame));
        self.speed = given.or(self.speed);
        self
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::bus::PartArea;

    /// Returns a report with round figures, for the tests of its renderings.
    pub(crate) fn example(regions: u64) -> AreaReport {
        example_of_units(regions, UnitCount { name: "RPU".into(), count: regions }, None)
    }

    pub(crate) fn serial_example(regions: u64, lanes: u64) -> AreaReport {
        example_of_units(regions, UnitCount { name: "lane".into(), count: lanes }, None)
    }

    /// Returns a report of a core on AXI.
    pub(crate) fn bus_example() -> AreaReport {
        let area = |lut_total| Area { lut_total, lut_total_packed: lut_total, ..Area::default() };
        let part = |name: &str, modules: &[&str], luts| PartArea {
            name: name.into(),
            modules: modules.iter().map(|&module| module.to_owned()).collect(),
            area: area(luts),
        };
        let bus = BusArea {
            module: "rcm_axi".into(),
            rtl_sha256: "02".into(),
            whole: area(1_404),
            parts: vec![part("registers", &["axi_registers"], 205), part("rest", &["rcm_axi"], 9)],
            path: LogicPath { levels: 7, ..LogicPath::default() },
        };
        let mut report =
            example_of_units(32_400, UnitCount { name: "core".into(), count: 1 }, Some(bus));
        report.leaves[0].module = "rcm_axi".into();
        report
    }

    fn example_of_units(regions: u64, units: UnitCount, bus: Option<BusArea>) -> AreaReport {
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
        let areas =
            MeasuredAreas { unit: rpu, glue, array: rpu.multiplied(units.count).plus(glue), bus };
        let path = LogicPath {
            levels: 3,
            carry4: 2,
            from: "slot_q[1]".into(),
            to: "count_q[0] (FDRE.D)".into(),
            through: ["LUT6", "CARRY4", "CARRY4", "LUT2"].map(str::to_owned).to_vec(),
        };
        let paths = LongestPaths { rpu: path.clone(), rcm: path.clone() };
        let clock =
            ClockEstimate { mhz: 60.0, low_mhz: 48.0, high_mhz: 80.0, wiring_share: 0.65, path };
        let timing = MeasuredTiming { paths, clock: Some(clock), clocks_per_frame: 64 };
        let rtl = RtlHashes { sha256: "00".into(), rpu_sha256: "01".into() };
        AreaReport::new(tool, rtl, regions, units, areas, timing, leaves)
    }

    #[test]
    fn the_report_compares_with_the_paper() {
        let report = example(784);
        assert_eq!(report.rcm.lut_total, 784 * 160 + 3);
        assert!((report.paper.rpu.ratio.lut_total - 0.874).abs() < 1e-9);
        assert!((report.share.lut - 10.611).abs() < 1e-9, "{}", report.share.lut);
        assert!(report.paper.rcm.is_some());
        assert!(example(4).paper.rcm.is_none());
    }

    #[test]
    fn json_reads_back() {
        for report in [example(784), bus_example()] {
            let json = serde_json::to_string_pretty(&report).unwrap();
            assert!(json.contains("\"format_version\": 1"));
            assert_eq!(json.contains("\"bus\""), report.bus.is_some());
            assert_eq!(serde_json::from_str::<AreaReport>(&json).unwrap(), report);
        }
    }

    #[test]
    fn the_whole_area_includes_the_bus() {
        let (array, on_bus) = (example(4), bus_example());
        assert_eq!((array.whole_area(), array.levels()), (&array.rcm, 3));
        assert_eq!((on_bus.whole_area().lut_total, on_bus.levels()), (1_404, 7));
    }
}
