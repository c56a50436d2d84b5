// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core ([`RasterRcm`]): the effect of an edge on each of its parts, and the outputs after
//! it. It keeps the state of every region from frame to frame, by which it decides
//! ([`RasterRegions`]).

use super::advances::{AdvanceCounter, IncomingFrame, WordPosition};
use super::decisions::{
    CompletedRegion, DecidedRasterRegion, DecisionQueue, RowStaleness, ScoredRasterRegion,
};
use super::external_store::ExternalStorePorts;
use super::ports::RasterOutput;
use super::readout::{DepartingRegion, ForwardWord, Readout};
use crate::class_memory::ClassMemory;
use crate::conversions::index;
use crate::cycle_model::{CoreInput, CycleModel};
use crate::periphery::{ShownSummary, no_summaries};
use crate::region_decision::RegionDecision;
use crate::thresholds::{ClassThresholdInputs, ThresholdConstants};
use crate::{FrameSync, RegionScorer, region_border, region_pixels, region_stream};
use foveate_camera::{Camera, FeatureKind, ReferencePolicy, RegionAction};
use foveate_design::{PortRole, RasterDesign, RasterTiming};
use foveate_pixels::Frame;

/// The cycle-level model of a raster core. A new one is in the state after a reset.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterRcm {
    feature_kinds: Vec<FeatureKind>,
    timing: RasterTiming,
    /// Number of regions in a row of regions.
    columns: u32,
    /// Side of a region N in pixels.
    side: u32,
    /// The thresholds, if they are constants of the core.
    constants: Option<ThresholdConstants>,
    sync: FrameSync,
    /// The memory of classes, if the core has zones.
    classes: Option<ClassMemory>,
    advances: AdvanceCounter,
    incoming_frame: IncomingFrame,
    staleness: RowStaleness,
    regions: RasterRegions,
    /// The streams of an external frame store, if the core has one.
    external_store: Option<ExternalStorePorts>,
    decisions: DecisionQueue,
    readout: Readout,
    /// The region whose decision is on the ports.
    decided: Option<DecidedRasterRegion>,
    /// Number of edges since reset.
    now: u64,
    /// Number of clocks after T0 until `ready_o` may be 1 again.
    clocks_to_ready: u64,
    /// True if a word would be taken at the next edge, from the stream or from the core's own
    /// completion of a frame.
    is_open: bool,
    output: RasterOutput,
}

impl RasterRcm {
    /// Makes the core of the design.
    #[must_use]
    pub fn new(design: RasterDesign<'_>) -> Self {
        let timing = RasterTiming::from_design(design);
        Self {
            feature_kinds: design.feature_kinds(),
            timing,
            columns: design.columns(),
            side: design.region_size(),
            constants: ThresholdConstants::of_design(&design),
            sync: FrameSync::new(&design),
            classes: ClassMemory::of_design(&design),
            advances: AdvanceCounter::new(timing),
            incoming_frame: IncomingFrame::new(design),
            staleness: RowStaleness::new(&timing),
            regions: RasterRegions::new(design),
            external_store: design.has_external_store().then(|| ExternalStorePorts::new(design)),
            decisions: DecisionQueue::new(timing),
            readout: Readout::new(&timing),
            decided: None,
            now: 0,
            clocks_to_ready: 0,
            is_open: true,
            output: RasterOutput::after_reset(index(timing.word_pixels)),
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
        self.clocks_to_ready = self.clocks_to_ready.saturating_sub(1);
        self.take_reference(input);
        let has_advanced = self.advance(input);
        self.step_classes(input, has_advanced);
        self.step_readout(input.forward_ready);
        let scored_region = self.decisions.step(self.now);
        self.decided = scored_region.map(|scored_region| self.regions.decide(scored_region));
        self.step_store();
        self.update_output();
        &self.output
    }

    /// Returns the outputs after the last edge.
    #[must_use]
    pub fn output(&self) -> &RasterOutput {
        &self.output
    }

    /// Returns the reference of a region for the next frame: scored pixels in row-major order, or
    /// `None` if there is no valid reference. With `last-sent` the reference is known when nothing
    /// is [pending](Self::is_pending). With an external frame store the reference is the pixels
    /// that the core has stored, even if the memory returns others.
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
        self.decided.as_ref().is_some_and(|decided| self.has_words_to_send(decided))
            || self.is_deciding()
            || !self.readout.is_empty()
    }

