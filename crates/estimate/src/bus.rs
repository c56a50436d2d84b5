// SPDX-License-Identifier: MIT OR Apache-2.0
//! The area of a core on AXI: that of the whole core, and that of each part around the array.
//!
//! The whole is one netlist, in which logic is shared across the borders of modules. The parts are
//! counted in a netlist in which every module is synthesized separately, so their sum differs a
//! little from the whole.

use foveate_emit::AXI_PARTS;
use foveate_tools::{SynthesisJob, SynthesisResult, sources_sha256};
use serde::{Deserialize, Serialize};

use crate::area::Area;
use crate::error::EstimateError;
use crate::logic_levels::{LogicPath, longest_paths};
use crate::netlist::{AreaNetlist, NETLIST};

/// The area of a core on AXI, with the array inside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BusArea {
    /// The top module, `rcm_axi`.
    pub module: String,
    /// The hash of its RTL, computed as for the array. A co-simulation of the core on AXI reports
    /// the same hash.
    pub rtl_sha256: String,
    /// The area of the whole core, the array included.
    pub whole: Area,
    /// The areas of the parts around the array, with each module synthesized separately; empty
    /// unless requested.
    pub parts: Vec<PartArea>,
    /// The longest path of the core.
    pub path: LogicPath,
}

/// The area of modules around the array that form one part.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartArea {
    /// The name of the part in reports.
    pub name: String,
    /// The modules, each with all modules inside it. For the top module, only its own cells count.
    pub modules: Vec<String>,
    /// The area of the modules together.
    pub area: Area,
}

impl BusArea {
    /// Counts the area in the netlist of the whole core, and that of its parts in the netlist of
    /// its separate modules, if there is one.
    ///
    /// # Errors
    /// Fails if a netlist cannot be read, if a cell is not known or a part is missing, or if there
    /// is a combinational loop.
    pub(crate) fn of(
        job: &SynthesisJob,
        whole: &SynthesisResult,
        apart: Option<&AreaNetlist>,
    ) -> Result<Self, EstimateError> {
        let top = job.array.as_str();
        let paths = longest_paths(NETLIST, &whole.json, &[top])?;
        Ok(Self {
            module: top.to_owned(),
            rtl_sha256: sources_sha256(&job.sources),
            whole: AreaNetlist::parse(NETLIST, &whole.json)?.whole_area(top, &[])?,
            parts: apart.map(|apart| part_areas(top, apart)).transpose()?.unwrap_or_default(),
            path: paths.into_iter().next().expect("a path for the one module"),
        })
    }
}

/// Returns the area of every part around the array, and of the cells of the top itself.
fn part_areas(top: &str, apart: &AreaNetlist) -> Result<Vec<PartArea>, EstimateError> {
    let part = |(name, modules): &(&str, &[&str])| {
        let add = |sum: Area, module: &&str| apart.area_in(top, module).map(|area| sum.plus(area));
        Ok(PartArea {
            name: (*name).to_owned(),
            modules: modules.iter().map(|&module| module.to_owned()).collect(),
            area: modules.iter().try_fold(Area::default(), add)?,
        })
    };
    let own = PartArea {
        name: "time and counters".to_owned(),
        modules: vec![top.to_owned()],
        area: apart.own_area(top)?,
    };
    AXI_PARTS.iter().map(part).chain([Ok(own)]).collect()
}
