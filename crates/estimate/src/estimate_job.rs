// SPDX-License-Identifier: MIT OR Apache-2.0
//! An estimate and the runs of Yosys that it takes ([`EstimateJob`]): one for unit and array,
//! one for a core on AXI, and one for the leaves, in parallel ([`estimate`]).

use super::speed::ClockEstimate;
use crate::bus::BusArea;
use crate::error::EstimateError;
use crate::leaf_areas::leaf_areas;
use crate::logic_levels::{CellLibrary, longest_paths};
use crate::netlist::{AreaNetlist, NETLIST};
use crate::report::{
    AreaReport, LongestPaths, MeasuredAreas, MeasuredTiming, RtlHashes, UnitCount,
};
use foveate_design::Design;
use foveate_emit::{AXI_TOP, SourceFile, Top, axi_modules};
use foveate_tools::{
    Cache, Source, SynthesisJob, SynthesisResult, ToolError, Toolchain, sources_sha256,
};
use std::sync::atomic::Ordering;
use std::thread;

/// A design to estimate.
#[derive(Debug, Clone)]
pub struct EstimateJob {
    /// The synthesis of the array and its unit.
    pub synthesis: SynthesisJob,
    /// The synthesis of the core on AXI, with that array inside; `None` for an array with ports
    /// only.
    pub bus: Option<SynthesisJob>,
    /// The name of the unit in reports: `RPU` or `lane`.
    pub unit_name: String,
    /// The number of units in the array.
    pub units: u64,
    /// The number of regions.
    pub regions: u64,
    /// The clocks from one frame to the next, for frames per second.
    pub clocks_per_frame: u64,
    /// The hash of the RTL of one RPU, as a co-simulation of it reports; see [`sources_sha256`].
    pub rpu_sha256: String,
    /// The module whose leaves are listed, if any.
    pub leaves_of: Option<String>,
}

/// Synthesizes the design and reports its area and its longest paths.
///
/// # Errors
/// Fails if Yosys is missing or rejects the design, if a cell is not known, if there is a
/// combinational loop, or if the number of units in the array differs from that of the design.
pub fn estimate(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &EstimateJob,
) -> Result<AreaReport, EstimateError> {
    let (synthesis, bus, leaves) = thread::scope(|scope| {
        let leaves = scope.spawn(|| {
            let run = |top: &String| job.top_synthesis().run_hierarchical(top, toolchain, cache);
            job.leaves_of.as_ref().map(run).transpose()
        });
        let synthesis = job.synthesis.run(toolchain, cache);
        let bus = job.bus.as_ref().map(|bus| bus.run(toolchain, cache)).transpose();
        let leaves = leaves.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        Ok::<_, EstimateError>((synthesis?, bus?, leaves?))
    })?;
    // The cancel flag is checked between the steps, because reading a netlist of many regions takes
    // seconds.
    let check_interrupt = || match toolchain.cancel_flag().load(Ordering::Relaxed) {
        true => Err(EstimateError::Tool(ToolError::Interrupted)),
        false => Ok(()),
    };
    check_interrupt()?;
    let netlist = AreaNetlist::parse(NETLIST, &synthesis.json)?;
    check_interrupt()?;
    let units = job.units(&netlist, &job.synthesis)?;
    let unit_modules: Vec<&str> = units.iter().map(String::as_str).collect();
    let paths = longest_paths(NETLIST, &synthesis.json, &[unit_modules[0], &job.synthesis.array])?;
    check_interrupt()?;
    let leaf_netlist = leaves.map(|json| AreaNetlist::parse(NETLIST, &json)).transpose()?;
    let top_result = bus.as_ref().unwrap_or(&synthesis);
    let clock = ClockEstimate::of(
        NETLIST,
        &top_result.json,
        &job.top_synthesis().array,
        CellLibrary::Xilinx,
    )?;
    check_interrupt()?;
    let bus_area = |(job, result): (&SynthesisJob, &SynthesisResult)| {
        BusArea::of(job, result, leaf_netlist.as_ref())
    };
    let bus = job.bus.as_ref().zip(bus.as_ref()).map(bus_area).transpose()?;
    check_interrupt()?;
    let [unit, array] = paths.try_into().expect("a path for each of the two modules");
    Ok(AreaReport::new(
        synthesis.tool,
        RtlHashes {
            sha256: sources_sha256(&job.synthesis.sources),
            rpu_sha256: job.rpu_sha256.clone(),
        },
        job.regions,
        UnitCount { name: job.unit_name.clone(), count: job.units },
        MeasuredAreas {
            unit: netlist.whole_area(unit_modules[0], &[])?,
            glue: netlist.whole_area(&job.synthesis.array, &unit_modules)?,
            array: netlist.whole_area(&job.synthesis.array, &[])?,
            bus,
        },
        MeasuredTiming {
            paths: LongestPaths { rpu: unit, rcm: array },
            clock,
            clocks_per_frame: job.clocks_per_frame,
        },
        match (&job.leaves_of, &leaf_netlist) {
            (Some(top), Some(leaf_netlist)) => leaf_areas(top, leaf_netlist)?,
            _ => Vec::new(),
        },
    ))
}

