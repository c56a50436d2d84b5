// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds at the ports of a core, clock by clock.

use super::frame_generator::{DecisionPredictor, PatternAim};
use super::port_zones::{ClassChoice, PortZones};
use super::random::Random;
use super::threshold_ranges::{ThresholdAim, ThresholdAimer};
use foveate_design::{Design, ThresholdSource as Mode};
use foveate_model::{CoreInput, CycleModel, ThresholdInputs, region_stream};
use foveate_pixels::Frame;

/// The thresholds at the ports, and the state from which they are chosen.
pub(super) struct PortThresholds<'a> {
    design: &'a Design,
    aimer: ThresholdAimer,
    /// The prediction of decisions, if thresholds may change at every clock.
    predictor: Option<DecisionPredictor>,
    aim: ThresholdAim,
    /// The thresholds of [`ThresholdAim::Configured`].
    configured: ThresholdInputs,
    current: ThresholdInputs,
    /// The other inputs of a core with zones.
    zones: Option<PortZones>,
    /// True if a frame is under way, so that thresholds must not change.
    is_under_way: bool,
    /// The number of frames since the sequence began.
    turn: u32,
    /// The side of the squares at which levels are aimed.
    square_side: u32,
    /// The square of the last frame at which levels were aimed, as [`first_square`] cuts it.
    last_square: Vec<u16>,
}

impl<'a> PortThresholds<'a> {
    /// `lanes` is the number of regions at the ports, and `has_frame_sync` says that the frame
    /// synchronization of the design is simulated.
    pub(super) fn new(
        design: &'a Design,
        (square_side, lanes): (u32, usize),
        has_frame_sync: bool,
    ) -> Self {
        let configured = ThresholdInputs::from_camera(design);
        Self {
            design,
            aimer: ThresholdAimer::new(design),
            predictor: DecisionPredictor::for_design(design, has_frame_sync),
            aim: ThresholdAim::Configured,
            configured,
            current: configured,
            zones: PortZones::of_design(design, lanes),
            is_under_way: false,
            turn: 0,
            square_side,
            last_square: vec![0; (square_side * square_side) as usize],
        }
    }

    /// Begins a sequence. Thresholds that are constants are always those of the design.
    pub(super) fn begin_sequence(&mut self, aim: ThresholdAim, classes: ClassChoice) {
        if let Some(zones) = &mut self.zones {
            zones.begin_sequence(classes);
        }
        self.aim = match self.design.threshold_source() {
            Mode::Constant if aim != ThresholdAim::Independent => ThresholdAim::Configured,
            Mode::Constant | Mode::Runtime => aim,
        };
        self.is_under_way = false;
        self.turn = 0;
    }

    /// Returns the number of clocks that the next frame must wait until the classes of the sequence
    /// are in the core, which are written from the next clock on.
    pub(super) fn load_classes(&mut self) -> u64 {
        self.zones.as_mut().map_or(0, |zones| zones.load_clocks() as u64)
    }

    pub(super) fn current(&self) -> ThresholdInputs {
        self.current
    }

    /// Returns the other inputs of a core with zones.
    pub(super) fn zones(&self) -> Option<&PortZones> {
        self.zones.as_ref()
    }

    /// Returns the choice of data, which must meet thresholds that are those of the design.
    pub(super) fn pattern_aim(&self) -> PatternAim {
        match (self.aim, self.design.threshold_source()) {
            (ThresholdAim::Configured, _) => PatternAim::NearMinimum,
            (ThresholdAim::Independent, Mode::Constant) => PatternAim::RelevantNoise,
            _ => PatternAim::Free,
        }
    }

    /// Replaces the thresholds of the design, from now on.
    pub(super) fn configure(&mut self, thresholds: ThresholdInputs) {
        (self.configured, self.current) = (thresholds, thresholds);
    }

    /// Sets the thresholds of the design.
    pub(super) fn set_configured(&mut self) {
        self.current = self.configured;
    }

    /// Lets thresholds change from now on, unless `must_stay` says that regions are still to be
    /// decided with them.
    pub(super) fn end_frame(&mut self, must_stay: bool) {
        self.is_under_way &= must_stay;
    }

