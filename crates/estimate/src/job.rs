// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drives Yosys: one run for RPU and RCM, one for the leaves, side by side.

use std::thread;

use foveate_toolchain::yosys::{self, YosysJob, YosysRun};
use foveate_toolchain::{Cache, Source, Tool, ToolError, Toolchain, sha256_hex};

use crate::error::EstimateError;
use crate::leaves::leaf_areas;
use crate::netlist::Netlist;
use crate::report::{Report, ToolRecord};

const SYNTHESIS: &str = "synth_xilinx -family xcup -abc9 -noiopad -noclkbuf";
const NETLIST: &str = "netlist.json";

/// A design to estimate.
#[derive(Debug, Clone)]
pub struct EstimateJob {
    /// The Verilog files; headers for `` `include `` may be among them if they end in `.vh`.
    pub sources: Vec<Source>,
    /// The module of one RPU, without parameters.
    pub rpu_top: String,
    /// The module of the array, without parameters.
    pub rcm_top: String,
    /// The number of regions, each with one RPU.
    pub regions: u64,
}

/// Synthesizes the design and reports its area.
///
/// # Errors
/// When Yosys is missing or refuses the design, when a cell is not known, or when the array has not
/// as many RPUs as there are regions.
pub fn estimate(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &EstimateJob,
) -> Result<Report, EstimateError> {
    let version = toolchain.find(Tool::Yosys)?.banner;
    let (array, leaves) = thread::scope(|scope| {
        let leaves = scope.spawn(|| yosys::run(toolchain, cache, &job.leaves()));
        let array = yosys::run(toolchain, cache, &job.array());
        let leaves = leaves.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        Ok::<_, ToolError>((array?, leaves?))
    })?;
    let array = netlist(&array)?;
    job.check_regions(&array)?;
    Ok(Report::new(
        ToolRecord {
            name: "Yosys".into(),
            version,
            flags: format!("{SYNTHESIS} -flatten; RPU kept as a module"),
        },
        job.rtl_sha256(),
        job.regions,
        array.whole_area(&job.rpu_top, None)?,
        array.whole_area(&job.rcm_top, Some(&job.rpu_top))?,
        leaf_areas(&job.rpu_top, &netlist(&leaves)?)?,
    ))
}

impl EstimateJob {
    /// The array, with the leaves flattened into the RPU but not the RPU into the array.
    fn array(&self) -> YosysJob {
        let Self { rpu_top, rcm_top, .. } = self;
        self.script(&format!(
            "hierarchy -check -top {rcm_top}\n\
             setattr -mod -set keep_hierarchy 1 {rpu_top}\n\
             {SYNTHESIS} -flatten -top {rcm_top}\n"
        ))
    }

    /// The RPU with its leaves apart.
    fn leaves(&self) -> YosysJob {
        let top = &self.rpu_top;
        self.script(&format!("hierarchy -check -top {top}\n{SYNTHESIS} -top {top}\n"))
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

    fn check_regions(&self, netlist: &Netlist) -> Result<(), EstimateError> {
        netlist.module(&self.rpu_top)?;
        let instances = netlist.instances(&self.rcm_top, Some(&self.rpu_top))?;
        let found = instances.get(&self.rpu_top).copied().unwrap_or_default();
        if found == self.regions {
            return Ok(());
        }
        Err(EstimateError::RegionCount {
            rcm: self.rcm_top.clone(),
            rpu: self.rpu_top.clone(),
            expected: self.regions,
            found,
        })
    }

    /// The hash of what `sha256sum` prints for all files in the order of their names.
    fn rtl_sha256(&self) -> String {
        let mut lines: Vec<(&str, String)> = self
            .sources
            .iter()
            .map(|(name, text)| (name.as_str(), format!("{}  {name}\n", sha256_hex(text))))
            .collect();
        lines.sort();
        sha256_hex(lines.into_iter().map(|(_, line)| line).collect::<String>())
    }
}

fn netlist(run: &YosysRun) -> Result<Netlist, EstimateError> {
    Netlist::parse(NETLIST, run.files.get(NETLIST).map(Vec::as_slice).unwrap_or_default())
}
