// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesis of the points of an exploration: area and clock on an FPGA, and area, clock and energy in the
//! cells of a process.

use crate::cost::{ResultsByRtl, SynthesisResult};
use crate::footage::ExplorationFootage;
use crate::request::{ProcessRequest, SynthesisRequest};
use crate::store::{EnergyStore, MeasurementStore};
use crate::target_process::{EnergyClips, ProcessEnergy, ProcessFigures};
use crate::{ExploreError, Synthesizer};
use foveate_design::Design;
use foveate_estimate::SiliconReport;
use foveate_media::{PlaybackError, RunHooks, RunProgress};
use foveate_tools::Interrupt;
use std::collections::BTreeMap;

/// The results of synthesizing a point.
#[derive(Clone, Debug, Default)]
pub(crate) struct SynthesizedPoint {
    /// The area and clock on an FPGA; `None` if Yosys failed.
    pub(crate) fpga: Option<SynthesisResult>,
    /// The figures in the process; `None` without one, or if a tool failed.
    pub(crate) process: Option<ProcessFigures>,
}

/// The results of synthesizing points.
#[derive(Debug, Default)]
pub(crate) struct SynthesizedPoints {
    /// The results of the first points, as far as they are known.
    pub(crate) points: Vec<SynthesizedPoint>,
    /// The points for which a tool failed, with the reasons.
    pub(crate) problems: Vec<String>,
}

pub(crate) struct PointSynthesis<'a> {
    synthesizer: &'a Synthesizer,
    process: Option<ProcessRequest<'a>>,
    /// The clips on which energies are measured.
    energy_clips: Option<EnergyClips<'a>>,
    hooks: &'a dyn RunHooks,
}

impl<'a> PointSynthesis<'a> {
    /// Checks what a long run would find at its end.
    ///
    /// # Errors
    /// Fails if the energy is wanted, and an input is a data set, is too short or cannot be read,
    /// or the library has no energies.
    pub(crate) fn check(
        request: SynthesisRequest<'_>,
        footage: &ExplorationFootage<'_>,
    ) -> Result<(), ExploreError> {
        energy_clips(request.process, footage).iter().try_for_each(EnergyClips::check)
    }

    /// Prepares the synthesis. Energies that `store` has are not measured again.
    pub(crate) fn new(
        request: SynthesisRequest<'a>,
        footage: &'a ExplorationFootage<'_>,
        store: &'a MeasurementStore,
        hooks: &'a dyn RunHooks,
    ) -> Self {
        let SynthesisRequest { synthesizer, process } = request;
        let energy_clips = energy_clips(process, footage).map(|clips| {
            let texts = (0..footage.clips.clips().len()).map(|clip| {
                let (clip, ideal) = footage.clip_texts(clip);
                format!("{clip}\n{ideal}")
            });
            let store = EnergyStore { measurements: store, clips: texts.collect() };
            EnergyClips { store: Some(store), ..clips }
        });
        Self { synthesizer, process, energy_clips, hooks }
    }

    /// Synthesizes the next of all designs, as many at a time as keep the processors busy, and adds
    /// the results and the errors of tools to `found`. A design that fails does not lose the
    /// others.
    ///
    /// # Errors
    /// Fails if the hooks cancel.
    pub(crate) fn synthesize_next(
        &self,
        designs: &[Design],
        found: &mut SynthesizedPoints,
    ) -> Result<(), ExploreError> {
        let first = found.points.len();
        let all = designs.len();
        let at_once = (2 * rayon::current_num_threads()).max(8).max(designs.len().div_ceil(16));
        let designs = &designs[first..all.min(first + at_once)];
        let hooks = PartHooks { hooks: self.hooks, first, count: designs.len(), all };
        let mut errors = Vec::new();
        found.points.extend(self.synthesize(designs, &hooks, &mut errors)?);
        errors.sort_by_key(|(index, _)| *index);
        let problem = |(index, error)| format!("point {}: {error}", first + index + 1);
        found.problems.extend(errors.into_iter().map(problem));
        Ok(())
    }

