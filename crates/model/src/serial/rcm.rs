// SPDX-License-Identifier: MIT OR Apache-2.0
//! The array: its position in a frame, and its outputs there.

use foveate_camera::RegionAction;
use foveate_design::{PixelFeed, PortRole, SerialDesign};

use super::intake::FrameIntake;
use super::ports::SerialOutput;
use super::regions::{DecidedSerialRegion, SerialRegions};
use super::schedule::{ForwardedKind, SerialSchedule, StepOutput};
use crate::class_memory::ClassMemory;
use crate::conversions::index;
use crate::cycle_model::{CoreInput, CycleModel};
use crate::thresholds::{ClassThresholdInputs, ThresholdConstants};
use crate::{ClassMapInputs, FrameSync, region_border};

/// The cycle-level model of a serial array. A new one is in the state after a reset.
#[derive(Clone, Debug, PartialEq)]
pub struct SerialRcm {
    schedule: SerialSchedule,
    /// The thresholds, if they are constants of the core.
    constants: Option<ThresholdConstants>,
    feed: PixelFeed,
    borders: Vec<u8>,
    flow: Option<DisplacementPorts>,
    sync: FrameSync,
    /// The memory of classes, if the core has zones.
    classes: Option<ClassMemory>,
    intake: FrameIntake,
    regions: SerialRegions,
    stage: SerialStage,
    output: SerialOutput,
    /// True if a `forward_valid_o` is 1.
    is_forwarding: bool,
}

/// The ports of the displacements of regions.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DisplacementPorts {
    /// Number of the score of `flow`, with which displacements pass.
    number: u32,
    /// Bits of a coordinate.
    bits: u32,
}

impl DisplacementPorts {
    /// Returns the ports of a design, or `None` if it does not have `flow`.
    fn new(design: SerialDesign<'_>) -> Option<Self> {
        let scores = (1..).zip(design.features());
        let mut flow = scores.filter(|(_, feature)| feature.kind().is_displacement());
        let ((number, _), search) = (flow.next()?, design.flow_search()?);
        Some(Self { number, bits: search.coordinate_bits() })
    }

    /// Returns a coordinate in two's complement.
    fn port_value(self, coordinate: i8) -> u64 {
        i64::from(coordinate).cast_unsigned() & ((1 << self.bits) - 1)
    }
}

/// The position of the array in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SerialStage {
    /// The array takes pixels. The last one is still being written for `writing` clocks. `before`
    /// is the number of edges since T0 of the previous frame, because the outputs of its last step
    /// may come after the array is ready again.
    Taking { writing: u64, before: Option<u64> },
    /// T0 was `clock` edges ago.
    Working { clock: u64 },
}

impl SerialStage {
    /// The state after a reset.
    const AFTER_RESET: Self = Self::Taking { writing: 0, before: None };
}

impl SerialRcm {
    /// Makes the array of the design. The array of [`SerialDesign::single_lane_design`] is the core
    /// of one RPU.
    #[must_use]
    pub fn new(design: SerialDesign<'_>) -> Self {
        let intake = FrameIntake::new(design);
        let output =
            SerialOutput { ready: true, ..SerialOutput::without_valid_bits(intake.port_pixels()) };
        Self {
            schedule: SerialSchedule::new(design),
            constants: ThresholdConstants::of_design(&design),
            feed: design.feed(),
            flow: DisplacementPorts::new(design),
            borders: (0..design.regions()).map(|region| region_border(&design, region)).collect(),
            regions: SerialRegions::new(design),
            stage: SerialStage::AFTER_RESET,
            is_forwarding: false,
            sync: FrameSync::new(&design),
            classes: ClassMemory::of_design(&design),
            intake,
            output,
        }
    }

    /// Applies one rising edge, and returns every output after it.
    ///
    /// # Panics
    /// Panics if there are not as many pixels as `pixel_i` has.
    pub fn step(&mut self, input: &CoreInput<'_>) -> &SerialOutput {
        assert_eq!(
            input.pixels.len(),
            self.intake.port_pixels(),
            "a pixel per lane of the port is needed"
        );
        if input.reset {
            self.reset();
        } else {
            if self.sync.step(input.valid, input.sof, self.is_open()) {
                self.take_pixels(input);
            } else {
                self.advance_clocks(1);
            }
            self.step_classes(input.class_map());
        }
        self.update_output();
        &self.output
    }

