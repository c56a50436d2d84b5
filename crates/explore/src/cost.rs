// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a design costs: clocks from its timing, area from Yosys, once for every distinct RTL.

use std::collections::BTreeMap;

use foveate_emit::Top;
use foveate_estimate::{Area, EstimateJob, estimate};
use foveate_spec::Design;
use foveate_toolchain::{Cache, Toolchain, sources_sha256};
use serde::{Deserialize, Serialize};

use crate::ExploreError;

/// Area of a design, in Yosys' estimate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Silicon {
    /// One RPU, or one lane of a serial design.
    pub unit: Area,
    /// How many of them the frame has.
    pub units: u64,
    /// All of them and what they share.
    pub array: Area,
    /// Logic levels of the longest path.
    pub levels: u32,
}

/// What synthesizes.
#[derive(Clone, Debug)]
pub struct Synthesizer {
    /// Finds and runs Yosys.
    pub toolchain: Toolchain,
    /// Keeps what it made, under the hash of the RTL.
    pub cache: Cache,
}

/// Clocks from one frame to the next, and frames per second at a clock, rounded down.
pub(crate) fn speed(design: &Design, clock_mhz: u32) -> (u64, u64) {
    let clocks = design.timing().clocks_per_frame();
    (clocks, u64::from(clock_mhz) * 1_000_000 / clocks.max(1))
}

/// The job of a design, and what tells its RTL from that of others.
pub(crate) fn job(design: &Design) -> (String, EstimateJob) {
    let sources = foveate_emit::verilog(design, Top::Rcm);
    let sources: Vec<_> = sources.into_iter().map(|file| (file.path, file.contents)).collect();
    let hash = sources_sha256(&sources);
    let job = foveate_cosim::synthesis(design, Top::Rcm, sources);
    (format!("{hash} {:?}", job.parameters), job)
}

impl Synthesizer {
    pub(crate) fn area(&self, job: &EstimateJob) -> Result<Silicon, ExploreError> {
        let report = estimate(&self.toolchain, &self.cache, job)?;
        Ok(Silicon {
            unit: report.rpu,
            units: job.units,
            array: report.rcm,
            levels: report.paths.rcm.levels.max(report.paths.rpu.levels),
        })
    }
}

/// Every distinct RTL of some designs.
pub(crate) fn distinct<'a>(
    designs: impl Iterator<Item = &'a Design>,
) -> (Vec<String>, BTreeMap<String, EstimateJob>) {
    let mut jobs = BTreeMap::new();
    let keys = designs.map(|design| {
        let (key, job) = job(design);
        jobs.entry(key.clone()).or_insert(job);
        key
    });
    let keys = keys.collect();
    (keys, jobs)
}