    /// Synthesizes designs. Errors of tools are added to `problems`, with the indices of their
    /// designs.
    fn synthesize(
        &self,
        designs: &[Design],
        hooks: &dyn RunHooks,
        problems: &mut Vec<(usize, String)>,
    ) -> Result<Vec<SynthesizedPoint>, ExploreError> {
        let areas = self.synthesizer.synthesize_designs(designs.iter(), hooks)?;
        problems.extend(problems_of(&areas));
        let areas = areas.iter().map(|area| area.ok().cloned());
        let mut points: Vec<_> =
            areas.map(|fpga| SynthesizedPoint { fpga, process: None }).collect();
        if let Some(ProcessRequest { process, .. }) = self.process {
            let mapped = process.map_designs(self.synthesizer, designs.iter(), hooks)?;
            problems.extend(problems_of(&mapped));
            let reports: Vec<Option<&SiliconReport>> = mapped.iter().map(Result::ok).collect();
            let mut energies = self.measure_energies(designs, &reports, hooks, problems)?;
            for (index, (point, report)) in points.iter_mut().zip(reports).enumerate() {
                let energy = energies.remove(&index);
                let figures = report.map(ProcessFigures::from_report);
                point.process = figures.map(|figures| ProcessFigures { energy, ..figures });
            }
        }
        Ok(points)
    }

    /// Returns the energies of designs that can be measured, by their index.
    fn measure_energies(
        &self,
        designs: &[Design],
        reports: &[Option<&SiliconReport>],
        hooks: &dyn RunHooks,
        problems: &mut Vec<(usize, String)>,
    ) -> Result<BTreeMap<usize, ProcessEnergy>, ExploreError> {
        let Some(clips) = &self.energy_clips else { return Ok(BTreeMap::new()) };
        let mapped = designs.iter().zip(reports).enumerate();
        let mapped =
            mapped.filter_map(|(index, (design, report))| Some((index, design, (*report)?)));
        let measure =
            |(index, design, report)| match clips.measure(self.synthesizer, design, report) {
                Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
                    Err(PlaybackError::Interrupted.into())
                }
                result => Ok((index, result)),
            };
        let mut energies = BTreeMap::new();
        for (index, result) in EnergyClips::measure_all(mapped.collect(), hooks, measure)? {
            match result {
                Ok(energy) => energies.extend(energy.map(|energy| (index, energy))),
                Err(error) => problems.push((index, error.to_string())),
            }
        }
        Ok(energies)
    }
}

/// Returns the whole clips, if energies are wanted.
fn energy_clips<'a>(
    request: Option<ProcessRequest<'a>>,
    footage: &'a ExplorationFootage<'_>,
) -> Option<EnergyClips<'a>> {
    let ProcessRequest { process, energy_rate } = request?;
    let whole = footage.clips.clips().iter().map(|_| 0..u64::MAX);
    Some(EnergyClips::new(process, &footage.clips, whole, Some(energy_rate?)))
}

fn problems_of<T: Send + Clone>(results: &ResultsByRtl<T>) -> Vec<(usize, String)> {
    let errors = results.iter().enumerate();
    errors.filter_map(|(index, result)| Some((index, result.err()?.to_string()))).collect()
}

/// The hooks of some of all designs, which report progress as a number of all designs.
struct PartHooks<'a> {
    hooks: &'a dyn RunHooks,
    /// The number of designs before these.
    first: usize,
    count: usize,
    all: usize,
}

impl RunHooks for PartHooks<'_> {
    fn progress(&self, part: &RunProgress<'_>) {
        let [first, count, all] = [self.first, self.count, self.all].map(|number| number as u64);
        let done = part.total.map_or(part.done, |total| first + part.done * count / total.max(1));
        self.hooks.progress(&RunProgress { done, total: part.total.map(|_| all), ..part.clone() });
    }

    fn is_cancelled(&self) -> bool {
        self.hooks.is_cancelled()
    }

    fn interrupt(&self) -> Interrupt {
        self.hooks.interrupt()
    }
}
