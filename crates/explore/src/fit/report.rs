// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a fit, for people and programs.

use foveate_design::Config;
use foveate_estimate::Speed;
use foveate_fidelity::Figures;
use serde::Serialize;

use super::build::Built;
use super::constraints::{Held, all_hold};
use super::held_out::Halves;
use super::looks::Search;
use super::network::FittedNetwork;
use super::{FitRequest, frames, why};
use crate::cost::Silicon;
use crate::row::bytes_per_frame;

/// The thresholds for a wanted share of active regions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Target {
    /// The wanted share, 0..=1.
    pub wanted: f64,
    /// The nearest share that was possible, on the first half.
    pub found: f64,
    /// The task with these thresholds, as TOML.
    pub task: String,
}

/// The chosen design.
#[derive(Clone, Debug, Serialize)]
pub struct Design {
    /// The configuration, for `generate`.
    #[serde(skip)]
    pub config: Config,
    /// The configuration as TOML.
    pub toml: String,
    /// A summary in a few words.
    pub summary: String,
    /// The number of clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// The frames per second, at the clock of the request or at the clock that is estimated from
    /// the netlist.
    pub speed: Option<Speed>,
    /// The area.
    pub silicon: Silicon,
    /// The bytes per frame that the camera sends, on the first half and on the second half.
    pub bytes_per_frame: (f64, f64),
    /// The figures on the first half, on which the design was fitted.
    pub fitted: Figures,
    /// The constraints on the first half.
    pub fitted_held: Vec<Held>,
    /// The figures on the second half, which influenced no choice.
    pub held_out: Figures,
    /// The constraints on the second half.
    pub held_out_held: Vec<Held>,
}

/// The result of a fit.
#[derive(Clone, Debug, Serialize)]
pub struct Fit {
    /// The version of the JSON format; it changes if a field changes its meaning or is removed.
    pub format_version: u32,
    /// The numbers of frames of the first halves and of the second halves.
    pub frames: (u64, u64),
    /// The camera that designs are compared with, as TOML.
    pub task: String,
    /// The thresholds of the task, if a share of active regions was wanted.
    pub target: Option<Target>,
    /// The clock in Hz, if one was given.
    pub clock_hz: Option<u64>,
    /// The numbers of candidate cameras, of synthesized designs, and of less promising designs that
    /// were skipped.
    pub considered: (usize, usize, usize),
    /// Whether the design meets all limits on the first half.
    pub feasible: bool,
    /// Whether the design meets all limits on the second half.
    pub borne_out: bool,
    /// The binding limits: without any one of them there would be a design. Empty if there is a
    /// design, or if every design exceeds more than one limit.
    pub binding: Vec<&'static str>,
    /// The agreement of a network, if one was given.
    pub network: Option<FittedNetwork>,
    /// The cheapest design, or the nearest one if no design meets all limits.
    pub design: Design,
    /// The reasons why this design was chosen.
    pub why: Vec<String>,
    /// The clips that ended early, with the reasons.
    pub problems: Vec<String>,
}

pub(super) fn fit(
    request: &FitRequest<'_>,
    search: &Search<'_>,
    (asked, mut reasons): (usize, Vec<String>),
    built: &Built,
    target: Option<Target>,
    ((held_out, mut held), network): ((Figures, Vec<Held>), Option<FittedNetwork>),
    halves: &Halves,
) -> Fit {
    let chosen = built.chosen();
    reasons.extend(why::why(search, built, chosen, request));
    held.extend(request.constraints.on_speed(chosen.speed.as_ref()));
    held.extend(request.constraints.on_silicon(&chosen.silicon));
    let agreement =
        |network: &FittedNetwork| Held::agreement(network.held_out.share, network.min_agreement);
    held.extend(network.as_ref().map(agreement));
    let config = chosen.design.config();
    let bytes = |figures: &Figures| bytes_per_frame(&chosen.design, figures);
    Fit {
        format_version: 3,
        frames: frames(halves),
        task: Config { camera: search.task().clone(), ..Config::default() }.to_toml(),
        target,
        clock_hz: request.clock_hz,
        considered: (search.all().count().max(asked), built.all().len(), built.left_out),
        feasible: chosen.holds(),
        borne_out: all_hold(&held),
        binding: why::binding(built),
        why: reasons,
        problems: halves.problems.clone(),
        network,
        design: Design {
            toml: config.to_toml(),
            summary: why::summary(&chosen.design),
            clocks_per_frame: chosen.clocks_per_frame,
            speed: chosen.speed,
            silicon: chosen.silicon.clone(),
            bytes_per_frame: (bytes(&chosen.look.figures), bytes(&held_out)),
            fitted: chosen.look.figures.clone(),
            fitted_held: chosen.held.clone(),
            held_out,
            held_out_held: held,
            config,
        },
    }
}
