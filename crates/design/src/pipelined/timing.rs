// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a pipelined design: the numbers behind `docs/timing.md`.

use crate::timing::DepartureTiming;
use crate::{DesignTiming, FeatureHardware, PipelinedDesign, Pipelining};
use foveate_camera::Neighborhood;

/// Registers between a filter window and the stream behind it in a plain design: window, result.
const FILTER_REGISTERS: u32 = 2;
/// Registers between a filter window and the stream behind it in a deep design: window, rows,
/// result.
const DEEP_FILTER_REGISTERS: u32 = 3;
/// Clocks from the step of the last pixel until the temporal count is final in a plain design: the
/// count.
const COUNT_LATENCY: u32 = 1;
/// Clocks from the step of the last pixel until the temporal count is final in a deep design:
/// pixel, difference, count.
const DEEP_COUNT_LATENCY: u32 = 3;

/// Latencies of a pipelined RPU, in clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PipelinedTiming {
    /// Pixels of the stream of a region, halo included. With one pixel per clock they are also the
    /// clocks from one frame to the next (the initiation interval).
    pub cycles_per_frame: u32,
    /// Clock edges from the one that takes the last pixel of a frame to the one after which
    /// `decision_valid_o` is 1, when no frame follows or the next frame follows without a gap. With
    /// `decision_frames` = 1 they are counted from the last pixel of the next frame.
    pub decision_latency: u32,
    /// Number of frames that must follow before a decision is known: 1 if a feature needs a second
    /// pass, else 0.
    pub decision_frames: u32,
    /// Number of frames that must follow before the pixels of an active region leave. They leave
    /// while the last of these frames enters the frame store.
    pub forward_frames: u32,
    /// Clocks from the step of a filter window to the edge at which the next stage takes its
    /// result.
    pub filter_registers: u32,
    /// Clocks from a step of the last window to its tail step.
    pub tail_delay: u32,
}

impl PipelinedTiming {
    /// Returns the latencies of the design.
    #[must_use]
    pub fn from_design(design: PipelinedDesign<'_>) -> Self {
        let flush = match design.neighborhood() {
            Neighborhood::Isolated => design.region_size() + 1,
            Neighborhood::Shared => 0,
        };
        let pipelining = design.pipelining();
        let (filter_registers, count_latency) = match pipelining {
            Pipelining::Plain => (FILTER_REGISTERS, COUNT_LATENCY),
            Pipelining::Deep => (DEEP_FILTER_REGISTERS, DEEP_COUNT_LATENCY),
        };
        let score_latency = |kind| FeatureHardware::in_pipelined(kind).score_latency(pipelining);
        let latencies = design.features().iter().map(|feature| score_latency(feature.kind()));
        // The tail is delayed so far that every score is final when the frame is done.
        let tail_delay = latencies.fold(count_latency, u32::max) - 1;
        let filter = if design.filter().has_window() { flush + filter_registers } else { 0 };
        let window = if design.has_feature_window() { flush } else { 0 };
        let decision_frames = u32::from(design.has_second_pass());
        Self {
            cycles_per_frame: design.stream_pixels(),
            decision_latency: filter + window + tail_delay,
            decision_frames,
            forward_frames: decision_frames + 1,
            filter_registers,
            tail_delay,
        }
    }

    /// Returns the timing in terms that every organization has.
    pub(super) fn to_design_timing(self) -> DesignTiming {
        let of = if self.decision_frames == 0 { "" } else { " of the next frame" };
        let which = if self.forward_frames == 1 { "next frame" } else { "next frame but one" };
        DesignTiming {
            clocks_per_frame: self.cycles_per_frame.into(),
            pixels_per_frame: self.cycles_per_frame.into(),
            figures: vec![
                ("cycles_per_frame", self.cycles_per_frame.into()),
                ("decision_latency", self.decision_latency.into()),
                ("decision_frames", self.decision_frames.into()),
                ("forward_frames", self.forward_frames.into()),
            ],
            phases: Vec::new(),
            descriptions: vec![
                ("cycles per frame", self.cycles_per_frame.to_string()),
                (
                    "decision",
                    format!("valid {} clocks after the last pixel{of}", self.decision_latency),
                ),
                ("pixels leave", format!("while the {which} enters")),
            ],
            departure: DepartureTiming {
                take_clocks: self.cycles_per_frame.into(),
                decision_frames: self.decision_frames,
                decision_clocks: self.decision_latency.into(),
                forward_frames: self.forward_frames,
                // The last pixel leaves at the tail step that ends the later frame, which is also
                // the step of a decision.
                forward_clocks: self.decision_latency.into(),
                slot_clocks: 0,
                buffered_rows: None,
                has_independent_units: true,
            },
        }
    }
}
