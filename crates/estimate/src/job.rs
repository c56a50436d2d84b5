// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives Yosys: one run for unit and array, one for the leaves, side by side.

use std::collections::BTreeSet;
use std::sync::atomic::Ordering;
use std::thread;

use foveate_toolchain::yosys::{self, YosysJob, YosysRun};
use foveate_toolchain::{Cache, Source, Tool, ToolError, Toolchain, sources_sha256};

use crate::clock::ClockEstimate;
use crate::error::EstimateError;
use crate::leaves::leaf_areas;
use crate::levels::{Library, longest_paths};
use crate::netlist::Netlist;
use crate::report::{Areas, Paths, Report, Rtl, Timing, ToolRecord, Units};

const SYNTHESIS: &str = "synth_xilinx -family xcup -abc9 -nosrl -noiopad -noclkbuf";
/// Shift registers, which `synth_xilinx` would make in the middle. Yosys up to 0.67 loses their enable
/// (<https://github.com/YosysHQ/yosys/issues/6058>): it notes that there is none, next to its net. What
/// was a chain of FDRE has an enable, active high.
const SHIFT_REGISTERS: &str = "xilinx_srl -fixed -minlen 3\n\
    setparam -set ENPOL 1 t:$__XILINX_SHREG_\n\
    techmap -map +/xilinx/cells_map.v\n\
    clean\n";
const NETLIST: &str = "netlist.json";
const VERILOG: &str = "netlist.v";

/// A design to estimate.
#[derive(Debug, Clone)]
pub struct EstimateJob {
    /// The Verilog files; headers for `` `include `` may be among them if they end in `.vh`.
    pub sources: Vec<Source>,
    /// The module of which the array has many, an RPU or a lane. Its leaves are flattened into it. If
    /// it has parameters, its Verilog must have the attribute `keep_hierarchy`.
    pub unit: String,
    /// What people call it: `RPU` or `lane`.
    pub unit_name: String,
    /// How many of it the array has.
    pub units: u64,
    /// The module of the array.
    pub array: String,
    /// Its parameters and their values.
    pub parameters: Vec<(String, u32)>,
    /// The number of regions.
    pub regions: u64,
    /// Clocks from one frame to the next, for frames per second.
    pub clocks_per_frame: u64,
    /// The hash of the RTL of one RPU, as a co-simulation of it says it; see [`sources_sha256`].
    pub rpu_sha256: String,
    /// The module whose leaves are listed, if any.
    pub leaves_of: Option<String>,
}

/// The netlist of an array, as it is counted and as Verilog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Synthesis {
    /// What made it.
    pub tool: ToolRecord,
    /// The netlist as JSON.
    pub json: Vec<u8>,
    /// The same netlist as Verilog: a module for the array, and one for the unit.
    pub verilog: String,
}

impl Synthesis {
    /// The types of all primitive cells.
    ///
    /// # Errors
    /// When the netlist is not understood.
    pub fn cells(&self) -> Result<BTreeSet<String>, EstimateError> {
        Ok(Netlist::parse(NETLIST, &self.json)?.cell_types())
    }
}

/// Synthesizes the design and reports its area and its longest paths.
///
/// # Errors
/// When Yosys is missing or refuses the design, when a cell is not known, when logic runs in a circle,
/// or when the array has not as many units as it should.
pub fn estimate(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &EstimateJob,
) -> Result<Report, EstimateError> {
    let (synthesis, leaves) = thread::scope(|scope| {
        let leaves = scope.spawn(|| {
            let run = |top: &String| yosys::run(toolchain, cache, &job.leaves(top));
            job.leaves_of.as_ref().map(run).transpose()
        });
        let synthesis = job.synthesize(toolchain, cache);
        let leaves = leaves.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        Ok::<_, EstimateError>((synthesis?, leaves?))
    })?;
    // A netlist of many regions takes seconds to be read.
    let go_on = || match toolchain.cancel_flag().load(Ordering::Relaxed) {
        true => Err(EstimateError::Tool(ToolError::Interrupted)),
        false => Ok(()),
    };
    go_on()?;
    let netlist = Netlist::parse(NETLIST, &synthesis.json)?;
    go_on()?;
    let units = job.units(&netlist)?;
    let without: Vec<&str> = units.iter().map(String::as_str).collect();
    let paths = longest_paths(NETLIST, &synthesis.json, &[without[0], &job.array])?;
    go_on()?;
    let clock = ClockEstimate::of(NETLIST, &synthesis.json, &job.array, Library::Xilinx)?;
    go_on()?;
    let [unit, array] = paths.try_into().expect("a path for each of the two modules");
    Ok(Report::new(
        synthesis.tool,
        Rtl { sha256: sources_sha256(&job.sources), rpu_sha256: job.rpu_sha256.clone() },
        job.regions,
        Units { name: job.unit_name.clone(), count: job.units },
        Areas {
            unit: netlist.whole_area(without[0], &[])?,
            glue: netlist.whole_area(&job.array, &without)?,
            array: netlist.whole_area(&job.array, &[])?,
        },
        Timing {
            paths: Paths { rpu: unit, rcm: array },
            clock,
            clocks_per_frame: job.clocks_per_frame,
        },
        match (&job.leaves_of, leaves) {
            (Some(top), Some(run)) => {
                leaf_areas(top, &Netlist::parse(NETLIST, file(&run, NETLIST))?)?
            }
            _ => Vec::new(),
        },
    ))
}

