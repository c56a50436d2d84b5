// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core: what an edge does to each of its parts, and what its outputs show after it.

use foveate_design::{FeatureKind, PortRole, RasterDesign, RasterTiming};

use super::advances::{Advances, Place};
use super::decisions::{Complete, Decided, Decisions};
use super::outside::Outside;
use super::picture::IncomingFrame;
use super::ports::RasterOutput;
use super::readout::Readout;
use super::regions::Regions;
use super::staleness::Staleness;
use crate::cycle::{CoreInput, CycleModel};
use crate::number::index;
use crate::{FrameSync, Thresholds};

/// The cycle-level model of a raster core, as after a reset when new.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterRcm {
    kinds: Vec<FeatureKind>,
    timing: RasterTiming,
    /// Regions side by side.
    columns: u32,
    /// Side of a region N.
    side: u32,
    /// The thresholds, where they are constants of the core.
    constants: Option<Thresholds>,
    sync: FrameSync,
    advances: Advances,
    picture: IncomingFrame,
    staleness: Staleness,
    regions: Regions,
    /// The streams of a frame store outside, where it is there.
    outside: Option<Outside>,
    decisions: Decisions,
    readout: Readout,
    /// The region whose decision is on the ports.
    decided: Option<Decided>,
    /// Edges since reset.
    now: u64,
    /// Clocks until `ready_o` may be 1 again after T0.
    closed: u64,
    /// Whether a word would be taken at the next edge, from outside or not.
    is_open: bool,
    output: RasterOutput,
}

impl RasterRcm {
    /// The core of the design.
    #[must_use]
    pub fn new(design: RasterDesign<'_>) -> Self {
        let timing = RasterTiming::of(design);
        Self {
            kinds: design.kinds(),
            timing,
            columns: design.columns(),
            side: design.region_size(),
            constants: Thresholds::constants(&design),
            sync: FrameSync::new(&design),
            advances: Advances::new(timing),
            picture: IncomingFrame::new(design),
            staleness: Staleness::new(&timing),
            regions: Regions::new(design),
            outside: design.frames_are_kept_outside().then(|| Outside::new(design)),
            decisions: Decisions::new(timing),
            readout: Readout::new(&timing),
            decided: None,
            now: 0,
            closed: 0,
            is_open: true,
            output: RasterOutput::fresh(index(timing.word_pixels)),
        }
    }

    /// One rising edge; returns what every output shows after it.
    ///
    /// # Panics
    /// When there are not as many pixels as `pixel_i` has, or as `reference_pixel_i` where that is a port.
    pub fn step(&mut self, input: &CoreInput<'_>) -> &RasterOutput {
        let word = index(self.timing.word_pixels);
        assert_eq!(input.pixels.len(), word, "a word has K pixels");
        if input.reset {
            self.reset();
            return &self.output;
        }
        self.now += 1;
        self.closed = self.closed.saturating_sub(1);
        self.take_reference(input);
        self.advance(input);
        self.read(input.forward_ready);
        let decided = self.decisions.step(self.now);
        self.decided = decided.map(|judged| self.regions.decide(judged));
        self.store();
        self.show();
        &self.output
    }

    /// What the outputs show.
    #[must_use]
    pub fn output(&self) -> &RasterOutput {
        &self.output
    }

