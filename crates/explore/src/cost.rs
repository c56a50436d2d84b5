// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost and speed of a design: its area and its estimated clock from Yosys, once for every
//! distinct RTL.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{Area, EstimateJob, FrameRate, estimate};
use foveate_playback::{PlaybackError, RunHooks};
use foveate_toolchain::{Cache, Toolchain, sources_sha256};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::ExploreError;
use crate::progress::synthesis_progress;

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

/// The result of synthesizing a design.
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

/// The results of synthesizing some designs: an area, or the error of Yosys.
pub(crate) struct SynthesisResults {
    /// The key of every design, which is unique for its RTL.
    keys: Vec<String>,
    by_rtl: BTreeMap<String, Result<SynthesisResult, ExploreError>>,
}

impl SynthesisResults {
    /// Returns the result or the error of every design.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Result<&SynthesisResult, &ExploreError>> {
        self.keys.iter().filter_map(|key| self.by_rtl.get(key)).map(Result::as_ref)
    }

    /// Returns the results of all designs.
    ///
    /// # Errors
    /// Fails with the first error of the synthesis.
    pub(crate) fn into_results(self) -> Result<Vec<SynthesisResult>, ExploreError> {
        let found = self.by_rtl.into_iter().map(|(key, area)| Ok((key, area?)));
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
    ) -> Result<SynthesisResults, ExploreError> {
        let mut jobs = BTreeMap::new();
        let keys = designs.map(|design| {
            let job = EstimateJob::for_design(design, Top::Rcm);
            let all = job.top_synthesis();
            let key = format!("{} {:?}", sources_sha256(&all.sources), all.parameters);
            jobs.entry(key.clone()).or_insert(job);
            key
        });
        let keys = keys.collect();
        let (done, all) = (AtomicUsize::new(0), jobs.len());
        let jobs = jobs.into_par_iter().filter(|_| !hooks.is_cancelled());
        let areas = jobs.map(|(key, job)| {
            let area = self.synthesize_job(&job);
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            hooks.progress(&synthesis_progress(done, all));
            (key, area)
        });
        let by_rtl = areas.collect();
        if hooks.is_cancelled() {
            Err(PlaybackError::Interrupted.into())
        } else {
            Ok(SynthesisResults { keys, by_rtl })
        }
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
