// SPDX-License-Identifier: MIT OR Apache-2.0
//! Offers frames to the model of a core, clock by clock, in front of a sink, and records what goes in and what
//! comes out.

use super::super::ahead::{Aimer, FrameAim};
use super::super::applied::Applied;
use super::super::damage::Delivery;
use super::super::manners::Manners;
use super::super::random::Random;
use super::super::sequence::Gaps;
use super::codec::RasterCodec;
use super::memory::{Lapse, Memory};
use super::sink::{Mood, Sink};
use super::words::words;
use crate::error::CosimError;
use crate::recording::Recorder;
use foveate_design::{RasterDesign, Thresholds as Mode};
use foveate_frame::Frame;
use foveate_model::{RasterOutput, RasterRcm, Thresholds, region_stream};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// How much of a frame is taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum Until {
    /// All of it.
    End,
    /// So many words.
    Word(usize),
    /// As much as comes before the edge at which a region is lost in the middle.
    Loss,
}

/// Offers frames to the model.
pub(crate) struct Driver<'a> {
    design: RasterDesign<'a>,
    model: RasterRcm,
    aimer: Aimer,
    cancel: &'a AtomicBool,
    recorder: &'a mut Recorder,
    codec: RasterCodec,
    random: Random,
    configured: Thresholds,
    /// Thresholds as they are now.
    thresholds: Thresholds,
    /// Whether a frame is under way, so that thresholds must stay still.
    is_under_way: bool,
    aim: FrameAim,
    /// Frames since the sequence began.
    turn: u32,
    manners: Manners,
    sink: Sink,
    /// The frame store, where it is outside.
    memory: Option<Memory>,
    max: u16,
    garbage: Vec<u16>,
    input: Vec<u8>,
    expected: Vec<u8>,
}

impl<'a> Driver<'a> {
    pub(crate) fn new(
        design: RasterDesign<'a>,
        recorder: &'a mut Recorder,
        mut random: Random,
        cancel: &'a AtomicBool,
    ) -> Self {
        let configured = Thresholds::of(&design);
        let max = u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits");
        Self {
            model: RasterRcm::new(design),
            aimer: Aimer::new(&design),
            cancel,
            input: recorder.inputs().record(),
            expected: recorder.outputs().record(),
            recorder,
            codec: RasterCodec::new(design),
            memory: Memory::of(design, max, &mut random),
            random,
            configured,
            thresholds: configured,
            is_under_way: false,
            aim: FrameAim::Design,
            turn: 0,
            manners: Manners::Quiet,
            sink: Sink::new(Mood::Willing),
            max,
            garbage: vec![0; design.pixels_per_clock() as usize],
            design,
        }
    }

    /// Starts over: a reset, during which anything may be on the other inputs.
    pub(super) fn begin(
        &mut self,
        aim: FrameAim,
        mood: Mood,
        lapse: Lapse,
    ) -> Result<(), CosimError> {
        let constant = self.design.thresholds() == Mode::Constant;
        self.aim = if constant { FrameAim::Design } else { aim };
        self.sink = Sink::new(mood);
        self.is_under_way = false;
        self.turn = 0;
        for _ in 0..=self.random.up_to(1) {
            let valid = self.random.one_in(2);
            self.clock(true, valid, None, None)?;
        }
        if let Some(memory) = &mut self.memory {
            memory.begin(lapse);
        }
        let pause = self.random.up_to(2);
        self.idle(pause)
    }

    /// From here on the sink is ready at every clock.
    pub(super) fn calm_sink(&mut self) {
        self.sink = Sink::new(Mood::Willing);
    }

    /// Whether the thresholds are those of the design, so that the data must meet them.
    pub(super) fn thresholds_are_configured(&self) -> bool {
        self.aim == FrameAim::Design
    }

    /// Names the clocks from here on.
    pub(super) fn name(&mut self, sequence: &str, frame: u64) {
        self.recorder.begin_frame(sequence, frame, None);
    }

    /// What the outputs show.
    pub(super) fn output(&self) -> &RasterOutput {
        self.model.output()
    }

    /// Whether a region is not decided yet, or has pixels that have not left.
    pub(super) fn is_pending(&self) -> bool {
        self.model.is_pending()
    }

