// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state that the array keeps of every region from frame to frame, and its decisions.

use foveate_design::{Action, Camera, Reference, SerialDesign};

use super::schedule::Leaving;
use crate::number::index;
use crate::periphery::{Summary, last_of_block, no_summaries};
use crate::verdict::Verdict;
use crate::{RegionScorer, Thresholds};

/// The state of all regions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Regions {
    camera: Camera,
    scorer: RegionScorer,
    /// Number of pixels of a region, n.
    pixels: usize,
    /// The scored pixels of the last frame, region by region.
    scored: Vec<u16>,
    /// The scored pixels of the frame in which each region was last active. Empty unless the
    /// reference is `last-sent`.
    sent: Vec<u16>,
    /// True for every region with a valid reference.
    referenced: Vec<bool>,
    /// The summary that each region has sent last.
    summaries: Vec<Summary>,
    judged: Vec<Judged>,
}

/// The scores, the decision and the values to send of a region in the last frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) action: Action,
    /// The pixels that the region forwards, in row-major order.
    payload: Vec<u16>,
    /// The means of the blocks of the region. They are empty if irrelevant regions send none.
    means: Vec<u16>,
}

impl Judged {
    /// Makes the state before the first frame.
    fn nothing() -> Self {
        let (payload, means) = (Vec::new(), Vec::new());
        Self { verdict: Verdict::default(), action: Action::Hold, payload, means }
    }
}

impl Regions {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let (regions, pixels) = (index(design.regions()), index(design.region_pixels()));
        let sent = match design.temporal().reference {
            Reference::Previous => Vec::new(),
            Reference::LastSent => vec![0; regions * pixels],
        };
        Self {
            scorer: RegionScorer::new(&design),
            pixels,
            scored: vec![0; regions * pixels],
            sent,
            referenced: vec![false; regions],
            summaries: no_summaries(&design),
            judged: vec![Judged::nothing(); regions],
            camera: design.camera().clone(),
        }
    }

    /// Resets the state: the next frame is the first. Pixels stay, and are never seen.
    pub(super) fn forget(&mut self) {
        self.referenced.fill(false);
        self.summaries = no_summaries(&self.camera);
    }

    /// Returns the reference of a region for the next frame.
    pub(super) fn reference(&self, region: usize) -> Option<&[u16]> {
        let from = match self.camera.temporal().reference {
            Reference::Previous => &self.scored,
            Reference::LastSent => &self.sent,
        };
        self.referenced[region].then(|| &from[region * self.pixels..][..self.pixels])
    }

    /// Returns the means of a region that the screen shows, or `None` if it shows no summary.
    pub(super) fn summary(&self, region: usize) -> Option<&[u16]> {
        self.summaries[region].shown()
    }

    /// Returns the decision for a region in the last frame.
    pub(super) fn judged(&self, region: usize) -> &Judged {
        &self.judged[region]
    }

    /// Returns pixel or mean `number` of the last frame of a region with its position, or `None` if
    /// the region does not send it.
    pub(super) fn leaving(&self, region: u32, what: Leaving, number: u32) -> Option<(u32, u16)> {
        let Judged { action, payload, means, .. } = &self.judged[index(region)];
        match (what, action) {
            (Leaving::Pixel, Action::Forward) => Some((number, payload[index(number)])),
            (Leaving::Mean, Action::Summarize) => {
                let position = last_of_block(self.camera.periphery()?, number);
                Some((position, means[index(number)]))
            }
            (Leaving::Pixel, Action::Hold | Action::Blank | Action::Summarize)
            | (Leaving::Mean, Action::Hold | Action::Blank | Action::Forward) => None,
        }
    }

    /// Scores and decides the next frame of a region, and updates its reference and its summary.
    pub(super) fn judge(
        &mut self,
        region: usize,
        stream: impl Iterator<Item = u16>,
        border: u8,
        thresholds: &Thresholds,
    ) {
        self.scorer.take(stream, border);
        let verdict = Verdict::of(&self.camera, &self.scorer, self.reference(region), thresholds);
        let means = self.scorer.means();
        let (irrelevant, level) = (self.camera.irrelevant(), thresholds.summary_level);
        let summary = &mut self.summaries[region];
        let action = summary.decide(irrelevant, verdict.srs, verdict.trs, &means, level);
        let payload = self.scorer.payload().collect();
        self.judged[region] = Judged { verdict, action, payload, means };
        let own = region * self.pixels..(region + 1) * self.pixels;
        for (scored, pixel) in self.scored[own.clone()].iter_mut().zip(self.scorer.pixels()) {
            *scored = pixel;
        }
        match (self.camera.temporal().reference, action) {
            (Reference::Previous, _) => self.referenced[region] = true,
            (Reference::LastSent, Action::Forward) => {
                self.referenced[region] = true;
                self.sent[own.clone()].copy_from_slice(&self.scored[own]);
            }
            (Reference::LastSent, Action::Hold) => {}
            // The screen no longer shows the pixels that were sent.
            (Reference::LastSent, Action::Blank | Action::Summarize) => {
                self.referenced[region] = false;
            }
        }
    }
}
