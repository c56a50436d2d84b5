// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report: areas, share of the device, and the paper's figures beside them.

use serde::{Deserialize, Serialize};

use crate::area::Area;
use crate::bus::BusArea;
use crate::clock::ClockEstimate;
use crate::device::{Device, Share};
use crate::error::EstimateError;
use crate::levels::LogicPath;
use crate::paper::{BesidePaper, PAPER_RCM, PAPER_REGIONS, PAPER_RPU, Paper};
use crate::speed::Speed;
use foveate_toolchain::ToolRecord;

/// The version of the JSON report. It grows when a field changes its meaning or goes away.
pub const FORMAT_VERSION: u32 = 1;

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

/// Paths, and the clock that follows from the slowest.
#[derive(Debug, Clone, Default)]
pub(crate) struct Timing {
    pub(crate) paths: Paths,
    pub(crate) clock: Option<ClockEstimate>,
    pub(crate) clocks_per_frame: u64,
}

/// Areas as they are measured.
#[derive(Debug, Clone, Default)]
pub(crate) struct Areas {
    pub(crate) unit: Area,
    pub(crate) glue: Area,
    pub(crate) array: Area,
    pub(crate) bus: Option<BusArea>,
}

/// What the array has many of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Units {
    pub(crate) name: String,
    pub(crate) count: u64,
}

/// What was synthesized.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rtl {
    pub(crate) sha256: String,
    pub(crate) rpu_sha256: String,
}

/// The area of a design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AreaReport {
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
    /// What the array has many of: `RPU`, one per region, or `lane`.
    pub unit: String,
    /// How many of it.
    pub units: u64,
    /// One RPU, or one lane, its leaves flattened.
    pub rpu: Area,
    /// What the RCM has beside its RPUs or lanes.
    pub rcm_glue: Area,
    /// The RCM: glue and all RPUs or lanes.
    pub rcm: Area,
    /// The core on a bus, with the RCM inside; nothing where the RCM is all that there is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bus: Option<BusArea>,
    /// The longest paths.
    pub paths: Paths,
    /// The clock that the RCM, or the core on a bus, is expected to reach; nothing where it has no logic between registers.
    #[serde(default)]
    pub clock: Option<ClockEstimate>,
    /// Clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// Frames per second at the estimated clock, or at one that was given; nothing where there is none.
    pub speed: Option<Speed>,
    /// The share of the device that the RCM, or the core on a bus, takes.
    pub share: Share,
    /// The paper's table.
    pub paper: Paper,
    /// The leaves of an RPU, of the array or of the core on a bus, and its own glue; empty if not asked for. They do not
    /// add up to it, because logic is optimized across leaves.
    pub leaves: Vec<LeafArea>,
}

impl AreaReport {
    /// Puts the measured areas beside device and paper.
    pub(crate) fn new(
        tool: ToolRecord,
        rtl: Rtl,
        regions: u64,
        units: Units,
        areas: Areas,
        timing: Timing,
        leaves: Vec<LeafArea>,
    ) -> Self {
        let device = Device::xcvu9p();
        let Areas { unit, glue, array, bus } = areas;
        let Timing { paths, clock, clocks_per_frame } = timing;
        let share = Share::new(bus.as_ref().map_or(&array, |bus| &bus.whole), &device);
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
            unit: units.name,
            units: units.count,
            rpu: unit,
            rcm_glue: glue,
            rcm: array,
            bus,
            paths,
            speed: clock.as_ref().map(|clock| Speed::estimated(clock, clocks_per_frame)),
            clock,
            clocks_per_frame,
            share,
            paper,
            leaves,
        }
    }

    /// All that the design takes: the core on a bus, else the RCM.
    #[must_use]
    pub fn whole(&self) -> &Area {
        self.bus.as_ref().map_or(&self.rcm, |bus| &bus.whole)
    }

    /// Logic levels of the longest path of all.
    #[must_use]
    pub fn levels(&self) -> u32 {
        let bus = self.bus.as_ref().map_or(0, |bus| bus.path.levels);
        self.paths.rcm.levels.max(self.paths.rpu.levels).max(bus)
    }

    /// The report with frames per second at a clock of so many MHz, if one is given.
    #[must_use]
    pub fn at(mut self, mhz: Option<f64>) -> Self {
        let given = mhz.map(|mhz| Speed::given(mhz, self.clocks_per_frame));
        self.speed = given.or(self.speed);
        self
    }

    /// The report as indented JSON with a final line break.
    ///
    /// # Errors
    /// When it cannot be serialized, which no report of this crate causes.
    pub fn to_json(&self) -> Result<String, EstimateError> {
        serde_json::to_string_pretty(self).map(|text| text + "\n").map_err(EstimateError::Json)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::bus::PartArea;

    /// A report with round figures, for the tests of its renderings.
    pub(crate) fn example(regions: u64) -> AreaReport {
        of_units(regions, Units { name: "RPU".into(), count: regions }, None)
    }

    /// The same as a serial array of `lanes` lanes.
    pub(crate) fn serial_example(regions: u64, lanes: u64) -> AreaReport {
        of_units(regions, Units { name: "lane".into(), count: lanes }, None)
    }

    /// The same as a core on a bus.
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
        let mut report = of_units(32_400, Units { name: "core".into(), count: 1 }, Some(bus));
        report.leaves[0].module = "rcm_axi".into();
        report
    }

    fn of_units(regions: u64, units: Units, bus: Option<BusArea>) -> AreaReport {
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
        let areas = Areas { unit: rpu, glue, array: rpu.times(units.count).plus(glue), bus };
        let path = LogicPath {
            levels: 3,
            carry4: 2,
            from: "slot_q[1]".into(),
            to: "count_q[0] (FDRE.D)".into(),
            through: ["LUT6", "CARRY4", "CARRY4", "LUT2"].map(str::to_owned).to_vec(),
        };
        let paths = Paths { rpu: path.clone(), rcm: path.clone() };
        let clock =
            ClockEstimate { mhz: 60.0, low_mhz: 48.0, high_mhz: 80.0, wiring_share: 0.65, path };
        let timing = Timing { paths, clock: Some(clock), clocks_per_frame: 64 };
        let rtl = Rtl { sha256: "00".into(), rpu_sha256: "01".into() };
        AreaReport::new(tool, rtl, regions, units, areas, timing, leaves)
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
        for report in [example(784), bus_example()] {
            let json = report.to_json().unwrap();
            assert!(json.contains("\"format_version\": 1"));
            assert_eq!(json.contains("\"bus\""), report.bus.is_some());
            assert_eq!(serde_json::from_str::<AreaReport>(&json).unwrap(), report);
        }
    }

    #[test]
    fn what_a_design_takes_is_all_of_it() {
        let (array, on_bus) = (example(4), bus_example());
        assert_eq!((array.whole(), array.levels()), (&array.rcm, 3));
        assert_eq!((on_bus.whole().lut_total, on_bus.levels()), (1_404, 7));
    }
}
