// SPDX-License-Identifier: MIT OR Apache-2.0
//! Offers frames to the model of an array, clock by clock, and records what goes in and what comes out.

use super::super::ahead::{Aimer, FrameAim};
use super::super::applied::Applied;
use super::super::damage::Delivery;
use super::super::manners::Manners;
use super::super::random::Random;
use super::super::sequence::Gaps;
use super::codec::SerialCodec;
use super::feed::Feed;
use crate::error::CosimError;
use crate::recording::Recorder;
use foveate_design::{SerialDesign, Thresholds as Mode};
use foveate_model::{SerialOutput, SerialRcm, Thresholds};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// Offers frames to the model.
pub(crate) struct Driver<'a> {
    model: SerialRcm,
    aimer: Aimer,
    cancel: &'a AtomicBool,
    recorder: &'a mut Recorder,
    codec: SerialCodec,
    random: Random,
    configured: Thresholds,
    /// Thresholds as they are now.
    thresholds: Thresholds,
    /// Whether a frame is under way, so that thresholds must stay still.
    is_under_way: bool,
    constant: bool,
    /// Whether the array finds its frames.
    syncs: bool,
    aim: FrameAim,
    /// Frames since the sequence began.
    turn: u32,
    manners: Manners,
    max: u16,
    garbage: Vec<u16>,
    input: Vec<u8>,
    expected: Vec<u8>,
}

impl<'a> Driver<'a> {
    pub(crate) fn new(
        design: SerialDesign<'_>,
        recorder: &'a mut Recorder,
        random: Random,
        cancel: &'a AtomicBool,
    ) -> Self {
        let (model, configured) = (SerialRcm::new(design), Thresholds::of(&design));
        Self {
            aimer: Aimer::new(&design),
            cancel,
            input: recorder.inputs().record(),
            expected: recorder.outputs().record(),
            recorder,
            codec: SerialCodec::new(design),
            random,
            configured,
            thresholds: configured,
            is_under_way: false,
            syncs: design.syncs(),
            constant: design.thresholds() == Mode::Constant,
            aim: FrameAim::Design,
            turn: 0,
            manners: Manners::Quiet,
            max: u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits"),
            garbage: vec![0; model.output().forward_valid.len()],
            model,
        }
    }

    /// Starts over: a reset, during which anything may be on the other inputs.
    pub(super) fn begin(&mut self, aim: FrameAim) -> Result<(), CosimError> {
        self.aim = if self.constant { FrameAim::Design } else { aim };
        self.is_under_way = false;
        self.turn = 0;
        for _ in 0..=self.random.up_to(1) {
            let valid = self.random.one_in(2);
            self.clock(true, valid, None, None)?;
        }
        let pause = self.random.up_to(2);
        self.idle(pause)
    }

    /// Whether the thresholds are those of the design, so that the data must meet them.
    pub(super) fn thresholds_are_configured(&self) -> bool {
        self.aim == FrameAim::Design
    }

    /// Names the clocks from here on.
    pub(super) fn name(&mut self, sequence: &str, frame: u64, region: Option<u32>) {
        self.recorder.begin_frame(sequence, frame, region);
    }

    /// What the outputs show.
    pub(super) fn output(&self) -> &SerialOutput {
        self.model.output()
    }

    /// How many clocks without a pixel it takes until the array takes one again.
    pub(super) fn clocks_until_ready(&self) -> u64 {
        self.model.clocks_until_ready()
    }

    /// The first `count` pixels of a frame, each as soon as it is taken and its gap is over.
    pub(super) fn take(&mut self, feed: &Feed, count: usize, gaps: Gaps) -> Result<(), CosimError> {
        self.manners = Manners::any(&mut self.random);
        self.wait(feed.beats().next())?;
        self.is_under_way = false;
        for (place, pixels) in feed.beats().take(count).enumerate() {
            self.wait(Some(pixels))?;
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            if !self.is_under_way {
                self.thresholds = match self.aim {
                    FrameAim::Design => self.configured,
                    FrameAim::Exact | FrameAim::Largest => {
                        let largest = (self.aim == FrameAim::Largest).then_some(self.turn);
                        let region = self.aimer.any_region(&mut self.random);
                        let stream = feed.stream(region as usize);
                        let reference = self.model.reference(region);
                        self.aimer.exact(region, stream, reference, largest, &mut self.random)
                    }
                    FrameAim::Least => Aimer::least(),
                };
                self.turn += 1;
                self.is_under_way = true;
            }
            self.clock(false, true, Some(place == 0), Some(pixels))?;
        }
        Ok(())
    }

    /// What comes of a frame on its way, each beat as soon as it is taken and its gap is over. Thresholds stay those
    /// of the design: nobody says here when a frame begins.
    pub(super) fn deliver(
        &mut self,
        feed: &Feed,
        delivery: Delivery,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        self.manners = Manners::any(&mut self.random);
        self.thresholds = self.configured;
        let beats: Vec<&[u16]> = feed.beats().collect();
        for (sof, place) in delivery.beats(beats.len(), &mut self.random) {
            let pixels = place.map(|place| beats[place]);
            self.wait(pixels)?;
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            self.clock(false, true, Some(sof), pixels)?;
        }
        Ok(())
    }

    /// Lets the array work until it takes the next pixel, which is `next`.
    fn wait(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        while !self.output().ready {
            self.busy(next)?;
        }
        Ok(())
    }

    /// Lets the array work on its frame until only so many clocks are left of it.
    pub(super) fn work_until(&mut self, left: u64) -> Result<(), CosimError> {
        while self.clocks_until_ready() > left {
            self.busy(None)?;
        }
        self.is_under_way &= !self.output().ready;
        Ok(())
    }

    /// Lets the array work on its frame until a score is at the ports.
    pub(super) fn work_until_score(&mut self) -> Result<(), CosimError> {
        while self.clocks_until_ready() > 0 && !self.output().score_valid {
            self.busy(None)?;
        }
        Ok(())
    }

    /// One clock at which nothing is taken.
    fn busy(&mut self, next: Option<&[u16]>) -> Result<(), CosimError> {
        let (valid, offered) = self.manners.offer(next, &mut self.random);
        self.clock(false, valid, None, offered)
    }

    /// Clocks without a pixel; the pixel port shows anything.
    pub(super) fn idle(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.clock(false, false, None, None)?;
        }
        Ok(())
    }

    /// One edge. Without pixels garbage is applied, and without a mark any.
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
        if !self.is_under_way && self.aim != FrameAim::Design {
            self.aimer.shake(&mut self.thresholds, &mut self.random);
        }
        let pixels = pixels.unwrap_or(&self.garbage);
        let sof = sof.unwrap_or_else(|| self.syncs && self.random.one_in(2));
        let applied = Applied { reset, valid, sof, ..Applied::idle(pixels, &self.thresholds) };
        let output = self.model.step(&applied.of_array());
        self.codec.inputs(self.recorder.inputs(), &applied, &mut self.input);
        self.codec.outputs(self.recorder.outputs(), output, &mut self.expected);
        self.recorder.push(&self.input, &self.expected)
    }
}
