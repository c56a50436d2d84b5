// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ideal camera ([`IdealCamera`]), which takes one whole frame at a time, and gives the
//! scores, decisions and pixels of that frame ([`IdealOutcome`]).

use super::plane::RegionGrid;
use crate::IdealError;
use crate::binomial::filter_binomial;
use crate::feature::{ScoreBuffers, count_changed_pixels, score};
use crate::median::{SortedColumns, filter_median};
use crate::memory::ReferenceMemory;
use crate::periphery::PeripheryState;
use crate::plane::PaddedPlane;
use crate::rules::{ClassRules, DecisionRules};
use crate::switching::filter_switching;
use crate::view::FrameView;
use foveate_camera::{Camera, DenoiseFilter, Payload, RegionAction, RegionClass};
use foveate_pixels::ByteFrame;

/// A camera that computes the contract in real numbers.
///
/// It ignores the neighborhood of the configuration (every window sees the whole frame, as with
/// `shared`) and the fraction bits of the mean (it uses the real mean). It does not round the
/// pixels of `binomial3x3`, so its denoised and rendered pixels may be fractions of grey levels.
#[derive(Clone, Debug)]
pub struct IdealCamera {
    camera: Camera,
    grid: RegionGrid,
    rules: DecisionRules,
    memory: ReferenceMemory,
    periphery: Option<PeripheryState>,
    raw: PaddedPlane,
    denoised: PaddedPlane,
    columns: SortedColumns,
    scratch: ScoreBuffers,
    classes: Vec<RegionClass>,
    /// The scores of all regions with the keen thresholds; empty in a camera without zones.
    keen_scores: ClassScores,
    outcome: IdealOutcome,
}

/// The scores of a frame by feature and region, and the numbers of changed pixels by region.
#[derive(Clone, Debug, Default)]
struct ClassScores {
    scores: Vec<Vec<f64>>,
    changed: Vec<f64>,
}

impl IdealCamera {
    /// Creates a camera before its first frame, whose regions have the classes of the
    /// configuration.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let grid = RegionGrid::from_camera(camera);
        let rules = DecisionRules::from_camera(camera);
        Self {
            memory: ReferenceMemory::new(camera, &grid),
            periphery: PeripheryState::from_camera(camera, &grid),
            raw: PaddedPlane::black(&grid),
            denoised: PaddedPlane::black(&grid),
            columns: SortedColumns::default(),
            scratch: ScoreBuffers::default(),
            classes: camera.configured_classes(),
            keen_scores: rules.keen.as_ref().map_or_else(ClassScores::default, |keen| {
                ClassScores {
                    scores: vec![vec![0.0; grid.regions()]; keen.features.len()],
                    changed: vec![0.0; grid.regions()],
                }
            }),
            outcome: IdealOutcome::new(rules.own.features.len(), &grid),
            rules,
            grid,
            camera: camera.clone(),
        }
    }

    /// Returns the camera's configuration as it was given.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the outcome of the last frame. It has no meaning before the first frame and after a
    /// reset.
    #[must_use]
    pub fn outcome(&self) -> &IdealOutcome {
        &self.outcome
    }

    /// Sets the class of every region, numbered row by row, from the next frame on.
    ///
    /// # Errors
    /// Returns the errors of [`Camera::check_classes`]; nothing has changed then.
    pub fn set_classes(&mut self, classes: &[RegionClass]) -> Result<(), IdealError> {
        self.camera.check_classes(classes)?;
        self.classes.copy_from_slice(classes);
        Ok(())
    }

    /// Forgets every frame and makes the screen black. The classes of the regions stay.
    pub fn reset(&mut self) {
        self.memory.forget();
        if let Some(periphery) = &mut self.periphery {
            periphery.forget();
        }
        self.outcome.rendered.fill(0.0);
    }

    /// Processes the next frame.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size and depth; nothing has changed then.
    pub fn step(&mut self, frame: &ByteFrame) -> Result<&IdealOutcome, IdealError> {
        self.check_frame_format((frame.width(), frame.height(), frame.bits()))?;
        self.raw.read_padded(frame.borrowed_pixels(), &self.grid);
        match self.camera.filter() {
            DenoiseFilter::None => self.denoised.copy_from(&self.raw),
            DenoiseFilter::Median3x3 => {
                filter_median(&self.raw, &mut self.denoised, &mut self.columns);
            }
            DenoiseFilter::Switching3x3 => {
                filter_switching(&self.raw, &mut self.denoised, &mut self.columns);
            }
            DenoiseFilter::Binomial3x3 => filter_binomial(&self.raw, &mut self.denoised),
        }
        self.score();
        for region in 0..self.grid.regions() {
            self.decide(region);
            self.render_region(region);
            let action = self.outcome.actions[region];
            self.memory.update_reference(&self.denoised, &self.grid, region, action);
        }
        self.denoised.crop_into(&self.grid, &mut self.outcome.denoised);
        Ok(&self.outcome)
    }

    fn check_frame_format(&self, given: (u32, u32, u32)) -> Result<(), IdealError> {
        let expected = (self.camera.width(), self.camera.height(), self.camera.pixel_bits());
        if given == expected {
            return Ok(());
        }
        let description = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
        Err(IdealError::FrameFormat { given: description(given), expected: description(expected) })
    }

    fn score(&mut self) {
        let Self { grid, rules, memory, denoised, scratch, classes, keen_scores, outcome, .. } =
            self;
        let view = memory.frame_view(denoised, grid);
        score_frame(&rules.own, &view, scratch, (&mut outcome.scores, &mut outcome.changed));
        let Some(keen) = &rules.keen else { return };
        if !classes.contains(&RegionClass::Keen) {
            return;
        }
        let ClassScores { scores, changed } = keen_scores;
        score_frame(keen, &view, scratch, (scores, changed));
        let keen_regions =
            classes.iter().enumerate().filter(|(_, class)| **class == RegionClass::Keen);
        for (region, _) in keen_regions {
            outcome.changed[region] = changed[region];
            for (own, keen) in outcome.scores.iter_mut().zip(&*scores) {
                own[region] = keen[region];
            }
        }
    }

    fn decide(&mut self, region: usize) {
        let Self { camera, grid, raw, denoised, rules, classes, periphery, outcome, .. } = self;
        let class = classes[region];
        let srs = rules.srs(class, &outcome.scores, region);
        let trs = rules.trs(class, outcome.changed[region]);
        outcome.srs[region] = srs;
        outcome.trs[region] = trs;
        outcome.active[region] = srs && trs;
        let means = periphery.as_ref().map_or(Vec::new(), |periphery| {
            periphery.means(payload_plane(camera, raw, denoised), grid, region)
        });
        let level = rules.summary_level(class);
        let is_due =
            || periphery.as_ref().is_some_and(|periphery| periphery.is_due(region, &means, level));
        let action = rules.action(srs, trs, is_due);
        outcome.actions[region] = action;
        if let Some(periphery) = periphery {
            periphery.apply_action(region, action, means);
        }
    }

    /// Renders one region and leaves the rest of the screen as it is.
    fn render_region(&mut self, region: usize) {
        let Self { camera, grid, raw, denoised, periphery, outcome, .. } = self;
        let payload = payload_plane(camera, raw, denoised);
        let (columns, rows) = grid.area_without_padding(region);
        for y in rows {
            let shown = &mut outcome.rendered[y * grid.width..][columns.clone()];
            match outcome.actions[region] {
                RegionAction::Forward => shown.copy_from_slice(&payload.row(y)[columns.clone()]),
                RegionAction::Hold => {}
                RegionAction::Blank => shown.fill(0.0),
                RegionAction::Summarize => {
                    let periphery = periphery.as_ref().expect("only a periphery sends summaries");
                    for (x, shown) in columns.clone().zip(shown) {
                        *shown = periphery.shown_value(grid, region, (x, y));
                    }
                }
            }
        }
    }
}

