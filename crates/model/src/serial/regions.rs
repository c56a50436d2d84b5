// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the array keeps of every region from frame to frame, and what it thinks of it.

use foveate_design::{Action, Camera, Reference, SerialDesign};

use super::schedule::Leaving;
use crate::number::index;
use crate::periphery::{Summary, last_of_block, no_summaries};
use crate::verdict::Verdict;
use crate::{RegionScorer, Thresholds};

/// The state of every region.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Regions {
    camera: Camera,
    scorer: RegionScorer,
    /// Pixels of a region n.
    pixels: usize,
    /// The scored pixels of the last frame, region by region.
    scored: Vec<u16>,
    /// Those of the frame in which the region was last active; empty where that does not matter.
    sent: Vec<u16>,
    /// Which regions have a reference.
    referenced: Vec<bool>,
    /// What each region has sent of itself last.
    summaries: Vec<Summary>,
    judged: Vec<Judged>,
}

/// What is known of a region in the last frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) action: Action,
    /// Its pixels as they leave, row by row.
    payload: Vec<u16>,
    /// The means of its blocks; none where irrelevant regions send none.
    means: Vec<u16>,
}

impl Judged {
    /// Before the first frame.
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

    /// The next frame is the first; pixels stay and are never seen.
    pub(super) fn forget(&mut self) {
        self.referenced.fill(false);
        self.summaries = no_summaries(&self.camera);
    }

    /// What the next frame of a region is compared with.
    pub(super) fn reference(&self, region: usize) -> Option<&[u16]> {
        let from = match self.camera.temporal().reference {
            Reference::Previous => &self.scored,
            Reference::LastSent => &self.sent,
        };
        self.referenced[region].then(|| &from[region * self.pixels..][..self.pixels])
    }

    /// The means that the screen shows of a region, if it shows any.
    pub(super) fn summary(&self, region: usize) -> Option<&[u16]> {
        self.summaries[region].shown()
    }

    /// What was thought of the last frame of a region.
    pub(super) fn judged(&self, region: usize) -> &Judged {
        &self.judged[region]
    }

    /// Pixel or mean `number` of the last frame of a region with its position, if it leaves.
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

    /// Judges the next frame of a region and draws the consequences for its reference and its summary.
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
            // What was sent is no longer on the screen.
            (Reference::LastSent, Action::Blank | Action::Summarize) => {
                self.referenced[region] = false;
            }
        }
    }
}
