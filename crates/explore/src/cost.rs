// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost and speed of a design: its area and its estimated clock from Yosys, once for every
//! distinct RTL.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{Area, EstimateJob, FrameRate, estimate};
use foveate_media::{PlaybackError, RunHooks, RunProgress};
use foveate_tools::{Cache, Toolchain, sources_sha256};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::progress::synthesis_progress;
use crate::ExploreError;

/// The area of a design, as Yosys estimates it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DesignArea {
    /// The area of one RPU, of one lane of a serial design, or of a raster core.
    pub unit: Area,
    /// The number of RPUs, lanes or raster cores for a frame.
    pub units: u64,
    /// The area of all units and of the logic that they share. With AXI it includes the logic
    /// around the core.
    pub array: Area,
    /// The number of logic levels of the longest path.
    #[serde(rename = "levels")]
    pub logic_levels: u32,
}

#[derive(Clone, Debug)]
pub(crate) struct SynthesisResult {
    pub(crate) silicon: DesignArea,
    /// The estimated clock, and the frames per second at it; `None` for a design without logic
    /// between registers.
    pub(crate) speed: Option<FrameRate>,
}

/// The tools of the synthesis.
#[derive(Clone, Debug)]
pub struct Synthesizer {
    /// The toolchain, which finds and runs Yosys.
    pub toolchain: Toolchain,
    /// The cache of results, under the hash of the RTL.
    pub cache: Cache,
}

/// The results for some designs, one for every distinct RTL: a value, or an error.
pub(crate) struct ResultsByRtl<T> {
    /// The key of every design, which is unique for its RTL.
    keys: Vec<String>,
    by_rtl: BTreeMap<String, Result<T, ExploreError>>,
}

impl<T: Send> ResultsByRtl<T> {
    /// Computes the result of every distinct RTL of some designs in parallel. `stage` reports how
    /// many are done, and of how many.
    ///
    /// # Errors
    /// Fails if `hooks` cancels.
    pub(crate) fn compute<'a>(
        designs: impl Iterator<Item = &'a Design>,
        hooks: &dyn RunHooks,
        stage: fn(usize, usize) -> RunProgress<'static>,
        compute: impl Fn(EstimateJob, &Design) -> Result<T, ExploreError> + Sync,
    ) -> Result<Self, ExploreError> {
        let mut distinct = BTreeMap::new();
        let keys = designs.map(|design| {
            let job = EstimateJob::for_design(design, Top::Rcm);
            let all = job.top_synthesis();
            let key = format!("{} {:?}", sources_sha256(&all.sources), all.parameters);
            distinct.entry(key.clone()).or_insert((job, design));
            key
        });
        let keys = keys.collect();
        let (done, all) = (AtomicUsize::new(0), distinct.len());
        if all > 0 {
            hooks.progress(&stage(0, all));
        }
        let running = distinct.into_par_iter().filter(|_| !hooks.is_cancelled());
        let results = running.map(|(key, (job, design))| {
            let result = compute(job, design);
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            hooks.progress(&stage(done, all));
            (key, result)
        });
        let by_rtl = results.collect();
        if hooks.is_cancelled() {
            Err(PlaybackError::Interrupted.into())
        } else {
            Ok(Self { keys, by_rtl })
        }
    }
}

impl<T: Clone> ResultsByRtl<T> {
    pub(crate) fn iter(&self) -> impl Iterator<Item = Result<&T, &ExploreError>> {
        self.keys.iter().filter_map(|key| self.by_rtl.get(key)).map(Result::as_ref)
    }

    /// Returns the results of all designs.
    ///
    /// # Errors
    /// Fails with the first error.
    pub(crate) fn into_results(self) -> Result<Vec<T>, ExploreError> {
        let found = self.by_rtl.into_iter().map(|(key, result)| Ok((key, result?)));
        let found = found.collect::<Result<BTreeMap<_, _>, ExploreError>>()?;
        Ok(self.keys.iter().filter_map(|key| found.get(key).cloned()).collect())
    }
}

impl Synthesizer {
    /// Synthesizes every distinct RTL of some designs in parallel.
    ///
    /// # Errors
    /// Fails if `hooks` cancels.
    pub(crate) fn synthesize_designs<'a>(
        &self,
        designs: impl Iterator<Item = &'a Design>,
        hooks: &dyn RunHooks,
    ) -> Result<ResultsByRtl<SynthesisResult>, ExploreError> {
        ResultsByRtl::compute(designs, hooks, synthesis_progress, |job, _| {
            self.synthesize_job(&job)
        })
    }

    fn synthesize_job(&self, job: &EstimateJob) -> Result<SynthesisResult, ExploreError> {
        let report = estimate(&self.toolchain, &self.cache, job)?;
        let silicon = DesignArea {
            unit: report.rpu,
            units: job.units,
            array: *report.whole_area(),
            logic_levels: report.levels(),
        };
        Ok(SynthesisResult { silicon, speed: report.speed })
    }
}