    /// Returns true if a region that has sent some of its words is lost at the next edge, unless
    /// that edge has a reset. A test driver uses it to choose whether the sink is ready at that
    /// edge.
    #[must_use]
    pub fn will_abort(&self) -> bool {
        self.readout.has_partial_region_below(self.staleness.first_fresh_row_at(self.now + 1))
    }

    /// Returns true if the last word of a region has come to the tail and the region is not decided
    /// yet.
    #[must_use]
    pub fn is_deciding(&self) -> bool {
        !self.decisions.is_empty()
            || self.external_store.as_ref().is_some_and(ExternalStorePorts::has_waiting_region)
    }

    /// Returns true if the region sends pixels or means.
    fn has_words_to_send(&self, decided: &DecidedRasterRegion) -> bool {
        self.timing.words_sent(decided.action).is_some()
    }

    fn reset(&mut self) {
        self.sync.reset();
        if let Some(classes) = &mut self.classes {
            classes.reset();
        }
        self.advances.reset();
        self.staleness.reset();
        self.regions.reset();
        if let Some(external_store) = &mut self.external_store {
            external_store.reset();
        }
        self.decisions.reset();
        self.readout = Readout::new(&self.timing);
        self.decided = None;
        (self.now, self.clocks_to_ready, self.is_open) = (0, 0, true);
        self.output = RasterOutput::after_reset(index(self.timing.word_pixels));
    }

    /// Applies an edge to the position in the frame. Returns true if the core advances.
    fn advance(&mut self, input: &CoreInput<'_>) -> bool {
        let takes = self.sync.step(input.valid, input.sof, self.is_open);
        let Some(advance) = self.advances.step(takes) else { return false };
        if let Some(place) = advance.word {
            self.incoming_frame.write(place, input.pixels);
        }
        if advance.is_last_taken {
            self.clocks_to_ready = self.timing.edges_to_ready();
        }
        if let Some(place) = advance.tail {
            self.take_word_in_tail(place, ClassThresholdInputs::new(input.thresholds, input.zones));
        }
        true
    }

    /// Applies an edge to the memory of classes. A frame occupies the edges from its first advance
    /// up to its last one.
    fn step_classes(&mut self, input: &CoreInput<'_>, has_advanced: bool) {
        let is_occupied = has_advanced || !self.advances.is_between_frames();
        if let Some(classes) = &mut self.classes {
            classes.step(input.class_map(), is_occupied);
        }
    }

    /// Processes a word that comes to the tail, which may be the first of a row of regions or the
    /// last of a region.
    fn take_word_in_tail(&mut self, place: WordPosition, applied: ClassThresholdInputs<'_>) {
        if place.column == 0 && place.row.is_multiple_of(self.side) {
            self.staleness.begin_row(self.now);
        }
        let completed = self.completed_region(place);
        match (&mut self.external_store, completed) {
            (Some(external_store), _) => {
                external_store.push_word(self.now, place, completed, self.incoming_frame.padded());
            }
            (None, Some(completed)) => self.score_region(completed, applied),
            (None, None) => {}
        }
    }

    /// Returns the region whose last word is at this position, or `None`.
    fn completed_region(&self, place: WordPosition) -> Option<CompletedRegion> {
        let region_words = self.timing.region_row_words;
        let is_last = (place.column + 1).is_multiple_of(region_words)
            && (place.row + 1).is_multiple_of(self.side);
        let region = place.row / self.side * self.columns + place.column / region_words;
        is_last.then(|| CompletedRegion {
            region,
            row: self.staleness.current_row(),
            completion_edge: self.now,
            class: self.classes.as_ref().map(|classes| classes.class(region)).unwrap_or_default(),
        })
    }

    /// Applies an edge of the stream of references.
    fn take_reference(&mut self, input: &CoreInput<'_>) {
        let Some(external_store) = &mut self.external_store else { return };
        let pixels = input.reference_pixels;
        assert_eq!(pixels.len(), index(self.timing.word_pixels), "a word has K pixels");
        if let Some(completed) =
            external_store.take_reference(self.now, input.reference_valid, pixels)
        {
            self.score_region(completed, ClassThresholdInputs::new(input.thresholds, input.zones));
        }
    }

