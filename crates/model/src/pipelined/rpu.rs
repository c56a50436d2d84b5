// SPDX-License-Identifier: MIT OR Apache-2.0
//! One RPU: its stages in sequence.

use foveate_design::PipelinedDesign;

use super::delay_line::DelayLine;
use super::median::MedianStage;
use super::pixel::{StagePixel, TailStep};
use super::ports::{RpuInput, RpuOutput};
use super::rpu_parameters::{MAX_FEATURES, RpuParameters};
use super::tail::RpuTail;
use super::window_center::WindowCenter;
use super::window_stage::WindowStage;
use crate::ThresholdInputs;
use crate::feature::is_hit;

/// The cycle-level model of one RPU. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub struct PipelinedRpu {
    plan: RpuParameters,
    median: Option<MedianStage>,
    feature: Option<WindowStage>,
    /// The registers in front of the tail.
    delay: DelayLine<TailStep>,
    tail: RpuTail,
}

impl PipelinedRpu {
    /// Makes an RPU of the design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        let plan = RpuParameters::from_design(design);
        let denoises = match plan.filter {
            foveate_design::DenoiseFilter::None => false,
            foveate_design::DenoiseFilter::Median3x3 => true,
        };
        // A shared median window gives a square that is smaller by the halo of the window.
        let feature_side = plan.side + (plan.stream_side - plan.side).min(2);
        Self {
            median: denoises.then(|| MedianStage::new(&plan)),
            feature: plan.has_feature_window.then(|| WindowStage::new(&plan, feature_side)),
            delay: DelayLine::new(plan.tail_delay),
            tail: RpuTail::new(&plan),
            plan,
        }
    }

    /// Applies one rising edge, and returns every output after it, with these inputs still applied.
    pub fn step(&mut self, input: &RpuInput, thresholds: &ThresholdInputs) -> RpuOutput {
        let plan = self.plan;
        let thresholds = plan.effective_thresholds(thresholds);
        if input.reset {
            self.reset();
        } else {
            let pixel = input.valid.then(|| StagePixel::from_input(input.pixel));
            let step = self.step_windows(pixel, input.border, thresholds);
            self.tail.step(self.delay.step(step), thresholds);
        }
        self.tail.output(thresholds)
    }

    fn step_windows(
        &mut self,
        pixel: Option<StagePixel>,
        border: u8,
        thresholds: &ThresholdInputs,
    ) -> Option<TailStep> {
        let denoised = match &mut self.median {
            Some(median) => median.step(pixel),
            None => pixel,
        };
        match &mut self.feature {
            Some(feature) => {
                let border = if self.plan.needs_border { border } else { 0 };
                let center = feature.step(denoised, border)?;
                Some(TailStep { pixel: center.pixel, hits: self.hits(&center, thresholds) })
            }
            None => denoised.map(|pixel| TailStep { pixel, hits: [false; MAX_FEATURES] }),
        }
    }

    /// Returns the hits of a center, with the levels of the edge at which it steps.
    fn hits(&self, center: &WindowCenter, thresholds: &ThresholdInputs) -> [bool; MAX_FEATURES] {
        let mut hits = [false; MAX_FEATURES];
        for ((hit, kind), level) in hits.iter_mut().zip(self.plan.features).zip(thresholds.level) {
            *hit = kind.is_some_and(|kind| is_hit(kind, &center.window, level));
        }
        hits
    }

    fn reset(&mut self) {
        if let Some(median) = &mut self.median {
            median.reset();
        }
        if let Some(feature) = &mut self.feature {
            feature.reset();
        }
        self.delay.reset();
        self.tail.reset();
    }
}
