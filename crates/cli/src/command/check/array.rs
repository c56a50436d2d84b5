// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of the card about area and speed: lanes, memory, frames per second and folds.

use foveate_camera::Decimal;
use foveate_design::{Design, LaneMemory, MemoryChoice, SerialDesign, SlotArea};
use serde::Serialize;

use crate::args::{ClockFrequency, FramesPerSecond};
use crate::error::CliError;

/// The lanes of a serial design, as the card shows them.
#[derive(Serialize)]
pub(super) struct LaneArray {
    pub(super) lanes: u32,
    pub(super) fold: u32,
    pub(super) feed: &'static str,
    pub(super) memory: LaneMemoryFigures,
}

/// The memory of a lane, in words of one pixel.
#[derive(Serialize)]
pub(super) struct LaneMemoryFigures {
    pub(super) kind: &'static str,
    /// The reason for the kind of memory, in words.
    pub(super) why: String,
    pub(super) read_latency: u32,
    pub(super) words: u64,
    pub(super) slot_words: u32,
    pub(super) areas: Vec<AreaRow>,
}

#[derive(Serialize)]
pub(super) struct AreaRow {
    pub(super) area: String,
    pub(super) base: u32,
    pub(super) side: u32,
    pub(super) words: u32,
}

/// The frames per second at a clock.
#[derive(Serialize)]
pub(super) struct ReachedFrameRate {
    pub(super) clock_hz: u64,
    pub(super) frames_per_second: f64,
    #[serde(skip)]
    pub(super) text: String,
}

/// The clock that a frame rate needs, for a design whose clock is not known.
#[derive(Serialize)]
pub(super) struct RequiredClock {
    pub(super) frames_per_second: f64,
    pub(super) clock_hz: u64,
    #[serde(skip)]
    pub(super) text: String,
}

/// The largest fold that reaches a frame rate, or the rate of fold 1 if no fold reaches it. A
/// design that does not fold has fold 1.
#[derive(Serialize)]
pub(super) struct FoldProposal {
    pub(super) wanted: f64,
    /// True if `fold` reaches the frame rate.
    pub(super) reached: bool,
    pub(super) fold: u32,
    pub(super) lanes: u32,
    pub(super) cycles_per_frame: u64,
    pub(super) frames_per_second: f64,
    #[serde(skip)]
    pub(super) text: String,
}

impl LaneArray {
    pub(super) fn from_design(design: SerialDesign<'_>) -> Self {
        let memory = design.lane_memory();
        let row = |area: &SlotArea| AreaRow {
            area: area.kind.to_string(),
            base: area.base,
            side: area.side,
            words: area.words(),
        };
        Self {
            lanes: design.lanes(),
            fold: design.fold(),
            feed: design.feed().name(),
            memory: LaneMemoryFigures {
                kind: memory.kind.name(),
                why: memory_reason(&memory),
                read_latency: memory.kind.read_latency(),
                words: memory.depth,
                slot_words: memory.slot_words,
                areas: memory.areas.iter().map(row).collect(),
            },
        }
    }
}

/// Returns the reason for the kind of a lane's memory.
fn memory_reason(memory: &LaneMemory) -> String {
    match memory.choice {
        MemoryChoice::Configured => "as hardware.memory says".to_owned(),
        MemoryChoice::LutLimit(most) => {
            let luts = memory.luts;
            let side = if luts <= most { "within" } else { "above" };
            format!(
                "{luts} LUTs if distributed, {side} the limit of {most}; hardware.memory overrides"
            )
        }
    }
}

impl ReachedFrameRate {
    pub(super) fn at_clock(clock: ClockFrequency, clocks: u64) -> Self {
        Self {
            clock_hz: clock.0,
            frames_per_second: frames_per_second(clock, clocks),
            text: format!("{} frames/s at {clock}", frames_per_second_text(clock, clocks)),
        }
    }
}

impl RequiredClock {
    /// Returns the clock for the frame rate `wanted`, or for 1000 frames per second if none is
    /// given.
    pub(super) fn for_frame_rate(wanted: Option<FramesPerSecond>, clocks: u64) -> Self {
        let rate = wanted.unwrap_or(FramesPerSecond(Decimal::from_whole(1000)));
        let clock = rate.required_clock(clocks);
        let mut text =
            format!("{clocks} clocks per frame; {} frames/s need a clock of {clock}", rate.0);
        if wanted.is_some() {
            text += ". `foveate estimate` says whether the design reaches it";
        }
        Self { frames_per_second: rate.per_second(), clock_hz: clock.0, text }
    }
}

impl FoldProposal {
    /// Proposes a fold for a design that folds, whatever its own fold. For any other design, it
    /// states whether the design reaches the rate as it is.
    pub(super) fn for_design(
        design: &Design,
        rate: FramesPerSecond,
        clock: ClockFrequency,
    ) -> Result<Self, CliError> {
        let (most, folds) = (rate.max_clocks(clock), design.organization().has_folding());
        let reaches = design.timing().clocks_per_frame() <= most;
        let found = if folds { design.largest_fold(most) } else { reaches.then_some(1) };
        let fold = found.unwrap_or(1);
        let best = design.with_fold(fold)?;
        let clocks = best.timing().clocks_per_frame();
        let reach = format!(
            "{clocks} clocks per frame, {} frames/s at {clock}",
            frames_per_second_text(clock, clocks)
        );
        let lanes = best.regions().div_ceil(fold);
        let wanted = rate.0;
        let text = match found {
            Some(_) if !folds => format!("{wanted} frames/s are reached: {reach}"),
            Some(fold) => format!("fold {fold} for {wanted} frames/s: {lanes} lanes, {reach}"),
            None if folds => {
                format!("no fold reaches {wanted} frames/s; fold 1 is the fastest: {reach}")
            }
            None => format!(
                "{wanted} frames/s are not reached: {reach}; use a faster clock or a smaller region.size"
            ),
        };
        Ok(Self {
            wanted: rate.per_second(),
            reached: found.is_some(),
            fold,
            lanes,
            cycles_per_frame: clocks,
            frames_per_second: frames_per_second(clock, clocks),
            text,
        })
    }
}

/// Returns the frames per second. Both arguments are far below 2^53.
#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
fn frames_per_second(clock: ClockFrequency, clocks: u64) -> f64 {
    clock.0 as f64 / clocks as f64
}

/// Returns the frames per second, rounded down: whole from 100 on, else with two digits after the
/// point.
fn frames_per_second_text(clock: ClockFrequency, clocks: u64) -> String {
    let hundredths = clock.0 * 100 / clocks;
    match hundredths {
        10_000.. => (hundredths / 100).to_string(),
        _ => format!("{}.{:02}", hundredths / 100, hundredths % 100),
    }
}