    /// Scores a region, all of whose references are known.
    fn score_region(&mut self, completed: CompletedRegion, applied: ClassThresholdInputs<'_>) {
        let thresholds = self.constants.as_ref().map_or(applied, ThresholdConstants::by_class);
        let taken = self.external_store.as_ref().map(ExternalStorePorts::references);
        let padded = self.incoming_frame.padded();
        let scored = self.regions.score_region(completed, padded, taken, thresholds);
        self.decisions.push(completed.completion_edge, scored);
    }

    /// Applies an edge of the stream of words to store.
    fn step_store(&mut self) {
        if let Some(external_store) = &mut self.external_store {
            let word = external_store.take_store_word(self.now);
            self.output.set_store_ports(word.as_ref());
            self.output.reference_ready = external_store.is_reference_due_after(self.now);
            self.output.underrun = external_store.has_underrun();
        }
    }

    /// Applies an edge of the readout, which stays empty in a core without forwarding. The decision
    /// that was on the ports before the edge is removed.
    fn step_readout(&mut self, sink_takes: bool) {
        if let Some(decided) = self.decided.take()
            && let Some(departing) = self.regions.departing_region(decided, &self.timing)
        {
            self.readout.enqueue(self.now, departing);
        }
        let fresh = self.staleness.step(self.now);
        let read = self.readout.step(self.now, sink_takes, fresh);
        if read.has_fetched
            && let Some(word) = self.readout.fetched_word()
        {
            self.regions.record_sent_word(word);
        }
        if let Some(loss) = read.lost {
            self.regions.record_loss(loss.region);
        }
        self.output.set_loss_ports(read.lost);
    }

    fn update_output(&mut self) {
        let waits = self.timing.waits_for_pending && self.advances.is_between_frames();
        self.is_open = self.clocks_to_ready == 0
            && self.advances.takes_next()
            && !(waits && self.is_pending());
        self.output.ready = self.is_open && !self.sync.is_filling();
        self.output.sync_error = self.sync.is_error();
        self.output.zone_pending = self.classes.as_ref().is_some_and(ClassMemory::is_pending);
        self.output.set_decision_ports(self.decided.as_ref());
        self.output.set_forward_ports(self.readout.shown_word());
        self.output.set_lost_count(self.readout.lost_count());
    }
}

impl CycleModel for RasterRcm {
    fn clock(&mut self, input: &CoreInput<'_>) {
        self.step(input);
    }

    fn append_output(&self, role: PortRole, values: &mut Vec<u64>) {
        self.output.append_port(role, &self.feature_kinds, values);
    }

    fn is_ready(&self) -> bool {
        self.output.ready
    }

    fn is_pending(&self) -> bool {
        self.is_pending()
    }

    fn requires_stable_thresholds(&self) -> bool {
        self.timing.second_pass.is_some() && self.is_deciding()
    }

    fn will_abort(&self) -> bool {
        self.will_abort()
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

/// The references and the summaries of all regions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RasterRegions {
    camera: Camera,
    scorer: RegionScorer,
    /// Number of pixels of a region, n.
    pixels: usize,
    references: Vec<u16>,
    /// True for every region with a valid reference.
    has_reference: Vec<bool>,
    /// The summary that each region has sent last.
    summaries: Vec<ShownSummary>,
}

impl RasterRegions {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        let (regions, pixels) = (index(design.regions()), index(design.region_pixels()));
        Self {
            scorer: RegionScorer::new(&design),
            pixels,
            references: vec![0; regions * pixels],
            has_reference: vec![false; regions],
            summaries: no_summaries(&design),
            camera: design.camera().clone(),
        }
    }

    /// Resets the state: the next frame is the first. Pixels stay, and are never seen.
    pub(super) fn reset(&mut self) {
        self.has_reference.fill(false);
        self.summaries = no_summaries(&self.camera);
    }

    /// Returns the reference of a region for the next frame.
    pub(super) fn reference(&self, region: u32) -> Option<&[u16]> {
        let region = index(region);
        self.has_reference[region].then(|| &self.references[region * self.pixels..][..self.pixels])
    }

