// SPDX-License-Identifier: MIT OR Apache-2.0
//! A driver that feeds frames to a core, word by word, in front of a sink that is not always ready.
//! It records inputs and outputs.

use foveate_model::{ClassMapInputs, CoreInput, RasterOutput, RasterRcm};
use foveate_pixels::Frame;

use super::memory::{ExternalMemory, MemoryFaultRates};
use super::raster_parameters::RasterParameters;
use crate::class_maps::{ClassMapLog, ClassMapWriter};
use crate::frames::SeededRandom;
use crate::port_thresholds::PortThresholds;

/// The clocks at which the sink is ready.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SinkPattern {
    /// The sink is ready in this percentage of clocks, at random.
    Percent(i64),
    /// The sink is alternately ready and not ready for up to this number of clocks.
    Alternating(i64),
}

/// The pattern in which words come and leave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RasterTraffic {
    /// Percentage of clocks without a word although the core is ready.
    pub(crate) gaps: i64,
    /// Longest pause between frames in clocks.
    pub(crate) max_pause: i64,
    /// Percentage of clocks with a word although the core is not ready.
    pub(crate) pushing: i64,
    pub(crate) sink: SinkPattern,
    /// Faults of the external memory, if there is one.
    pub(crate) faults: MemoryFaultRates,
    pub(crate) seed: u64,
}

impl RasterTraffic {
    pub(crate) const DENSE: Self = Self {
        gaps: 0,
        max_pause: 0,
        pushing: 0,
        sink: SinkPattern::Percent(100),
        faults: MemoryFaultRates::NONE,
        seed: 0,
    };
}

/// A frame with its thresholds.
pub(crate) struct RasterStimulus {
    pub(crate) frame: Frame,
    pub(crate) thresholds: PortThresholds,
}

/// The inputs and outputs since a reset. Element x belongs to edge x, and element 0 to the time
/// before the first edge.
#[derive(Clone, Debug, Default)]
pub(crate) struct RasterTrace {
    pub(crate) valid: Vec<bool>,
    pub(crate) sink: Vec<bool>,
    /// The references and their valid bits, if the core has these ports.
    pub(crate) references: Vec<(bool, Vec<u16>)>,
    /// The inputs of the memory of classes.
    pub(crate) maps: Vec<ClassMapInputs>,
    pub(crate) shown: Vec<RasterOutput>,
}

impl RasterTrace {
    /// Returns the number of the last edge.
    pub(crate) fn end(&self) -> i64 {
        self.shown.len() as i64 - 1
    }
}

pub(crate) struct RasterDriver {
    pub(crate) recipe: RasterParameters,
    pub(crate) rcm: RasterRcm,
    traffic: RasterTraffic,
    memory: ExternalMemory,
    random: SeededRandom,
    trace: RasterTrace,
    /// Clocks that are left until the run ends.
    clocks_left: i64,
    /// Clocks left of the current phase of the sink, and true if the sink is ready in it.
    sink_phase: (i64, bool),
    decisions: i64,
    /// The writer of maps, if the core has zones.
    writer: Option<ClassMapWriter>,
    /// The edges of all traces before this one.
    pub(crate) maps: ClassMapLog,
    /// True between the first and the last word of a frame.
    is_inside: bool,
}

impl RasterDriver {
    pub(crate) fn new(recipe: &RasterParameters, traffic: RasterTraffic) -> Self {
        let design = recipe.design();
        let rcm = RasterRcm::new(design.as_raster().unwrap());
        let writer = |_| ClassMapWriter::new(&recipe.base, recipe.advances(), traffic.seed);
        let mut driver = Self {
            recipe: recipe.clone(),
            rcm,
            traffic,
            memory: ExternalMemory::new(recipe, traffic.faults, traffic.seed),
            random: SeededRandom(traffic.seed),
            trace: RasterTrace::default(),
            clocks_left: i64::MAX,
            sink_phase: (0, true),
            decisions: 0,
            writer: recipe.base.zones.as_ref().map(writer),
            maps: ClassMapLog::new(&recipe.base),
            is_inside: false,
        };
        driver.restart_trace();
        driver
    }

    /// Resets the core for some clocks, with random values at its ports.
    pub(crate) fn reset(&mut self, clocks: i64) {
        for _ in 0..clocks {
            let (word, thresholds) =
                (self.ignored_word(), PortThresholds::random(&mut self.random));
            let (valid, forward_ready) = (self.random.below(2) > 0, self.random.below(2) > 0);
            let map = self.map_inputs();
            let input = CoreInput {
                reset: true,
                valid,
                reference_pixels: &word,
                forward_ready,
                zones: self.writer.is_some().then(|| thresholds.zone_inputs(map)),
                ..CoreInput::idle(&word, &thresholds.own)
            };
            self.rcm.step(&input);
        }
        self.memory.clear();
        self.maps.push_reset();
        self.restart_trace();
    }

