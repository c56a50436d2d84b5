// SPDX-License-Identifier: MIT OR Apache-2.0
//! The array: where in a frame it is, and what its outputs show there.

use foveate_design::{Action, Feed, PortRole, SerialDesign};

use super::intake::Intake;
use super::ports::SerialOutput;
use super::regions::{Judged, Regions};
use super::schedule::{Leaving, Schedule, Seen};
use crate::cycle::{CoreInput, CycleModel};
use crate::number::index;
use crate::{FrameSync, Thresholds, region_border};

/// The cycle-level model of a serial array, as after a reset when new.
#[derive(Clone, Debug, PartialEq)]
pub struct SerialRcm {
    schedule: Schedule,
    /// The thresholds, where they are constants of the core.
    constants: Option<Thresholds>,
    feed: Feed,
    borders: Vec<u8>,
    sync: FrameSync,
    intake: Intake,
    regions: Regions,
    stage: Stage,
    output: SerialOutput,
    /// Whether a `forward_valid_o` is 1.
    is_forwarding: bool,
}

/// Where in a frame the array is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Takes pixels; the last one is still being written for so many clocks. T0 of the frame before was so many
    /// edges ago: its last step may be seen once the array is ready again.
    Taking { writing: u64, before: Option<u64> },
    /// So many edges ago was T0.
    Working { clock: u64 },
}

impl Stage {
    /// As after a reset.
    const EMPTY: Self = Self::Taking { writing: 0, before: None };
}

impl SerialRcm {
    /// The array of the design. That of [`SerialDesign::one_lane`] is the core of one RPU.
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

    /// One rising edge; returns what every output shows after it.
    ///
    /// # Panics
    /// When there are not as many pixels as `pixel_i` has.
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

    /// As many steps without reset and without a pixel, at once.
    ///
    /// # Panics
    /// When the array completes a frame by itself, and so needs pixels. It has no [quiet clocks](Self::quiet_clocks)
    /// then.
    pub fn skip(&mut self, clocks: u64) -> &SerialOutput {
        assert!(!self.sync.is_filling(), "an array that completes a frame takes pixels");
        if clocks > 0 {
            self.sync.step(false, false, false);
        }
        self.pass(clocks);
        self.show();
        &self.output
    }

    /// What the outputs show.
    #[must_use]
    pub fn output(&self) -> &SerialOutput {
        &self.output
    }

    /// How many clocks without a pixel it takes until `ready_o` is 1.
    #[must_use]
    pub fn clocks_until_ready(&self) -> u64 {
        if self.sync.is_filling() {
            return self.clocks_until_open()
                + self.intake.clocks_left()
                + self.schedule.clocks_until_ready(0);
        }
        self.clocks_until_open()
    }

    /// How many clocks without a pixel it takes until one would be taken, from outside or not.
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

    /// For how many more clocks without reset and without a pixel the outputs stay as they are, since the
    /// array works and nothing is seen of it: a lower bound.
    #[must_use]
    pub fn quiet_clocks(&self) -> u64 {
        let Stage::Working { clock } = self.stage else { return 0 };
        let seen = self.schedule.until_seen(clock).unwrap_or(u64::MAX);
        seen.min(self.clocks_until_ready()).saturating_sub(1)
    }

    /// What the next frame of a region will be compared with: scored pixels, row by row; `None` where
    /// there is no reference. Known from the edge that takes the last pixel of a frame.
    ///
    /// # Panics
    /// When the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<&[u16]> {
        self.regions.reference(index(region))
    }

    /// The means that the screen shows of a region before the next frame, block by block; `None` where it shows no summary.
    /// Known from the edge that takes the last pixel of a frame.
    ///
    /// # Panics
    /// When the design has no such region.
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
            // The thresholds stay still from here, and nobody sees the scores before they are due.
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

    /// Lets clocks pass. A pixel that is written for c clocks was taken c - 1 edges before T0.
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
        // The ports of the lanes are touched only where something is seen on them.
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

    /// What leaves of the region of a lane, if anything does.
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
