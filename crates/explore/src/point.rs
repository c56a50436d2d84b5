// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points of a space, each with its design ([`DesignPoint`]), and their synthesis
//! ([`PointSynthesis`]): area and clock on an FPGA, and area, clock and energy in the cells of
//! a process.

use crate::cost::{ResultsByRtl, SynthesisResult};
use crate::footage::ExplorationFootage;
use crate::request::{ProcessRequest, SynthesisRequest};
use crate::space::{DesignSpace, plain_text};
use crate::store::{EnergyStore, MeasurementStore};
use crate::target_process::{EnergyClips, ProcessEnergy, ProcessFigures};
use crate::{ExploreError, Synthesizer};
use foveate_design::{Design, DesignConfig};
use foveate_estimate::SiliconReport;
use foveate_media::{PlaybackError, RunHooks, RunProgress};
use foveate_tools::Interrupt;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use toml::Value;

/// A design of a space.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPoint {
    /// The value of every axis, a string without quotes; empty if the axis has the value of the
    /// start.
    pub settings: Vec<String>,
    /// The configuration.
    pub config: DesignConfig,
    /// The number of the combination, from 0.
    pub combination: usize,
}

/// A combination that is not a valid design.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RefusedCombination {
    /// The settings as `key = value`.
    pub settings: String,
    /// The reason why the combination cannot be built.
    pub reason: String,
}

impl DesignSpace {
    /// Returns the different designs for frames of `width` x `height` pixels, and the combinations
    /// that are not valid designs.
    #[must_use]
    pub fn points(&self, width: u32, height: u32) -> (Vec<DesignPoint>, Vec<RefusedCombination>) {
        self.points_of_combinations(None, width, height)
    }

    pub(crate) fn points_of_combinations(
        &self,
        some: Option<&[usize]>,
        width: u32,
        height: u32,
    ) -> (Vec<DesignPoint>, Vec<RefusedCombination>) {
        let (mut points, mut refused, mut seen) = (Vec::new(), Vec::new(), BTreeSet::new());
        let all = self.method.combinations(&self.axes).into_iter().enumerate();
        for (number, combination) in
            all.filter(|(number, _)| some.is_none_or(|some| some.contains(number)))
        {
            let values: Vec<Option<&Value>> = std::iter::zip(&self.axes, combination)
                .map(|(axis, index)| index.and_then(|index| axis.values.get(index)))
                .collect();
            let settings: Vec<String> =
                values.iter().map(|value| value.map(plain_text).unwrap_or_default()).collect();
            match self.config_of_values(&values, width, height) {
                Ok(config) => {
                    // The first of equal designs is kept, because it has the fewest settings.
                    if seen.insert(config.to_toml()) {
                        points.push(DesignPoint { settings, config, combination: number });
                    }
                }
                Err(reason) => {
                    refused.push(RefusedCombination {
                        settings: self.settings_of_point(&settings),
                        reason,
                    });
                }
            }
        }
        (points, refused)
    }

    /// Returns the settings as `key = value`, without those that have the value of the start.
    #[must_use]
    pub fn settings_of_point(&self, settings: &[String]) -> String {
        settings_text(self.axes.iter().map(|axis| axis.key.as_str()), settings)
    }

    fn config_of_values(
        &self,
        values: &[Option<&Value>],
        width: u32,
        height: u32,
    ) -> Result<DesignConfig, String> {
        let set = self.axes.iter().zip(values);
        let overrides: Vec<String> = set
            .filter_map(|(axis, value)| value.map(|value| format!("{}={value}", axis.key)))
            .collect();
        let config = self.start.with_overrides_in_start_levels(&overrides);
        let design = config
            .and_then(|config| config.validate_for_frames(width, height))
            .map_err(|error| error.to_string())?;
        // Every default is filled in, so that equal designs have equal texts.
        Ok(design.config())
    }
}

/// Returns the settings of some axes as `key = value`, without those that have the value of the
/// start.
pub(crate) fn settings_text<'a>(
    axes: impl Iterator<Item = &'a str>,
    settings: &[String],
) -> String {
    let set = axes.zip(settings).filter(|(_, value)| !value.is_empty());
    let words: Vec<String> = set.map(|(axis, value)| format!("{axis} = {value}")).collect();
    if words.is_empty() { START_NAME.to_owned() } else { words.join(", ") }
}

/// The name of the point that changes no setting.
pub(crate) const START_NAME: &str = "the start";

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