    /// Starts a new record of inputs and outputs.
    fn restart_trace(&mut self) {
        self.decisions = 0;
        self.is_inside = false;
        let shown = vec![self.rcm.output().clone()];
        let references = vec![(false, Vec::new())];
        let (valid, maps) = (vec![false], vec![ClassMapInputs::default()]);
        self.trace = RasterTrace { valid, sink: vec![false], references, maps, shown };
    }

    /// Feeds the frames, lets `rest` clocks pass, and returns the record. The run ends after
    /// `clocks` clocks, whatever is under way.
    pub(crate) fn run(&mut self, jobs: &[RasterStimulus], rest: i64, clocks: i64) -> RasterTrace {
        self.clocks_left = clocks;
        for (number, job) in (1..).zip(jobs) {
            let pause = self.random.below(self.traffic.max_pause + 1);
            for _ in 0..pause {
                self.idle(&job.thresholds);
            }
            self.feed(job);
            // Thresholds may change only from here on.
            while !self.may_change_thresholds(number) && self.clocks_left > 0 {
                self.idle(&job.thresholds);
            }
        }
        for _ in 0..rest {
            let noise = PortThresholds::random(&mut self.random);
            self.idle(&noise);
        }
        std::mem::take(&mut self.trace)
    }

    /// Returns true if the thresholds may change: without a second pass when the core is ready
    /// again, with a second pass after the last decision.
    fn may_change_thresholds(&self, frames: i64) -> bool {
        let regions = self.recipe.base.columns() * self.recipe.base.rows();
        let is_decided = self.decisions == frames * regions;
        self.rcm.output().ready && (is_decided || !self.recipe.base.has_second_pass())
    }

    fn feed(&mut self, job: &RasterStimulus) {
        for word in frame_words(&self.recipe, &job.frame, &mut self.random) {
            while !self.rcm.output().ready || self.random.below(100) < self.traffic.gaps {
                if self.clocks_left == 0 {
                    return;
                }
                self.idle(&job.thresholds);
            }
            self.step(true, &word, &job.thresholds);
            self.is_inside = true;
        }
        self.is_inside = false;
    }

    fn idle(&mut self, thresholds: &PortThresholds) {
        let junk = self.ignored_word();
        let pushes = !self.rcm.output().ready && self.random.below(100) < self.traffic.pushing;
        self.step(pushes, &junk, thresholds);
    }

    fn step(&mut self, valid: bool, pixels: &[u16], thresholds: &PortThresholds) {
        if self.clocks_left == 0 {
            return;
        }
        self.clocks_left -= 1;
        let forward_ready = self.is_sink_ready();
        let map = self.map_inputs();
        let (reference_valid, reference) = self.memory.reference_port(self.rcm.output());
        let input = CoreInput {
            valid,
            reference_valid,
            reference_pixels: &reference,
            forward_ready,
            zones: self.writer.is_some().then(|| thresholds.zone_inputs(map)),
            ..CoreInput::idle(pixels, &thresholds.own)
        };
        let shown = self.rcm.step(&input).clone();
        self.memory.store(&shown);
        self.trace.references.push((reference_valid, reference));
        self.decisions += i64::from(shown.decision_valid);
        self.trace.valid.push(valid);
        self.trace.sink.push(forward_ready);
        self.trace.maps.push(map);
        self.trace.shown.push(shown);
    }

    /// Returns the inputs of the memory of classes at the next edge.
    fn map_inputs(&mut self) -> ClassMapInputs {
        let is_near_end = !self.is_inside;
        self.writer.as_mut().map(|writer| writer.next(is_near_end)).unwrap_or_default()
    }

    fn is_sink_ready(&mut self) -> bool {
        match self.traffic.sink {
            SinkPattern::Percent(percent) => self.random.below(100) < percent,
            SinkPattern::Alternating(longest) => {
                if self.sink_phase.0 == 0 {
                    self.sink_phase = (1 + self.random.below(longest), !self.sink_phase.1);
                }
                self.sink_phase.0 -= 1;
                self.sink_phase.1
            }
        }
    }

    /// Returns a word that the core must ignore.
    fn ignored_word(&mut self) -> Vec<u16> {
        let top = self.recipe.base.pixel_max() + 1;
        (0..self.recipe.word_pixels).map(|_| self.random.below(top) as u16).collect()
    }
}

/// Returns the words of a frame. Pixels beyond its right border are random.
fn frame_words(
    recipe: &RasterParameters,
    frame: &Frame,
    random: &mut SeededRandom,
) -> Vec<Vec<u16>> {
    let top = recipe.base.pixel_max() + 1;
    let mut words = Vec::new();
    for y in 0..frame.height() {
        let mut row = frame.row(y).to_vec();
        row.resize(
            (recipe.taken_row_words() * recipe.word_pixels) as usize,
            random.below(top) as u16,
        );
        words.extend(row.chunks_exact(recipe.word_pixels as usize).map(<[u16]>::to_vec));
    }
    words
}
