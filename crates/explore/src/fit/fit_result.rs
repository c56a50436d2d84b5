// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a fit, for people and programs.

use foveate_design::DesignConfig;
use foveate_estimate::FrameRate;
use foveate_measure::FidelityFigures;
use foveate_media::ClipHalves;
use serde::Serialize;

use super::activity_target::ActivityTarget;
use super::camera_search::{CameraSearch, SecondHalfResult};
use super::constraints::{ConstraintCheck, all_met};
use super::network_agreement::{FittedNetwork, KnownAgreements};
use super::synthesis::SynthesizedDesigns;
use super::synthesized_design::SynthesizedDesign;
use super::{CostObjective, FitRequest, reasons};
use crate::cost::DesignArea;
use crate::row::bytes_per_frame;
use crate::target_process::{ProcessEnergy, ProcessFigures};

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
    /// The frames per second, at the clock of the request, at the highest clock in the process if
    /// that is lower, or at the clock that is estimated from the netlist.
    pub speed: Option<FrameRate>,
    /// The area on the FPGA.
    pub silicon: DesignArea,
    /// The cost in the process, with the energy on the first halves; `None` without a process.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub process: Option<ProcessFigures>,
    /// The energy in the process on the second halves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out_energy: Option<ProcessEnergy>,
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
    /// The disturbance of the frames that the designs saw, as `name=value`, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<String>,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
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
    /// The cost that was minimized.
    pub cheapest: CostObjective,
    /// The agreement of a network, if one was given.
    pub network: Option<FittedNetwork>,
    /// The cheapest design, or the nearest one if no design meets all limits.
    pub design: FittedDesign,
    /// The reasons why this design was chosen.
    pub why: Vec<String>,
    /// The clips that ended early, with the reasons, and the clips that lost frames during the fit.
    pub problems: Vec<String>,
}

/// The findings of all steps of a fit.
pub(super) struct FitFindings<'a> {
    pub(super) target: Option<ActivityTarget>,
    pub(super) search: &'a CameraSearch<'a>,
    /// The agreements of the network, if one was given.
    pub(super) agreements: KnownAgreements,
    pub(super) synthesized: SynthesizedDesigns,
    /// The figures of the chosen camera on the second halves, and its energy, if it was measured.
    pub(super) second_half: (SecondHalfResult, Option<ProcessEnergy>),
    pub(super) network: Option<FittedNetwork>,
    pub(super) halves: &'a ClipHalves,
}

impl FitFindings<'_> {
    /// Returns the result for people and programs.
    pub(super) fn into_result(self, request: &FitRequest<'_>) -> FitResult {
        let Self { target, search, agreements, synthesized, second_half, network, halves } = self;
        let chosen = synthesized.chosen();
        let (second_half, energy) = second_half;
        let SecondHalfResult { figures: held_out, mut checks, problems: lost_frames } = second_half;
        checks.extend(request.constraints.check_speed(chosen.speed.as_ref()));
        checks.extend(request.constraints.check_area(&chosen.silicon));
        checks.extend(request.constraints.check_process_area(chosen.process.as_ref()));
        checks.extend(request.constraints.check_power(energy.as_ref()));
        let agreement = |network: &FittedNetwork| {
            ConstraintCheck::check_agreement(network.held_out.share, network.min_agreement)
        };
        checks.extend(network.as_ref().map(agreement));
        let least_agreement = request.network.map_or(0.0, |goal| goal.min_agreement);
        let mut why = agreements.reasons(&chosen.examined.config, least_agreement);
        why.extend(reasons::reason_lines(search, &synthesized, chosen, request));
        FitResult {
            format_version: 5,
            frames: frames_of_halves(halves),
            disturbance: request.disturbance.map(|own| own.to_string()),
            luma: request.input.luma.name(),
            task: DesignConfig { camera: search.task().clone(), ..DesignConfig::default() }
                .to_toml(),
            target,
            clock_hz: request.clock_hz,
            considered: (
                // A descent examines only some of the cameras that the network ran behind.
                search.compared().max(agreements.count()),
                synthesized.designs().len(),
                synthesized.left_out_designs,
            ),
            feasible: chosen.meets_limits(),
            borne_out: all_met(&checks),
            binding: reasons::binding_limits(&synthesized),
            why,
            cheapest: request.cheapest,
            problems: [halves.problems.clone(), lost_frames].concat(),
            network,
            design: FittedDesign::new(chosen, held_out, checks, energy),
        }
    }
}

impl FittedDesign {
    fn new(
        chosen: &SynthesizedDesign,
        held_out: FidelityFigures,
        held_out_checks: Vec<ConstraintCheck>,
        held_out_energy: Option<ProcessEnergy>,
    ) -> Self {
        let config = chosen.design.config();
        let fitted = chosen.examined.figures.clone();
        let bytes = |figures: &FidelityFigures| bytes_per_frame(&chosen.design, figures);
        Self {
            toml: config.to_toml(),
            summary: reasons::design_text(&chosen.design),
            clocks_per_frame: chosen.clocks_per_frame,
            speed: chosen.speed,
            silicon: chosen.silicon.clone(),
            process: chosen.process.clone(),
            held_out_energy,
            bytes_per_frame: (bytes(&fitted), bytes(&held_out)),
            fitted,
            fitted_held: chosen.checks.clone(),
            held_out,
            held_out_held: held_out_checks,
            config,
        }
    }
}

fn frames_of_halves(halves: &ClipHalves) -> (u64, u64) {
    halves
        .frames
        .iter()
        .fold((0, 0), |(first, second), (half, all)| (first + half, second + all - half))
}
