// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a design says what, and of `pipelined` the numbers behind `docs/timing.md`; those of `serial`
//! are in [`crate::serial`].

use crate::{Design, DesignError, Filter, Neighborhood, Organization, SerialTiming};

/// Registers between a median window and the stream that follows it: window, result.
const MEDIAN_REGISTERS: u32 = 2;

/// When a design says what, by its organization.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Timing {
    /// One RPU per region.
    Pipelined(PipelinedTiming),
    /// Lanes under one sequencer.
    Serial(SerialTiming),
}

impl Timing {
    /// Clocks from one frame to the next, where frames follow each other at once.
    #[must_use]
    pub fn clocks_per_frame(&self) -> u64 {
        match self {
            Self::Pipelined(timing) => timing.cycles_per_frame.into(),
            Self::Serial(timing) => timing.clocks_per_frame(),
        }
    }
}

impl Design {
    /// When the design says what.
    #[must_use]
    pub fn timing(&self) -> Timing {
        match self.organization() {
            Organization::Pipelined => Timing::Pipelined(PipelinedTiming::of(self)),
            Organization::Serial => Timing::Serial(SerialTiming::of(self)),
        }
    }

    /// The latencies of a pipelined design, for `user`, such as "the emitter", which knows no other.
    ///
    /// # Errors
    /// When the design is serial; the message names `user`.
    pub fn pipelined_timing(&self, user: &str) -> Result<PipelinedTiming, DesignError> {
        match self.organization() {
            Organization::Pipelined => Ok(PipelinedTiming::of(self)),
            Organization::Serial => Err(DesignError::Combination {
                key: "hardware.organization".to_owned(),
                value: format!("\"{}\"", Organization::Serial),
                with: format!("{user} of this version"),
                remedy: format!("use \"{}\"", Organization::Pipelined),
            }),
        }
    }
}

/// Latencies of a pipelined RPU, in clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PipelinedTiming {
    /// Pixels of a region's stream, halo included; with one pixel per clock also the clocks from
    /// one frame to the next (the initiation interval).
    pub cycles_per_frame: u32,
    /// Clock edges from the one that takes the last pixel of a frame to the one after which
    /// `decision_valid_o` is high, when nothing follows or the next frame follows without a gap.
    /// With `decision_frames` = 1 it is counted from the last pixel of the next frame.
    pub decision_latency: u32,
    /// Frames that must follow before a decision is known: 1 where a feature needs a second pass.
    pub decision_frames: u32,
    /// Frames that must follow before an active region's pixels leave: they leave while the
    /// frame enters the store that many frames later.
    pub forward_frames: u32,
    /// Registers that align windows and counters with features whose score is final a clock later.
    pub tail_delay: u32,
}

impl PipelinedTiming {
    fn of(design: &Design) -> Self {
        let flush = match design.neighborhood() {
            Neighborhood::Isolated => design.region_size() + 1,
            Neighborhood::Shared => 0,
        };
        let median = match design.filter() {
            Filter::None => 0,
            Filter::Median3x3 => flush + MEDIAN_REGISTERS,
        };
        let window = if design.has_feature_window() { flush } else { 0 };
        let slowest = design.features().iter().map(|f| f.kind().score_latency()).max();
        let tail_delay = slowest.map_or(0, |latency| latency - 1);
        let decision_frames = u32::from(design.has_second_pass());
        Self {
            cycles_per_frame: design.stream_pixels(),
            decision_latency: median + window + tail_delay,
            decision_frames,
            forward_frames: decision_frames + 1,
            tail_delay,
        }
    }
}
