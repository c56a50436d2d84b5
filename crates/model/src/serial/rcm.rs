// SPDX-License-Identifier: MIT OR Apache-2.0
//! The array: its position in a frame, and its outputs there.

use foveate_design::{Action, Feed, PortRole, SerialDesign};

use super::intake::Intake;
use super::ports::SerialOutput;
use super::regions::{Judged, Regions};
use super::schedule::{Leaving, Schedule, Seen};
use crate::cycle::{CoreInput, CycleModel};
use crate::number::index;
use crate::{FrameSync, Thresholds, region_border};

/// The cycle-level model of a serial array. A new one is in the state after a reset.
#[derive(Clone, Debug, PartialEq)]
pub struct SerialRcm {
    schedule: Schedule,
    /// The thresholds, if they are constants of the core.
    constants: Option<Thresholds>,
    feed: Feed,
    borders: Vec<u8>,
    sync: FrameSync,
    intake: Intake,
    regions: Regions,
    stage: Stage,
    output: SerialOutput,
    /// True if a `forward_valid_o` is 1.
    is_forwarding: bool,
}

/// The position of the array in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// The array takes pixels. The last one is still being written for `writing` clocks. `before`
    /// is the number of edges since T0 of the frame before, whose last step may be seen after the
    /// array is ready again.
    Taking { writing: u64, before: Option<u64> },
    /// T0 was `clock` edges ago.
    Working { clock: u64 },
}

impl Stage {
    /// The state after a reset.
    const EMPTY: Self = Self::Taking { writing: 0, before: None };
}

impl SerialRcm {
    /// Makes the array of the design. The array of [`SerialDesign::one_lane`] is the core of one
    /// RPU.
    #[must_use]
    pub fn new(design: SerialDesign<'_>) -> Self {
        let intake = Intake::new(design);
        let output = SerialOutput { ready: true, ..SerialOutput::silent(intake.width()) };
        Self {
            schedule: Schedule::new(design),
            constants: Thresholds::constants(&design),
            feed: design.feed(),
            borders: (0..design.regions()).map(|region| region_border(&design, region)).collect(),
            regions: Regions::new(design),
            stage: Stage::EMPTY,
            is_forwarding: false,
            sync: FrameSync::new(&design),
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
            self.intake.width(),
            "a pixel per lane of the port is needed"
        );
        if input.reset {
            self.reset();
        } else if self.sync.step(input.valid, input.sof, self.is_open()) {
            self.take(input);
        } else {
            self.pass(1);
        }
        self.show();
        &self.output
    }

    /// Applies `clocks` edges at once, without a reset and without a valid pixel.
    ///
    /// # Panics
    /// Panics if the array completes a frame by itself, because it takes pixels then. In that state
    /// it has no [quiet clocks](Self::quiet_clocks).
    pub fn skip(&mut self, clocks: u64) -> &SerialOutput {
        assert!(!self.sync.is_filling(), "an array that completes a frame takes pixels");
        if clocks > 0 {
            self.sync.step(false, false, false);
        }
        self.pass(clocks);
        self.show();
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
            Stage::Taking { writing, .. } if self.intake.is_full() => {
                writing + self.schedule.clocks_until_ready(0)
            }
            Stage::Taking { writing, .. } => writing,
            Stage::Working { clock } => self.schedule.clocks_until_ready(clock),
        }
    }

    fn is_open(&self) -> bool {
        self.clocks_until_open() == 0
    }

    /// Returns a lower bound of the clocks, without a reset and without a valid pixel, for which
    /// the outputs stay as they are because the array works and outputs nothing.
    #[must_use]
    pub fn quiet_clocks(&self) -> u64 {
        let Stage::Working { clock } = self.stage else { return 0 };
        let seen = self.schedule.until_seen(clock).unwrap_or(u64::MAX);
        seen.min(self.clocks_until_ready()).saturating_sub(1)
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
        self.intake.forget();
        self.regions.forget();
        self.stage = Stage::EMPTY;
    }

    fn take(&mut self, input: &CoreInput<'_>) {
        let clocks = self.intake.take(input.pixels);
        if self.intake.is_full() {
            // Thresholds stay constant from here on, and no score is output before it is due. So
            // the frame can be scored now.
            self.judge(input.thresholds);
        }
        let before = match self.stage {
            Stage::Taking { before, .. } => before,
            Stage::Working { clock } => Some(clock),
        };
        self.stage = Stage::Taking { writing: clocks, before };
        self.pass(1);
    }

    fn judge(&mut self, applied: &Thresholds) {
        let thresholds = self.constants.as_ref().unwrap_or(applied);
        let mut stream = Vec::new();
        for (region, &border) in self.borders.iter().enumerate() {
            self.intake.stream(region, &mut stream);
            self.regions.judge(region, stream.iter().copied(), border, thresholds);
        }
    }

    /// Advances the time. A pixel that is written for c clocks was taken c - 1 edges before T0.
    fn pass(&mut self, clocks: u64) {
        self.stage = match self.stage {
            Stage::Taking { writing, .. } if clocks >= writing && self.intake.is_full() => {
                Stage::Working { clock: clocks - writing }
            }
            Stage::Taking { writing, before } => Stage::Taking {
                writing: writing.saturating_sub(clocks),
                before: before.map(|clock| clock.saturating_add(clocks)),
            },
            Stage::Working { clock } => Stage::Working { clock: clock.saturating_add(clocks) },
        };
    }

    fn show(&mut self) {
        // The ports of the lanes are written only in clocks in which they show something.
        if std::mem::take(&mut self.is_forwarding) {
            self.output.stop_forwarding();
        }
        self.output.stop_saying();
        self.output.ready = self.is_open() && !self.sync.is_filling();
        self.output.sync_error = self.sync.is_error();
        let seen = match self.stage {
            Stage::Taking { before, .. } => before.and_then(|clock| self.schedule.at(clock)),
            Stage::Working { clock } => self.schedule.at(clock),
        };
        if let Some((slot, seen)) = seen {
            match seen {
                Seen::Score { number, lane, decides } => {
                    if let Some(region) = self.schedule.region(lane, slot) {
                        self.show_score(region, number, decides);
                    }
                }
                Seen::Leaving { what, number, lane: None } => {
                    for lane in 0..self.schedule.lanes() {
                        self.show_leaving(lane, slot, what, number);
                    }
                }
                Seen::Leaving { what, number, lane: Some(lane) } => {
                    self.show_leaving(lane, slot, what, number);
                }
            }
        }
    }

    fn show_score(&mut self, region: u32, number: u32, decides: bool) {
        let Judged { verdict, action, .. } = self.regions.judged(index(region));
        let output = &mut self.output;
        output.score_valid = true;
        (output.region, output.score_index) = (region, number);
        output.score = verdict.score(number);
        if decides {
            output.decision_valid = true;
            (output.srs, output.trs, output.active) = (verdict.srs, verdict.trs, verdict.active());
            output.summary = *action == Action::Summarize;
        }
    }

    /// Writes the pixel or mean of the region of a lane to the ports, if one leaves.
    fn show_leaving(&mut self, lane: u32, slot: u32, what: Leaving, number: u32) {
        if let Some(region) = self.schedule.region(lane, slot)
            && let Some((position, pixel)) = self.regions.leaving(region, what, number)
        {
            self.is_forwarding = true;
            let output = &mut self.output;
            output.forward_position = position;
            let port = match self.feed {
                Feed::Parallel => {
                    output.forward_slot = slot;
                    index(lane)
                }
                Feed::Raster => {
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

    fn show(&self, role: PortRole, values: &mut Vec<u64>) {
        self.output.show(role, values);
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
