// SPDX-License-Identifier: MIT OR Apache-2.0
//! All RPUs of an array: the stages in a row, for one set of lane types.

use foveate_design::{FeatureKind, PipelinedDesign};
use foveate_lanes::{Lane, Task, threshold};
use foveate_model::Thresholds;

use crate::borders::Borders;
use crate::kernel;
use crate::median::MedianStage;
use crate::plan::Plan;
use crate::rows::{Row, row};
use crate::tail::{Stepped, Tail};
use crate::wide::Types;
use crate::window::{Pixels, WindowStage};

/// The RPUs, one per lane.
#[derive(Clone, Debug)]
pub(crate) struct Core<Y: Types> {
    pub(crate) plan: Plan,
    median: Option<MedianStage<Y::Pixel>>,
    feature: Option<WindowStage<Y::Pixel>>,
    /// The steps of the windows, the newest first, up to the one that enters the tail.
    steps: Vec<Step<Y::Pixel>>,
    pub(crate) tail: Tail<Y>,
    /// What is on the pixel ports.
    incoming: Row<Y::Pixel>,
}

/// A step of the last window: pixels and, by place of the feature, hits.
#[derive(Clone, Debug)]
struct Step<T: Lane> {
    valid: bool,
    scored: Row<T>,
    raw: Option<Row<T>>,
    hits: Vec<Row<T>>,
}

impl<Y: Types> Core<Y> {
    pub(crate) fn new(design: PipelinedDesign<'_>) -> Self {
        let plan = Plan::of(design);
        let counts = |&kind: &FeatureKind| row(if kind.has_window() { plan.lanes } else { 0 });
        let step = || Step {
            valid: false,
            scored: row(plan.lanes),
            raw: plan.keeps_raw.then(|| row(plan.lanes)),
            hits: plan.features.iter().map(counts).collect(),
        };
        let borders = plan.needs_border.then(|| Borders::of(&design));
        let window =
            || WindowStage::new(&plan, plan.denoised_side, plan.keeps_raw, borders.clone());
        Self {
            median: plan.denoises.then(|| MedianStage::new(&plan)),
            feature: plan.feature_window.then(window),
            steps: (0..=plan.tail_delay).map(|_| step()).collect(),
            tail: Tail::new(&plan),
            incoming: row(plan.lanes),
            plan,
        }
    }

    fn reset(&mut self) {
        if let Some(median) = &mut self.median {
            median.reset();
        }
        if let Some(feature) = &mut self.feature {
            feature.reset();
        }
        self.steps.iter_mut().for_each(|step| step.valid = false);
        self.tail.reset();
    }

    /// One edge at which a pixel is taken, or none.
    #[inline(always)]
    fn advance(&mut self, valid: bool, thresholds: &Thresholds) {
        let Self { plan, median, feature, steps, tail, incoming } = self;
        let pixels = valid.then(|| Pixels { scored: incoming.blocks(), raw: None });
        steps.rotate_right(1);
        let denoised = match &median {
            Some(median) => median.leaving(),
            None => pixels,
        };
        steps[0].take(plan, feature.as_mut(), denoised, thresholds);
        tail.step(plan, steps[plan.tail_delay].shown(), thresholds);
        // Last, because what has just left is in the register that it writes.
        if let Some(median) = median {
            median.step(pixels);
        }
    }
}

impl<T: Lane> Step<T> {
    /// The windows' edge: what steps, if anything.
    #[inline(always)]
    fn take(
        &mut self,
        plan: &Plan,
        feature: Option<&mut WindowStage<T>>,
        denoised: Option<Pixels<'_, T>>,
        thresholds: &Thresholds,
    ) {
        self.valid = false;
        match feature {
            None => denoised.into_iter().for_each(|pixels| self.set(pixels)),
            Some(window) => {
                let Some(center) = window.step(denoised) else { return };
                self.set(window.pixels(center));
                let nine = window.window(center);
                for ((hits, kind), &level) in
                    self.hits.iter_mut().zip(&plan.features).zip(&thresholds.level)
                {
                    match kind {
                        FeatureKind::Edge => kernel::edge_hits(nine, level, hits.blocks_mut()),
                        FeatureKind::Corner => {
                            kernel::corner_hits(nine, threshold(level), hits.blocks_mut());
                        }
                        FeatureKind::Mad | FeatureKind::Variance => {}
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn set(&mut self, pixels: Pixels<'_, T>) {
        self.valid = true;
        self.scored.blocks_mut().copy_from_slice(pixels.scored);
        if let (Some(own), Some(raw)) = (&mut self.raw, pixels.raw) {
            own.blocks_mut().copy_from_slice(raw);
        }
    }

    fn shown(&self) -> Option<Stepped<'_, T>> {
        let raw = self.raw.as_ref().map(|raw| raw.blocks());
        let pixels = Pixels { scored: self.scored.blocks(), raw };
        self.valid.then_some(Stepped { pixels, hits: &self.hits })
    }
}

/// What the pixel ports show at an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge<'a, P> {
    pub(crate) reset: bool,
    pub(crate) valid: bool,
    pub(crate) pixels: &'a [P],
    pub(crate) thresholds: &'a Thresholds,
}

/// One edge of all RPUs, compiled for every instruction set.
pub(crate) struct Clock<'a, Y: Types, P> {
    pub(crate) core: &'a mut Core<Y>,
    pub(crate) edge: Edge<'a, P>,
}

impl<Y: Types, P: Copy> Task for Clock<'_, Y, P>
where
    Y::Pixel: From8Or16<P>,
{
    #[inline(always)]
    fn run(self) {
        let Self { core, edge } = self;
        let thresholds = core.plan.seen(edge.thresholds);
        if edge.reset {
            core.reset();
        } else {
            if edge.valid {
                for (lane, pixel) in core.incoming.iter_mut().zip(edge.pixels) {
                    *lane = Y::Pixel::from_port(*pixel);
                }
            }
            core.advance(edge.valid, &thresholds);
        }
        core.tail.decide(&core.plan, &thresholds);
    }
}

/// A pixel port's value as a lane. Wider values than the design's pixels do not occur.
pub(crate) trait From8Or16<P> {
    fn from_port(value: P) -> Self;
}

impl From8Or16<u8> for u8 {
    #[inline(always)]
    fn from_port(value: u8) -> Self {
        value
    }
}

impl From8Or16<u16> for u8 {
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "the design's pixels have up to 8 bits")]
    fn from_port(value: u16) -> Self {
        value as Self
    }
}

impl From8Or16<u16> for u16 {
    #[inline(always)]
    fn from_port(value: u16) -> Self {
        value
    }
}

impl From8Or16<u8> for u16 {
    #[inline(always)]
    fn from_port(value: u8) -> Self {
        value.into()
    }
}
