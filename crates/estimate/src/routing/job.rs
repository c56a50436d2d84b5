// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs Yosys once for each family of devices, and nextpnr once for each device and seed.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use foveate_design::Design;
use foveate_emit::{AXI_CLOCK, AXI_TOP, Parameter, Top, axi_modules};
use foveate_tools::{
    Cache, Source, Tool, ToolError, Toolchain,
    nextpnr::{self, NextpnrJob},
    sources_sha256,
    yosys::{self, YosysJob},
};

use super::device::{DeviceFamily, RouteDevice};
use super::netlist;
use super::netlist::{ModuleHierarchy, PlacementNetlist};
use super::nextpnr_report::NextpnrReport;
use super::report::{
    ClockStatistics, DeviceResult, PlacementResult, ROUTE_FORMAT_VERSION, ResourceUse, RouteReport,
    SourceNames,
};
use super::shortage::resource_shortages;
use crate::error::EstimateError;
use crate::estimate_job::{sources, sources_of_files};
use crate::logic_levels::CellLibrary;
use crate::speed::ClockEstimate;
use foveate_tools::ToolRecord;

const NETLIST: &str = "netlist.json";
const HIERARCHY: &str = "hierarchy.json";
/// The number of concurrent placements: each takes a processor and up to a gigabyte.
const CONCURRENT_PLACEMENTS: usize = 2;

/// A design to place and route.
#[derive(Debug, Clone)]
pub struct RouteJob {
    /// The Verilog files.
    pub sources: Vec<Source>,
    /// The top module.
    pub top: String,
    /// The clock port of the top.
    pub clock: &'static str,
    /// The parameters of the top and their values.
    pub parameters: Vec<Parameter>,
    /// The number of seeds, which count from 1.
    pub seeds: u32,
    /// True to ignore the family's own memories, which the Verilog uses where the macro of the
    /// family is defined.
    pub is_portable: bool,
}

impl RouteJob {
    /// Makes a job for the whole array of a design, or for its smallest core.
    #[must_use]
    pub fn of(design: &Design, top: Top, seeds: u32, is_portable: bool) -> Self {
        Self {
            sources: sources(design, top),
            top: top.module().to_owned(),
            clock: "clk_i",
            parameters: top.parameters(design),
            seeds,
            is_portable,
        }
    }

    /// Makes a job for the whole core of a design on AXI; `None` for a design with ports only.
    #[must_use]
    pub fn for_axi_core(design: &Design, seeds: u32, is_portable: bool) -> Option<Self> {
        Some(Self {
            sources: sources_of_files(axi_modules(design)?),
            top: AXI_TOP.to_owned(),
            clock: AXI_CLOCK,
            parameters: Vec::new(),
            seeds,
            is_portable,
        })
    }

    /// Returns the synthesis of the whole design as one module, so that placement crosses all
    /// borders. The family's synthesis checks that all modules are present, because it knows its
    /// cells.
    fn synthesis(&self, family: DeviceFamily) -> YosysJob {
        let Self { top, .. } = self;
        let define = family.memory_macro().filter(|_| !self.is_portable);
        let define = define.map_or_else(String::new, |name| format!("-D{name} "));
        let read = |(name, _): &Source| format!("read_verilog {define}-I. {name}\n");
        let read = self.sources.iter().map(read);
        let set = self.parameters.iter().map(|(name, value)| format!(" -set {name} {value}"));
        let set = match set.collect::<String>() {
            none if none.is_empty() => none,
            set => format!("chparam{set} {top}\n"),
        };
        let memories = match family.has_distributed_ram() {
            true => "",
            false => "setattr -unset ram_style */m:*\n",
        };
        let script = format!(
            "{}{set}hierarchy -top {top}\n\
             proc\n\
             write_json {HIERARCHY}\n\
             {memories}setattr -mod -unset keep_hierarchy *\n\
             {} -top {top}\n\
             write_json {NETLIST}\n",
            read.collect::<String>(),
            family.synthesis_command(),
        );
        let outputs = [NETLIST, HIERARCHY].map(str::to_owned).to_vec();
        YosysJob { sources: self.sources.clone(), script, outputs }
    }
}

