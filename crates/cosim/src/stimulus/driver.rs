// SPDX-License-Identifier: MIT OR Apache-2.0
//! The driver of the model of a core: it offers frames clock by clock, simulates what surrounds the
//! core, and records the inputs and outputs.

use super::damaged_sequence::FrameDelivery;
use super::decision_predictor::DecisionPredictor;
use super::faulty_store::{FaultyStore, StoreFault};
use super::frame_feed::FrameFeed;
use super::idle_input::IdleInputPolicy;
use super::random::Random;
use super::sequences::GapPattern;
use super::sink::StimulusSink;
use super::threshold_aimer::{ThresholdAim, ThresholdAimer};
use crate::codec::RecordCodec;
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::Recorder;
use foveate_design::{Design, PortRole, ThresholdSource as Mode};
use foveate_frame::Frame;
use foveate_model::{CoreInput, CycleModel, ThresholdInputs, rcm_model, region_stream, rpu_model};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// The part of a frame that is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameLimit {
    /// The whole frame.
    WholeFrame,
    /// The given number of beats, and no clock more.
    Beat(usize),
    /// The beats before the edge at which a region is lost in the middle.
    BeforeLoss,
}

/// A driver that offers frames to the model.
pub(super) struct ModelDriver<'a> {
    design: &'a Design,
    /// The side of the squares at which levels are aimed.
    square_side: u32,
    core: Box<dyn CycleModel>,
    aimer: ThresholdAimer,
    /// The prediction of decisions, if thresholds may change at every clock.
    predictor: Option<DecisionPredictor>,
    /// The sink, if it may stall.
    sink: Option<StimulusSink>,
    /// The frame store, if it is external.
    external_store: Option<FaultyStore>,
    cancel: &'a AtomicBool,
    recorder: &'a mut Recorder,
    codec: RecordCodec,
    random: Random,
    configured: ThresholdInputs,
    /// The thresholds at the current clock.
    thresholds: ThresholdInputs,
    /// True if a frame is under way, so that thresholds must not change.
    is_under_way: bool,
    /// True if the next reset must come while a frame is under way.
    cuts_next_reset: bool,
    /// True if the simulated hardware synchronizes to the start of a frame.
    has_frame_sync: bool,
    aim: ThresholdAim,
    /// The number of frames since the sequence began.
    turn: u32,
    /// The square of the last frame at which levels were aimed, as [`ModelDriver::first_square`]
    /// cuts it.
    last_square: Vec<u16>,
    border: u8,
    idle_policy: IdleInputPolicy,
    max: u16,
    garbage: Vec<u16>,
    input: Vec<u8>,
    expected: Vec<u8>,
}

impl<'a> ModelDriver<'a> {
    pub(super) fn new(
        design: &'a Design,
        level: CosimLevel,
        is_brief: bool,
        recorder: &'a mut Recorder,
        mut random: Random,
        cancel: &'a AtomicBool,
    ) -> Self {
        let configured = ThresholdInputs::from_camera(design);
        let max = u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits");
        let feed = FrameFeed::for_level(level, design);
        let mut outputs = recorder.outputs().fields().iter();
        let finds_frames = outputs.any(|field| field.port.role == PortRole::SyncError);
        Self {
            design,
            core: match level {
                CosimLevel::Rpu => rpu_model(design),
                CosimLevel::Rcm { .. } | CosimLevel::Full => rcm_model(design),
            },
            aimer: ThresholdAimer::new(design),
            predictor: DecisionPredictor::for_design(design, finds_frames),
            sink: StimulusSink::for_design(design, is_brief),
            external_store: FaultyStore::for_design(design, max, &mut random),
            cancel,
            input: recorder.inputs().zero_record(),
            expected: recorder.outputs().zero_record(),
            recorder,
            codec: RecordCodec::new(design),
            random,
            configured,
            thresholds: configured,
            is_under_way: false,
            cuts_next_reset: false,
            has_frame_sync: finds_frames,
            aim: ThresholdAim::Configured,
            turn: 0,
            last_square: vec![0; (feed.square_side() * feed.square_side()) as usize],
            border: 0,
            idle_policy: IdleInputPolicy::Nothing,
            max,
            garbage: vec![0; feed.width()],
            square_side: feed.square_side(),
        }
    }

