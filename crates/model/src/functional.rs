// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model ([`FunctionalCamera`]): an RCM and its renderer, one whole frame at a
//! time. It is the reference for all other models. Its screen has the pixels of each region
//! after its action.

use super::region::{FrameRegion, combine_votes};
use crate::ModelError;
use crate::conversions::index;
use crate::denoising::denoise_into;
use crate::feature::flow::flow_match;
use crate::feature::score;
use crate::periphery::{ShownSummary, block_means, no_summaries};
use crate::region::{
    RegionArea, black_frame, black_padded_frame, check_frame_kind, crop_into, pad_into,
};
use crate::temporal::{RegionReferences, changed_pixels};
use foveate_camera::{
    Camera, ClassThresholds, Displacement, Payload, RegionAction, RegionClass, SpatialFeature,
};
use foveate_pixels::Frame;

/// The results of one frame. Regions are numbered row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionalOutcome {
    /// Spatial relevance of every region.
    pub srs: Vec<bool>,
    /// Temporal relevance of every region.
    pub trs: Vec<bool>,
    /// The class of every region; [`RegionClass::Normal`] in a camera without zones.
    pub classes: Vec<RegionClass>,
    /// SRS and TRS of every region are both 1, so its pixels are forwarded.
    pub active: Vec<bool>,
    /// Action on every region of the screen.
    pub actions: Vec<RegionAction>,
    /// Number of changed pixels of every region. It is n for a region without a valid reference.
    pub temporal_count: Vec<u32>,
    /// Scores, by feature in the order of the camera and then by region.
    pub scores: Vec<Vec<u64>>,
    /// The displacement of every region since its reference. It is empty for a camera without
    /// `flow`.
    pub displacements: Vec<Displacement>,
    /// Means of the blocks, region by region. They are empty if irrelevant regions send no means.
    /// Only the means of regions with [`RegionAction::Summarize`] were sent.
    pub means: Vec<Vec<u16>>,
    /// The padded frame.
    pub padded: Frame,
    /// The denoised padded frame, from which the scores are computed.
    pub denoised: Frame,
    /// The screen after this frame, without padding.
    pub rendered: Frame,
}

impl FunctionalOutcome {
    fn new(camera: &Camera) -> Self {
        let regions = index(camera.regions());
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            classes: vec![RegionClass::default(); regions],
            active: vec![false; regions],
            actions: vec![RegionAction::Hold; regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; camera.features().len()],
            displacements: match camera.displacement_feature() {
                Some(_) => vec![Displacement::default(); regions],
                None => Vec::new(),
            },
            means: vec![Vec::new(); regions],
            padded: black_padded_frame(camera),
            denoised: black_padded_frame(camera),
            rendered: black_frame(camera),
        }
    }

    /// Returns the padded frame whose pixels active regions forward.
    #[must_use]
    pub fn payload(&self, camera: &Camera) -> &Frame {
        match camera.payload() {
            Payload::Denoised => &self.denoised,
            Payload::Raw => &self.padded,
        }
    }
}

/// The state of a region that is kept between frames, except its pixels on the screen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RegionMemory {
    /// The reference of the region: denoised pixels in row-major order, or `None` if there is no
    /// valid reference.
    pub reference: Option<Vec<u16>>,
    /// The means of the region that the screen shows, block by block, or `None` if it shows no
    /// summary.
    pub summary: Option<Vec<u16>>,
}

/// An RCM with its renderer. Its state between frames is references, summaries and the screen, and
/// the map of the classes of its regions.
#[derive(Clone, Debug)]
pub struct FunctionalCamera {
    camera: Camera,
    references: RegionReferences,
    summaries: Vec<ShownSummary>,
    screen: Screen,
    classes: Vec<RegionClass>,
    outcome: FunctionalOutcome,
}