/// A design synthesized for a device, ready to be placed.
struct SynthesizedDesign {
    device: &'static RouteDevice,
    netlist: PlacementNetlist,
    hierarchy: ModuleHierarchy,
    json: Vec<u8>,
    clock: &'static str,
    port_ff: u64,
}

/// Places and routes a design on each of the devices, once per seed. A device that is too small is
/// part of the report.
///
/// # Errors
/// Fails if a tool is missing or fails, or if its output cannot be read.
pub fn place_and_route(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &RouteJob,
    devices: &[&'static RouteDevice],
) -> Result<RouteReport, EstimateError> {
    let synthesize =
        |&device: &&'static RouteDevice| SynthesizedDesign::new(toolchain, cache, job, device);
    let designs = devices.iter().map(synthesize).collect::<Result<Vec<_>, _>>()?;
    let runs: Vec<_> =
        designs.iter().flat_map(|design| (1..=job.seeds).map(move |seed| (design, seed))).collect();
    let outcomes = in_parallel(&runs, |(design, seed)| design.place(toolchain, cache, *seed));
    let mut outcomes = outcomes.into_iter();
    let synthesizer = toolchain.find(Tool::Yosys)?.banner;
    let devices = designs.iter().map(|design| {
        let outcomes = outcomes.by_ref().take(job.seeds as usize).collect();
        let router = toolchain.find(design.device.tool())?.banner;
        design.device_result(&job.top, [synthesizer.clone(), router], outcomes)
    });
    Ok(RouteReport {
        format_version: ROUTE_FORMAT_VERSION,
        top: job.top.clone(),
        rtl_sha256: sources_sha256(&job.sources),
        devices: devices.collect::<Result<_, _>>()?,
    })
}

impl SynthesizedDesign {
    fn new(
        toolchain: &Toolchain,
        cache: &Cache,
        job: &RouteJob,
        device: &'static RouteDevice,
    ) -> Result<Self, EstimateError> {
        // The place-and-route program is checked first, because the synthesis takes minutes.
        toolchain.find(device.tool())?;
        let (major, minor, needed) = device.family.oldest_yosys();
        let found = toolchain.find(Tool::Yosys)?;
        if let Some(version) = found.version.filter(|found| !found.is_at_least(major, minor)) {
            let (device, found) = (device.name, version.to_string());
            return Err(EstimateError::OldYosys { device, found, needed });
        }
        let run = yosys::run(toolchain, cache, &job.synthesis(device.family))?;
        let file =
            |name: &str| run.files.get(name).expect("it is one of the wanted files").as_slice();
        let hierarchy = ModuleHierarchy::parse(HIERARCHY, file(HIERARCHY))?;
        let (netlist, json, port_ff) =
            placement_netlist(file(NETLIST), &job.top, job.clock, device.family)?;
        Ok(Self { device, netlist, hierarchy, json, clock: job.clock, port_ff })
    }

    fn place(&self, toolchain: &Toolchain, cache: &Cache, seed: u32) -> Result<Vec<u8>, ToolError> {
        let job = NextpnrJob {
            tool: self.device.tool(),
            args: self.device.arguments(),
            seed,
            netlist: self.json.clone(),
            extra_file: self.device.family.pin_file(self.clock),
        };
        nextpnr::run(toolchain, cache, &job)
    }

    /// Combines the results of all seeds on one device.
    fn device_result(
        &self,
        top: &str,
        [synthesizer, router]: [String; 2],
        outcomes: Vec<Result<Vec<u8>, ToolError>>,
    ) -> Result<DeviceResult, EstimateError> {
        let mut reports = Vec::new();
        let mut shortages = Vec::new();
        for outcome in outcomes {
            match outcome {
                Ok(report) => reports.push(NextpnrReport::parse(&report)?),
                Err(ToolError::Failed { full, .. }) if !resource_shortages(&full).is_empty() => {
                    shortages = resource_shortages(&full);
                }
                Err(error) => return Err(error.into()),
            }
        }
        let tool = |name: &str, version, flags| ToolRecord { name: name.into(), version, flags };
        Ok(DeviceResult {
            device: self.device.name.to_owned(),
            part: self.device.full_name(),
            synthesis: tool(
                "Yosys",
                synthesizer,
                self.device.family.synthesis_command().to_owned(),
            ),
            route: tool("nextpnr", router, self.device.arguments().join(" ")),
            placed: if shortages.is_empty() {
                Some(self.placement_result(top, &reports)?)
            } else {
                None
            },
            over: shortages,
        })
    }

    fn placement_result(
        &self,
        top: &str,
        reports: &[NextpnrReport],
    ) -> Result<PlacementResult, EstimateError> {
        let seeds = reports.iter().map(NextpnrReport::fmax_mhz).collect::<Result<Vec<_>, _>>()?;
        let no_seeds =
            || EstimateError::UnreadableReport { reason: "no seed gave a report".to_owned() };
        let (fmax, median) = ClockStatistics::of(seeds).ok_or_else(no_seeds)?;
        let report = &reports[median];
        let names = SourceNames { top, netlist: &self.netlist, hierarchy: &self.hierarchy };
        let used = |place: &str| {
            let (used, available) = report.utilization_of(place);
            ResourceUse { used, available }
        };
        let without_ports =
            |all: ResourceUse| ResourceUse { used: all.used.saturating_sub(self.port_ff), ..all };
        let (logic, ff, block_ram, spram, dsp) = match self.device.family {
            DeviceFamily::Ecp5 => (
                used("TRELLIS_COMB"),
                without_ports(used("TRELLIS_FF")),
                used("DP16KD"),
                ResourceUse::default(),
                used("MULT18X18D"),
            ),
            DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx => {
                let cells = used("ICESTORM_LC");
                let ff = ResourceUse { used: self.netlist.count_cells("SB_DFF"), ..cells };
                let [ram, spram, dsp] =
                    ["ICESTORM_RAM", "ICESTORM_SPRAM", "ICESTORM_DSP"].map(used);
                (without_ports(cells), without_ports(ff), ram, spram, dsp)
            }
            DeviceFamily::Gowin => (
                used("LUT4"),
                without_ports(used("DFF")),
                used("BSRAM"),
                ResourceUse::default(),
                used("MULT18X18"),
            ),
        };
        Ok(PlacementResult {
            logic,
            ff,
            block_ram,
            spram,
            dsp,
            port_ff: self.port_ff,
            estimate: match self.device.family {
                DeviceFamily::Ecp5 => {
                    ClockEstimate::of(NETLIST, &self.json, top, CellLibrary::Ecp5)?
                }
                DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx | DeviceFamily::Gowin => None,
            },
            fmax,
            critical: report.longest().and_then(|path| names.path(path)),
        })
    }
}

/// Prepares the netlist of Yosys for nextpnr: everything stays unchanged, except that flip-flops
/// replace the ports. Returns the netlist, its file, and the number of these flip-flops.
pub(super) fn placement_netlist(
    json: &[u8],
    top: &str,
    clock: &'static str,
    family: DeviceFamily,
) -> Result<(PlacementNetlist, Vec<u8>, u64), EstimateError> {
    let (mut netlist, creator) = PlacementNetlist::parse(json, top)?;
    let port_ff = netlist::replace_ports(&mut netlist, clock, family)?;
    let json = netlist.to_json(top, creator)?;
    Ok((netlist, json, port_ff))
}

/// Returns the result for each item in order, a few at a time.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    let processors = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..processors.min(CONCURRENT_PLACEMENTS) {
            scope.spawn(|| {
                while let index = next.fetch_add(1, Ordering::Relaxed)
                    && let Some(item) = items.get(index)
                {
                    let result = work(item);
                    results.lock().expect("no thread panics while it pushes").push((index, result));
                }
            });
        }
    });
    let mut results = results.into_inner().expect("no thread panics while it pushes");
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}
