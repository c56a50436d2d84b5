// SPDX-License-Identifier: MIT OR Apache-2.0
//! A fit: the search for the cheapest design that a scene needs. The design is fitted on the first
//! half of every clip and reported on the second half.
//!
//! 1. If a share of active regions is wanted, the task's thresholds are set for it
//!    ([`activity_target`]).
//! 2. The search tries cameras. A camera says what is computed, and not how it is built. The search
//!    tries region sizes and features, and for the best of them all depths, windows, filters and
//!    references ([`camera_search`]), each with the thresholds that are nearest to the limits
//!    ([`threshold_search`]). Thresholds are chosen on the first two thirds of the first half. All
//!    limits must hold there and on the rest of the first half ([`search_frames`]), with a margin
//!    for other frames ([`decision_rates`]). With a network, the search is a descent from the task
//!    instead: the network must agree, behind the camera, with its outputs for whole frames
//!    ([`descent`], [`network_agreement`]).
//! 3. Of the cameras that meet the limits, only the simplest are built: a camera is dropped if a
//!    simpler one also meets the limits. If the fewest bytes are wanted, only the cameras that send
//!    the fewest are built ([`simplest_cameras`]). Each is built with every feed and with the folds
//!    that are fast enough and may be the cheapest; pipelined, if no serial array is fast enough
//!    or with a process; and as a raster core, if one is fast enough ([`possible_designs`]). The
//!    most promising designs are synthesized first ([`rough_cost`], [`synthesis`]). If no clock is given, a
//!    planned clock decides which designs are tried. The clock that is estimated from the netlist
//!    decides whether they are fast enough, and which are folded again ([`slower_designs`]).
//! 4. The cheapest design is chosen, with the reasons why no simpler one is enough ([`reasons`]),
//!    measured on the second half ([`CameraSearch::measure_second_half`]), and reported
//!    ([`fit_result`]).

mod activity_target;
mod camera_search;
mod constraints;
mod cost_objective;
mod decision_rates;
mod descent;
mod fit_result;
mod network_agreement;
mod possible_designs;
mod reasons;
mod rough_cost;
mod search_frames;
mod simplest_cameras;
mod slower_designs;
mod synthesis;
mod synthesized_design;
#[cfg(test)]
mod test_clip;
mod threshold_search;

pub(crate) use camera_search::exact_fraction_bits;
pub(crate) use decision_rates::{DecisionGroups, group_margin};

use std::ops::Range;
use std::path::PathBuf;

use foveate_cosim::ActivityClip;
use foveate_design::{DesignConfig, HardwareConfig, LaneMemoryKind, OrganizationConfig};
use foveate_media::{ClipHalves, InputOptions, RunHooks, RunMonitor};

use super::progress::reading_progress;
use crate::cost::Synthesizer;
use crate::footage::ExplorationFootage;
use crate::target_process::{EnergyClips, TargetProcess};
use crate::{Disturbance, ExploreError};
use activity_target::task_for_target;
use camera_search::CameraSearch;
use descent::Descent;
use fit_result::FitFindings;
use network_agreement::{KnownAgreements, NetworkAgreement};
use search_frames::ClipPart;
use synthesis::synthesize_promising_designs;

pub use activity_target::ActivityTarget;
pub use constraints::{ConstraintCheck, Constraints};
pub use cost_objective::CostObjective;
pub use fit_result::{FitResult, FittedDesign};
pub use network_agreement::{AgreementEstimate, FittedNetwork, NetworkGoal};

/// The request of a fit.
#[derive(Clone, Debug)]
pub struct FitRequest<'a> {
    /// The task of the camera. The ideal camera performs it in floating point over whole frames.
    pub task: &'a DesignConfig,
    /// The clips, which have one size.
    pub inputs: &'a [PathBuf],
    /// The options for reading the clips.
    pub input: &'a InputOptions,
    /// A disturbance of the frames that candidates see; the ideal camera sees the clips as they
    /// are.
    pub disturbance: Option<Disturbance>,
    /// The limits that the design must meet.
    pub constraints: &'a Constraints,
    /// The clock in Hz, if it is known. Otherwise the clock of each design is estimated from its
    /// netlist, and [`Constraints::min_fps`] is checked at the low end of its range. With a
    /// process, a design has the highest clock in its cells, or this one if it is lower.
    pub clock_hz: Option<u64>,
    /// The wanted share of active regions, 0..=1; the task's thresholds are set to reach it.
    pub target_active: Option<f64>,
    /// The ground-truth boxes for [`Constraints::min_recall`]: one file or folder for all inputs,
    /// or one for each.
    pub boxes: &'a [PathBuf],
    /// The cost that is minimized.
    pub cheapest: CostObjective,
    /// A process in whose cells designs are measured, too: their area, and their energy at
    /// [`Constraints::min_fps`], or else at 30 frames per second.
    pub process: Option<&'a TargetProcess>,
    /// A network that must agree, behind the camera, with its outputs for whole frames.
    pub network: Option<NetworkGoal<'a>>,
    /// The synthesizer, for areas.
    pub synthesizer: &'a Synthesizer,
    /// The most designs that are synthesized. If none of them meets all limits, up to 16 more are
    /// synthesized, to find the nearest one and the binding limits.
    pub max_designs: usize,
}

