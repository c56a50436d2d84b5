// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesis of the designs that may be the cheapest: which designs are synthesized, in which
//! order, and when that ends.

use foveate_design::{Design, LaneMemoryKind, Organization};
use foveate_estimate::{FpgaDevice, FrameRate};
use foveate_playback::RunHooks;

use super::FitRequest;
use super::camera_search::{CameraSearch, ExaminedCamera};
use super::constraints::{ConstraintCheck, all_met, total_excess};
use super::network_goal::CostObjective;
use super::possible_designs::{BuildBounds, possible_designs};
use super::rough_cost::rough_cost;
use super::simplest_cameras::{cameras_with_fewest_bytes, simplest_cameras};
use super::slower_designs::{expected_cost, slower_designs};
use crate::ExploreError;
use crate::cost::{DesignArea, SynthesisResult};
use crate::row::count_to_f64;

/// The number of nearest cameras that are built if no camera meets the limits.
const MAX_NEAREST_CAMERAS: usize = 6;
/// The number of designs that are synthesized before checking whether one meets the limits.
const BATCH_SIZE: usize = 8;
/// The most designs that are folded again for their own clocks.
const MAX_SLOWER_DESIGNS: usize = 4;

/// A synthesized design.
#[derive(Clone, Debug)]
pub(super) struct SynthesizedDesign {
    /// The camera that the design computes, with its figures.
    pub(super) examined: ExaminedCamera,
    pub(super) design: Design,
    pub(super) clocks_per_frame: u64,
    /// The speed at the clock of the request, or else at the estimated clock.
    pub(super) speed: Option<FrameRate>,
    pub(super) silicon: DesignArea,
    /// All constraints, with the figures of this design.
    pub(super) checks: Vec<ConstraintCheck>,
}

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

    pub(super) fn designs(&self) -> &[SynthesizedDesign] {
        &self.candidates
    }
}

impl SynthesizedDesign {
    pub(super) fn meets_limits(&self) -> bool {
        all_met(&self.checks)
    }

    pub(super) fn excess(&self) -> f64 {
        total_excess(&self.checks)
    }

    /// Returns the cost of the array, as a share of the device.
    pub(super) fn cost(&self) -> f64 {
        FpgaDevice::xcvu9p().cost(&self.silicon.array)
    }
}

/// Synthesizes the designs that may be the cheapest. If none of them meets the limits, it also
/// synthesizes the nearest ones.
pub(super) fn synthesize_promising_designs(
    search: &CameraSearch<'_>,
    request: &FitRequest<'_>,
    memory: Option<LaneMemoryKind>,
    hooks: &dyn RunHooks,
) -> Result<SynthesizedDesigns, ExploreError> {
    let holding: Vec<&ExaminedCamera> =
        search.all().filter(|examined| examined.meets_limits()).collect();
    let promising = match request.network.map(|goal| goal.cheapest) {
        None | Some(CostObjective::Area) => simplest_cameras(&holding),
        // All designs of a camera send the same bytes.
        Some(CostObjective::Bytes) => cameras_with_fewest_bytes(&holding)?,
    };
    let bounds = BuildBounds::of_request(request, memory);
    let (mut candidates, mut left_out) =
        synthesize_in_batches(&promising, bounds, request.max_designs, request, hooks)?;
    add_slower_designs(&mut candidates, request, hooks)?;
    if !candidates.iter().any(SynthesizedDesign::meets_limits) {
        // Nothing meets the limits. The nearest cameras are built, and those that would meet the
        // limits at a lower speed, to find the binding limits.
        let mut nearest: Vec<&ExaminedCamera> =
            search.all().filter(|examined| !examined.meets_limits()).collect();
        nearest.sort_by(|one, other| one.excess().total_cmp(&other.excess()));
        nearest.truncate(MAX_NEAREST_CAMERAS);
        for (cameras, bounds) in [(&nearest, bounds), (&promising, bounds.at_any_speed())] {
            let most = request.max_designs.min(BATCH_SIZE);
            let (built, left) = synthesize_in_batches(cameras, bounds, most, request, hooks)?;
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

/// Looks for cheaper designs among those that meet the limits: it folds them again for their own
/// clock, which is faster than the planned one, or halves their pixels per clock. A design is
/// synthesized if it is expected to be cheaper than the cheapest so far, the most promising first.
fn add_slower_designs(
    candidates: &mut Vec<SynthesizedDesign>,
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<(), ExploreError> {
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
                let cost = expected_cost(&design, &candidate.silicon);
                (cost, &candidate.examined, design)
            };
            slower.unwrap_or_default().into_iter().filter(is_new).map(expected)
        });
        let promising = slower.filter(|(cost, ..)| *cost < least);
        let best = promising.min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((_, examined, design)) = best else { break };
        let examined = examined.clone();
        candidates.extend(synthesize(&[(&examined, design)], request, hooks)?);
    }
    Ok(())
}

