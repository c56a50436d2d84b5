// SPDX-License-Identifier: MIT OR Apache-2.0
//! The driver of the ports of a model ([`ModelDriver`]): it offers frames clock by clock,
//! simulates what surrounds the core, waits until all pixels of a frame have left
//! ([`DrainTiming`]), and hands every clock to a [`ClockReceiver`].

use super::frame_feed::{FrameDelivery, FrameFeed, GapPattern};
use super::frame_generator::PatternAim;
use super::port_thresholds::PortThresholds;
use super::port_zones::{ClassChoice, PortZones};
use super::random::Random;
use super::sink::{ExternalStore, Sink, SinkPattern, StoreFault};
use super::threshold_ranges::ThresholdAim;
use super::unused_inputs::{IdlePixelPolicy, UnusedInputs};
use crate::codec::RecordCodec;
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::Recorder;
use foveate_design::{Design, Hardware, PipelinedDesign, PipelinedTiming, PortRole};
use foveate_emit::Top;
use foveate_model::{CoreInput, CycleModel, ThresholdInputs, rcm_model, region_border, rpu_model};
use foveate_pixels::Frame;
use foveate_tools::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// The part of a frame that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameLimit {
    /// The whole frame.
    WholeFrame,
    /// The given number of beats, and no clock more.
    Beat(usize),
    /// The beats before the edge at which a region is lost in the middle.
    BeforeLoss,
    /// The beats up to the first pixel or mean that leaves.
    Leaving,
}

/// The surroundings of a core during a sequence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SequenceSurroundings {
    /// The choice of thresholds.
    pub(crate) aim: ThresholdAim,
    /// True if the sink stalls so long that regions are lost, and the turn that chooses its
    /// pattern.
    pub(crate) sink: (bool, usize),
    /// The fault of the external frame store.
    pub(crate) store_fault: StoreFault,
    /// The sides at the frame's border, if these are an input.
    pub(crate) border: u8,
    /// The classes of the regions, in a core with zones.
    pub(crate) classes: ClassChoice,
}

impl SequenceSurroundings {
    /// Returns the surroundings with the thresholds of the design and with a faultless frame store.
    pub(super) fn of_design(sink: (bool, usize), border: u8) -> Self {
        Self {
            aim: ThresholdAim::Configured,
            sink,
            store_fault: StoreFault::None,
            border,
            classes: ClassChoice::Configured,
        }
    }
}

/// A driver that offers frames to a model.
pub(crate) struct ModelDriver<'a, Receiver> {
    core: Box<dyn CycleModel>,
    feed: FrameFeed<'a>,
    drain_timing: DrainTiming,
    thresholds: PortThresholds<'a>,
    /// The sink, if it may stall.
    sink: Option<Sink>,
    /// The frame store, if it is external.
    external_store: Option<ExternalStore>,
    cancel: &'a AtomicBool,
    receiver: &'a mut Receiver,
    codec: RecordCodec,
    random: Random,
    /// True if the next reset must come while a frame is under way.
    cuts_next_reset: bool,
    /// True if the simulated hardware synchronizes to the start of a frame.
    has_frame_sync: bool,
    border: u8,
    unused: UnusedInputs,
    idle_policy: IdlePixelPolicy,
    max: u16,
    input: Vec<u8>,
    output: Vec<u8>,
}

