// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the array keeps of every region from frame to frame, and what it thinks of it.

use foveate_design::{Action, Camera, Reference, SerialDesign};

use crate::number::index;
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
    verdicts: Vec<Verdict>,
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
            verdicts: vec![Verdict::default(); regions],
            camera: design.camera().clone(),
        }
    }

    /// The next frame is the first; pixels stay and are never seen.
    pub(super) fn forget(&mut self) {
        self.referenced.fill(false);
    }

    /// What the next frame of a region is compared with.
    pub(super) fn reference(&self, region: usize) -> Option<&[u16]> {
        let from = match self.camera.temporal().reference {
            Reference::Previous => &self.scored,
            Reference::LastSent => &self.sent,
        };
        self.referenced[region].then(|| &from[region * self.pixels..][..self.pixels])
    }

    pub(super) fn verdict(&self, region: usize) -> &Verdict {
        &self.verdicts[region]
    }

    /// A pixel of the last frame as it was scored.
    pub(super) fn scored(&self, region: usize, position: usize) -> u16 {
        self.scored[region * self.pixels + position]
    }

    /// Judges the next frame of a region and draws the consequences for its reference.
    pub(super) fn judge(
        &mut self,
        region: usize,
        stream: impl Iterator<Item = u16>,
        border: u8,
        thresholds: &Thresholds,
    ) {
        self.scorer.take(stream, border);
        let verdict = Verdict::of(&self.camera, &self.scorer, self.reference(region), thresholds);
        self.verdicts[region] = verdict;
        let own = region * self.pixels..(region + 1) * self.pixels;
        for (scored, pixel) in self.scored[own.clone()].iter_mut().zip(self.scorer.pixels()) {
            *scored = pixel;
        }
        match (self.camera.temporal().reference, verdict.action(&self.camera)) {
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