    /// Makes the next reset meet a pixel and last one clock: a second clock would no longer find a
    /// frame under way.
    pub(super) fn cut_by_next_reset(&mut self) {
        self.cuts_next_reset = true;
    }

    /// Begins a sequence with a reset, during which the other inputs have any value. `turn` chooses
    /// the behavior of the sink.
    pub(super) fn begin_sequence(
        &mut self,
        aim: ThresholdAim,
        (stalls, turn): (bool, usize),
        lapse: StoreFault,
        border: u8,
    ) -> Result<(), CosimError> {
        self.aim = match self.design.threshold_source() {
            Mode::Constant if aim != ThresholdAim::Independent => ThresholdAim::Configured,
            Mode::Constant | Mode::Runtime => aim,
        };
        if let Some(sink) = &mut self.sink {
            sink.begin(stalls, turn);
        }
        self.is_under_way = false;
        self.turn = 0;
        self.border = border;
        for _ in 0..=self.random.up_to(u64::from(!self.cuts_next_reset)) {
            let valid = self.random.one_in(2) || self.cuts_next_reset;
            self.clock(true, valid, None, None)?;
        }
        self.cuts_next_reset = false;
        if let Some(memory) = &mut self.external_store {
            memory.begin(lapse);
        }
        let pause = self.random.up_to(2);
        self.idle(pause)
    }

    /// Returns the sides at the frame's border for a sequence, if these are an input; all sixteen
    /// sets come in turn.
    pub(super) fn border(&self, turn: usize) -> u8 {
        let mut inputs = self.recorder.inputs().fields().iter();
        match inputs.any(|field| field.port.role == PortRole::Border) {
            true => u8::try_from(7 * turn % 16).expect("four bits"),
            false => 0,
        }
    }

    /// Returns true if a sink takes the pixels that leave, and may stall.
    pub(super) fn has_sink(&self) -> bool {
        self.sink.is_some()
    }

    /// Makes the sink ready at every clock from now on.
    pub(super) fn make_sink_ready(&mut self) {
        if let Some(sink) = &mut self.sink {
            sink.make_ready();
        }
    }

    /// Returns true if the thresholds are those of the design, so that the data must be chosen to
    /// meet them.
    pub(super) fn thresholds_are_configured(&self) -> bool {
        self.aim == ThresholdAim::Configured
    }

    /// Returns true if the simulated hardware synchronizes to the start of a frame.
    pub(super) fn has_frame_sync(&self) -> bool {
        self.has_frame_sync
    }

    /// Names the sequence, frame and region of the following clocks.
    pub(super) fn name_clocks(&mut self, sequence: &str, frame: u64, region: Option<u32>) {
        self.recorder.begin_frame(sequence, frame, region);
    }

    /// Returns the model.
    pub(super) fn model(&self) -> &dyn CycleModel {
        &*self.core
    }

    /// Offers the beats of a frame, each as soon as the core is ready and its gap is over.
    pub(super) fn send_frame(
        &mut self,
        frame: &Frame,
        beats: &[Vec<u16>],
        until: FrameLimit,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        self.idle_policy = IdleInputPolicy::random(&mut self.random);
        self.wait_until_ready(beats.first().map(Vec::as_slice))?;
        self.is_under_way &= self.core.requires_stable_thresholds();
        for (place, pixels) in beats.iter().enumerate() {
            if until == FrameLimit::Beat(place) {
                break;
            }
            self.wait_until_ready(Some(pixels))?;
            if until == FrameLimit::BeforeLoss && self.core.will_abort() {
                break;
            }
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            if !self.is_under_way {
                self.choose_thresholds(frame);
            }
            self.clock(false, true, Some(place == 0), Some(pixels))?;
        }
        Ok(())
    }

