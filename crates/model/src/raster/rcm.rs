// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core: what an edge does to each of its parts, and what its outputs show after it.

use foveate_design::{Design, RasterTiming};

use super::advances::{Advances, Place};
use super::decisions::{Decisions, Judged};
use super::picture::Picture;
use super::ports::{RasterInput, RasterOutput};
use super::readout::Readout;
use super::regions::Regions;
use super::staleness::Staleness;
use crate::Thresholds;
use crate::number::index;

/// The cycle-level model of a raster core, as after a reset when new.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterRcm {
    timing: RasterTiming,
    /// Regions side by side.
    columns: u32,
    /// Side of a region N.
    side: u32,
    /// The thresholds, where they are constants of the core.
    constants: Option<Thresholds>,
    advances: Advances,
    picture: Picture,
    staleness: Staleness,
    regions: Regions,
    decisions: Decisions,
    readout: Readout,
    /// The region whose decision is on the ports.
    decided: Option<Judged>,
    /// Edges since reset.
    now: u64,
    /// Clocks until `ready_o` may be 1 again after T0.
    closed: u64,
    output: RasterOutput,
}

impl RasterRcm {
    /// The core of the design, which must be a raster design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let timing = RasterTiming::of(design);
        Self {
            timing,
            columns: design.columns(),
            side: design.region_size(),
            constants: Thresholds::constants(design),
            advances: Advances::new(timing),
            picture: Picture::new(design),
            staleness: Staleness::new(&timing),
            regions: Regions::new(design),
            decisions: Decisions::new(timing),
            readout: Readout::new(timing.word_pixels),
            decided: None,
            now: 0,
            closed: 0,
            output: RasterOutput::fresh(index(timing.word_pixels)),
        }
    }

    /// One rising edge; returns what every output shows after it.
    ///
    /// # Panics
    /// When there are not as many pixels as `pixel_i` has.
    pub fn step(&mut self, input: &RasterInput<'_>) -> &RasterOutput {
        let word = index(self.timing.word_pixels);
        assert_eq!(input.pixels.len(), word, "a word has K pixels");
        if input.reset {
            self.reset();
            return &self.output;
        }
        self.now += 1;
        self.closed = self.closed.saturating_sub(1);
        self.advance(input);
        self.read(input.forward_ready);
        self.decided = self.decisions.step(self.now);
        if let Some(judged) = &self.decided {
            self.regions.decide(judged);
        }
        self.show();
        &self.output
    }

    /// What the outputs show.
    #[must_use]
    pub fn output(&self) -> &RasterOutput {
        &self.output
    }

    /// What the next frame of a region will be compared with: scored pixels, row by row; `None` where there
    /// is no valid reference. With `last-sent` it is known when nothing is [pending](Self::is_pending).
    ///
    /// # Panics
    /// When the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<&[u16]> {
        self.regions.reference(region)
    }

    /// Whether a region is not yet decided though its last word has come to the tail, or has pixels that have
    /// not left.
    #[must_use]
    pub fn is_pending(&self) -> bool {
        let is_active = self.decided.as_ref().is_some_and(|judged| judged.verdict.active());
        is_active || self.is_deciding() || !self.readout.is_empty()
    }

    /// Whether a region is not yet decided though its last word has come to the tail.
    #[must_use]
    pub fn is_deciding(&self) -> bool {
        !self.decisions.is_empty()
    }

    fn reset(&mut self) {
        self.advances.forget();
        self.staleness.forget();
        self.regions.forget();
        self.decisions.forget();
        self.readout = Readout::new(self.timing.word_pixels);
        self.decided = None;
        (self.now, self.closed) = (0, 0);
        self.output = RasterOutput::fresh(index(self.timing.word_pixels));
    }

    fn advance(&mut self, input: &RasterInput<'_>) {
        let takes = input.valid && self.output.ready;
        let Some(advance) = self.advances.step(takes) else { return };
        if let Some(place) = advance.word {
            self.picture.write(place, input.pixels);
        }
        if advance.is_last_taken {
            self.closed = self.timing.edges_to_ready();
        }
        if let Some(place) = advance.tail {
            self.tail(place, input.thresholds);
        }
    }

    /// A word comes to the tail: the first of a row of regions, the last of a region, or any other.
    fn tail(&mut self, place: Place, applied: &Thresholds) {
        let (row, last_row) = (place.row % self.side, self.side - 1);
        if row == 0 && place.column == 0 {
            self.staleness.begin_row(self.now);
        }
        let wide = self.timing.region_row_words;
        if row == last_row && place.column % wide == wide - 1 {
            let region = place.row / self.side * self.columns + place.column / wide;
            let thresholds = self.constants.as_ref().unwrap_or(applied);
            let (row, padded) = (self.staleness.row(), self.picture.padded());
            let judged = self.regions.judge(region, row, padded, thresholds);
            self.decisions.push(self.now, judged);
        }
    }

    /// An edge of the readout. The decision that was on the ports before it stands there no more.
    fn read(&mut self, sink_takes: bool) {
        if let Some(judged) = self.decided.take()
            && judged.verdict.active()
        {
            self.readout.enter(self.now, judged);
        }
        let fresh = self.staleness.step(self.now);
        let read = self.readout.step(self.now, sink_takes, fresh);
        if read.has_fetched
            && let Some(word) = self.readout.fetched()
        {
            self.regions.send(word);
        }
        if let Some(region) = read.lost {
            self.regions.lose(region);
        }
    }

    fn show(&mut self) {
        let waits = self.timing.waits_for_pending && self.advances.is_between_frames();
        self.output.ready =
            self.closed == 0 && self.advances.takes_next() && !(waits && self.is_pending());
        self.output.show_decision(self.decided.as_ref());
        self.output.show_word(self.readout.shown());
        self.output.show_lost(self.readout.lost());
    }
}