    /// The words of a frame, each as soon as it is taken and its gap is over.
    pub(super) fn take(
        &mut self,
        frame: &Frame,
        until: Until,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        self.manners = Manners::any(&mut self.random);
        let (max, random) = (self.max, &mut self.random);
        let words = words(self.design, frame, || random.pixel(max));
        self.wait(words.first().map(Vec::as_slice))?;
        self.settle();
        for (place, word) in words.iter().enumerate() {
            self.wait(Some(word))?;
            let ends = match until {
                Until::End => false,
                Until::Word(most) => place == most,
                Until::Loss => self.model.aborts_next(),
            };
            if ends {
                break;
            }
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            if !self.is_under_way {
                self.choose_thresholds(frame);
            }
            self.clock(false, true, Some(place == 0), Some(word))?;
        }
        Ok(())
    }

    /// What comes of a frame on its way, each word as soon as it is taken and its gap is over. Thresholds stay those
    /// of the design: nobody says here when a frame begins.
    pub(super) fn deliver(
        &mut self,
        frame: &Frame,
        delivery: Delivery,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        self.manners = Manners::any(&mut self.random);
        let (max, random) = (self.max, &mut self.random);
        let words = words(self.design, frame, || random.pixel(max));
        self.thresholds = self.configured;
        for (sof, place) in delivery.beats(words.len(), &mut self.random) {
            let word = place.map(|place| words[place].as_slice());
            self.wait(word)?;
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            self.clock(false, true, Some(sof), word)?;
        }
        Ok(())
    }

    /// With a second pass the thresholds of a frame that follows at once are those of the frame before.
    fn settle(&mut self) {
        let is_deciding = self.design.has_second_pass() && self.model.is_deciding();
        self.is_under_way &= is_deciding;
    }

    fn choose_thresholds(&mut self, frame: &Frame) {
        self.thresholds = match self.aim {
            FrameAim::Design => self.configured,
            FrameAim::Exact | FrameAim::Largest => {
                let largest = (self.aim == FrameAim::Largest).then_some(self.turn);
                let region = self.aimer.any_region(&mut self.random);
                let mut stream = Vec::new();
                region_stream(&self.design, frame, region, &mut stream);
                let reference = self.model.reference(region);
                self.aimer.exact(region, &stream, reference, largest, &mut self.random)
            }
            FrameAim::Least => Aimer::least(),
        };
        self.turn += 1;
        self.is_under_way = true;
    }

    /// Lets clocks pass until the core takes the next word, which is `next`.
    fn wait(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        while !self.output().ready {
            self.busy(next)?;
        }
        Ok(())
    }

    /// Lets everything of the frames that were taken leave.
    pub(super) fn drain(&mut self) -> Result<(), CosimError> {
        while !self.output().ready || self.is_pending() {
            self.busy(None)?;
        }
        self.is_under_way = false;
        Ok(())
    }

    /// One clock at which nothing is taken.
    pub(super) fn busy(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        if self.output().ready {
            return self.clock(false, false, None, None);
        }
        let (valid, offered) = self.manners.offer(next, &mut self.random);
        self.clock(false, valid, None, offered)
    }

    /// Clocks without a word; the pixel port shows anything.
    pub(super) fn idle(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.clock(false, false, None, None)?;
        }
        Ok(())
    }

    /// One edge. Without a word garbage is applied, and without a mark any.
    fn clock(
        &mut self,
        reset: bool,
        valid: bool,
        sof: Option<bool>,
        word: Option<&[u16]>,
    ) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        if word.is_none() {
            for pixel in &mut self.garbage {
                *pixel = self.random.pixel(self.max);
            }
        }
        if !self.is_under_way && self.aim != FrameAim::Design {
            self.aimer.shake(&mut self.thresholds, &mut self.random);
        }
        let sof = sof.unwrap_or_else(|| self.design.syncs() && self.random.one_in(2));
        let forward_ready = self.sink.next(&self.model, &mut self.random);
        let pixels = word.unwrap_or(&self.garbage);
        let idle = Applied::idle(pixels, &self.thresholds);
        let before = self.model.output();
        let reference = self.memory.as_mut().map(|memory| memory.show(before));
        let (reference_valid, reference_pixels) = match &reference {
            Some((valid, word)) => (*valid, word.as_slice()),
            None => (false, &[][..]),
        };
        let core = Applied { reference_valid, reference_pixels, forward_ready, ..idle };
        let applied = Applied { reset, valid, sof, ..core };
        let output = self.model.step(&applied.of_core());
        if let Some(memory) = &mut self.memory {
            memory.keep(output);
        }
        self.codec.inputs(self.recorder.inputs(), &applied, &mut self.input);
        self.codec.outputs(self.recorder.outputs(), output, &mut self.expected);
        self.recorder.push(&self.input, &self.expected)
    }
}