impl<'a, Receiver: ClockReceiver> ModelDriver<'a, Receiver> {
    pub(crate) fn new(
        (design, top): (&'a Design, Top),
        feed: FrameFeed<'a>,
        unused: UnusedInputs,
        receiver: &'a mut Receiver,
        random: Random,
        cancel: &'a AtomicBool,
    ) -> Self {
        let has_frame_sync = receiver.has_port(PortRole::SyncError);
        Self {
            core: match top {
                Top::Rpu => rpu_model(design),
                Top::Rcm => rcm_model(design),
            },
            feed,
            drain_timing: DrainTiming::for_design(design),
            thresholds: PortThresholds::new(
                design,
                (feed.square_side(), feed.width()),
                has_frame_sync,
            ),
            sink: Sink::for_design(design),
            // The store draws from a copy, so that the clocks do not depend on it.
            external_store: ExternalStore::for_design(design, unused, random.clone().fork()),
            cancel,
            input: receiver.inputs().zero_record(),
            output: receiver.outputs().zero_record(),
            receiver,
            codec: RecordCodec::new(design),
            random,
            cuts_next_reset: false,
            has_frame_sync,
            border: region_border(design, 0),
            unused,
            idle_policy: IdlePixelPolicy::Nothing,
            max: u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits"),
        }
    }

    /// Makes the next reset meet a pixel and last one clock: a second clock would no longer find a
    /// frame under way.
    pub(super) fn cut_by_next_reset(&mut self) {
        self.cuts_next_reset = true;
    }

    /// Begins a sequence with a reset, during which the other inputs have any value.
    pub(crate) fn begin_sequence(
        &mut self,
        surroundings: SequenceSurroundings,
    ) -> Result<(), CosimError> {
        let SequenceSurroundings { aim, sink, store_fault, border, classes } = surroundings;
        let (stalls, turn) = sink;
        self.thresholds.begin_sequence(aim, classes);
        if let Some(sink) = &mut self.sink {
            sink.set_pattern(sink.pattern_of_turn(stalls, turn));
        }
        self.border = border;
        for _ in 0..=self.random.up_to(u64::from(!self.cuts_next_reset)) {
            let valid = self.random.one_in(2) || self.cuts_next_reset;
            self.clock(true, valid, None, None)?;
        }
        self.cuts_next_reset = false;
        let load = self.thresholds.load_classes();
        self.idle(load)?;
        if let Some(store) = &mut self.external_store {
            store.begin(store_fault);
        }
        let pause = self.random.up_to(2);
        self.idle(pause)
    }

    /// Returns true if a sink takes the pixels that leave, and may stall.
    pub(super) fn has_sink(&self) -> bool {
        self.sink.is_some()
    }

    /// Sets the pattern of the sink from now on.
    pub(crate) fn set_sink(&mut self, pattern: SinkPattern) {
        if let Some(sink) = &mut self.sink {
            sink.set_pattern(pattern);
        }
    }

    /// Returns the choice of data, which must meet thresholds that are those of the design.
    pub(super) fn pattern_aim(&self) -> PatternAim {
        self.thresholds.pattern_aim()
    }

    /// Replaces the thresholds of the design, from now on.
    pub(crate) fn configure_thresholds(&mut self, thresholds: ThresholdInputs) {
        self.thresholds.configure(thresholds);
    }

    /// Returns true if the simulated hardware synchronizes to the start of a frame.
    pub(crate) fn has_frame_sync(&self) -> bool {
        self.has_frame_sync
    }

    /// Returns the receiver of the clocks.
    pub(crate) fn receiver(&mut self) -> &mut Receiver {
        self.receiver
    }

    pub(super) fn model(&self) -> &dyn CycleModel {
        &*self.core
    }

    /// Returns the time that the core needs after a frame.
    pub(crate) fn drain_timing(&self) -> DrainTiming {
        self.drain_timing
    }

    pub(super) fn random(&mut self) -> &mut Random {
        &mut self.random
    }

    /// Returns the beats of a frame for the pixel port.
    fn beats(&mut self, frame: &Frame) -> Vec<Vec<u16>> {
        let Self { unused, max, random, .. } = self;
        self.feed.beats(frame, || unused.pixel(*max, random))
    }

    /// Offers the beats of a frame, each as soon as the core is ready and its gap is over.
    pub(crate) fn send_frame(
        &mut self,
        frame: &Frame,
        until: FrameLimit,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        let beats = self.beats(frame);
        self.idle_policy = self.unused.idle_policy(&mut self.random);
        self.wait_until_ready(beats.first().map(Vec::as_slice))?;
        self.thresholds.end_frame(self.core.requires_stable_thresholds());
        for (place, pixels) in beats.iter().enumerate() {
            if until == FrameLimit::Beat(place) {
                break;
            }
            self.wait_until_ready(Some(pixels))?;
            if until == FrameLimit::BeforeLoss && self.core.will_abort() {
                break;
            }
            let pause = gaps.before_pixel(place, &mut self.random);
            self.idle(pause)?;
            if until == FrameLimit::Leaving && self.core.is_high(PortRole::ForwardValid) {
                break;
            }
            self.thresholds.begin_frame(frame, &*self.core, &mut self.random);
            self.clock(false, true, Some(place == 0), Some(pixels))?;
        }
        Ok(())
    }

    /// Offers the beats of a damaged frame, each as soon as the core is ready and its gap is over.
    /// The thresholds are those of the design, because nothing here says when a frame begins.
    pub(crate) fn send_damaged_frame(
        &mut self,
        frame: &Frame,
        delivery: FrameDelivery,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        let beats = self.beats(frame);
        self.idle_policy = self.unused.idle_policy(&mut self.random);
        self.thresholds.set_configured();
        let delivered = delivery.beats(beats.len(), &mut self.random);
        for (number, (sof, place)) in delivered.into_iter().enumerate() {
            let pixels = place.map(|place| beats[place].as_slice());
            self.send_beat(pixels, (number, sof), gaps)?;
            // A frame that the core completes by itself goes on without beats.
            if self.core.is_high(PortRole::SyncError) && self.random.one_in(2) {
                let pause = 1 + self.random.up_to(2);
                self.idle(pause)?;
            }
        }
        Ok(())
    }

    /// Offers a frame that pushes the earlier ones out, without a change of the thresholds, as long
    /// as `goes_on` returns true for the core.
    pub(super) fn push_out(
        &mut self,
        frame: &Frame,
        gaps: GapPattern,
        goes_on: impl Fn(&dyn CycleModel) -> bool,
    ) -> Result<(), CosimError> {
        for (place, pixels) in self.beats(frame).iter().enumerate() {
            if !goes_on(&*self.core) {
                break;
            }
            self.send_beat(Some(pixels), (place, place == 0), gaps)?;
        }
        Ok(())
    }

    /// Offers a beat as soon as the core is ready and its gap is over.
    fn send_beat(
        &mut self,
        pixels: Option<&[u16]>,
        (place, sof): (usize, bool),
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        self.wait_until_ready(pixels)?;
        let pause = gaps.before_pixel(place, &mut self.random);
        self.idle(pause)?;
        self.clock(false, true, Some(sof), pixels)
    }

    /// Lets clocks pass until the core is ready for the next beat, `next`.
    pub(crate) fn wait_until_ready(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        while !self.core.is_ready() {
            self.clock_without_intake(next)?;
        }
        Ok(())
    }

    /// Lets clocks pass until all pixels have left that need no further frame.
    pub(super) fn wait_until_left(&mut self) -> Result<(), CosimError> {
        while !self.core.is_ready() || self.core.is_pending() {
            self.clock_without_intake(None)?;
        }
        self.thresholds.end_frame(false);
        Ok(())
    }

    /// Lets the core work until `left` clocks remain until it is ready.
    pub(super) fn work_until(&mut self, left: u64) -> Result<(), CosimError> {
        while self.core.clocks_until_ready() > left {
            self.clock_without_intake(None)?;
        }
        self.thresholds.end_frame(!self.core.is_ready());
        Ok(())
    }

    /// Simulates clocks at which nothing is taken.
    pub(super) fn clocks_without_intake(&mut self, clocks: u64) -> Result<(), CosimError> {
        (0..clocks).try_for_each(|_| self.clock_without_intake(None))
    }

    /// Simulates one clock at which nothing is taken, or all clocks until an output changes if
    /// their inputs are the same.
    pub(super) fn clock_without_intake(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        if self.core.is_ready() {
            return self.idle(1);
        }
        let (valid, offered) = self.idle_policy.offered_input(next, &mut self.random);
        let quiet = self.core.quiet_clocks();
        if self.unused.are_constant() && !valid && quiet > 1 {
            return self.skip_clocks(quiet);
        }
        self.clock(false, valid, None, offered)
    }

    /// Simulates clocks without a beat; the pixel port has any value.
    pub(crate) fn idle(&mut self, clocks: u64) -> Result<(), CosimError> {
        (0..clocks).try_for_each(|_| self.clock(false, false, None, None))
    }

    /// Simulates one edge. Without pixels the port has unused values, and without a mark the mark
    /// is unused.
    fn clock(
        &mut self,
        reset: bool,
        valid: bool,
        sof: Option<bool>,
        pixels: Option<&[u16]>,
    ) -> Result<(), CosimError> {
        self.check_cancelled()?;
        let unused = match pixels {
            Some(_) => Vec::new(),
            None => self.unused.pixels(self.feed.width(), self.max, &mut self.random),
        };
        self.thresholds.begin_clock(&mut self.random);
        let sof = sof.unwrap_or_else(|| self.has_frame_sync && self.unused.bit(&mut self.random));
        let sink = self.sink.as_mut();
        let forward_ready =
            sink.is_none_or(|sink| sink.is_ready_next(&*self.core, &mut self.random));
        let (reference_valid, reference) = match &mut self.external_store {
            Some(store) => store.output_word(&*self.core),
            None => (false, Vec::new()),
        };
        let (thresholds, zones) = (self.thresholds.current(), self.thresholds.zones().cloned());
        let input = CoreInput {
            reset,
            valid,
            sof,
            pixels: pixels.unwrap_or(&unused),
            border: self.border,
            reference_valid,
            reference_pixels: &reference,
            forward_ready,
            thresholds: &thresholds,
            zones: zones.as_ref().map(PortZones::inputs),
        };
        self.thresholds.aim_at_decision(&input, &*self.core, &mut self.random);
        let thresholds = self.thresholds.current();
        let zones = self.thresholds.zones().map(PortZones::inputs);
        let input = CoreInput { thresholds: &thresholds, zones, ..input };
        self.core.clock(&input);
        if let Some(store) = &mut self.external_store {
            store.store_output(&*self.core);
        }
        self.codec.encode_inputs(self.receiver.inputs(), &input, &mut self.input);
        self.hand_over(1)
    }

    /// Simulates so many clocks with the inputs of an idle clock at once. The core has neither a
    /// sink nor an external store if it can do that.
    fn skip_clocks(&mut self, clocks: u64) -> Result<(), CosimError> {
        self.check_cancelled()?;
        let unused = self.unused.pixels(self.feed.width(), self.max, &mut self.random);
        let thresholds = self.thresholds.current();
        let sof = self.has_frame_sync;
        let zones = self.thresholds.zones().map(PortZones::inputs_without_writes);
        let input =
            CoreInput { sof, border: self.border, zones, ..CoreInput::idle(&unused, &thresholds) };
        self.core.skip_quiet_clocks();
        self.codec.encode_inputs(self.receiver.inputs(), &input, &mut self.input);
        self.hand_over(clocks)
    }

    /// Hands so many equal clocks with the encoded inputs and the present outputs to the receiver.
    fn hand_over(&mut self, clocks: u64) -> Result<(), CosimError> {
        self.codec.encode_outputs(self.receiver.outputs(), &*self.core, &mut self.output);
        self.receiver.add_clocks(&self.input, &self.output, clocks)
    }

    fn check_cancelled(&self) -> Result<(), CosimError> {
        match self.cancel.load(Ordering::Relaxed) {
            true => Err(ToolError::Interrupted.into()),
            false => Ok(()),
        }
    }
}

/// A receiver of clocks: a recording on disk, the vectors of a bench, or a diagram.
pub(crate) trait ClockReceiver {
    fn inputs(&self) -> &RecordLayout;

