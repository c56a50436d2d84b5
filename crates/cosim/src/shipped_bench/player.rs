// SPDX-License-Identifier: MIT OR Apache-2.0
//! The player of a script ([`ScriptPlayer`]): it offers the frames to the cycle-level model,
//! and its clocks become the vectors of the bench, packed into text and counted
//! ([`VectorRecorder`]).

use super::script::{BenchFrame, BenchScript, BenchSequence, MIN_FRAMES_PER_SCRIPT};
use super::tally::{TallyCounter, VectorTally};
use crate::codec::VectorPacker;
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::situations::SituationMonitor;
use crate::stimulus::{
    ClassChoice, ClockReceiver, FrameFeed, FrameLimit, GapPattern, ModelDriver, Random,
    SequenceEnd, SequenceSurroundings, SinkPattern, StoreFault, ThresholdAim, UnusedInputs,
};
use foveate_design::{Design, Hardware, Port, RasterTiming};
use foveate_emit::Top;
use foveate_model::region_border;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The number of beats of a frame that a reset discards.
const DISCARDED_BEATS: usize = 3;
/// The period of pauses, in beats. Long frames have fewer pauses, because a pause takes two lines
/// of the vectors.
const PAUSE_PERIOD: usize = 29;
const LONG_FRAME_PAUSE_PERIOD: usize = 997;
const LONG_FRAME_BEATS: usize = 20_000;
/// The number of clocks of a frame at which pixels are offered that a busy array must not take.
const REFUSED_CLOCKS: u64 = 3;
/// The number of clocks between two frames after which no window has flushed: the smallest window
/// has four pixels.
const CLOCKS_WITHIN_FLUSH: u64 = 2;

pub(super) struct ScriptPlayer<'a> {
    driver: ModelDriver<'a, VectorRecorder>,
    surroundings: SequenceSurroundings,
    gaps: GapPattern,
    /// True if a frame waits for the sink, which must then not stall between frames.
    frames_wait_for_sink: bool,
}

impl<'a> ScriptPlayer<'a> {
    pub(super) fn new(
        part: &'a Design,
        top: Top,
        recorder: &'a mut VectorRecorder,
        cancel: &'a AtomicBool,
    ) -> Self {
        let unused = UnusedInputs::Constant { refused_clocks: REFUSED_CLOCKS };
        let (feed, random) = (FrameFeed::for_design(part), Random::new(1));
        Self {
            driver: ModelDriver::new((part, top), feed, unused, recorder, random, cancel),
            surroundings: SequenceSurroundings {
                aim: ThresholdAim::Configured,
                sink: (false, 0),
                store_fault: store_fault(part),
                border: region_border(part, 0),
                classes: ClassChoice::Normal,
            },
            gaps: gaps(part),
            frames_wait_for_sink: part.timing().departure().buffered_rows.is_none(),
        }
    }

    /// Plays all sequences. The first sequence begins twice: a reset discards the first attempt.
    pub(super) fn play(&mut self, script: &BenchScript) -> Result<(), CosimError> {
        for (number, sequence) in script.sequences.iter().enumerate() {
            let (Some(first), Some(last)) = (sequence.frames.first(), sequence.frames.last())
            else {
                continue;
            };
            if number == 0 {
                self.begin(first, sequence.classes)?;
                let limit = FrameLimit::Beat(DISCARDED_BEATS);
                self.driver.send_frame(&first.frame, limit, GapPattern::None)?;
            }
            self.begin(first, sequence.classes)?;
            self.play_frames(sequence)?;
            self.driver.end_sequence(sequence.end, &last.frame, self.gaps)?;
        }
        if self.driver.has_frame_sync() { self.play_damaged(script) } else { Ok(()) }
    }

    /// Begins a sequence with a reset.
    fn begin(&mut self, first: &BenchFrame, classes: ClassChoice) -> Result<(), CosimError> {
        self.driver.configure_thresholds(first.thresholds);
        self.driver.begin_sequence(SequenceSurroundings { classes, ..self.surroundings })
    }

    /// Plays the frames of a sequence; before an end with pixels that leave, up to the first one.
    fn play_frames(&mut self, sequence: &BenchSequence) -> Result<(), CosimError> {
        let limit = match matches!(sequence.end, SequenceEnd::Leaving(_)) {
            true => FrameLimit::Leaving,
            false => FrameLimit::WholeFrame,
        };
        let mut before: Option<&BenchFrame> = None;
        for (number, shown) in sequence.frames.iter().enumerate() {
            if let (Some(before), FrameLimit::WholeFrame) = (before, limit) {
                self.pause(number, before, before.thresholds != shown.thresholds)?;
            }
            self.driver.configure_thresholds(shown.thresholds);
            self.driver.set_sink(shown.sink);
            self.driver.send_frame(&shown.frame, limit, self.gaps)?;
            before = Some(shown);
        }
        Ok(())
    }