    /// Applies `clocks` edges at once, without a reset, without a valid pixel, and without a write
    /// or commit to the memory of classes.
    ///
    /// # Panics
    /// Panics if the array completes a frame by itself, because it takes pixels then. In that state
    /// it has no [quiet clocks](Self::quiet_clocks).
    pub fn skip(&mut self, clocks: u64) -> &SerialOutput {
        assert!(!self.sync.is_filling(), "an array that completes a frame takes pixels");
        if clocks > 0 {
            self.sync.step(false, false, false);
        }
        self.advance_clocks(clocks);
        if clocks > 0 {
            // The edges that a frame occupies come first, so that the last edge decides.
            self.step_classes(ClassMapInputs::default());
        }
        self.update_output();
        &self.output
    }

    /// Returns the outputs after the last edge.
    #[must_use]
    pub fn output(&self) -> &SerialOutput {
        &self.output
    }

    /// Returns the number of clocks without a valid pixel until `ready_o` is 1.
    #[must_use]
    pub fn clocks_until_ready(&self) -> u64 {
        if self.sync.is_filling() {
            return self.clocks_until_open()
                + self.intake.clocks_left()
                + self.schedule.clocks_until_ready(0);
        }
        self.clocks_until_open()
    }

    /// Returns the number of clocks without a valid pixel until the array would take one, from the
    /// stream or from its own completion of a frame.
    fn clocks_until_open(&self) -> u64 {
        match self.stage {
            SerialStage::Taking { writing, .. } if self.intake.is_full() => {
                writing + self.schedule.clocks_until_ready(0)
            }
            SerialStage::Taking { writing, .. } => writing,
            SerialStage::Working { clock } => self.schedule.clocks_until_ready(clock),
        }
    }

    fn is_open(&self) -> bool {
        self.clocks_until_open() == 0
    }

    /// Returns a lower bound of the clocks, without a reset, without a valid pixel, and without a
    /// write or commit to the memory of classes, for which the outputs stay as they are because the
    /// array works and outputs nothing.
    #[must_use]
    pub fn quiet_clocks(&self) -> u64 {
        let SerialStage::Working { clock } = self.stage else { return 0 };
        let clocks_to_output = self.schedule.clocks_until_output(clock).unwrap_or(u64::MAX);
        clocks_to_output.min(self.clocks_until_ready()).saturating_sub(1)
    }