    fn outputs(&self) -> &RecordLayout;

    /// Takes `clocks` clocks with the same inputs and outputs.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError>;

    /// Returns true if the module has an input or output of this role.
    fn has_port(&self, role: PortRole) -> bool {
        let mut fields = self.inputs().fields().iter().chain(self.outputs().fields());
        fields.any(|field| field.port.role == role)
    }
}

impl ClockReceiver for Recorder {
    fn inputs(&self) -> &RecordLayout {
        self.inputs()
    }

    fn outputs(&self) -> &RecordLayout {
        self.outputs()
    }

    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError> {
        (0..clocks).try_for_each(|_| self.push(input, output))
    }
}

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrainTiming {
    /// The number of clocks after the last pixel of a frame until everything is decided that does
    /// not wait for another frame. A core that is ready earlier may need more clocks.
    pub(crate) settling_clocks: u64,
    /// True if the core shows by its own outputs that everything has left.
    shows_end: bool,
    /// The number of frames that must follow before the pixels of a frame have left.
    pub(crate) frames_behind: u32,
    /// The largest number of clocks that are simulated after a sequence has left.
    pub(super) trailing_clocks: u64,
}

impl DrainTiming {
    /// Returns the number of clocks to wait until everything is decided, or `None` if the core
    /// shows by its own outputs that everything has left.
    pub(super) fn clocks_to_wait(&self) -> Option<u64> {
        (!self.shows_end).then_some(self.settling_clocks)
    }

    pub(crate) fn for_design(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.with_hardware(own);
                Self {
                    settling_clocks: settling_clocks(design),
                    shows_end: false,
                    frames_behind: PipelinedTiming::from_design(design).forward_frames,
                    trailing_clocks: 0,
                }
            }
            Hardware::Serial(_) => {
                Self { settling_clocks: 0, shows_end: true, frames_behind: 0, trailing_clocks: 5 }
            }
            Hardware::Raster(_) => {
                let departure = design.timing().departure();
                Self {
                    settling_clocks: departure.decision_clocks.max(departure.forward_clocks),
                    shows_end: true,
                    frames_behind: 0,
                    trailing_clocks: 8,
                }
            }
        }
    }
}

/// Returns the number of clocks after the last pixel of a frame after which a pipelined array has
/// decided everything that does not wait for another frame.
pub(super) fn settling_clocks(design: PipelinedDesign<'_>) -> u64 {
    u64::from(PipelinedTiming::from_design(design).decision_latency) + 4
}