    /// Offers the beats of a damaged frame, each as soon as the core is ready and its gap is over.
    /// The thresholds are those of the design, because nothing here says when a frame begins.
    pub(super) fn send_damaged_frame(
        &mut self,
        beats: &[Vec<u16>],
        delivery: FrameDelivery,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        self.idle_policy = IdleInputPolicy::random(&mut self.random);
        self.thresholds = self.configured;
        for (sof, place) in delivery.beats(beats.len(), &mut self.random) {
            self.send_beat(place.map(|place| beats[place].as_slice()), sof, gaps)?;
            // A frame that the core completes by itself goes on without beats.
            if self.core.is_high(PortRole::SyncError) && self.random.one_in(2) {
                let pause = 1 + self.random.up_to(2);
                self.idle(pause)?;
            }
        }
        Ok(())
    }

    /// Offers a frame that pushes the earlier ones out, without a change of the thresholds.
    pub(super) fn push_out(
        &mut self,
        beats: &[Vec<u16>],
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        for (place, pixels) in beats.iter().enumerate() {
            self.send_beat(Some(pixels), place == 0, gaps)?;
        }
        Ok(())
    }

    /// Offers a frame that pushes the earlier ones out, up to the first pixel that leaves.
    pub(super) fn push_until_leaving(&mut self, beats: &[Vec<u16>]) -> Result<(), CosimError> {
        for (place, pixels) in beats.iter().enumerate() {
            if self.core.is_high(PortRole::ForwardValid) {
                break;
            }
            self.send_beat(Some(pixels), place == 0, GapPattern::None)?;
        }
        Ok(())
    }

    /// Offers a beat as soon as the core is ready and its gap is over.
    fn send_beat(
        &mut self,
        pixels: Option<&[u16]>,
        sof: bool,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        self.wait_until_ready(pixels)?;
        let pause = gaps.before_pixel(&mut self.random);
        self.idle(pause)?;
        self.clock(false, true, Some(sof), pixels)
    }

    fn choose_thresholds(&mut self, frame: &Frame) {
        let turn = self.turn;
        let largest = (self.aim == ThresholdAim::Largest).then_some(turn);
        self.turn += 1;
        self.is_under_way = true;
        match self.aim {
            ThresholdAim::Configured => self.thresholds = self.configured,
            ThresholdAim::Smallest => self.thresholds = ThresholdAimer::smallest_thresholds(),
            ThresholdAim::Independent => {
                self.thresholds = match self.design.threshold_source() {
                    Mode::Runtime => ThresholdAimer::smallest_thresholds(),
                    Mode::Constant => self.configured,
                };
            }
            ThresholdAim::HeldRegions => self.thresholds = self.aimer.held_thresholds(turn),
            ThresholdAim::DriftingRegions => self.thresholds = self.aimer.drifting_thresholds(turn),
            ThresholdAim::EveryClock => {}
            ThresholdAim::Exact | ThresholdAim::Largest => self.aim_at_frame(frame, largest),
        }
    }

    /// Aims levels at a frame that comes, and also minima if these must not change within a frame.
    fn aim_at_frame(&mut self, frame: &Frame, largest: Option<u32>) {
        if self.predictor.is_some() {
            let now = self.first_square(frame);
            let squares = (now.as_slice(), self.last_square.as_slice());
            self.aimer.aim_levels(squares, largest, &mut self.thresholds, &mut self.random);
            self.last_square = now;
            return;
        }
        let region = self.aimer.any_region(&mut self.random);
        let mut stream = Vec::new();
        region_stream(self.design, frame, region, &mut stream);
        let (reference, shown) = (self.core.reference(region), self.core.summary(region));
        let random = &mut self.random;
        self.thresholds =
            self.aimer.near_region(region, &stream, reference, shown, largest, random);
    }

    /// Returns the first square of a frame: its first region, or the whole of a region with its
    /// halo.
    fn first_square(&self, frame: &Frame) -> Vec<u16> {
        let side = self.square_side;
        let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        places.map(|(x, y)| frame.get_clamped(x.into(), y.into())).collect()
    }

    /// Lets clocks pass until the core is ready for the next beat, `next`.
    fn wait_until_ready(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        while !self.core.is_ready() {
            self.clock_without_intake(next)?;
        }
        Ok(())
    }

