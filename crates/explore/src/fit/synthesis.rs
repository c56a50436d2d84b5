// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesis of the designs that may be the cheapest: which designs are synthesized, in which
//! order, and when that ends.

use foveate_design::{Design, LaneMemoryKind, Organization};
use foveate_media::RunHooks;

use super::FitRequest;
use super::camera_search::{CameraSearch, ExaminedCamera};
use super::cost_objective::CostObjective;
use super::possible_designs::{BuildBounds, possible_designs};
use super::rough_cost::RoughCostModel;
use super::simplest_cameras::{cameras_with_fewest_bytes, simplest_cameras};
use super::slower_designs::{expected_cost, slower_designs};
use super::synthesized_design::SynthesizedDesign;
use crate::ExploreError;
use crate::target_process::EnergyClips;

/// The number of nearest cameras that are built if no camera meets the limits.
const MAX_NEAREST_CAMERAS: usize = 6;
/// The number of designs that are synthesized before checking whether one meets the limits.
const BATCH_SIZE: usize = 8;
/// The most designs that are folded again for their own clocks.
const MAX_SLOWER_DESIGNS: usize = 4;

/// All synthesized designs, the chosen one first.
pub(super) struct SynthesizedDesigns {
    candidates: Vec<SynthesizedDesign>,
    /// The number of designs that were not synthesized because they were less promising.
    pub(super) left_out_designs: usize,
}

impl SynthesizedDesigns {
    /// Returns the cheapest design that meets all limits, or else the nearest one.
    pub(super) fn chosen(&self) -> &SynthesizedDesign {
        &self.candidates[0]
    }

    /// Returns the chosen design, for figures that have no part in the choice.
    pub(super) fn chosen_mut(&mut self) -> &mut SynthesizedDesign {
        &mut self.candidates[0]
    }

    pub(super) fn designs(&self) -> &[SynthesizedDesign] {
        &self.candidates
    }
}

/// Synthesizes the designs that may be the cheapest. If none of them meets the limits, it also
/// synthesizes the nearest ones.
pub(super) fn synthesize_promising_designs(
    search: &CameraSearch<'_>,
    (request, memory): (&FitRequest<'_>, Option<LaneMemoryKind>),
    energy_clips: Option<&EnergyClips<'_>>,
    hooks: &dyn RunHooks,
) -> Result<SynthesizedDesigns, ExploreError> {
    let synthesis = FitSynthesis { request, energy_clips, hooks };
    let holding: Vec<&ExaminedCamera> =
        search.all().filter(|examined| examined.meets_limits()).collect();
    let promising = match request.cheapest {
        CostObjective::Area | CostObjective::Mm2 | CostObjective::Energy => {
            simplest_cameras(&holding)
        }
        // All designs of a camera send the same bytes.
        CostObjective::Bytes => cameras_with_fewest_bytes(&holding)?,
    };
    let bounds = BuildBounds::of_request(request, memory);
    let (mut candidates, mut left_out) =
        synthesis.in_batches(&promising, bounds, request.max_designs)?;
    synthesis.add_slower_designs(&mut candidates)?;
    if !candidates.iter().any(SynthesizedDesign::meets_limits) {
        // Nothing meets the limits. The nearest cameras are built, and those that would meet the
        // limits at a lower speed, to find the binding limits.
        let mut nearest: Vec<&ExaminedCamera> =
            search.all().filter(|examined| !examined.meets_limits()).collect();
        nearest.sort_by(|one, other| one.excess().total_cmp(&other.excess()));
        nearest.truncate(MAX_NEAREST_CAMERAS);
        for (cameras, bounds) in [(&nearest, bounds), (&promising, bounds.at_any_speed())] {
            let most = request.max_designs.min(BATCH_SIZE);
            let (built, left) = synthesis.in_batches(cameras, bounds, most)?;
            candidates.extend(built);
            left_out += left;
        }
    }
    candidates.sort_by(|one, other| {
        let cost = one.cost().total_cmp(&other.cost());
        one.excess().total_cmp(&other.excess()).then(cost)
    });
    if candidates.is_empty() {
        return Err(ExploreError::NoPoints {
            settings: "all candidate cameras".to_owned(),
            reason: "no design can be built from any of them".to_owned(),
        });
    }
    Ok(SynthesizedDesigns { candidates, left_out_designs: left_out })
}

struct FitSynthesis<'a> {
    request: &'a FitRequest<'a>,
    /// The first halves of the clips, if there is a process.
    energy_clips: Option<&'a EnergyClips<'a>>,
    hooks: &'a dyn RunHooks,
}