    /// Returns the means of a region that the screen shows, or `None` if it shows no summary.
    pub(super) fn summary(&self, region: u32) -> Option<&[u16]> {
        self.summaries[index(region)].shown()
    }

    /// Scores a region of a frame. With an external frame store the reference is that of `taken`,
    /// whatever its pixels are.
    pub(super) fn score_region(
        &mut self,
        CompletedRegion { region, row, class, .. }: CompletedRegion,
        padded: &Frame,
        taken: Option<&Frame>,
        thresholds: ClassThresholdInputs<'_>,
    ) -> Box<ScoredRasterRegion> {
        let mut stream = Vec::new();
        region_stream(&self.camera, padded, region, &mut stream);
        self.scorer.load(stream.into_iter(), region_border(&self.camera, region));
        let taken = taken.map(|frame| self.region_pixels_of(frame, region));
        let reference = self.reference(region).map(|own| taken.as_deref().unwrap_or(own));
        let rules = (class, thresholds);
        let decision = RegionDecision::from_scorer(&self.camera, &self.scorer, reference, rules);
        let scored = self.scorer.pixel_rows().concat();
        match self.camera.temporal().reference {
            ReferencePolicy::Previous => {
                self.write_reference(region, 0, &scored);
                self.has_reference[index(region)] = true;
            }
            ReferencePolicy::LastSent => {}
        }
        let payload = self.scorer.payload_rows().concat();
        let frame = row / u64::from(self.camera.rows());
        let (means, summary_level) = (self.scorer.means(), thresholds.summary_level(class));
        Box::new(ScoredRasterRegion {
            region,
            row,
            frame,
            decision,
            scored,
            payload,
            means,
            summary_level,
        })
    }

    /// Decides a region: returns its action, and updates its reference and its summary.
    pub(super) fn decide(&mut self, scored_region: Box<ScoredRasterRegion>) -> DecidedRasterRegion {
        let summary = &mut self.summaries[index(scored_region.region)];
        let ScoredRasterRegion { decision, means, summary_level, .. } = &*scored_region;
        let (irrelevant, level) = (self.camera.irrelevant(), *summary_level);
        let action = summary.decide(irrelevant, decision.srs, decision.trs, means, level);
        let referenced = &mut self.has_reference[index(scored_region.region)];
        match (self.camera.temporal().reference, action) {
            (ReferencePolicy::Previous, _) | (ReferencePolicy::LastSent, RegionAction::Hold) => {}
            (ReferencePolicy::LastSent, RegionAction::Forward) => *referenced = true,
            // The screen no longer shows the pixels that were sent.
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                *referenced = false;
            }
        }
        DecidedRasterRegion { scored_region, action }
    }

    /// Returns the region that leaves of a region that was decided, or `None` if it sends nothing.
    pub(super) fn departing_region(
        &self,
        decided: DecidedRasterRegion,
        timing: &RasterTiming,
    ) -> Option<DepartingRegion> {
        DepartingRegion::from_decided(decided, &self.camera, timing)
    }

    /// Records a word that was fetched and will leave. The hardware writes it to the reference an
    /// edge later. That difference cannot be observed, because the next frame of the region comes
    /// later still.
    pub(super) fn record_sent_word(&mut self, word: &ForwardWord) {
        match self.camera.temporal().reference {
            ReferencePolicy::Previous => {}
            ReferencePolicy::LastSent => {
                self.write_reference(word.region, word.position, word.scored.as_slice());
            }
        }
    }

    /// Records a region that was lost. It is not known how much of it was sent.
    pub(super) fn record_loss(&mut self, region: u32) {
        self.summaries[index(region)].forget();
        match self.camera.temporal().reference {
            ReferencePolicy::Previous => {}
            ReferencePolicy::LastSent => self.has_reference[index(region)] = false,
        }
    }

    /// Returns the pixels of a region of a padded frame, in row-major order.
    fn region_pixels_of(&self, padded: &Frame, region: u32) -> Vec<u16> {
        let mut pixels = Vec::with_capacity(self.pixels);
        region_pixels(&self.camera, padded, region, &mut pixels);
        pixels
    }

    fn write_reference(&mut self, region: u32, position: u32, pixels: &[u16]) {
        let from = index(region) * self.pixels + index(position);
        self.references[from..from + pixels.len()].copy_from_slice(pixels);
    }
}
