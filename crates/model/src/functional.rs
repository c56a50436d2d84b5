// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional reference: an RCM and its renderer, one whole frame at a time.

use foveate_camera::{Camera, Payload};

use crate::ModelError;
use crate::decision::combined;
use crate::denoise::denoise_into;
use crate::feature::score;
use crate::number::index;
use crate::periphery::{Summary, block_means, no_summaries};
use crate::region::{Area, black, black_padded, check_kind, pad_into};
use crate::render::Screen;
use crate::temporal::{References, changed_pixels};
use crate::view::FrameRegion;
use foveate_camera::Action;
use foveate_frame::Frame;

/// Everything that one frame leads to. Regions are numbered row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionalOutcome {
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
    /// Scores, by feature in the order of the camera and then by region.
    pub scores: Vec<Vec<u64>>,
    /// Means of the blocks of every region, region by region; empty where irrelevant regions send none. The means of those
    /// whose action is [`Action::Summarize`] were sent.
    pub means: Vec<Vec<u16>>,
    /// The frame, padded.
    pub padded: Frame,
    /// The padded frame, denoised: what was scored.
    pub denoised: Frame,
    /// What is on the screen after this frame, without padding.
    pub rendered: Frame,
}

impl FunctionalOutcome {
    fn new(camera: &Camera) -> Self {
        let regions = index(camera.regions());
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![Action::Hold; regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; camera.features().len()],
            means: vec![Vec::new(); regions],
            padded: black_padded(camera),
            denoised: black_padded(camera),
            rendered: black(camera),
        }
    }

    /// The padded frame whose pixels active regions forward.
    #[must_use]
    pub fn payload(&self, camera: &Camera) -> &Frame {
        match camera.payload() {
            Payload::Denoised => &self.denoised,
            Payload::Raw => &self.padded,
        }
    }
}

/// What is remembered of a region between frames, beside the screen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Remembered {
    /// What the next frame's region will be compared with: denoised pixels, row by row; none where there is no valid
    /// reference.
    pub reference: Option<Vec<u16>>,
    /// The means that the screen shows of it, block by block; none where it shows no summary.
    pub summary: Option<Vec<u16>>,
}

/// An RCM with its renderer. Between frames it remembers references, summaries and the screen, nothing else.
#[derive(Clone, Debug)]
pub struct FunctionalCamera {
    camera: Camera,
    references: References,
    summaries: Vec<Summary>,
    screen: Screen,
    outcome: FunctionalOutcome,
}

impl FunctionalCamera {
    /// A camera that has seen nothing yet.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        Self {
            references: References::none(camera),
            summaries: no_summaries(camera),
            screen: Screen::black(camera),
            outcome: FunctionalOutcome::new(camera),
            camera: camera.clone(),
        }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Forgets every frame.
    pub fn reset(&mut self) {
        self.references = References::none(&self.camera);
        self.summaries = no_summaries(&self.camera);
        self.screen = Screen::black(&self.camera);
    }

    /// What the next frame's region will be compared with: denoised pixels, row by row; `None` where
    /// there is no valid reference.
    ///
    /// # Panics
    /// When the camera has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<Vec<u16>> {
        self.references.pixels(&self.camera, region)
    }

    /// The means that the screen shows of a region, block by block; `None` where it shows no summary.
    ///
    /// # Panics
    /// When the camera has no such region.
    #[must_use]
    pub fn summary(&self, region: u32) -> Option<&[u16]> {
        self.summaries[index(region)].shown()
    }

    /// What is remembered of a region.
    ///
    /// # Panics
    /// When the camera has no such region.
    #[must_use]
    pub fn remembered(&self, region: u32) -> Remembered {
        let summary = self.summary(region).map(<[u16]>::to_vec);
        Remembered { reference: self.reference(region), summary }
    }

    /// A camera that goes on from what another one remembers: its screen, and what is remembered of every region.
    ///
    /// # Errors
    /// When the screen is not of the camera's size and depth.
    ///
    /// # Panics
    /// When a region's reference or summary has too few values.
    pub fn resume(
        camera: &Camera,
        screen: &Frame,
        remembered: impl Fn(u32) -> Remembered,
    ) -> Result<Self, ModelError> {
        check_kind(camera, screen)?;
        let mut resumed = Self::new(camera);
        resumed.screen.show_all(screen);
        for region in 0..camera.regions() {
            let Remembered { reference, summary } = remembered(region);
            if let Some(pixels) = reference {
                resumed.references.set(camera, region, &pixels);
            }
            resumed.summaries[index(region)] = Summary::of(summary);
        }
        Ok(resumed)
    }

    /// Takes the next frame.
    ///
    /// # Errors
    /// When the frame is not of the camera's size and depth; nothing has changed then.
    pub fn step(&mut self, frame: &Frame) -> Result<&FunctionalOutcome, ModelError> {
        check_kind(&self.camera, frame)?;
        pad_into(frame, &mut self.outcome.padded);
        denoise_into(&self.camera, &self.outcome.padded, &mut self.outcome.denoised);
        for region in 0..self.camera.regions() {
            self.decide(region);
            self.summarize(region);
            self.act(region);
        }
        self.screen.crop_into(&mut self.outcome.rendered);
        Ok(&self.outcome)
    }

    /// Scores and both relevances of one region.
    fn decide(&mut self, region: u32) {
        let Self { camera, references, outcome, .. } = self;
        let at = index(region);
        let seen = FrameRegion::new(camera, &outcome.denoised, region);
        let seen = seen.after(references.frame(region));
        for (feature, scores) in camera.features().iter().zip(&mut outcome.scores) {
            // A feature without a level does not ask for one.
            scores[at] = score(feature, feature.level().unwrap_or(0), &seen);
        }
        let votes = camera
            .features()
            .iter()
            .zip(&outcome.scores)
            .map(|(feature, scores)| scores[at] >= feature.min_score());
        let srs = combined(camera.combine(), votes);
        let count = changed_pixels(&seen, camera.temporal().level);
        let trs = count >= camera.temporal().min_count;
        outcome.srs[at] = srs;
        outcome.trs[at] = trs;
        outcome.active[at] = srs && trs;
        outcome.temporal_count[at] = count;
    }

    /// The means of one region.
    fn summarize(&mut self, region: u32) {
        let Self { camera, outcome, .. } = self;
        if let Some(periphery) = camera.periphery() {
            let pixels = Area::of(camera, region).pixels(outcome.payload(camera));
            outcome.means[index(region)] = block_means(periphery, pixels);
        }
    }

    /// What follows from them: the action, the screen, and what is remembered.
    fn act(&mut self, region: u32) {
        let Self { camera, references, summaries, screen, outcome } = self;
        let at = index(region);
        let means = &outcome.means[at];
        let level = camera.periphery().map_or(0, |periphery| periphery.level);
        let (srs, trs) = (outcome.srs[at], outcome.trs[at]);
        let action = summaries[at].decide(camera.irrelevant(), srs, trs, means, level);
        outcome.actions[at] = action;
        screen.show(camera, region, action, (outcome.payload(camera), means));
        references.update(camera, &outcome.denoised, region, action);
    }
}
