// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state that the core keeps of every region from frame to frame, and its decisions.

use foveate_design::{Action, Camera, RasterDesign, Reference};
use foveate_frame::Frame;

use super::decisions::{Complete, Decided, Judged};
use super::word::{Departing, Word};
use crate::number::index;
use crate::periphery::{Summary, no_summaries};
use crate::verdict::Verdict;
use crate::{RegionScorer, Thresholds, region_border, region_pixels, region_stream};

/// The references and the summaries of all regions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Regions {
    camera: Camera,
    scorer: RegionScorer,
    /// Number of pixels of a region, n.
    pixels: usize,
    /// Number of pixels of a word, K.
    word_pixels: u32,
    /// The references, region by region.
    references: Vec<u16>,
    /// True for every region with a valid reference.
    referenced: Vec<bool>,
    /// The summary that each region has sent last.
    summaries: Vec<Summary>,
}

impl Regions {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        let (regions, pixels) = (index(design.regions()), index(design.region_pixels()));
        Self {
            scorer: RegionScorer::new(&design),
            pixels,
            word_pixels: design.pixels_per_clock(),
            references: vec![0; regions * pixels],
            referenced: vec![false; regions],
            summaries: no_summaries(&design),
            camera: design.camera().clone(),
        }
    }

    /// Resets the state: the next frame is the first. Pixels stay, and are never seen.
    pub(super) fn forget(&mut self) {
        self.referenced.fill(false);
        self.summaries = no_summaries(&self.camera);
    }

    /// Returns the reference of a region for the next frame.
    pub(super) fn reference(&self, region: u32) -> Option<&[u16]> {
        let region = index(region);
        self.referenced[region].then(|| &self.references[region * self.pixels..][..self.pixels])
    }

    /// Returns the means of a region that the screen shows, or `None` if it shows no summary.
    pub(super) fn summary(&self, region: u32) -> Option<&[u16]> {
        self.summaries[index(region)].shown()
    }

    /// Scores a region of a frame. With an external frame store the reference is that of `taken`,
    /// whatever its pixels are.
    pub(super) fn judge(
        &mut self,
        Complete { region, row, .. }: Complete,
        padded: &Frame,
        taken: Option<&Frame>,
        thresholds: &Thresholds,
    ) -> Judged {
        let mut stream = Vec::new();
        region_stream(&self.camera, padded, region, &mut stream);
        self.scorer.take(stream.into_iter(), region_border(&self.camera, region));
        let taken = taken.map(|frame| self.pixels_of(frame, region));
        let reference = self.reference(region).map(|own| taken.as_deref().unwrap_or(own));
        let verdict = Verdict::of(&self.camera, &self.scorer, reference, thresholds);
        let scored: Vec<u16> = self.scorer.pixels().collect();
        match self.camera.temporal().reference {
            Reference::Previous => {
                self.remember(region, 0, &scored);
                self.referenced[index(region)] = true;
            }
            Reference::LastSent => {}
        }
        let payload: Vec<u16> = self.scorer.payload().collect();
        let frame = row / u64::from(self.camera.rows());
        let (means, summary_level) = (self.scorer.means(), thresholds.summary_level);
        Judged { region, row, frame, verdict, scored, payload, means, summary_level }
    }

    /// Decides a region: returns its action, and updates its reference and its summary.
    pub(super) fn decide(&mut self, judged: Judged) -> Decided {
        let summary = &mut self.summaries[index(judged.region)];
        let Judged { verdict, means, summary_level, .. } = &judged;
        let (irrelevant, level) = (self.camera.irrelevant(), *summary_level);
        let action = summary.decide(irrelevant, verdict.srs, verdict.trs, means, level);
        let referenced = &mut self.referenced[index(judged.region)];
        match (self.camera.temporal().reference, action) {
            (Reference::Previous, _) | (Reference::LastSent, Action::Hold) => {}
            (Reference::LastSent, Action::Forward) => *referenced = true,
            // The screen no longer shows the pixels that were sent.
            (Reference::LastSent, Action::Blank | Action::Summarize) => *referenced = false,
        }
        Decided { judged, action }
    }

    /// Returns the words that leave of a region that was decided.
    pub(super) fn departing(&self, decided: &Decided) -> Departing {
        Departing::of(decided, &self.camera, self.word_pixels)
    }

    /// Records a word that was fetched and will leave. The hardware writes it to the reference an
    /// edge later. That difference cannot be observed, because the next frame of the region comes
    /// later still.
    pub(super) fn send(&mut self, word: &Word) {
        match self.camera.temporal().reference {
            Reference::Previous => {}
            Reference::LastSent => self.remember(word.region, word.position, &word.scored),
        }
    }

    /// Records a region that was lost. It is not known how much of it was sent.
    pub(super) fn lose(&mut self, region: u32) {
        self.summaries[index(region)].forget();
        match self.camera.temporal().reference {
            Reference::Previous => {}
            Reference::LastSent => self.referenced[index(region)] = false,
        }
    }

    /// Returns the pixels of a region of a padded frame, in row-major order.
    fn pixels_of(&self, padded: &Frame, region: u32) -> Vec<u16> {
        let mut pixels = Vec::with_capacity(self.pixels);
        region_pixels(&self.camera, padded, region, &mut pixels);
        pixels
    }

    fn remember(&mut self, region: u32, position: u32, pixels: &[u16]) {
        let from = index(region) * self.pixels + index(position);
        self.references[from..from + pixels.len()].copy_from_slice(pixels);
    }
}
