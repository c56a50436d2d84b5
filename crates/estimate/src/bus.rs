// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core on a bus: what it takes as a whole, and what each part around the array takes of that.
//!
//! The whole is one netlist, in which logic is shared across the borders of modules. The parts are those of the netlist in
//! which every module stands apart, so they add up to a little more or less.

use foveate_emit::AXI_PARTS;
use foveate_toolchain::{Synthesis, SynthesisJob, sources_sha256};
use serde::{Deserialize, Serialize};

use crate::area::Area;
use crate::error::EstimateError;
use crate::levels::{LogicPath, longest_paths};
use crate::netlist::{NETLIST, Netlist};

/// A core on a bus, with the array inside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BusArea {
    /// The module on top: `rcm_axi`.
    pub module: String,
    /// The hash of its RTL, as that of the array. A co-simulation of the core on the bus says the same.
    pub rtl_sha256: String,
    /// All of it, the array included.
    pub whole: Area,
    /// What stands around the array, each module synthesized apart; empty if not asked for.
    pub parts: Vec<PartArea>,
    /// Its longest path.
    pub path: LogicPath,
}

/// Modules around the array that do one thing together.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartArea {
    /// What people call it.
    pub name: String,
    /// The modules, with all that is inside them; of the top only what is its own.
    pub modules: Vec<String>,
    /// What they take together.
    pub area: Area,
}

impl BusArea {
    /// What is counted in the netlist of the whole, and in that of its modules apart, if there is one.
    ///
    /// # Errors
    /// When a netlist is not understood, a cell is not known or a part is missing, or when logic runs in a circle.
    pub(crate) fn of(
        job: &SynthesisJob,
        whole: &Synthesis,
        apart: Option<&Netlist>,
    ) -> Result<Self, EstimateError> {
        let top = job.array.as_str();
        let paths = longest_paths(NETLIST, &whole.json, &[top])?;
        Ok(Self {
            module: top.to_owned(),
            rtl_sha256: sources_sha256(&job.sources),
            whole: Netlist::parse(NETLIST, &whole.json)?.whole_area(top, &[])?,
            parts: apart.map(|apart| parts(top, apart)).transpose()?.unwrap_or_default(),
            path: paths.into_iter().next().expect("a path for the one module"),
        })
    }
}

/// Every part around the array, and what the top has itself.
fn parts(top: &str, apart: &Netlist) -> Result<Vec<PartArea>, EstimateError> {
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