impl EstimateJob {
    /// Synthesizes the array with the unit kept as a module: the leaves are flattened into the unit
    /// but not the unit into the array. This is the netlist that [`estimate`] counts.
    ///
    /// # Errors
    /// When Yosys is missing or refuses the design.
    pub fn synthesize(
        &self,
        toolchain: &Toolchain,
        cache: &Cache,
    ) -> Result<Synthesis, EstimateError> {
        let version = toolchain.find(Tool::Yosys)?.banner;
        let mut run = yosys::run(toolchain, cache, &self.whole())?;
        let verilog = run.files.remove(VERILOG).expect("it is one of the wanted files");
        Ok(Synthesis {
            tool: ToolRecord {
                name: "Yosys".into(),
                version,
                flags: format!(
                    "{SYNTHESIS} -flatten, then xilinx_srl; {} kept as a module",
                    self.unit
                ),
            },
            json: run.files.remove(NETLIST).expect("it is one of the wanted files"),
            verilog: String::from_utf8_lossy(&verilog).into_owned(),
        })
    }

    fn whole(&self) -> YosysJob {
        let Self { unit, array, .. } = self;
        let set = |(name, value): &(String, u32)| format!(" -set {name} {value}");
        let parameters: String = self.parameters.iter().map(set).collect();
        let parameters = match parameters.as_str() {
            "" => String::new(),
            set => format!("chparam{set} {array}\n"),
        };
        // A unit with parameters has another name by now, and its attribute from its Verilog.
        let mut job = self.script(&format!(
            "{parameters}hierarchy -check -top {array}\n\
             setattr -mod -set keep_hierarchy 1 {unit}\n\
             {SYNTHESIS} -flatten -top {array}\n\
             {SHIFT_REGISTERS}"
        ));
        job.script += &format!("write_verilog -noattr {VERILOG}\n");
        job.outputs.push(VERILOG.to_owned());
        job
    }

    /// A module with its leaves apart.
    fn leaves(&self, top: &str) -> YosysJob {
        self.script(&format!(
            "hierarchy -check -top {top}\n{SYNTHESIS} -top {top}\n{SHIFT_REGISTERS}"
        ))
    }

    /// Reads the sources, synthesizes, and writes the netlist without the library of cells.
    fn script(&self, synthesis: &str) -> YosysJob {
        let script = format!(
            "{}{synthesis}delete =A:blackbox =A:whitebox\nwrite_json {NETLIST}\n",
            self.read()
        );
        YosysJob { sources: self.sources.clone(), script, outputs: vec![NETLIST.to_owned()] }
    }

    fn read(&self) -> String {
        let names = self.sources.iter().map(|(name, _)| name).filter(|name| !name.ends_with(".vh"));
        names.map(|name| format!("read_verilog -I. {name}\n")).collect()
    }

    /// The modules that are the unit, the most frequent first: one for each set of parameters.
    fn units(&self, netlist: &Netlist) -> Result<Vec<String>, EstimateError> {
        let mut found = Vec::new();
        for (name, count) in netlist.instances(&self.array, &[])? {
            if netlist.module(&name)?.source_name == self.unit {
                found.push((count, name));
            }
        }
        found.sort_by(|a, b| b.cmp(a));
        let total = found.iter().map(|(count, _)| count).sum::<u64>();
        if total == 0 {
            netlist.module(&self.unit)?;
        }
        if total == self.units && total > 0 {
            return Ok(found.into_iter().map(|(_, name)| name).collect());
        }
        Err(EstimateError::UnitCount {
            array: self.array.clone(),
            unit: self.unit.clone(),
            expected: self.units,
            found: total,
        })
    }
}

fn file<'a>(run: &'a YosysRun, name: &str) -> &'a [u8] {
    run.files.get(name).expect("it is one of the wanted files")
}