impl FitSynthesis<'_> {
    /// Looks for cheaper designs among those that meet the limits: it folds them again for their
    /// own clock, which is faster than the planned one, or halves their pixels per clock. A design
    /// is synthesized if it is expected to be cheaper than the cheapest so far, the most promising
    /// first.
    fn add_slower_designs(
        &self,
        candidates: &mut Vec<SynthesizedDesign>,
    ) -> Result<(), ExploreError> {
        let (request, cost_model) = (self.request, RoughCostModel::of_request(self.request));
        let Some(min_fps) = request.constraints.min_fps else { return Ok(()) };
        let most = request.max_designs.min(candidates.len() + MAX_SLOWER_DESIGNS);
        while candidates.len() < most {
            let holding = || candidates.iter().filter(|candidate| candidate.meets_limits());
            let Some(least) = holding().map(SynthesizedDesign::cost).min_by(f64::total_cmp) else {
                break;
            };
            let is_new = |design: &Design| candidates.iter().all(|tried| tried.design != *design);
            let slower = holding().flat_map(|candidate| {
                let speed = candidate.speed.as_ref();
                let slower = speed.map(|speed| slower_designs(&candidate.design, speed, min_fps));
                let expected = |design| {
                    let cost = expected_cost(&design, candidate, cost_model);
                    (cost, &candidate.examined, design)
                };
                slower.unwrap_or_default().into_iter().filter(is_new).map(expected)
            });
            let promising = slower.filter(|(cost, ..)| *cost < least);
            let best = promising.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some((_, examined, design)) = best else { break };
            let examined = examined.clone();
            candidates.extend(self.synthesize(&[(&examined, design)])?);
        }
        Ok(())
    }

    /// Synthesizes the designs of some cameras, the promising ones first, until one meets the
    /// limits or there are `most` of them. Returns the number of designs that are left out.
    fn in_batches(
        &self,
        cameras: &[&ExaminedCamera],
        bounds: BuildBounds,
        most: usize,
    ) -> Result<(Vec<SynthesizedDesign>, usize), ExploreError> {
        let mut designs: Vec<(&ExaminedCamera, Design)> = Vec::new();
        for examined in cameras {
            let own = possible_designs(&examined.config, &self.request.task.hardware, bounds);
            designs.extend(own.into_iter().map(|design| (*examined, design)));
        }
        sort_by_rough_cost(&mut designs, RoughCostModel::of_request(self.request));
        let all = designs.len();
        let mut built = Vec::new();
        for batch in designs[..all.min(most)].chunks(BATCH_SIZE) {
            built.extend(self.synthesize(batch)?);
            let is_found =
                |built: &SynthesizedDesign| built.meets_limits() && built.cost().is_finite();
            if built.iter().any(is_found) {
                break;
            }
        }
        let left_out = all - built.len();
        Ok((built, left_out))
    }

    /// Synthesizes designs, and measures their energy if it decides.
    fn synthesize(
        &self,
        designs: &[(&ExaminedCamera, Design)],
    ) -> Result<Vec<SynthesizedDesign>, ExploreError> {
        let Self { request, hooks, .. } = *self;
        let alone = || designs.iter().map(|(_, design)| design);
        let found = request.synthesizer.synthesize_designs(alone(), hooks)?.into_results()?;
        let reports = match request.process {
            None => vec![None; designs.len()],
            Some(process) => {
                let mapped = process.map_designs(request.synthesizer, alone(), hooks)?;
                mapped.into_results()?.into_iter().map(Some).collect()
            }
        };
        let candidate = |(((examined, design), found), report)| {
            SynthesizedDesign::new((examined, design), found, report, request)
        };
        let built = designs.iter().map(|(examined, design)| (*examined, design));
        let mut built: Vec<_> = built.zip(found).zip(reports).map(candidate).collect();
        let near = built.iter_mut().filter(|candidate| candidate.is_decided_by_energy(request));
        self.measure_energies(near.collect())?;
        Ok(built)
    }

    /// Measures the energy of designs in parallel.
    fn measure_energies(&self, designs: Vec<&mut SynthesizedDesign>) -> Result<(), ExploreError> {
        let Some(clips) = self.energy_clips else { return Ok(()) };
        let measured = EnergyClips::measure_all(designs, self.hooks, |candidate| {
            let Some(report) = &candidate.report else { return Ok(()) };
            let energy = clips.measure(self.request.synthesizer, &candidate.design, report)?;
            candidate.set_energy(energy, self.request);
            Ok(())
        });
        measured.map(drop)
    }
}

/// Sorts designs by their rough cost, after the cheapest one of each organization: a limit on a
/// unit may exclude one organization, and the others must not wait behind all its designs.
fn sort_by_rough_cost(designs: &mut [(&ExaminedCamera, Design)], cost_model: RoughCostModel) {
    designs.sort_by(|(_, one), (_, other)| cost_model.cost(one).total_cmp(&cost_model.cost(other)));
    let firsts = Organization::ALL
        .iter()
        .filter_map(|own| designs.iter().position(|(_, design)| design.organization() == *own));
    let mut firsts: Vec<usize> = firsts.collect();
    firsts.sort_unstable();
    for (to, from) in firsts.into_iter().enumerate() {
        designs[to..=from].rotate_right(1);
    }
}
