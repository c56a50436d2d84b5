// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state that the array keeps of every region from frame to frame, and its decisions.

use foveate_camera::{Camera, Displacement, ReferencePolicy, RegionAction, RegionClass};
use foveate_design::SerialDesign;

use super::schedule::ForwardedKind;
use crate::RegionScorer;
use crate::conversions::index;
use crate::periphery::{ShownSummary, last_position_of_block, no_summaries};
use crate::region_decision::RegionDecision;
use crate::thresholds::ClassThresholdInputs;

/// The state of all regions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SerialRegions {
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
    has_reference: Vec<bool>,
    /// The summary that each region has sent last.
    summaries: Vec<ShownSummary>,
    decided: Vec<DecidedSerialRegion>,
}

/// The scores, the decision and the values to send of a region in the last frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DecidedSerialRegion {
    pub(super) decision: RegionDecision,
    /// The displacement since the reference. It is 0 without `flow`.
    pub(super) displacement: Displacement,
    pub(super) action: RegionAction,
    /// The pixels that the region forwards, in row-major order.
    payload: Vec<u16>,
    /// The means of the blocks of the region. They are empty if irrelevant regions send none.
    means: Vec<u16>,
}

impl DecidedSerialRegion {
    /// Makes the state before the first frame.
    fn before_first_frame() -> Self {
        let (payload, means) = (Vec::new(), Vec::new());
        let (decision, displacement) = (RegionDecision::default(), Displacement::default());
        Self { decision, displacement, action: RegionAction::Hold, payload, means }
    }
}

impl SerialRegions {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let (regions, pixels) = (index(design.regions()), index(design.region_pixels()));
        let sent = match design.temporal().reference {
            ReferencePolicy::Previous => Vec::new(),
            ReferencePolicy::LastSent => vec![0; regions * pixels],
        };
        Self {
            scorer: RegionScorer::new(&design),
            pixels,
            scored: vec![0; regions * pixels],
            sent,
            has_reference: vec![false; regions],
            summaries: no_summaries(&design),
            decided: vec![DecidedSerialRegion::before_first_frame(); regions],
            camera: design.camera().clone(),
        }
    }

    /// Resets the state: the next frame is the first. Pixels stay, and are never seen.
    pub(super) fn reset(&mut self) {
        self.has_reference.fill(false);
        self.summaries = no_summaries(&self.camera);
    }

    /// Returns the reference of a region for the next frame.
    pub(super) fn reference(&self, region: usize) -> Option<&[u16]> {
        let from = match self.camera.temporal().reference {
            ReferencePolicy::Previous => &self.scored,
            ReferencePolicy::LastSent => &self.sent,
        };
        self.has_reference[region].then(|| &from[region * self.pixels..][..self.pixels])
    }

    /// Returns the means of a region that the screen shows, or `None` if it shows no summary.
    pub(super) fn summary(&self, region: usize) -> Option<&[u16]> {
        self.summaries[region].shown()
    }

    /// Returns the decision for a region in the last frame.
    pub(super) fn decided(&self, region: usize) -> &DecidedSerialRegion {
        &self.decided[region]
    }

    /// Returns pixel or mean `number` of the last frame of a region with its position, or `None` if
    /// the region does not send it.
    pub(super) fn forwarded_value(
        &self,
        region: u32,
        what: ForwardedKind,
        number: u32,
    ) -> Option<(u32, u16)> {
        let DecidedSerialRegion { action, payload, means, .. } = &self.decided[index(region)];
        match (what, action) {
            (ForwardedKind::Pixel, RegionAction::Forward) => Some((number, payload[index(number)])),
            (ForwardedKind::Mean, RegionAction::Summarize) => {
                let position = last_position_of_block(self.camera.periphery()?, number);
                Some((position, means[index(number)]))
            }
            (
                ForwardedKind::Pixel,
                RegionAction::Hold | RegionAction::Blank | RegionAction::Summarize,
            )
            | (
                ForwardedKind::Mean,
                RegionAction::Hold | RegionAction::Blank | RegionAction::Forward,
            ) => None,
        }
    }

    /// Scores and decides the next frame of a region, in which it has this class, and updates its
    /// reference and its summary.
    pub(super) fn decide(
        &mut self,
        region: usize,
        stream: impl Iterator<Item = u16>,
        border: u8,
        (class, thresholds): (RegionClass, ClassThresholdInputs<'_>),
    ) {
        self.scorer.load(stream, border);
        let decision = RegionDecision::from_scorer(
            &self.camera,
            &self.scorer,
            self.reference(region),
            (class, thresholds),
        );
        let displacement = self.scorer.displacement(self.reference(region)).unwrap_or_default();
        let means = self.scorer.means();
        let (irrelevant, level) = (self.camera.irrelevant(), thresholds.summary_level(class));
        let summary = &mut self.summaries[region];
        let action = summary.decide(irrelevant, decision.srs, decision.trs, &means, level);
        let payload = self.scorer.payload().collect();
        self.decided[region] =
            DecidedSerialRegion { decision, displacement, action, payload, means };
        let pixel_range = region * self.pixels..(region + 1) * self.pixels;
        for (scored, pixel) in self.scored[pixel_range.clone()].iter_mut().zip(self.scorer.pixels())
        {
            *scored = pixel;
        }
        match (self.camera.temporal().reference, action) {
            (ReferencePolicy::Previous, _) => self.has_reference[region] = true,
            (ReferencePolicy::LastSent, RegionAction::Forward) => {
                self.has_reference[region] = true;
                self.sent[pixel_range.clone()].copy_from_slice(&self.scored[pixel_range]);
            }
            (ReferencePolicy::LastSent, RegionAction::Hold) => {}
            // The screen no longer shows the pixels that were sent.
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                self.has_reference[region] = false;
            }
        }
    }
}
