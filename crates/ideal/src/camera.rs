// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ideal camera, which takes one whole frame at a time.

use foveate_camera::Action;
use foveate_camera::{Camera, Filter, Payload};
use foveate_frame::Raster;

use crate::feature::{Scratch, changed, score};
use crate::grid::Grid;
use crate::median::{Columns, median};
use crate::memory::Memory;
use crate::periphery::Periphery;
use crate::plane::Plane;
use crate::rules::Rules;
use crate::{IdealError, IdealOutcome};

/// A camera that computes the contract in real numbers.
///
/// It ignores the neighborhood of the configuration (every window sees the whole frame, as with
/// `shared`) and the fraction bits of the mean (it uses the real mean).
#[derive(Clone, Debug)]
pub struct IdealCamera {
    camera: Camera,
    grid: Grid,
    rules: Rules,
    memory: Memory,
    periphery: Option<Periphery>,
    raw: Plane,
    denoised: Plane,
    columns: Columns,
    scratch: Scratch,
    outcome: IdealOutcome,
}

impl IdealCamera {
    /// Creates a camera before its first frame.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let grid = Grid::of(camera);
        let rules = Rules::of(camera);
        Self {
            memory: Memory::new(camera, &grid),
            periphery: Periphery::of(camera, &grid),
            raw: Plane::black(&grid),
            denoised: Plane::black(&grid),
            columns: Columns::default(),
            scratch: Scratch::default(),
            outcome: IdealOutcome::new(rules.features.len(), &grid),
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

    /// Forgets every frame and makes the screen black.
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
    pub fn step(&mut self, frame: &Raster) -> Result<&IdealOutcome, IdealError> {
        self.check_kind((frame.width(), frame.height(), frame.bits()))?;
        self.raw.pad(frame.plane(), &self.grid);
        match self.camera.filter() {
            Filter::None => self.denoised.copy(&self.raw),
            Filter::Median3x3 => median(&self.raw, &mut self.denoised, &mut self.columns),
        }
        self.score();
        for region in 0..self.grid.regions() {
            self.decide(region);
            self.show(region);
            let action = self.outcome.actions[region];
            self.memory.keep(&self.denoised, &self.grid, region, action);
        }
        self.denoised.crop_into(&self.grid, &mut self.outcome.denoised);
        Ok(&self.outcome)
    }

    fn check_kind(&self, given: (u32, u32, u32)) -> Result<(), IdealError> {
        let expected = (self.camera.width(), self.camera.height(), self.camera.pixel_bits());
        if given == expected {
            return Ok(());
        }
        let kind = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
        Err(IdealError::FrameKind { given: kind(given), expected: kind(expected) })
    }

    fn score(&mut self) {
        let Self { grid, rules, memory, denoised, scratch, outcome, .. } = self;
        let view = memory.before(denoised, grid);
        for (feature, scores) in rules.features.iter().zip(&mut outcome.scores) {
            score((feature.kind, feature.level), &view, scratch, scores);
        }
        changed(rules.level, &view, scratch, &mut outcome.changed);
    }

    fn decide(&mut self, region: usize) {
        let Self { camera, grid, raw, denoised, rules, periphery, outcome, .. } = self;
        let srs = rules.spatial(&outcome.scores, region);
        let trs = rules.temporal(outcome.changed[region]);
        outcome.srs[region] = srs;
        outcome.trs[region] = trs;
        outcome.active[region] = srs && trs;
        let means = periphery.as_ref().map_or(Vec::new(), |periphery| {
            periphery.means(payload(camera, raw, denoised), grid, region)
        });
        let is_due = || periphery.as_ref().is_some_and(|own| own.is_due(region, &means));
        let action = rules.action(srs, trs, is_due);
        outcome.actions[region] = action;
        if let Some(periphery) = periphery {
            periphery.follow(region, action, means);
        }
    }

    /// Renders one region and leaves the rest of the screen as it is.
    fn show(&mut self, region: usize) {
        let Self { camera, grid, raw, denoised, periphery, outcome, .. } = self;
        let payload = payload(camera, raw, denoised);
        let (columns, rows) = grid.seen(region);
        for y in rows {
            let shown = &mut outcome.rendered[y * grid.width..][columns.clone()];
            match outcome.actions[region] {
                Action::Forward => shown.copy_from_slice(&payload.row(y)[columns.clone()]),
                Action::Hold => {}
                Action::Blank => shown.fill(0.0),
                Action::Summarize => {
                    let periphery = periphery.as_ref().expect("only a periphery sends summaries");
                    for (x, shown) in columns.clone().zip(shown) {
                        *shown = periphery.value(grid, region, (x, y));
                    }
                }
            }
        }
    }
}

/// Returns the frame whose pixels are sent: denoised or raw.
fn payload<'a>(camera: &Camera, raw: &'a Plane, denoised: &'a Plane) -> &'a Plane {
    match camera.payload() {
        Payload::Denoised => denoised,
        Payload::Raw => raw,
    }
}
