// SPDX-License-Identifier: MIT OR Apache-2.0
//! RPUs that are clocked together: their stages in sequence.

use foveate_design::{FeatureKind, PipelinedDesign};

use super::delay_line::DelayLine;
use super::filter::FilterStage;
use super::pixel::{StagePixel, TailStep};
use super::ports::RpuOutput;
use super::rpu_parameters::RpuParameters;
use super::tail::RpuTail;
use super::window_center::WindowCenters;
use super::window_stage::WindowStage;
use crate::ThresholdInputs;
use crate::feature::is_hit;
use crate::feature::surface::window_differences;

/// The RPUs of an array, one per lane. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub(super) struct RpuArray {
    plan: RpuParameters,
    filter: Option<FilterStage>,
    feature: Option<WindowStage>,
    /// The registers in front of the tails.
    delay: DelayLine<Vec<TailStep>>,
    tails: Vec<RpuTail>,
    outputs: Vec<RpuOutput>,
}

impl RpuArray {
    /// Makes `lanes` RPUs of the design.
    pub(super) fn new(design: PipelinedDesign<'_>, lanes: usize) -> Self {
        let plan = RpuParameters::from_design(design);
        // A shared filter window gives a square that is smaller by the halo of the window.
        let feature_side = plan.side + (plan.stream_side - plan.side).min(2);
        Self {
            filter: plan.filter.has_window().then(|| FilterStage::new(&plan)),
            feature: plan.has_feature_window.then(|| WindowStage::new(&plan, feature_side)),
            delay: DelayLine::new(plan.tail_delay),
            tails: vec![RpuTail::new(&plan); lanes],
            outputs: vec![RpuOutput::default(); lanes],
            plan,
        }
    }

    /// Returns the number of RPUs.
    pub(super) fn lanes(&self) -> usize {
        self.tails.len()
    }

    /// Returns the outputs after the last edge, by number of the lane.
    pub(super) fn outputs(&self) -> &[RpuOutput] {
        &self.outputs
    }

    /// Applies one rising edge without a reset. `pixels` has a pixel per lane if they are valid, and
    /// `borders` the value of `border_i` of every lane.
    pub(super) fn step(
        &mut self,
        pixels: Option<&[u16]>,
        borders: &[u8],
        applied: &ThresholdInputs,
    ) {
        let plan = self.plan;
        let thresholds = plan.effective_thresholds(applied);
        let pixels = pixels.map(|pixels| pixels.iter().map(|&pixel| StagePixel::from_input(pixel)));
        let steps = self.step_windows(pixels.map(Iterator::collect), borders, thresholds);
        let steps = self.delay.step(steps);
        for (lane, tail) in self.tails.iter_mut().enumerate() {
            tail.step(&plan, steps.as_ref().map(|steps| &steps[lane]), thresholds);
        }
        self.update_outputs(thresholds);
    }

    /// Applies one rising edge with a reset.
    pub(super) fn reset(&mut self, applied: &ThresholdInputs) {
        let plan = self.plan;
        if let Some(filter) = &mut self.filter {
            filter.reset();
        }
        if let Some(feature) = &mut self.feature {
            feature.reset();
        }
        self.delay.reset();
        self.tails.iter_mut().for_each(RpuTail::reset);
        self.update_outputs(plan.effective_thresholds(applied));
    }

    fn step_windows(
        &mut self,
        pixels: Option<Vec<StagePixel>>,
        borders: &[u8],
        thresholds: &ThresholdInputs,
    ) -> Option<Vec<TailStep>> {
        let denoised = match &mut self.filter {
            Some(filter) => filter.step(pixels),
            None => pixels,
        };
        match &mut self.feature {
            Some(feature) => {
                let centers = feature.step(denoised, self.plan.needs_border.then_some(borders))?;
                Some(tail_steps(&self.plan, &centers, thresholds))
            }
            None => {
                let step = |pixel| TailStep { pixel, ..TailStep::default() };
                denoised.map(|pixels| pixels.into_iter().map(step).collect())
            }
        }
    }

    fn update_outputs(&mut self, thresholds: &ThresholdInputs) {
        for (tail, output) in self.tails.iter().zip(&mut self.outputs) {
            tail.set_output(&self.plan, thresholds, output);
        }
    }
}

/// Returns the centers with what the features need of their windows, with the levels of the edge at
/// which they step.
fn tail_steps(
    plan: &RpuParameters,
    centers: &WindowCenters<'_>,
    thresholds: &ThresholdInputs,
) -> Vec<TailStep> {
    let mut steps = centers.map(|pixel, _| TailStep { pixel, ..TailStep::default() });
    for (feature, (&kind, level)) in plan.features.iter().zip(thresholds.level).enumerate() {
        match kind {
            Some(kind @ (FeatureKind::Edge | FeatureKind::Corner)) => {
                let hits = centers.map(|_, window| is_hit(kind, window, level));
                for (step, hit) in steps.iter_mut().zip(hits) {
                    step.hits[feature] = hit;
                }
            }
            Some(FeatureKind::Surface) => {
                let differences = centers.map(|_, window| window_differences(window));
                for (step, differences) in steps.iter_mut().zip(differences) {
                    step.differences = differences;
                }
            }
            Some(
                FeatureKind::Mad
                | FeatureKind::Variance
                | FeatureKind::Range
                | FeatureKind::Segment
                | FeatureKind::Flow,
            )
            | None => {}
        }
    }
    steps
}