impl EstimateJob {
    /// Returns the synthesis of everything that is placed on a device: the core on AXI, else the
    /// array.
    #[must_use]
    pub fn top_synthesis(&self) -> &SynthesisJob {
        self.bus.as_ref().unwrap_or(&self.synthesis)
    }

    /// Returns the modules of the netlist of a synthesis that are made from the unit, the most
    /// frequent first. The netlist has one such module for each set of parameters.
    pub(crate) fn units(
        &self,
        netlist: &AreaNetlist,
        synthesis: &SynthesisJob,
    ) -> Result<Vec<String>, EstimateError> {
        let mut found = Vec::new();
        for (name, count) in netlist.instances(&synthesis.array, &[])? {
            if netlist.module(&name)?.source_name == synthesis.unit {
                found.push((count, name));
            }
        }
        found.sort_by(|a, b| b.cmp(a));
        let total = found.iter().map(|(count, _)| count).sum::<u64>();
        if total == 0 {
            netlist.module(&synthesis.unit)?;
        }
        if total == self.units && total > 0 {
            return Ok(found.into_iter().map(|(_, name)| name).collect());
        }
        Err(EstimateError::UnitCount {
            array: synthesis.array.clone(),
            unit: synthesis.unit.clone(),
            expected: self.units,
            found: total,
        })
    }
}

impl EstimateJob {
    /// Makes the job for a design's freshly generated Verilog.
    #[must_use]
    pub fn for_design(design: &Design, top: Top) -> Self {
        Self::with_sources(design, top, sources(design, top))
    }

    /// Makes the job for a design with this Verilog. If the array does not consist of modules
    /// `rpu`, module `rpu` is an array of its own.
    #[must_use]
    pub fn with_sources(design: &Design, top: Top, verilog: Vec<Source>) -> Self {
        let unit = design.unit();
        let array = top.array_top(design);
        let units = match array {
            Top::Rpu => 1,
            Top::Rcm => unit.count,
        };
        Self {
            synthesis: SynthesisJob {
                sources: verilog,
                unit: unit.module.to_owned(),
                array: array.module().to_owned(),
                parameters: array.parameters(design),
            },
            unit_name: unit.name.to_owned(),
            units: units.into(),
            regions: design.regions().into(),
            clocks_per_frame: design.timing().clocks_per_frame(),
            bus: match top {
                Top::Rpu => None,
                Top::Rcm => axi_modules(design).map(|verilog| SynthesisJob {
                    sources: sources_of_files(verilog),
                    unit: unit.module.to_owned(),
                    array: AXI_TOP.to_owned(),
                    parameters: Vec::new(),
                }),
            },
            rpu_sha256: sources_sha256(&sources(design, Top::Rpu)),
            leaves_of: None,
        }
    }

    /// Adds the list of separate modules: those of the unit, of the array where that says more, or
    /// of a core on AXI.
    #[must_use]
    pub fn with_leaves(self, design: &Design) -> Self {
        let of_array = design.unit().area_module.to_owned();
        let leaves_of = self.bus.as_ref().map_or(of_array, |bus| bus.array.clone());
        Self { leaves_of: Some(leaves_of), ..self }
    }
}

pub(crate) fn sources(design: &Design, top: Top) -> Vec<Source> {
    sources_of_files(foveate_emit::verilog(design, top))
}

pub(crate) fn sources_of_files(files: Vec<SourceFile>) -> Vec<Source> {
    files.into_iter().map(Source::from).collect()
}
