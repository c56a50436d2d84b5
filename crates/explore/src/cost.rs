// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a design costs and how fast it is: area and estimated clock from Yosys, once for every distinct RTL.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{Area, EstimateJob, Speed, estimate};
use foveate_toolchain::{Cache, Toolchain, sources_sha256};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{ExploreError, Hooks, Progress};

/// Area of a design, in Yosys' estimate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Silicon {
    /// One RPU, or one lane of a serial design.
    pub unit: Area,
    /// How many of them the frame has.
    pub units: u64,
    /// All of them and what they share; of a core on AXI with what puts it there.
    pub array: Area,
    /// Logic levels of the longest path.
    pub levels: u32,
}

/// What a synthesis tells of a design.
#[derive(Clone, Debug)]
pub(crate) struct Synthesized {
    pub(crate) silicon: Silicon,
    /// The estimated clock and frames per second at it; none of a design without logic between registers.
    pub(crate) speed: Option<Speed>,
}

/// What synthesizes.
#[derive(Clone, Debug)]
pub struct Synthesizer {
    /// Finds and runs Yosys.
    pub toolchain: Toolchain,
    /// Keeps what it made, under the hash of the RTL.
    pub cache: Cache,
}

/// The areas and speeds of some designs, or what Yosys said of those without one.
pub(crate) struct Areas {
    /// For every design what tells its RTL from that of others.
    keys: Vec<String>,
    by_rtl: BTreeMap<String, Result<Synthesized, ExploreError>>,
}

impl Areas {
    /// For every design what its synthesis tells, or why it has none.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Result<&Synthesized, &ExploreError>> {
        self.keys.iter().filter_map(|key| self.by_rtl.get(key)).map(Result::as_ref)
    }

    /// For every design what its synthesis tells.
    ///
    /// # Errors
    /// What Yosys said of the first without one.
    pub(crate) fn all(self) -> Result<Vec<Synthesized>, ExploreError> {
        let found = self.by_rtl.into_iter().map(|(key, area)| Ok((key, area?)));
        let found = found.collect::<Result<BTreeMap<_, _>, ExploreError>>()?;
        Ok(self.keys.iter().filter_map(|key| found.get(key).cloned()).collect())
    }
}

impl Synthesizer {
    /// Synthesizes every distinct RTL of some designs, side by side.
    ///
    /// # Errors
    /// When `hooks` cancels.
    pub(crate) fn areas<'a>(
        &self,
        designs: impl Iterator<Item = &'a Design>,
        hooks: &dyn Hooks,
    ) -> Result<Areas, ExploreError> {
        let mut jobs = BTreeMap::new();
        let keys = designs.map(|design| {
            let job = EstimateJob::of(design, Top::Rcm);
            let all = job.on_top();
            let key = format!("{} {:?}", sources_sha256(&all.sources), all.parameters);
            jobs.entry(key.clone()).or_insert(job);
            key
        });
        let keys = keys.collect();
        let (done, all) = (AtomicUsize::new(0), jobs.len());
        let jobs = jobs.into_par_iter().filter(|_| !hooks.cancelled());
        let areas = jobs.map(|(key, job)| {
            let area = self.area(&job);
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            hooks.progress(Progress::Synthesizing { done, all });
            (key, area)
        });
        let by_rtl = areas.collect();
        if hooks.cancelled() { Err(ExploreError::Cancelled) } else { Ok(Areas { keys, by_rtl }) }
    }

    fn area(&self, job: &EstimateJob) -> Result<Synthesized, ExploreError> {
        let report = estimate(&self.toolchain, &self.cache, job)?;
        let silicon = Silicon {
            unit: report.rpu,
            units: job.units,
            array: *report.whole(),
            levels: report.levels(),
        };
        Ok(Synthesized { silicon, speed: report.speed })
    }
}
