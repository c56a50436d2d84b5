// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of designs in the cells of a process: area, clock and energy.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_cosim::{ActivityClip, EnergyJob, EnergyReport, StretchEnergy, measure_energy};
use foveate_design::{Design, Organization};
use foveate_estimate::{LibertyLibrary, SiliconJob, SiliconReport, count_to_f64, map_to_silicon};
use foveate_media::{PlaybackError, RunClips, RunHooks};
use rayon::prelude::*;
use serde::Serialize;

use super::progress::{energy_progress, mapping_progress};
use crate::ExploreError;
use crate::cost::{ResultsByRtl, Synthesizer};
use crate::store::EnergyStore;

/// The frames per second for which powers are given if no rate is wanted.
const DEFAULT_FRAME_RATE: f64 = 30.0;

/// A process in whose cells designs are measured.
#[derive(Clone, Debug)]
pub struct TargetProcess {
    /// The library of cells.
    pub library: LibertyLibrary,
    /// The libraries of memory macros, of the same voltage.
    pub macros: Vec<LibertyLibrary>,
    /// The largest memory in bits that becomes flip-flops.
    pub memory_limit: u64,
}

/// The cost of a design in a process. Wires, the clock tree and other corners are not included, so
/// areas and powers are lower bounds, and the clock is an upper bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProcessFigures {
    /// The name of the library.
    pub library: String,
    /// The area of one RPU, lane or core in square micrometres, without memory macros.
    pub unit_um2: f64,
    /// The area of the array with its memory macros in square millimetres; `None` if a memory has
    /// no macro.
    pub mm2: Option<f64>,
    /// The bits of the memories for which no macro fits.
    pub memory_bits_without_macro: u64,
    /// The highest clock in MHz, rounded down to a tenth.
    pub clock_mhz: f64,
    /// The energy; `None` if it was not measured, for organization `raster`, or if a memory is too
    /// large for flip-flops.
    pub energy: Option<ProcessEnergy>,
}

/// The energy of a design in a process on some clips, if its clock stops when a frame is done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProcessEnergy {
    /// The frames per second for which powers are given.
    pub frame_rate: f64,
    /// The energy of a region in a frame in nanojoules, without leakage: the mean over the usual
    /// stretches of all clips.
    pub nj_per_region: f64,
    /// The power of the array in milliwatts: the mean over the usual stretches of all clips.
    pub usual_mw: f64,
    /// The power of the array in milliwatts in the busiest stretch of all clips.
    pub busiest_mw: f64,
}

impl ProcessFigures {
    /// Returns the figures of a report, without energy.
    pub(crate) fn from_report(report: &SiliconReport) -> Self {
        let memory_bits_without_macro = report.memory.bits_without_macro;
        Self {
            library: report.library.name.clone(),
            unit_um2: report.unit.cells.area_um2,
            mm2: (memory_bits_without_macro == 0).then(|| report.area_mm2()),
            memory_bits_without_macro,
            clock_mhz: (report.path.mhz * 10.0).floor() / 10.0,
            energy: None,
        }
    }
}

/// Returns the clock of a design in MHz: the given one, or the highest one in the process if that
/// is lower or none is given. A chip does not reach a clock above the highest one of its cells.
pub(crate) fn reachable_clock(given: Option<f64>, process: Option<&ProcessFigures>) -> Option<f64> {
    match (given, process.map(|process| process.clock_mhz)) {
        (Some(given), Some(highest)) => Some(given.min(highest)),
        (given, highest) => given.or(highest),
    }
}

impl ProcessEnergy {
    /// Returns the energy over several clips; `None` without clips.
    fn of_clips(reports: &[EnergyReport]) -> Option<Self> {
        let frame_rate = reports.first()?.frame_rate;
        // The stretches of a report are ordered by their activity: a quiet, a usual and the busiest
        // one.
        let usual: Vec<&StretchEnergy> =
            reports.iter().map(|report| &report.stretches[1]).collect();
        let mean = |take: fn(&StretchEnergy) -> f64| {
            usual.iter().map(|stretch| take(stretch)).sum::<f64>()
                / count_to_f64(usual.len() as u64)
        };
        let all = reports.iter().flat_map(|report| &report.stretches);
        Some(Self {
            frame_rate,
            nj_per_region: mean(|stretch| stretch.region_nj_per_frame.total()),
            usual_mw: mean(|stretch| stretch.stopped_clock_mw),
            busiest_mw: all.map(|stretch| stretch.stopped_clock_mw).fold(0.0, f64::max),
        })
    }
}