    /// What the next frame of a region will be compared with: scored pixels, row by row; `None` where there
    /// is no valid reference. With `last-sent` it is known when nothing is [pending](Self::is_pending); where
    /// the frame store is outside, it is what that was given to store.
    ///
    /// # Panics
    /// When the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<&[u16]> {
        self.regions.reference(region)
    }

    /// The means that the screen shows of a region, block by block; `None` where it shows no summary. Known when nothing is
    /// [pending](Self::is_pending).
    ///
    /// # Panics
    /// When the design has no such region.
    #[must_use]
    pub fn summary(&self, region: u32) -> Option<&[u16]> {
        self.regions.summary(region)
    }

    /// Whether a region is not yet decided though its last word has come to the tail, or has words that have
    /// not left.
    #[must_use]
    pub fn is_pending(&self) -> bool {
        self.decided.as_ref().is_some_and(|decided| self.leaves(decided))
            || self.is_deciding()
            || !self.readout.is_empty()
    }

    /// Whether a region is lost in the middle at the next edge, unless that is a reset: for a sink that is to be ready
    /// just then, or not.
    #[must_use]
    pub fn aborts_next(&self) -> bool {
        self.readout.has_begun_below(self.staleness.fresh_at(self.now + 1))
    }

    /// Whether a region is not yet decided though its last word has come to the tail.
    #[must_use]
    pub fn is_deciding(&self) -> bool {
        !self.decisions.is_empty() || self.outside.as_ref().is_some_and(Outside::is_asking)
    }

    /// Whether something of a region leaves.
    fn leaves(&self, decided: &Decided) -> bool {
        self.timing.words_sent(decided.action).is_some()
    }

    fn reset(&mut self) {
        self.sync.reset();
        self.advances.forget();
        self.staleness.forget();
        self.regions.forget();
        if let Some(outside) = &mut self.outside {
            outside.forget();
        }
        self.decisions.forget();
        self.readout = Readout::new(&self.timing);
        self.decided = None;
        (self.now, self.closed, self.is_open) = (0, 0, true);
        self.output = RasterOutput::fresh(index(self.timing.word_pixels));
    }

    fn advance(&mut self, input: &CoreInput<'_>) {
        let takes = self.sync.step(input.valid, input.sof, self.is_open);
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
        if place.row.is_multiple_of(self.side) && place.column == 0 {
            self.staleness.begin_row(self.now);
        }
        let complete = self.complete(place);
        match (&mut self.outside, complete) {
            (Some(outside), _) => outside.come(self.now, place, complete, self.picture.padded()),
            (None, Some(complete)) => self.judge(complete, applied),
            (None, None) => {}
        }
    }

    /// The region whose last word is at this place.
    fn complete(&self, place: Place) -> Option<Complete> {
        let wide = self.timing.region_row_words;
        let is_last = place.row % self.side == self.side - 1 && place.column % wide == wide - 1;
        is_last.then(|| Complete {
            region: place.row / self.side * self.columns + place.column / wide,
            row: self.staleness.row(),
            came: self.now,
        })
    }

    /// An edge of the stream from outside.
    fn take_reference(&mut self, input: &CoreInput<'_>) {
        let Some(outside) = &mut self.outside else { return };
        let pixels = input.reference_pixels;
        assert_eq!(pixels.len(), index(self.timing.word_pixels), "a word has K pixels");
        if let Some(complete) = outside.take(self.now, input.reference_valid, pixels) {
            self.judge(complete, input.thresholds);
        }
    }

    /// Judges a region, all of whose references are there.
    fn judge(&mut self, complete: Complete, applied: &Thresholds) {
        let thresholds = self.constants.as_ref().unwrap_or(applied);
        let taken = self.outside.as_ref().map(Outside::references);
        let padded = self.picture.padded();
        let judged = self.regions.judge(complete, padded, taken, thresholds);
        self.decisions.push(complete.came, judged);
    }

    /// An edge of the stream to the outside.
    fn store(&mut self) {
        if let Some(outside) = &mut self.outside {
            let word = outside.store(self.now);
            self.output.show_stored(word.as_ref());
            self.output.reference_ready = outside.asks_after(self.now);
            self.output.underrun = outside.underrun();
        }
    }

    /// An edge of the readout, in which there is never anything where no pixels leave. The decision that was on
    /// the ports before it stands there no more.
    fn read(&mut self, sink_takes: bool) {
        if let Some(decided) = self.decided.take()
            && self.leaves(&decided)
        {
            self.readout.enter(self.now, self.regions.departing(&decided));
        }
        let fresh = self.staleness.step(self.now);
        let read = self.readout.step(self.now, sink_takes, fresh);
        if read.has_fetched
            && let Some(word) = self.readout.fetched()
        {
            self.regions.send(word);
        }
        if let Some(loss) = read.lost {
            self.regions.lose(loss.region);
        }
        self.output.show_loss(read.lost);
    }

    fn show(&mut self) {
        let waits = self.timing.waits_for_pending && self.advances.is_between_frames();
        self.is_open =
            self.closed == 0 && self.advances.takes_next() && !(waits && self.is_pending());
        self.output.ready = self.is_open && !self.sync.is_filling();
        self.output.sync_error = self.sync.is_error();
        self.output.show_decision(self.decided.as_ref());
        self.output.show_word(self.readout.shown());
        self.output.show_lost(self.readout.lost());
    }
}

impl CycleModel for RasterRcm {
    fn clock(&mut self, input: &CoreInput<'_>) {
        self.step(input);
    }

    fn show(&self, role: PortRole, values: &mut Vec<u64>) {
        self.output.show(role, &self.kinds, values);
    }

    fn is_ready(&self) -> bool {
        self.output.ready
    }

    fn is_pending(&self) -> bool {
        self.is_pending()
    }

    fn holds_thresholds(&self) -> bool {
        self.timing.second_pass.is_some() && self.is_deciding()
    }

    fn aborts_next(&self) -> bool {
        self.aborts_next()
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