impl FitRequest<'_> {
    /// Returns true if the choice of a design depends on its energy.
    fn is_decided_by_energy(&self) -> bool {
        self.cheapest == CostObjective::Energy || self.constraints.max_mw.is_some()
    }

    /// Refuses costs and limits in a process if there is none.
    fn check_process(&self) -> Result<(), ExploreError> {
        let Constraints { max_mm2, max_mw, .. } = self.constraints;
        let figures = [
            (self.cheapest == CostObjective::Mm2, "the cost mm2"),
            (self.cheapest == CostObjective::Energy, "the cost energy"),
            (max_mm2.is_some(), "--max-mm2"),
            (max_mw.is_some(), "--max-mw"),
        ];
        match figures.into_iter().find(|(is_needed, _)| *is_needed && self.process.is_none()) {
            Some((_, figure)) => Err(ExploreError::NoProcess { figure }),
            None => Ok(()),
        }
    }

    /// Returns the least number of frames of a clip.
    fn min_frames(&self) -> u64 {
        // Each half is a clip whose activity is measured.
        let of_energy = self.process.map_or(0, |_| 2 * ActivityClip::MIN_FRAMES);
        of_energy.max(ClipPart::MIN_FRAMES)
    }

    /// Returns the first halves and the second halves of all clips, on which energies are measured,
    /// if there is a process.
    fn energy_halves<'c>(
        &'c self,
        footage: &'c ExplorationFootage<'_>,
        halves: &ClipHalves,
    ) -> Option<[EnergyClips<'c>; 2]> {
        let process = self.process?;
        let of = |half: fn(u64, u64) -> Range<u64>| {
            let frames = halves.frames.iter().map(|&(first, all)| half(first, all));
            EnergyClips::new(process, &footage.clips, frames, self.constraints.min_fps)
        };
        Some([of(|first, _| 0..first), of(|first, all| first..all)])
    }
}

/// Finds the cheapest design that meets the limits on the first half of the footage, or the nearest
/// one if no design does, and measures it on the second half.
///
/// # Errors
/// Fails if the task has zones, if a cost or a limit needs a process and there is none, if an input
/// cannot be read or is too short to be halved, if Yosys is missing or fails, or if `hooks`
/// cancels.
pub fn fit(request: &FitRequest<'_>, hooks: &dyn RunHooks) -> Result<FitResult, ExploreError> {
    if request.task.camera.zones.is_some() {
        return Err(ExploreError::Zones);
    }
    request.check_process()?;
    let (task, lane_memory) = task_without_hardware(request.task);
    let request = &FitRequest { task: &task, ..request.clone() };
    let inputs = (request.inputs, request.boxes);
    let footage = ExplorationFootage::new(inputs, request.input, &request.task.camera, hooks)?;
    let monitor = RunMonitor::of_stage(hooks, &reading_progress);
    let halves = ClipHalves::count(&footage.clips, request.min_frames(), &monitor)?;
    if let Some([first, _]) = request.energy_halves(&footage, &halves) {
        first.check()?;
    }
    let (task, target) = task_for_target(request, &footage, &halves)?;
    let footage = footage.with_ideal(&task).disturbed(request.disturbance);
    let energy_halves = request.energy_halves(&footage, &halves);
    let hardware = &request.task.hardware;
    let mut search = CameraSearch::new(request.constraints, &footage, &halves, &task, hardware)?;
    let network =
        request.network.map(|goal| NetworkAgreement::new(goal, &footage, &halves, search.task()));
    let network = network.transpose()?;
    let agreements = match &network {
        None => {
            search.run()?;
            KnownAgreements::default()
        }
        Some(network) => Descent::new(&mut search, network, request).run()?,
    };
    let mut synthesized = synthesize_promising_designs(
        &search,
        (request, lane_memory),
        energy_halves.as_ref().map(|[first, _]| first),
        hooks,
    )?;
    let second_energy = match &energy_halves {
        None => None,
        Some(halves) => synthesized.chosen_mut().measure_halves(halves, request)?,
    };
    let chosen = &synthesized.chosen().examined;
    let second_half = search.measure_second_half(chosen)?;
    let network = network.map(|network| {
        network.fitted_network(&chosen.config, agreements.agreements_of(&chosen.config))
    });
    let network = network.transpose()?;
    let (search, halves) = (&search, &halves);
    let second_half = (second_half, second_energy);
    let findings =
        FitFindings { target, search, agreements, synthesized, second_half, network, halves };
    Ok(findings.into_result(request))
}

/// Returns the task without the hardware settings that do not affect what the camera computes, and
/// the kind of lane memory that a serial task asks for. `thresholds` and `sync` stay in the task,
/// because every candidate design takes them over.
fn task_without_hardware(task: &DesignConfig) -> (DesignConfig, Option<LaneMemoryKind>) {
    let HardwareConfig { ref organization, thresholds, sync, .. } = task.hardware;
    let lane_memory = match organization {
        OrganizationConfig::Serial(own) => own.memory,
        OrganizationConfig::Pipelined | OrganizationConfig::Raster(_) => None,
    };
    let hardware = HardwareConfig { thresholds, sync, ..HardwareConfig::default() };
    (DesignConfig { hardware, ..task.clone() }, lane_memory)
}