/// The clips on which the energy of designs is measured.
pub(crate) struct EnergyClips<'a> {
    pub(crate) process: &'a TargetProcess,
    pub(crate) clips: Vec<ActivityClip<'a>>,
    /// The frames per second for which powers are given.
    pub(crate) frame_rate: f64,
    /// The store of finished measurements, if there is one.
    pub(crate) store: Option<EnergyStore<'a>>,
}

impl<'a> EnergyClips<'a> {
    pub(crate) fn new(
        process: &'a TargetProcess,
        clips: &'a RunClips,
        frames: impl Iterator<Item = Range<u64>>,
        frame_rate: Option<f64>,
    ) -> Self {
        let clip = |(clip, frames)| ActivityClip { clips, clip, frames };
        let clips = frames.enumerate().map(clip).collect();
        let frame_rate = frame_rate.unwrap_or(DEFAULT_FRAME_RATE);
        Self { process, clips, frame_rate, store: None }
    }

    /// Refuses data sets, whose images have no activity in time, clips that are too short, and a
    /// library without what every energy needs.
    pub(crate) fn check(&self) -> Result<(), ExploreError> {
        self.process.library.cell_models([])?;
        Ok(self.clips.iter().try_for_each(ActivityClip::check)?)
    }

    /// Returns the energy of a design for frames of the clips' size. `report` is its area in the
    /// process. The energy of a design whose memories are not flip-flops cannot be measured, nor
    /// that of organization `raster`.
    pub(crate) fn measure(
        &self,
        synthesizer: &Synthesizer,
        design: &Design,
        report: &SiliconReport,
    ) -> Result<Option<ProcessEnergy>, ExploreError> {
        let is_measurable = match design.organization() {
            Organization::Pipelined | Organization::Serial => report.memory.bits == 0,
            Organization::Raster => false,
        };
        if !is_measurable {
            return Ok(None);
        }
        let measure = |clip| self.measure_clip(clip, synthesizer, design, report);
        let reports = self.clips.par_iter().map(measure).collect::<Result<Vec<_>, _>>();
        if synthesizer.toolchain.cancel_flag().load(Ordering::Relaxed) {
            return Err(PlaybackError::Interrupted.into());
        }
        Ok(ProcessEnergy::of_clips(&reports?))
    }

    fn measure_clip(
        &self,
        clip: &ActivityClip<'_>,
        Synthesizer { toolchain, cache }: &Synthesizer,
        design: &Design,
        report: &SiliconReport,
    ) -> Result<EnergyReport, ExploreError> {
        let measure = || -> Result<EnergyReport, ExploreError> {
            let job = EnergyJob::record(clip, design, self.frame_rate, toolchain.cancel_flag())?;
            let inputs = (&self.process.library, report, report.path.mhz);
            Ok(measure_energy(toolchain, cache, &job, inputs)?)
        };
        match &self.store {
            None => measure(),
            Some(store) => {
                let key = store.key(clip.clip, self.frame_rate, design, report);
                store.measurements.get_or_measure(&key, measure)
            }
        }
    }

    /// Measures the energy of designs in parallel. `measure` does one.
    pub(crate) fn measure_all<T: Send, R: Send>(
        designs: Vec<T>,
        hooks: &dyn RunHooks,
        measure: impl Fn(T) -> Result<R, ExploreError> + Sync,
    ) -> Result<Vec<R>, ExploreError> {
        let (done, all) = (AtomicUsize::new(0), designs.len());
        if all > 0 {
            hooks.progress(&energy_progress(0, all));
        }
        let measured = designs.into_par_iter().map(|design| {
            if hooks.is_cancelled() {
                return Err(PlaybackError::Interrupted.into());
            }
            let result = measure(design)?;
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            hooks.progress(&energy_progress(done, all));
            Ok(result)
        });
        measured.collect()
    }
}

impl TargetProcess {
    /// Maps every distinct RTL of some designs to the cells in parallel, and times it.
    ///
    /// # Errors
    /// Fails if `hooks` cancels.
    pub(crate) fn map_designs<'a>(
        &self,
        synthesizer: &Synthesizer,
        designs: impl Iterator<Item = &'a Design>,
        hooks: &dyn RunHooks,
    ) -> Result<ResultsByRtl<SiliconReport>, ExploreError> {
        let Synthesizer { toolchain, cache } = synthesizer;
        ResultsByRtl::compute(designs, hooks, mapping_progress, |job, design| {
            let job = SiliconJob::for_array(job, design, self.memory_limit);
            let inputs = (&self.library, self.macros.as_slice());
            Ok(map_to_silicon(toolchain, cache, &job, inputs)?)
        })
    }
}
