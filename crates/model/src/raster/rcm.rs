// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core: the effect of an edge on each of its parts, and the outputs after it.

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

/// The cycle-level model of a raster core. A new one is in the state after a reset.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterRcm {
    kinds: Vec<FeatureKind>,
    timing: RasterTiming,
    /// Number of regions in a row of regions.
    columns: u32,
    /// Side of a region N in pixels.
    side: u32,
    /// The thresholds, if they are constants of the core.
    constants: Option<Thresholds>,
    sync: FrameSync,
    advances: Advances,
    picture: IncomingFrame,
    staleness: Staleness,
    regions: Regions,
    /// The streams of an external frame store, if the core has one.
    outside: Option<Outside>,
    decisions: Decisions,
    readout: Readout,
    /// The region whose decision is on the ports.
    decided: Option<Decided>,
    /// Number of edges since reset.
    now: u64,
    /// Number of clocks after T0 until `ready_o` may be 1 again.
    closed: u64,
    /// True if a word would be taken at the next edge, from the stream or from the core's own
    /// completion of a frame.
    is_open: bool,
    output: RasterOutput,
}

impl RasterRcm {
    /// Makes the core of the design.
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

    /// Applies one rising edge, and returns every output after it.
    ///
    /// # Panics
    /// Panics if there are not as many pixels as `pixel_i` has, or as `reference_pixel_i` has in a
    /// core with that port.
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

    /// Returns the outputs after the last edge.
    #[must_use]
    pub fn output(&self) -> &RasterOutput {
        &self.output
    }

    /// Returns the reference of a region for the next frame: scored pixels in row-major order, or
    /// `None` if there is no valid reference. With `last-sent` it is known when nothing is
    /// [pending](Self::is_pending). With an external frame store it is what the core has stored.
    ///
    /// # Panics
    /// Panics if the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<&[u16]> {
        self.regions.reference(region)
    }

    /// Returns the means of a region that the screen shows, block by block, or `None` if it shows
    /// no summary. They are known when nothing is [pending](Self::is_pending).
    ///
    /// # Panics
    /// Panics if the design has no such region.
    #[must_use]
    pub fn summary(&self, region: u32) -> Option<&[u16]> {
        self.regions.summary(region)
    }

    /// Returns true if the last word of a region has come to the tail and the region is not decided
    /// yet, or if it has words that have not left.
    #[must_use]
    pub fn is_pending(&self) -> bool {
        self.decided.as_ref().is_some_and(|decided| self.leaves(decided))
            || self.is_deciding()
            || !self.readout.is_empty()
    }

    /// Returns true if a region is lost in the middle at the next edge, unless that edge has a
    /// reset. A test driver uses it to choose whether the sink is ready at that edge.
    #[must_use]
    pub fn aborts_next(&self) -> bool {
        self.readout.has_begun_below(self.staleness.fresh_at(self.now + 1))
    }

    /// Returns true if the last word of a region has come to the tail and the region is not decided
    /// yet.
    #[must_use]
    pub fn is_deciding(&self) -> bool {
        !self.decisions.is_empty() || self.outside.as_ref().is_some_and(Outside::is_asking)
    }

    /// Returns true if the region sends pixels or means.
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

    /// Processes a word that comes to the tail, which may be the first of a row of regions or the
    /// last of a region.
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

    /// Returns the region whose last word is at this position, or `None`.
    fn complete(&self, place: Place) -> Option<Complete> {
        let wide = self.timing.region_row_words;
        let is_last = place.row % self.side == self.side - 1 && place.column % wide == wide - 1;
        is_last.then(|| Complete {
            region: place.row / self.side * self.columns + place.column / wide,
            row: self.staleness.row(),
            came: self.now,
        })
    }

    /// Applies an edge of the stream of references.
    fn take_reference(&mut self, input: &CoreInput<'_>) {
        let Some(outside) = &mut self.outside else { return };
        let pixels = input.reference_pixels;
        assert_eq!(pixels.len(), index(self.timing.word_pixels), "a word has K pixels");
        if let Some(complete) = outside.take(self.now, input.reference_valid, pixels) {
            self.judge(complete, input.thresholds);
        }
    }

    /// Scores a region, all of whose references are known.
    fn judge(&mut self, complete: Complete, applied: &Thresholds) {
        let thresholds = self.constants.as_ref().unwrap_or(applied);
        let taken = self.outside.as_ref().map(Outside::references);
        let padded = self.picture.padded();
        let judged = self.regions.judge(complete, padded, taken, thresholds);
        self.decisions.push(complete.came, judged);
    }

    /// Applies an edge of the stream of words to store.
    fn store(&mut self) {
        if let Some(outside) = &mut self.outside {
            let word = outside.store(self.now);
            self.output.show_stored(word.as_ref());
            self.output.reference_ready = outside.asks_after(self.now);
            self.output.underrun = outside.underrun();
        }
    }

    /// Applies an edge of the readout, which stays empty in a core without forwarding. The decision
    /// that was on the ports before the edge is removed.
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