    /// Lets clocks pass until all pixels have left that need no further frame.
    pub(super) fn drain(&mut self) -> Result<(), CosimError> {
        while !self.core.is_ready() || self.core.is_pending() {
            self.clock_without_intake(None)?;
        }
        self.is_under_way = false;
        Ok(())
    }

    /// Lets the core work until `left` clocks remain until it is ready.
    pub(super) fn work_until(&mut self, left: u64) -> Result<(), CosimError> {
        while self.core.clocks_until_ready() > left {
            self.clock_without_intake(None)?;
        }
        self.is_under_way &= !self.core.is_ready();
        Ok(())
    }

    /// Lets the core work on its frame until a score is at the ports.
    pub(super) fn work_until_score(&mut self) -> Result<(), CosimError> {
        while !self.core.is_ready() && !self.core.is_high(PortRole::ScoreValid) {
            self.clock_without_intake(None)?;
        }
        Ok(())
    }

    /// Simulates one clock at which nothing is taken.
    pub(super) fn clock_without_intake(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        if self.core.is_ready() {
            return self.clock(false, false, None, None);
        }
        let (valid, offered) = self.idle_policy.offered_input(next, &mut self.random);
        self.clock(false, valid, None, offered)
    }

    /// Simulates clocks without a beat; the pixel port has any value.
    pub(super) fn idle(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.clock(false, false, None, None)?;
        }
        Ok(())
    }

    /// Simulates one edge. Without pixels the port has random values, and without a mark the mark
    /// is random.
    fn clock(
        &mut self,
        reset: bool,
        valid: bool,
        sof: Option<bool>,
        pixels: Option<&[u16]>,
    ) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        if pixels.is_none() {
            for pixel in &mut self.garbage {
                *pixel = self.random.pixel(self.max);
            }
        }
        if self.are_thresholds_unrelated() {
            self.aimer.randomize(&mut self.thresholds, &mut self.random);
        }
        let sof = sof.unwrap_or_else(|| self.has_frame_sync && self.random.one_in(2));
        let sink = self.sink.as_mut();
        let forward_ready =
            sink.is_none_or(|sink| sink.is_ready_next(&*self.core, &mut self.random));
        let (reference_valid, reference) = match &mut self.external_store {
            Some(memory) => memory.output_word(&*self.core),
            None => (false, Vec::new()),
        };
        let shown = self.thresholds;
        let input = CoreInput {
            reset,
            valid,
            sof,
            pixels: pixels.unwrap_or(&self.garbage),
            border: self.border,
            reference_valid,
            reference_pixels: &reference,
            forward_ready,
            thresholds: &shown,
        };
        if let Some(scout) = &mut self.predictor
            && self.aim != ThresholdAim::Configured
            && self.aim != ThresholdAim::Independent
        {
            let lane = self.random.index(self.garbage.len() - 1);
            if scout.decides(&input) {
                let (scores, count) = scout.predict_scores(&*self.core, &input, lane);
                self.aimer.aim_minima(&scores, count, &mut self.thresholds, &mut self.random);
                let aimed = self.thresholds;
                let input = CoreInput { thresholds: &aimed, ..input };
                let level = scout.decisive_summary_level(&*self.core, &input, lane);
                self.aimer.aim_summary_level(level, &mut self.thresholds, &mut self.random);
            }
        }
        let input = CoreInput { thresholds: &self.thresholds, ..input };
        self.core.clock(&input);
        if let Some(memory) = &mut self.external_store {
            memory.store_output(&*self.core);
        }
        self.codec.encode_inputs(self.recorder.inputs(), &input, &mut self.input);
        self.codec.encode_outputs(self.recorder.outputs(), &*self.core, &mut self.expected);
        self.recorder.push(&self.input, &self.expected)
    }

    /// Returns true if thresholds are unrelated to the data at this clock.
    fn are_thresholds_unrelated(&self) -> bool {
        match self.aim {
            ThresholdAim::Configured => false,
            ThresholdAim::EveryClock => true,
            ThresholdAim::Exact
            | ThresholdAim::Largest
            | ThresholdAim::Smallest
            | ThresholdAim::Independent
            | ThresholdAim::HeldRegions
            | ThresholdAim::DriftingRegions => self.predictor.is_none() && !self.is_under_way,
        }
    }
}