/// Synthesizes the designs of some cameras, the promising ones first, until one meets the limits or
/// there are `most` of them. Returns the number of designs that are left out.
fn synthesize_in_batches(
    cameras: &[&ExaminedCamera],
    bounds: BuildBounds,
    most: usize,
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<(Vec<SynthesizedDesign>, usize), ExploreError> {
    let mut designs: Vec<(&ExaminedCamera, Design)> = Vec::new();
    for examined in cameras {
        let own = possible_designs(&examined.config, &request.task.hardware, bounds);
        designs.extend(own.into_iter().map(|design| (*examined, design)));
    }
    sort_by_rough_cost(&mut designs);
    let all = designs.len();
    let mut built = Vec::new();
    for batch in designs[..all.min(most)].chunks(BATCH_SIZE) {
        built.extend(synthesize(batch, request, hooks)?);
        if built.iter().any(SynthesizedDesign::meets_limits) {
            break;
        }
    }
    let left_out = all - built.len();
    Ok((built, left_out))
}

/// Sorts designs by their rough cost, and takes the organizations in turn. A limit on a unit may
/// exclude one organization, and the others must not wait behind all its designs.
fn sort_by_rough_cost(designs: &mut Vec<(&ExaminedCamera, Design)>) {
    designs.sort_by(|(_, one), (_, other)| rough_cost(one).total_cmp(&rough_cost(other)));
    let mut turns = [0; Organization::ALL.len()];
    let turn = |(examined, design): (_, Design)| {
        let number = design.organization() as usize;
        turns[number] += 1;
        (turns[number], (examined, design))
    };
    let mut turned: Vec<_> = designs.drain(..).map(turn).collect();
    turned.sort_by_key(|(turn, _)| *turn);
    designs.extend(turned.into_iter().map(|(_, design)| design));
}

/// Synthesizes designs.
fn synthesize(
    designs: &[(&ExaminedCamera, Design)],
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<Vec<SynthesizedDesign>, ExploreError> {
    let designs_alone = designs.iter().map(|(_, design)| design);
    let found = request.synthesizer.synthesize_designs(designs_alone, hooks)?.into_results()?;
    let candidate =
        |((examined, design), synthesized): (&(&ExaminedCamera, Design), SynthesisResult)| {
            let SynthesisResult { silicon, speed: estimated } = synthesized;
            let clocks_per_frame = design.timing().clocks_per_frame();
            let given = request.clock_hz.map(|hertz| {
                FrameRate::at_given_clock(count_to_f64(hertz) / 1e6, clocks_per_frame)
            });
            let speed = given.or(estimated);
            let mut checks = examined.checks.clone();
            checks.extend(request.constraints.check_speed(speed.as_ref()));
            checks.extend(request.constraints.check_area(&silicon));
            let (examined, design) = ((*examined).clone(), design.clone());
            SynthesizedDesign { examined, design, clocks_per_frame, speed, silicon, checks }
        };
    Ok(designs.iter().zip(found).map(candidate).collect())
}
