// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state that the core keeps of every region from frame to frame, and its decisions.

use foveate_camera::{Camera, ReferencePolicy, RegionAction};
use foveate_design::{RasterDesign, RasterTiming};
use foveate_pixels::Frame;

use super::decisions::{CompletedRegion, DecidedRasterRegion, ScoredRasterRegion};
use super::forward_word::{DepartingRegion, ForwardWord};
use crate::conversions::index;
use crate::periphery::{ShownSummary, no_summaries};
use crate::region_decision::RegionDecision;
use crate::thresholds::ClassThresholdInputs;
use crate::{RegionScorer, region_border, region_pixels, region_stream};

/// The references and the summaries of all regions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RasterRegions {
    camera: Camera,
    scorer: RegionScorer,
    /// Number of pixels of a region, n.
    pixels: usize,
    /// The references, region by region.
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