    /// Returns the reference of a region for the next frame: scored pixels in row-major order, or
    /// `None` if there is none. It is known from the edge on that takes the last pixel of a frame.
    ///
    /// # Panics
    /// Panics if the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<&[u16]> {
        self.regions.reference(index(region))
    }

    /// Returns the means of a region that the screen shows before the next frame, block by block,
    /// or `None` if it shows no summary. They are known from the edge on that takes the last pixel
    /// of a frame.
    ///
    /// # Panics
    /// Panics if the design has no such region.
    #[must_use]
    pub fn summary(&self, region: u32) -> Option<&[u16]> {
        self.regions.summary(index(region))
    }

    fn reset(&mut self) {
        self.sync.reset();
        self.intake.reset();
        self.regions.reset();
        if let Some(classes) = &mut self.classes {
            classes.reset();
        }
        self.stage = SerialStage::AFTER_RESET;
    }

    fn take_pixels(&mut self, input: &CoreInput<'_>) {
        let clocks = self.intake.take(input.pixels);
        if self.intake.is_full() {
            // The model scores the whole frame at this edge, before the array does. This is not
            // visible, because thresholds stay constant from here on, and because scores come to
            // the ports only in the clocks of the schedule.
            self.decide_frame(ClassThresholdInputs::new(input.thresholds, input.zones));
        }
        let before = match self.stage {
            SerialStage::Taking { before, .. } => before,
            SerialStage::Working { clock } => Some(clock),
        };
        self.stage = SerialStage::Taking { writing: clocks, before };
        self.advance_clocks(1);
    }

    fn decide_frame(&mut self, applied: ClassThresholdInputs<'_>) {
        let thresholds = self.constants.as_ref().map_or(applied, ThresholdConstants::by_class);
        let mut stream = Vec::new();
        for (number, &border) in (0..).zip(&self.borders) {
            let region = index(number);
            let class = self.classes.as_ref().map(|classes| classes.class(number));
            let rules = (class.unwrap_or_default(), thresholds);
            self.intake.stream(region, &mut stream);
            self.regions.decide(region, stream.iter().copied(), border, rules);
        }
    }

    /// Applies the last edge to the memory of classes.
    fn step_classes(&mut self, inputs: ClassMapInputs) {
        let is_occupied = self.is_occupied();
        if let Some(classes) = &mut self.classes {
            classes.step(inputs, is_occupied);
        }
    }

    /// Returns true if a frame occupies the last edge. Its edges are those from the edge that takes
    /// the first pixel up to the one before the edge after which `ready_o` is 1 again.
    fn is_occupied(&self) -> bool {
        match self.stage {
            SerialStage::Taking { .. } => !self.intake.is_empty(),
            SerialStage::Working { clock } => self.schedule.clocks_until_ready(clock) > 0,
        }
    }

    /// Advances the time. A pixel that is written for c clocks was taken c - 1 edges before T0.
    fn advance_clocks(&mut self, clocks: u64) {
        self.stage = match self.stage {
            SerialStage::Taking { writing, .. } if clocks >= writing && self.intake.is_full() => {
                SerialStage::Working { clock: clocks - writing }
            }
            SerialStage::Taking { writing, before } => SerialStage::Taking {
                writing: writing.saturating_sub(clocks),
                before: before.map(|clock| clock.saturating_add(clocks)),
            },
            SerialStage::Working { clock } => {
                SerialStage::Working { clock: clock.saturating_add(clocks) }
            }
        };
    }

    fn update_output(&mut self) {
        // The ports of the lanes are written only in clocks in which they show something.
        if std::mem::take(&mut self.is_forwarding) {
            self.output.clear_forward_ports();
        }
        self.output.clear_other_ports();
        self.output.ready = self.is_open() && !self.sync.is_filling();
        self.output.sync_error = self.sync.is_error();
        self.output.zone_pending = self.classes.as_ref().is_some_and(ClassMemory::is_pending);
        let seen = match self.stage {
            SerialStage::Taking { before, .. } => {
                before.and_then(|clock| self.schedule.output_at(clock))
            }
            SerialStage::Working { clock } => self.schedule.output_at(clock),
        };
        if let Some((slot, seen)) = seen {
            match seen {
                StepOutput::Score { number, lane, decides } => {
                    if let Some(region) = self.schedule.region(lane, slot) {
                        self.show_score(region, number, decides);
                    }
                }
                StepOutput::Forwarded { what, number, lane: None } => {
                    for lane in 0..self.schedule.lanes() {
                        self.show_forwarded(lane, slot, what, number);
                    }
                }
                StepOutput::Forwarded { what, number, lane: Some(lane) } => {
                    self.show_forwarded(lane, slot, what, number);
                }
            }
        }
    }

    fn show_score(&mut self, region: u32, number: u32, decides: bool) {
        let DecidedSerialRegion { decision, displacement, action, .. } =
            self.regions.decided(index(region));
        let output = &mut self.output;
        output.score_valid = true;
        (output.region, output.score_index) = (region, number);
        output.score = decision.score(number);
        if let Some(flow) = &self.flow
            && flow.number == number
        {
            output.displacement_x = flow.port_value(displacement.dx);
            output.displacement_y = flow.port_value(displacement.dy);
        }
        if decides {
            output.decision_valid = true;
            (output.srs, output.trs, output.active) =
                (decision.srs, decision.trs, decision.is_active());
            output.summary = *action == RegionAction::Summarize;
        }
    }

    /// Writes the pixel or mean of the region of a lane to the ports, if one leaves.
    fn show_forwarded(&mut self, lane: u32, slot: u32, what: ForwardedKind, number: u32) {
        if let Some(region) = self.schedule.region(lane, slot)
            && let Some((position, pixel)) = self.regions.forwarded_value(region, what, number)
        {
            self.is_forwarding = true;
            let output = &mut self.output;
            output.forward_position = position;
            let port = match self.feed {
                PixelFeed::Parallel => {
                    output.forward_slot = slot;
                    index(lane)
                }
                PixelFeed::Raster => {
                    output.forward_region = region;
                    0
                }
            };
            (output.forward_valid[port], output.forward_pixel[port]) = (true, pixel);
        }
    }
}

impl CycleModel for SerialRcm {
    fn clock(&mut self, input: &CoreInput<'_>) {
        self.step(input);
    }

    fn append_output(&self, role: PortRole, values: &mut Vec<u64>) {
        self.output.append_port(role, values);
    }

    fn is_ready(&self) -> bool {
        self.output.ready
    }

    fn clocks_until_ready(&self) -> u64 {
        self.clocks_until_ready()
    }

    fn quiet_clocks(&self) -> u64 {
        self.quiet_clocks()
    }

    fn skip_quiet_clocks(&mut self) {
        self.skip(self.quiet_clocks());
    }

    fn reference(&self, region: u32) -> Option<&[u16]> {
        self.reference(region)
    }

    fn summary(&self, region: u32) -> Option<&[u16]> {
        self.summary(region)
    }

    fn duplicate(&self) -> Box<dyn CycleModel> {
        Box::new(self.clone())
    }
}