    /// Pauses before a frame: in turn until everything has settled, not at all, and while windows
    /// flush. New thresholds wait until everything has settled, because a decision is made with the
    /// thresholds of its own clock.
    fn pause(
        &mut self,
        number: usize,
        before: &BenchFrame,
        has_new_thresholds: bool,
    ) -> Result<(), CosimError> {
        if self.frames_wait_for_sink && before.sink == SinkPattern::StallingUntilLoss {
            self.driver.set_sink(SinkPattern::Always);
        }
        self.driver.wait_until_ready(None)?;
        if has_new_thresholds || number.is_multiple_of(3) {
            self.driver.idle(self.driver.drain_timing().settling_clocks)?;
        }
        self.driver.idle(if number % 3 == 2 { CLOCKS_WITHIN_FLUSH } else { 0 })
    }

    /// Plays damaged frames, and the whole frames behind them.
    fn play_damaged(&mut self, script: &BenchScript) -> Result<(), CosimError> {
        let (Some((first, _)), Some((last, _))) = (script.damaged.first(), script.damaged.last())
        else {
            return Ok(());
        };
        self.begin(first, ClassChoice::Normal)?;
        for (shown, delivery) in &script.damaged {
            self.driver.send_damaged_frame(&shown.frame, *delivery, self.gaps)?;
        }
        self.driver.drain(&last.frame, self.gaps)
    }
}

/// Returns the fault of an external frame store: the last word of the frames that every script has
/// comes without its valid bit. So the bench sees an underrun, and all decisions use correct
/// references.
fn store_fault(part: &Design) -> StoreFault {
    match part.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => StoreFault::None,
        Hardware::Raster(own) => {
            let words = RasterTiming::from_design(part.with_hardware(own)).words();
            StoreFault::UnmarkedWord((MIN_FRAMES_PER_SCRIPT - 1) * words - 1)
        }
    }
}

/// Returns the pauses within a frame.
fn gaps(part: &Design) -> GapPattern {
    let beats = usize::try_from(part.timing().pixels_per_frame()).unwrap_or(usize::MAX);
    let period = if beats < LONG_FRAME_BEATS { PAUSE_PERIOD } else { LONG_FRAME_PAUSE_PERIOD };
    GapPattern::Periodic(period.min(beats))
}

/// A recorder of clocks, which keeps the vectors in memory.
pub(super) struct VectorRecorder {
    inputs: RecordLayout,
    outputs: RecordLayout,
    packer: VectorPacker<Vec<u8>>,
    counter: TallyCounter,
    watch: SituationMonitor,
    clocks: u64,
}

impl VectorRecorder {
    pub(super) fn new(part: &Design, top: Top, ports: &[Port]) -> Self {
        let (inputs, outputs) = (RecordLayout::inputs(ports), RecordLayout::outputs(ports));
        Self {
            packer: VectorPacker::new(&inputs, &outputs, Vec::new()),
            counter: TallyCounter::new(part, &outputs),
            watch: SituationMonitor::new(part, top, &inputs, &outputs),
            inputs,
            outputs,
            clocks: 0,
        }
    }

    /// Returns the counts of what the vectors contain, the number of clocks, and the vectors as
    /// text.
    pub(super) fn finish(self) -> Result<(VectorTally, u64, String), CosimError> {
        let bytes = self.packer.finish();
        let bytes = bytes.map_err(CosimError::io("write", Path::new("vectors")))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let situations = self.watch.occurrences();
        let tally = self.counter.finish(&self.outputs);
        Ok((VectorTally { situations, ..tally }, self.clocks, text))
    }
}

impl ClockReceiver for VectorRecorder {
    fn inputs(&self) -> &RecordLayout {
        &self.inputs
    }

    fn outputs(&self) -> &RecordLayout {
        &self.outputs
    }

    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError> {
        self.counter.count_clock(&self.outputs, output);
        self.watch.add_clocks(input, output, clocks);
        self.clocks += clocks;
        let pushed = self.packer.push(input, output, clocks);
        pushed.map_err(CosimError::io("write", Path::new("vectors")))
    }
}