    /// Chooses the thresholds of a frame that begins, unless an earlier one is under way.
    pub(super) fn begin_frame(
        &mut self,
        frame: &Frame,
        core: &dyn CycleModel,
        random: &mut Random,
    ) {
        if self.is_under_way {
            return;
        }
        let turn = self.turn;
        let largest = (self.aim == ThresholdAim::Largest).then_some(turn);
        self.turn += 1;
        self.is_under_way = true;
        match self.aim {
            ThresholdAim::Configured => self.set_configured(),
            ThresholdAim::Smallest => self.current = ThresholdAimer::smallest_thresholds(),
            ThresholdAim::Independent => {
                self.current = match self.design.threshold_source() {
                    Mode::Runtime => ThresholdAimer::smallest_thresholds(),
                    Mode::Constant => self.configured,
                };
            }
            ThresholdAim::HeldRegions => self.current = self.aimer.held_thresholds(turn),
            ThresholdAim::DriftingRegions => self.current = self.aimer.drifting_thresholds(turn),
            ThresholdAim::EveryClock => {}
            ThresholdAim::Exact | ThresholdAim::Largest => {
                self.aim_at_frame(frame, largest, core, random);
            }
        }
    }

    /// Aims levels at a frame that comes, and also minima if these must not change within a frame.
    fn aim_at_frame(
        &mut self,
        frame: &Frame,
        largest: Option<u32>,
        core: &dyn CycleModel,
        random: &mut Random,
    ) {
        if self.predictor.is_some() {
            let now = first_square(frame, self.square_side);
            let squares = (now.as_slice(), self.last_square.as_slice());
            self.aimer.aim_levels(squares, largest, &mut self.current, random);
            if let Some(zones) = &mut self.zones {
                self.aimer.aim_levels(squares, largest, &mut zones.keen, random);
            }
            self.last_square = now;
            return;
        }
        let region = self.aimer.any_region(random);
        let mut stream = Vec::new();
        region_stream(self.design, frame, region, &mut stream);
        let (reference, shown) = (core.reference(region), core.summary(region));
        let mut near =
            || self.aimer.near_region(region, &stream, reference, shown, largest, random);
        self.current = near();
        // The class of the region decides which of the thresholds are in use.
        if let Some(zones) = &mut self.zones {
            zones.keen = near();
            zones.off_summary_level = near().summary_level;
        }
    }

    /// Begins a clock: thresholds that have no effect at it, or that change at every clock, are
    /// random.
    pub(super) fn begin_clock(&mut self, random: &mut Random) {
        let are_unrelated = match self.aim {
            ThresholdAim::Configured => false,
            ThresholdAim::EveryClock => true,
            ThresholdAim::Exact
            | ThresholdAim::Largest
            | ThresholdAim::Smallest
            | ThresholdAim::Independent
            | ThresholdAim::HeldRegions
            | ThresholdAim::DriftingRegions => self.predictor.is_none() && !self.is_under_way,
        };
        if are_unrelated {
            self.aimer.randomize(&mut self.current, random);
        }
        let Some(zones) = &mut self.zones else { return };
        zones.begin_clock(random);
        if are_unrelated {
            self.aimer.randomize(&mut zones.keen, random);
        }
    }

    /// Aims minima and the summary level at the decision of a random lane, if thresholds may change
    /// at every clock and the next edge has a decision.
    pub(super) fn aim_at_decision(
        &mut self,
        input: &CoreInput<'_>,
        core: &dyn CycleModel,
        random: &mut Random,
    ) {
        let Some(predictor) = &mut self.predictor else { return };
        match self.aim {
            ThresholdAim::Exact
            | ThresholdAim::Largest
            | ThresholdAim::Smallest
            | ThresholdAim::EveryClock => {}
            // The minima of these have a purpose of their own.
            ThresholdAim::Configured
            | ThresholdAim::Independent
            | ThresholdAim::HeldRegions
            | ThresholdAim::DriftingRegions => return,
        }
        let lane = random.index(input.pixels.len() - 1);
        if predictor.decides(input) {
            let (scores, count) = predictor.predict_scores(core, input, lane);
            self.aimer.aim_minima(&scores, count, &mut self.current, random);
            if let Some(zones) = &mut self.zones {
                self.aimer.aim_minima(&scores, count, &mut zones.keen, random);
            }
            let zones = self.zones.as_ref().map(PortZones::inputs);
            let input = CoreInput { thresholds: &self.current, zones, ..*input };
            let level = predictor.decisive_summary_level(core, &input, lane);
            self.aimer.aim_summary_level(level, &mut self.current, random);
            if let Some(zones) = &mut self.zones {
                self.aimer.aim_summary_level(level, &mut zones.keen, random);
                let mut off = self.current;
                self.aimer.aim_summary_level(level, &mut off, random);
                zones.off_summary_level = off.summary_level;
            }
        }
    }
}

/// Returns the first square of a frame: its first region, or the whole of a region with its halo.
fn first_square(frame: &Frame, side: u32) -> Vec<u16> {
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    places.map(|(x, y)| frame.get_clamped(x.into(), y.into())).collect()
}
