// SPDX-License-Identifier: MIT OR Apache-2.0
//! A fit: the search for the cheapest design that a scene needs. The design is fitted on the first
//! half of every clip and reported on the second half.
//!
//! 1. If a share of active regions is wanted, the task's thresholds are set for it ([`target`]).
//! 2. The search tries cameras. A camera says what is computed, and not how it is built. The search
//!    tries region sizes and features, each with the thresholds that agree best with the ideal. For
//!    the best of them it tries all depths, windows, filters and references ([`search`]). With a
//!    network, the search is a descent from the task instead: the network must agree, behind the
//!    camera, with its outputs for whole frames ([`descent`], [`network`]).
//! 3. Of the cameras that meet the limits, only the simplest are built: a camera is dropped if a
//!    simpler one also meets the limits. Each is built with every feed and with the folds that are
//!    fast enough and may be the cheapest, or pipelined if no serial array is fast enough; and as a
//!    raster core, if one is fast enough ([`build`]). The most promising designs are synthesized
//!    first ([`rough_cost`]). If no clock is given, a planned clock decides which designs are
//!    tried. The clock that is estimated from the netlist decides whether they are fast enough, and
//!    which are folded again ([`plan`]).
//! 4. The cheapest design is chosen, with the reasons why no simpler one is enough ([`reasons`]).

mod agreement;
mod build;
mod constraints;
mod descent;
mod network;
mod plan;
mod reasons;
mod report;
mod rough_cost;
mod search;
mod target;
#[cfg(test)]
mod test_clip;

use std::path::PathBuf;

use foveate_design::{DesignConfig, HardwareConfig, OrganizationConfig};
use foveate_footage::InputOptions;
use foveate_playback::{ClipHalves, RunHooks, RunMonitor};

use crate::ExploreError;
use crate::cost::Synthesizer;
use crate::footage::ExplorationFootage;
use crate::progress::reading_progress;
use build::build_designs;
use descent::{Descent, KnownAgreements};
use network::{ClipPart, NetworkAgreement};
use search::CameraSearch;

pub use agreement::AgreementEstimate;
pub use constraints::{ConstraintCheck, Constraints};
pub use network::{CostObjective, FittedNetwork, NetworkGoal};
pub use report::{ActivityTarget, FitResult, FittedDesign};

/// The least number of frames of a clip: each half needs a first frame, and one that can change.
const MIN_FRAMES: u64 = 4;

/// The request of a fit.
#[derive(Clone, Debug)]
pub struct FitRequest<'a> {
    /// The task of the camera. The ideal camera performs it in floating point over whole frames.
    pub task: &'a DesignConfig,
    /// The clips, which have one size.
    pub inputs: &'a [PathBuf],
    /// The options for reading the clips.
    pub input: &'a InputOptions,
    /// The limits that the design must meet.
    pub constraints: &'a Constraints,
    /// The clock in Hz, if it is known. Otherwise the clock of each design is estimated from its
    /// netlist, and [`Constraints::min_fps`] is checked at the low end of its range.
    pub clock_hz: Option<u64>,
    /// The wanted share of active regions, 0..=1; the task's thresholds are set to reach it.
    pub target_active: Option<f64>,
    /// The ground-truth boxes for [`Constraints::min_recall`]: one file or folder for all inputs,
    /// or one for each.
    pub boxes: &'a [PathBuf],
    /// A network that must agree, behind the camera, with its outputs for whole frames.
    pub network: Option<NetworkGoal<'a>>,
    /// The synthesizer, for areas.
    pub synthesizer: &'a Synthesizer,
    /// The most designs that are synthesized: of those that meet all other limits, or of the
    /// nearest ones.
    pub max_designs: usize,
}

/// Finds the cheapest design that meets the limits on the first half of the footage, or the nearest
/// one if no design does, and measures it on the second half.
///
/// # Errors
/// Fails if an input cannot be read or is too short to be halved, if Yosys is missing or fails, or
/// if `hooks` cancels.
pub fn fit(request: &FitRequest<'_>, hooks: &dyn RunHooks) -> Result<FitResult, ExploreError> {
    // The hardware settings of the task do not affect what the camera computes, so they are
    // dropped. `thresholds` and `sync` stay, because every candidate design takes them over;
    // `memory` goes to `build`.
    let HardwareConfig { ref organization, thresholds, sync, .. } = request.task.hardware;
    let memory = match organization {
        OrganizationConfig::Serial(own) => own.memory,
        OrganizationConfig::Pipelined | OrganizationConfig::Raster(_) => None,
    };
    let hardware = HardwareConfig { thresholds, sync, ..HardwareConfig::default() };
    let task = DesignConfig { hardware, ..request.task.clone() };
    let request = &FitRequest { task: &task, ..request.clone() };
    let (inputs, camera) = ((request.inputs, request.boxes), &request.task.camera);
    let footage = ExplorationFootage::new(inputs, request.input, camera, hooks)?;
    let least = if request.network.is_some() { ClipPart::MIN_FRAMES } else { MIN_FRAMES };
    let monitor = RunMonitor::of_stage(hooks, &reading_progress);
    let lengths = ClipHalves::count(&footage.clips, least, &monitor)?;
    let (task, target) = target::task_for_target(request, &footage, &lengths)?;
    let footage = footage.with_ideal(&task);
    let mut search = CameraSearch::new(request.constraints, &footage, &lengths, &task)?;
    let jury =
        request.network.map(|goal| NetworkAgreement::new(goal, &footage, &lengths, search.task()));
    let jury = jury.transpose()?;
    let asked = match &jury {
        None => {
            search.run()?;
            KnownAgreements::default()
        }
        Some(jury) => Descent::new(&mut search, jury, &request.task.hardware).run()?,
    };
    let built = build_designs(&search, request, memory, hooks)?;
    let chosen = built.chosen();
    let camera = &chosen.look.config;
    let least = request.network.map_or(0.0, |goal| goal.min_agreement);
    let steps = (asked.count(), asked.reasons(camera, least));
    let second = search.measure_second_half(&chosen.look)?;
    let network =
        jury.map(|jury| jury.fitted_network(camera, asked.agreements_of(camera))).transpose()?;
    Ok(report::fit_result(request, &search, steps, &built, target, (second, network), &lengths))
}

/// Returns the number of frames of the first halves and of the second halves of all clips.
fn frames_of_halves(halves: &ClipHalves) -> (u64, u64) {
    halves
        .frames
        .iter()
        .fold((0, 0), |(first, second), (half, all)| (first + half, second + all - half))
}
