// SPDX-License-Identifier: MIT OR Apache-2.0
//! The card: everything that follows from a configuration, in the form of its JSON.

use foveate_design::{Config, Design, Direction, Organization, Phase, Port, SerialTiming, Timing};
use serde::Serialize;

use super::array::{Array, FrameRate, Proposal};
use crate::args::Clock;

/// Everything that follows from a configuration.
#[derive(Serialize)]
pub(super) struct Card<'a> {
    pub(super) format_version: u32,
    pub(super) fingerprint: String,
    pub(super) config: &'a Config,
    pub(super) grid: Grid,
    pub(super) pixel_max: u32,
    pub(super) region_pixels: u32,
    pub(super) stream: Stream,
    pub(super) features: Vec<Feature>,
    pub(super) count_bits: u32,
    /// Only of a serial design.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) array: Option<Array>,
    pub(super) timing: Clocks,
    pub(super) rate: FrameRate,
    /// Only where a rate was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) proposal: Option<Proposal>,
    pub(super) rpu_ports: Vec<PortRow>,
    pub(super) rcm_ports: Vec<PortRow>,
}

#[derive(Serialize)]
pub(super) struct Grid {
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) regions: u32,
}

#[derive(Serialize)]
pub(super) struct Stream {
    pub(super) halo: u32,
    pub(super) side: u32,
    pub(super) pixels: u32,
}

#[derive(Serialize)]
pub(super) struct Feature {
    pub(super) feature: &'static str,
    pub(super) level: Option<u32>,
    pub(super) level_bits: Option<u32>,
    pub(super) min_score: u64,
    pub(super) score_max: u64,
    pub(super) score_bits: u32,
}

#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Clocks {
    Pipelined(Latencies),
    Serial(Steps),
}

/// What a serial array does with a frame, in clocks.
#[derive(Serialize)]
pub(super) struct Steps {
    pub(super) cycles_per_frame: u64,
    pub(super) load_pixels: u64,
    pub(super) load_clocks: u64,
    pub(super) steps: u64,
    pub(super) slot_steps: u64,
    pub(super) phases: Vec<PhaseRow>,
}

#[derive(Serialize)]
pub(super) struct PhaseRow {
    pub(super) phase: String,
    pub(super) steps: u64,
}

#[derive(Serialize)]
pub(super) struct Latencies {
    pub(super) cycles_per_frame: u32,
    pub(super) decision_latency: u32,
    pub(super) decision_frames: u32,
    pub(super) forward_frames: u32,
}

#[derive(Serialize)]
pub(super) struct PortRow {
    pub(super) name: String,
    pub(super) direction: &'static str,
    pub(super) width: u32,
    pub(super) lanes: u32,
    pub(super) doc: String,
}

impl<'a> Card<'a> {
    pub(super) fn of(design: &'a Design, clock: Clock, proposal: Option<Proposal>) -> Self {
        Self {
            format_version: 1,
            fingerprint: design.fingerprint(),
            config: design.config(),
            grid: Grid {
                columns: design.columns(),
                rows: design.rows(),
                regions: design.regions(),
            },
            pixel_max: design.pixel_max(),
            region_pixels: design.region_pixels(),
            stream: Stream {
                halo: design.halo(),
                side: design.stream_side(),
                pixels: design.stream_pixels(),
            },
            features: design.features().iter().map(Feature::of).collect(),
            count_bits: design.count_bits(),
            timing: match design.timing() {
                Timing::Pipelined(timing) => Clocks::Pipelined(Latencies {
                    cycles_per_frame: timing.cycles_per_frame,
                    decision_latency: timing.decision_latency,
                    decision_frames: timing.decision_frames,
                    forward_frames: timing.forward_frames,
                }),
                Timing::Serial(timing) => Clocks::Serial(Steps::of(&timing)),
            },
            array: match design.organization() {
                Organization::Pipelined => None,
                Organization::Serial => Some(Array::of(design)),
            },
            rate: FrameRate::of(clock, design.timing().clocks_per_frame()),
            proposal,
            rpu_ports: design.rpu_ports().iter().map(PortRow::of).collect(),
            rcm_ports: design.rcm_ports().iter().map(PortRow::of).collect(),
        }
    }
}

impl Steps {
    fn of(timing: &SerialTiming) -> Self {
        let row =
            |(phase, steps): &(Phase, u64)| PhaseRow { phase: phase.to_string(), steps: *steps };
        Self {
            cycles_per_frame: timing.clocks_per_frame(),
            load_pixels: timing.load_pixels(),
            load_clocks: timing.load_clocks(),
            steps: timing.steps(),
            slot_steps: timing.slot_steps(),
            phases: timing.phases().iter().map(row).collect(),
        }
    }
}

impl Feature {
    fn of(feature: &foveate_design::SpatialFeature) -> Self {
        Self {
            feature: feature.kind().name(),
            level: feature.level(),
            level_bits: feature.level().map(|_| feature.level_bits()),
            min_score: feature.min_score(),
            score_max: feature.score_max(),
            score_bits: feature.score_bits(),
        }
    }
}

impl PortRow {
    fn of(port: &Port) -> Self {
        Self {
            name: port.name.clone(),
            direction: match port.direction {
                Direction::Input => "input",
                Direction::Output => "output",
            },
            width: port.width,
            lanes: port.lanes,
            doc: port.doc.clone(),
        }
    }
}