/// Returns the frame whose pixels are sent: denoised or raw.
fn payload_plane<'a>(
    camera: &Camera,
    raw: &'a PaddedPlane,
    denoised: &'a PaddedPlane,
) -> &'a PaddedPlane {
    match camera.payload() {
        Payload::Denoised => denoised,
        Payload::Raw => raw,
    }
}

/// Computes the scores and the numbers of changed pixels of all regions with the thresholds of a
/// class.
fn score_frame(
    rules: &ClassRules,
    view: &FrameView,
    scratch: &mut ScoreBuffers,
    (scores, changed): (&mut [Vec<f64>], &mut [f64]),
) {
    for (feature, scores) in rules.features.iter().zip(scores) {
        score(feature, view, scratch, scores);
    }
    count_changed_pixels(rules.level, view, scratch, changed);
}

/// The scores and decisions of every region, numbered row by row, and two whole frames. Every value
/// has its natural unit: no score is scaled to become an integer.
#[derive(Clone, Debug, PartialEq)]
pub struct IdealOutcome {
    /// The spatial relevance (SRS) of every region.
    pub srs: Vec<bool>,
    /// The temporal relevance (TRS) of every region.
    pub trs: Vec<bool>,
    /// The active regions, which have both SRS and TRS; their new pixels are sent.
    pub active: Vec<bool>,
    /// The action that the receiver's screen takes for every region.
    pub actions: Vec<RegionAction>,
    /// The scores by feature, in the order of the camera, and then by region, in the unit of the
    /// feature ([`FeatureSpec::unit`](foveate_camera::FeatureSpec)).
    pub scores: Vec<Vec<f64>>,
    /// The number of changed pixels of every region, 0..=n; n without a valid reference.
    pub changed: Vec<f64>,
    /// The denoised frame without padding: `width * height` grey levels, 0..=2^P - 1, in row-major
    /// order. They are whole numbers, or sixteenths of them with `binomial3x3`.
    pub denoised: Vec<f64>,
    /// The screen after this frame, in the same form as `denoised`.
    pub rendered: Vec<f64>,
}

impl IdealOutcome {
    pub(crate) fn new(features: usize, grid: &RegionGrid) -> Self {
        let (regions, pixels) = (grid.regions(), grid.width * grid.height);
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![RegionAction::Hold; regions],
            scores: vec![vec![0.0; regions]; features],
            changed: vec![0.0; regions],
            denoised: vec![0.0; pixels],
            rendered: vec![0.0; pixels],
        }
    }
}