impl FunctionalCamera {
    /// Makes a camera in the state after a reset, whose regions have the classes of the
    /// configuration.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        Self {
            references: RegionReferences::without_references(camera),
            summaries: no_summaries(camera),
            screen: Screen::black(camera),
            classes: camera.configured_classes(),
            outcome: FunctionalOutcome::new(camera),
            camera: camera.clone(),
        }
    }

    /// Returns the camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the class of every region in the next frame.
    #[must_use]
    pub fn classes(&self) -> &[RegionClass] {
        &self.classes
    }

    /// Sets the class of every region, from the next frame on.
    ///
    /// # Errors
    /// Returns the errors of [`Camera::check_classes`]. The classes are then unchanged.
    pub fn set_classes(&mut self, classes: &[RegionClass]) -> Result<(), ModelError> {
        self.camera.check_classes(classes)?;
        self.classes.copy_from_slice(classes);
        Ok(())
    }

    /// Resets references, summaries and the screen. The classes of the regions stay.
    pub fn reset(&mut self) {
        self.references = RegionReferences::without_references(&self.camera);
        self.summaries = no_summaries(&self.camera);
        self.screen = Screen::black(&self.camera);
    }

    /// Returns the reference of a region for the next frame: denoised pixels in row-major order, or
    /// `None` if there is no valid reference.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    #[must_use]
    pub fn reference(&self, region: u32) -> Option<Vec<u16>> {
        self.references.pixels(&self.camera, region)
    }

    /// Returns the means of a region that the screen shows, block by block, or `None` if it shows
    /// no summary.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    #[must_use]
    pub fn summary(&self, region: u32) -> Option<&[u16]> {
        self.summaries[index(region)].shown()
    }

    /// Returns the state of a region that is kept between frames.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    #[must_use]
    pub fn region_memory(&self, region: u32) -> RegionMemory {
        let summary = self.summary(region).map(<[u16]>::to_vec);
        RegionMemory { reference: self.reference(region), summary }
    }

    /// Makes a camera that continues from the state of another one: its screen, and the state of
    /// every region.
    ///
    /// # Errors
    /// Returns an error if the screen does not have the size and depth of the camera.
    ///
    /// # Panics
    /// Panics if the reference or the summary of a region has too few values.
    pub fn resume(
        camera: &Camera,
        screen: &Frame,
        memory_of: impl Fn(u32) -> RegionMemory,
    ) -> Result<Self, ModelError> {
        check_frame_kind(camera, screen)?;
        let mut resumed = Self::new(camera);
        resumed.screen.show_frame(screen);
        for region in 0..camera.regions() {
            let RegionMemory { reference, summary } = memory_of(region);
            if let Some(pixels) = reference {
                resumed.references.set(camera, region, &pixels);
            }
            resumed.summaries[index(region)] = ShownSummary::from_means(summary);
        }
        Ok(resumed)
    }

    /// Computes the next frame.
    ///
    /// # Errors
    /// Returns an error if the frame does not have the size and depth of the camera. The state is
    /// then unchanged.
    pub fn step(&mut self, frame: &Frame) -> Result<&FunctionalOutcome, ModelError> {
        check_frame_kind(&self.camera, frame)?;
        pad_into(frame, &mut self.outcome.padded);
        denoise_into(&self.camera, &self.outcome.padded, &mut self.outcome.denoised);
        for region in 0..self.camera.regions() {
            self.decide(region);
            self.summarize(region);
            self.apply_decision(region);
        }
        self.screen.crop_into(&mut self.outcome.rendered);
        Ok(&self.outcome)
    }

    /// Computes the scores, SRS and TRS of one region.
    fn decide(&mut self, region: u32) {
        let Self { camera, references, classes, outcome, .. } = self;
        let at = index(region);
        let class = classes[at];
        let thresholds = camera.class_thresholds(class);
        let ClassThresholds { features, temporal_level, min_count, summary_level: _ } = thresholds;
        let scored_region = FrameRegion::new(camera, &outcome.denoised, region);
        let scored_region = scored_region.with_reference(references.frame(region));
        for (feature, scores) in features.iter().zip(&mut outcome.scores) {
            // A feature without a level ignores this argument.
            scores[at] = score(feature, feature.level().unwrap_or(0), &scored_region);
        }
        if let Some(radius) = camera.displacement_feature().and_then(SpatialFeature::radius) {
            outcome.displacements[at] = flow_match(&scored_region, radius).displacement;
        }
        let votes = features
            .iter()
            .zip(&outcome.scores)
            .map(|(feature, scores)| scores[at] >= feature.min_score());
        let voted = combine_votes(camera.combine(), votes);
        let srs = class.forced_srs().unwrap_or(voted);
        let count = changed_pixels(&scored_region, temporal_level);
        let trs = count >= min_count;
        outcome.srs[at] = srs;
        outcome.trs[at] = trs;
        outcome.classes[at] = class;
        outcome.active[at] = srs && trs;
        outcome.temporal_count[at] = count;
    }

    /// Computes the means of one region.
    fn summarize(&mut self, region: u32) {
        let Self { camera, outcome, .. } = self;
        if let Some(periphery) = camera.periphery() {
            let pixels = RegionArea::from_region(camera, region).pixels(outcome.payload(camera));
            outcome.means[index(region)] = block_means(periphery, pixels);
        }
    }

    /// Applies the decision for one region: the action, the screen, the reference and the summary.
    fn apply_decision(&mut self, region: u32) {
        let Self { camera, references, summaries, screen, classes, outcome } = self;
        let at = index(region);
        let means = &outcome.means[at];
        let level = camera.class_thresholds(classes[at]).summary_level.unwrap_or(0);
        let (srs, trs) = (outcome.srs[at], outcome.trs[at]);
        let action = summaries[at].decide(camera.irrelevant(), srs, trs, means, level);
        outcome.actions[at] = action;
        screen.show_region(camera, region, action, (outcome.payload(camera), means));
        references.update(camera, &outcome.denoised, region, action);
    }
}

/// The rendered regions with padding. The screen is black before the first frame.
#[derive(Clone, Debug)]
pub(crate) struct Screen(Frame);

impl Screen {
    pub(crate) fn black(camera: &Camera) -> Self {
        Self(black_padded_frame(camera))
    }

    /// Renders one region of a frame with the forwarded pixels `payload` and the means `means`.
    pub(crate) fn show_region(
        &mut self,
        camera: &Camera,
        region: u32,
        action: RegionAction,
        (payload, means): (&Frame, &[u16]),
    ) {
        let area = RegionArea::from_region(camera, region);
        match action {
            RegionAction::Forward => area.copy(payload, &mut self.0),
            RegionAction::Hold => {}
            RegionAction::Blank => area.blank(&mut self.0),
            RegionAction::Summarize => {
                let periphery = camera.periphery().expect("who sends a summary has a periphery");
                area.fill_blocks(periphery, means, &mut self.0);
            }
        }
    }

    /// Shows a whole frame, which has the size of the screen without padding.
    pub(crate) fn show_frame(&mut self, frame: &Frame) {
        pad_into(frame, &mut self.0);
    }

    /// Copies the screen without padding to `rendered`.
    pub(crate) fn crop_into(&self, rendered: &mut Frame) {
        crop_into(&self.0, rendered);
    }
}
