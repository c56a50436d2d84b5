// SPDX-License-Identifier: MIT OR Apache-2.0
//! A driver of a cycle model. It plays random traffic clock by clock, and records the deliveries,
//! the stalls of the sink, and all events at the ports.

use std::ops::Range;

use foveate_design::Design;
use foveate_model::{CoreInput, ThresholdInputs};
use foveate_pixels::Frame;
use foveate_timed::BeatOffer;

use crate::event::PortEvent;
use crate::frame_beats::{beat_of_pixel, can_be_cut, frame_beats};
use crate::observed_core::ObservedCore;
use crate::traffic::{Random, Traffic};

/// A frame as the source has delivered it.
#[derive(Clone, Debug)]
pub(crate) struct RecordedDelivery {
    /// The frame as the core has seen it.
    pub(crate) frame: Frame,
    pub(crate) beats: u64,
    pub(crate) is_marked: bool,
    pub(crate) offers: Vec<BeatOffer>,
    pub(crate) reset: Option<u64>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct RecordedRun {
    pub(crate) deliveries: Vec<RecordedDelivery>,
    pub(crate) stalls: Vec<Range<u64>>,
    pub(crate) events: Vec<PortEvent>,
    pub(crate) edges: u64,
}

struct PlannedDelivery {
    frame: Frame,
    beats: u64,
    is_marked: bool,
    has_reset: bool,
}

pub(crate) struct Driver<'a> {
    design: &'a Design,
    traffic: Traffic,
    random: Random,
    core: ObservedCore,
    thresholds: ThresholdInputs,
    beats: u64,
    /// The value on the pixel port while nothing is taken.
    idle_pixel: u16,
    idle_beat: Vec<u16>,
    /// The number of edges that are left of the sink's phase, and true if it is ready in it.
    sink_phase: (u64, bool),
    run: RecordedRun,
}

impl<'a> Driver<'a> {
    pub(crate) fn new(design: &'a Design, traffic: Traffic) -> Self {
        let mut random = Random::new(traffic.seed);
        let idle_pixel = random.below(u64::from(design.pixel_max()) + 1) as u16;
        let blank = Frame::new(
            design.width(),
            design.height(),
            design.pixel_bits(),
            vec![idle_pixel; (design.width() * design.height()) as usize],
        );
        let idle_beat = frame_beats(design, &blank.unwrap()).swap_remove(0);
        Self {
            design,
            traffic,
            random,
            core: ObservedCore::new(design),
            thresholds: ThresholdInputs::from_camera(design),
            beats: design.timing().pixels_per_frame(),
            idle_pixel,
            idle_beat,
            sink_phase: (0, false),
            run: RecordedRun::default(),
        }
    }

    /// Makes a driver without pauses whose sink stalls once.
    pub(crate) fn with_stall(design: &'a Design, stall: Range<u64>) -> Self {
        let mut driver = Self::new(design, Traffic::DENSE);
        driver.run.stalls.push(stall);
        driver
    }

    /// Plays the frames, and then lets the core work until nothing can come any more.
    pub(crate) fn play(mut self, frames: &[Frame]) -> RecordedRun {
        for planned in self.plan(frames) {
            self.deliver(planned);
        }
        let rest =
            3 * self.design.timing().clocks_per_frame() + 200 + 2 * self.traffic.longest_stall;
        for _ in 0..rest {
            self.clock(false, false, None);
        }
        self.run
    }

    /// Plans deliveries of frames. A frame that the core completes has the idle pixel from the cut
    /// on, and so have the deliveries that it drops meanwhile.
    fn plan(&mut self, frames: &[Frame]) -> Vec<PlannedDelivery> {
        // The number of beats that the frame under way has, and the beats that the core may still
        // have to complete.
        let (mut inside, mut filling) = (0, 0);
        let mut plan = Vec::new();
        for frame in frames {
            let is_damaged =
                self.design.has_frame_sync() && self.random.percent(self.traffic.damage);
            let (mut beats, mut is_marked) = (self.beats, true);
            if is_damaged {
                match self.random.below(6) {
                    0 => beats = 1 + self.random.below(self.beats),
                    1 => beats = self.beats - 1 - self.random.below(3).min(self.beats - 2),
                    2 => beats = self.beats + 1 + self.random.below(5),
                    3 => beats = 2 * self.beats + self.random.below(3),
                    4 => is_marked = false,
                    _ => (beats, is_marked) = (1 + self.random.below(self.beats), false),
                }
            }
            let has_reset = self.random.percent(self.traffic.resets);
            let cut = if inside > 0 || filling > 0 { 0 } else { beats };
            let frame = self.cut_frame(frame, cut);
            (inside, filling) = match (inside, is_marked) {
                (0, false) => (0, filling),
                (0, true) => (if beats < self.beats { beats } else { 0 }, filling),
                // The first beat is the error. The core completes the frame from the next on.
                (had, true) => (0, self.beats - had + 1),
                (had, false) => (if had + beats < self.beats { had + beats } else { 0 }, filling),
            };
            filling = u64::saturating_sub(filling, beats);
            if has_reset {
                (inside, filling) = (0, 0);
            }
            plan.push(PlannedDelivery { frame, beats, is_marked, has_reset });
        }
        plan
    }

