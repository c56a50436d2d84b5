// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional reference: an RCM and its renderer, one whole frame at a time.

use foveate_design::{Design, Payload};

use crate::decision::{action, combined};
use crate::denoise::denoise_into;
use crate::number::index;
use crate::region::{Area, black, black_padded, check_kind, pad_into};
use crate::render::Screen;
use crate::temporal::References;
use crate::{ModelError, feature};
use foveate_design::Action;
use foveate_frame::Frame;

/// Everything that one frame leads to. Regions are numbered row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Spatial relevance of every region.
    pub srs: Vec<bool>,
    /// Temporal relevance of every region.
    pub trs: Vec<bool>,
    /// Both: new pixels of the region are forwarded.
    pub active: Vec<bool>,
    /// What becomes of every region on the screen.
    pub actions: Vec<Action>,
    /// Changed pixels of every region; all of them where there was no valid reference.
    pub temporal_count: Vec<u32>,
    /// Scores, by feature in the order of the design and then by region.
    pub scores: Vec<Vec<u64>>,
    /// The frame, padded.
    pub padded: Frame,
    /// The padded frame, denoised: what was scored.
    pub denoised: Frame,
    /// What is on the screen after this frame, without padding.
    pub rendered: Frame,
}

impl Outcome {
    fn new(design: &Design) -> Self {
        let regions = index(design.regions());
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![Action::Hold; regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; design.features().len()],
            padded: black_padded(design),
            denoised: black_padded(design),
            rendered: black(design),
        }
    }

    /// The padded frame whose pixels active regions forward.
    #[must_use]
    pub fn payload(&self, design: &Design) -> &Frame {
        match design.payload() {
            Payload::Denoised => &self.denoised,
            Payload::Raw => &self.padded,
        }
    }
}

/// An RCM with its renderer. Between frames it remembers references and the screen, nothing else.
#[derive(Clone, Debug)]
pub struct Camera {
    design: Design,
    references: References,
    screen: Screen,
    outcome: Outcome,
}

impl Camera {
    /// A camera that has seen nothing yet.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self {
            references: References::none(design),
            screen: Screen::black(design),
            outcome: Outcome::new(design),
            design: design.clone(),
        }
    }

    /// The design.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Forgets every frame.
    pub fn reset(&mut self) {
        self.references = References::none(&self.design);
        self.screen = Screen::black(&self.design);
    }

    /// What the next frame's region will be compared with: denoised pixels, row by row; `None` where
    /// there is no valid reference.
    ///
    /// # Panics
    /// When the design has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<Vec<u16>> {
        self.references.pixels(&self.design, region)
    }

    /// Takes the next frame.
    ///
    /// # Errors
    /// When the frame is not of the design's size and depth; nothing has changed then.
    pub fn step(&mut self, frame: &Frame) -> Result<&Outcome, ModelError> {
        check_kind(&self.design, frame)?;
        pad_into(frame, &mut self.outcome.padded);
        denoise_into(&self.design, &self.outcome.padded, &mut self.outcome.denoised);
        for region in 0..self.design.regions() {
            self.decide(region);
            self.act(region);
        }
        self.screen.crop_into(&mut self.outcome.rendered);
        Ok(&self.outcome)
    }

    /// Scores and both relevances of one region.
    fn decide(&mut self, region: u32) {
        let Self { design, references, outcome, .. } = self;
        let at = index(region);
        for (feature, scores) in design.features().iter().zip(&mut outcome.scores) {
            scores[at] = feature::of_region(design, feature, &outcome.denoised, region);
        }
        let votes = design
            .features()
            .iter()
            .zip(&outcome.scores)
            .map(|(feature, scores)| scores[at] >= feature.min_score());
        let srs = combined(design.combine(), votes);
        let count = references.count(design, &outcome.denoised, region);
        let trs = count >= design.temporal().min_count;
        outcome.srs[at] = srs;
        outcome.trs[at] = trs;
        outcome.active[at] = srs && trs;
        outcome.temporal_count[at] = count;
    }

    /// What follows from them: the screen and the next reference.
    fn act(&mut self, region: u32) {
        let Self { design, references, screen, outcome } = self;
        let at = index(region);
        let action = action(design, outcome.srs[at], outcome.trs[at]);
        outcome.actions[at] = action;
        screen.show(Area::of(design, region), action, outcome.payload(design));
        references.update(design, &outcome.denoised, region, action);
    }
}
