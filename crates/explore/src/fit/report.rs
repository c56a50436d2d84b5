// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a fit, for people and programs.

use foveate_design::DesignConfig;
use foveate_estimate::FrameRate;
use foveate_fidelity::FidelityFigures;
use foveate_playback::ClipHalves;
use serde::Serialize;

use super::build::SynthesizedDesigns;
use super::constraints::{ConstraintCheck, all_met};
use super::network::FittedNetwork;
use super::search::{CameraSearch, SecondHalfResult};
use super::{FitRequest, frames_of_halves, reasons};
use crate::cost::DesignArea;
use crate::row::bytes_per_frame;

/// The thresholds for a wanted share of active regions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActivityTarget {
    /// The wanted share, 0..=1.
    pub wanted: f64,
    /// The nearest share that was possible, on the first half.
    pub found: f64,
    /// The task with these thresholds, as TOML.
    pub task: String,
}

/// The chosen design.
#[derive(Clone, Debug, Serialize)]
pub struct FittedDesign {
    /// The configuration, for `generate`.
    #[serde(skip)]
    pub config: DesignConfig,
    /// The configuration as TOML.
    pub toml: String,
    /// A summary in a few words.
    pub summary: String,
    /// The number of clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// The frames per second, at the clock of the request or at the clock that is estimated from
    /// the netlist.
    pub speed: Option<FrameRate>,
    /// The area.
    pub silicon: DesignArea,
    /// The bytes per frame that the camera sends, on the first half and on the second half.
    pub bytes_per_frame: (f64, f64),
    /// The figures on the first half, on which the design was fitted.
    pub fitted: FidelityFigures,
    /// The constraints on the first half.
    pub fitted_held: Vec<ConstraintCheck>,
    /// The figures on the second half, which influenced no choice.
    pub held_out: FidelityFigures,
    /// The constraints on the second half.
    pub held_out_held: Vec<ConstraintCheck>,
}

/// The result of a fit.
#[derive(Clone, Debug, Serialize)]
pub struct FitResult {
    /// The version of the JSON format; it changes if a field changes its meaning or is removed.
    pub format_version: u32,
    /// The numbers of frames of the first halves and of the second halves.
    pub frames: (u64, u64),
    /// The camera that designs are compared with, as TOML.
    pub task: String,
    /// The thresholds of the task, if a share of active regions was wanted.
    pub target: Option<ActivityTarget>,
    /// The clock in Hz, if one was given.
    pub clock_hz: Option<u64>,
    /// The numbers of candidate cameras, of synthesized designs, and of less promising designs that
    /// were skipped.
    pub considered: (usize, usize, usize),
    /// True if the design meets all limits on the first half.
    pub feasible: bool,
    /// True if the design meets all limits on the second half.
    pub borne_out: bool,
    /// The binding limits: without any one of them there would be a design. Empty if there is a
    /// design, or if every design exceeds more than one limit.
    pub binding: Vec<&'static str>,
    /// The agreement of a network, if one was given.
    pub network: Option<FittedNetwork>,
    /// The cheapest design, or the nearest one if no design meets all limits.
    pub design: FittedDesign,
    /// The reasons why this design was chosen.
    pub why: Vec<String>,
    /// The clips that ended early, with the reasons, and the clips that lost frames during the fit.
    pub problems: Vec<String>,
}

pub(super) fn fit_result(
    request: &FitRequest<'_>,
    search: &CameraSearch<'_>,
    (asked, mut reasons): (usize, Vec<String>),
    built: &SynthesizedDesigns,
    target: Option<ActivityTarget>,
    (second, network): (SecondHalfResult, Option<FittedNetwork>),
    halves: &ClipHalves,
) -> FitResult {
    let SecondHalfResult { figures: held_out, checks: mut held, problems: lost } = second;
    let chosen = built.chosen();
    reasons.extend(reasons::reason_lines(search, built, chosen, request));
    held.extend(request.constraints.check_speed(chosen.speed.as_ref()));
    held.extend(request.constraints.check_area(&chosen.silicon));
    let agreement = |network: &FittedNetwork| {
        ConstraintCheck::check_agreement(network.held_out.share, network.min_agreement)
    };
    held.extend(network.as_ref().map(agreement));
    let config = chosen.design.config();
    let bytes = |figures: &FidelityFigures| bytes_per_frame(&chosen.design, figures);
    FitResult {
        format_version: 3,
        frames: frames_of_halves(halves),
        task: DesignConfig { camera: search.task().clone(), ..DesignConfig::default() }.to_toml(),
        target,
        clock_hz: request.clock_hz,
        considered: (
            search.all().count().max(asked),
            built.designs().len(),
            built.left_out_designs,
        ),
        feasible: chosen.meets_limits(),
        borne_out: all_met(&held),
        binding: reasons::binding_limits(built),
        why: reasons,
        problems: [halves.problems.clone(), lost].concat(),
        network,
        design: FittedDesign {
            toml: config.to_toml(),
            summary: reasons::design_text(&chosen.design),
            clocks_per_frame: chosen.clocks_per_frame,
            speed: chosen.speed,
            silicon: chosen.silicon.clone(),
            bytes_per_frame: (bytes(&chosen.look.figures), bytes(&held_out)),
            fitted: chosen.look.figures.clone(),
            fitted_held: chosen.checks.clone(),
            held_out,
            held_out_held: held,
            config,
        },
    }
}