    /// Returns a frame whose beats from number `cut` on have the idle pixel, or all of its beats if
    /// it would be no frame then.
    fn cut_frame(&self, frame: &Frame, cut: u64) -> Frame {
        let is_cut = cut < self.beats;
        let mut pixels = frame.pixels().to_vec();
        for (place, pixel) in (0..).zip(&mut pixels) {
            let (x, y) = (place % frame.width(), place / frame.width());
            let is_kept = || u64::from(beat_of_pixel(self.design, x, y)) < cut;
            if is_cut && !(can_be_cut(self.design) && is_kept()) {
                *pixel = self.idle_pixel;
            }
        }
        Frame::new(frame.width(), frame.height(), frame.bits(), pixels).unwrap()
    }

    fn deliver(&mut self, planned: PlannedDelivery) {
        let PlannedDelivery { frame, beats, is_marked, has_reset } = planned;
        let words = frame_beats(self.design, &frame);
        let mut offers = Vec::new();
        let mut offer = self.run.edges + self.random.below(self.traffic.longest_pause + 1);
        offers.push(BeatOffer { beat: 0, clock: offer });
        let (mut beat, mut reset) = (0, None);
        while beat < beats || reset.is_some() {
            let edge = self.run.edges;
            let is_ready = self.core.is_ready();
            if has_reset && reset.is_none() && is_ready {
                let frame = self.design.timing().clocks_per_frame();
                reset = Some(edge + self.random.below(2 * frame + 5));
            }
            if reset == Some(edge) {
                self.clock_reset();
                break;
            }
            let is_taken = edge >= offer && is_ready && beat < beats;
            let word = words.get(beat as usize).filter(|_| is_taken);
            let is_valid = edge >= offer && beat < beats;
            self.clock(is_valid, is_marked && beat == 0, word);
            if is_taken {
                beat += 1;
                offer = edge + 1;
                if self.random.percent(self.traffic.gaps) && beat < beats {
                    offer += 1 + self.random.below(self.traffic.longest_gap);
                    offers.push(BeatOffer { beat, clock: offer });
                }
            }
        }
        self.run.deliveries.push(RecordedDelivery { frame, beats, is_marked, offers, reset });
    }

    fn clock_reset(&mut self) {
        let input = CoreInput {
            reset: true,
            sof: true,
            ..CoreInput::valid(&self.idle_beat, &self.thresholds)
        };
        self.core.clock(&input, self.run.edges, &mut self.run.events);
        // The sink is ready at this edge, which nothing can see.
        self.run.edges += 1;
        self.sink_phase.0 = self.sink_phase.0.saturating_sub(1);
    }

    fn clock(&mut self, valid: bool, sof: bool, beat: Option<&Vec<u16>>) {
        let forward_ready = self.is_sink_ready();
        let input = CoreInput {
            valid,
            sof,
            forward_ready,
            ..CoreInput::idle(beat.unwrap_or(&self.idle_beat), &self.thresholds)
        };
        self.core.clock(&input, self.run.edges, &mut self.run.events);
        self.run.edges += 1;
    }

    fn is_sink_ready(&mut self) -> bool {
        let Traffic { longest_ready, longest_stall, .. } = self.traffic;
        if longest_ready == 0 {
            return self.run.stalls.iter().all(|stall| !stall.contains(&self.run.edges));
        }
        if self.sink_phase.0 == 0 {
            let is_ready = !self.sink_phase.1;
            let longest = if is_ready { longest_ready } else { longest_stall };
            let length = 1 + self.random.below(longest);
            self.sink_phase = (length, is_ready);
            if !is_ready {
                self.run.stalls.push(self.run.edges..self.run.edges + length);
            }
        }
        self.sink_phase.0 -= 1;
        self.sink_phase.1
    }
}
