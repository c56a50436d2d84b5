// SPDX-License-Identifier: MIT OR Apache-2.0
//! RPUs that are clocked together: their stages in sequence ([`RpuArray`]). One RPU is an array
//! with a single lane ([`PipelinedRpu`]).

use super::pixel::{StagePixel, TailStep};
use super::ports::{RpuInput, RpuOutput};
use super::rpu_parameters::RpuParameters;
use super::tail::RpuTail;
use super::window_stage::{DelayLine, FilterStage, WindowCenters, WindowStage};
use crate::ThresholdInputs;
use crate::feature::is_hit;
use crate::feature::surface::window_differences;
use crate::thresholds::ClassThresholdInputs;
use foveate_camera::{FeatureKind, RegionClass};
use foveate_design::PipelinedDesign;

/// The RPUs of an array, one per lane. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub(super) struct RpuArray {
    plan: RpuParameters,
    filter: Option<FilterStage>,
    feature: Option<WindowStage>,
    classes: FrontClasses,
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
            classes: FrontClasses::new(lanes),
            delay: DelayLine::new(plan.tail_delay),
            tails: vec![RpuTail::new(&plan); lanes],
            outputs: vec![RpuOutput::default(); lanes],
            plan,
        }
    }

    pub(super) fn lanes(&self) -> usize {
        self.tails.len()
    }

    /// Returns the outputs after the last edge, by number of the lane.
    pub(super) fn outputs(&self) -> &[RpuOutput] {
        &self.outputs
    }

    /// Applies one rising edge without a reset. `pixels` has a pixel per lane if they are valid,
    /// `borders` the value of `border_i` of every lane, and `classes` that of `zone_i` in an array
    /// with zones.
    pub(super) fn step(
        &mut self,
        pixels: Option<&[u16]>,
        (borders, classes): (&[u8], Option<&[RegionClass]>),
        applied: ClassThresholdInputs<'_>,
    ) {
        let plan = self.plan;
        let thresholds = plan.effective_thresholds(applied);
        let pixels = pixels.map(|pixels| pixels.iter().map(|&pixel| StagePixel::from_input(pixel)));
        let pixels = pixels.map(Iterator::collect);
        let steps = self.step_windows(pixels, (borders, classes), thresholds);
        let steps = self.delay.step(steps);
        for (lane, tail) in self.tails.iter_mut().enumerate() {
            tail.step(&plan, steps.as_ref().map(|steps| &steps[lane]), thresholds);
        }
        self.update_outputs(thresholds);
    }

    /// Applies one rising edge with a reset.
    pub(super) fn reset(&mut self, applied: ClassThresholdInputs<'_>) {
        let plan = self.plan;
        if let Some(filter) = &mut self.filter {
            filter.reset();
        }
        if let Some(feature) = &mut self.feature {
            feature.reset();
        }
        self.classes.reset();
        self.delay.reset();
        self.tails.iter_mut().for_each(RpuTail::reset);
        self.update_outputs(plan.effective_thresholds(applied));
    }

    fn step_windows(
        &mut self,
        pixels: Option<Vec<StagePixel>>,
        (borders, classes): (&[u8], Option<&[RegionClass]>),
        thresholds: ClassThresholdInputs<'_>,
    ) -> Option<Vec<TailStep>> {
        let denoised = match &mut self.filter {
            Some(filter) => filter.step(pixels),
            None => pixels,
        };
        let plan = &self.plan;
        match &mut self.feature {
            Some(feature) => {
                let centers = feature.step(denoised, plan.needs_border.then_some(borders))?;
                let classes = self.classes.step(classes, plan.pixels);
                Some(tail_steps(plan, &centers, classes, thresholds))
            }
            None => {
                let pixels = denoised?;
                let classes = self.classes.step(classes, plan.pixels);
                let step = |(pixel, &class)| TailStep { pixel, class, ..TailStep::default() };
                Some(pixels.into_iter().zip(classes).map(step).collect())
            }
        }
    }

    fn update_outputs(&mut self, thresholds: ClassThresholdInputs<'_>) {
        for (tail, output) in self.tails.iter().zip(&mut self.outputs) {
            tail.set_output(&self.plan, thresholds, output);
        }
    }
}

/// The classes of the regions in the frame whose pixels leave the last window.
#[derive(Clone, Debug)]
struct FrontClasses {
    /// Number of pixels of the frame that have left the last window, 0..n.
    position: usize,
    classes: Vec<RegionClass>,
}

impl FrontClasses {
    fn new(lanes: usize) -> Self {
        Self { position: 0, classes: vec![RegionClass::default(); lanes] }
    }

    fn reset(&mut self) {
        self.position = 0;
    }

    /// Applies a step of a frame of `pixels` pixels, and returns the classes of that frame. The
    /// first step of a frame takes them from the inputs.
    fn step(&mut self, inputs: Option<&[RegionClass]>, pixels: usize) -> &[RegionClass] {
        if let Some(inputs) = inputs.filter(|_| self.position == 0) {
            self.classes.copy_from_slice(inputs);
        }
        self.position = (self.position + 1) % pixels;
        &self.classes
    }
}

/// Returns the centers with what the features need of their windows, with the levels of the edge at
/// which they step.
fn tail_steps(
    plan: &RpuParameters,
    centers: &WindowCenters<'_>,
    classes: &[RegionClass],
    thresholds: ClassThresholdInputs<'_>,
) -> Vec<TailStep> {
    let mut steps = centers.map(|pixel, _| TailStep { pixel, ..TailStep::default() });
    steps.iter_mut().zip(classes).for_each(|(step, &class)| step.class = class);
    for (feature, &kind) in plan.features.iter().enumerate() {
        match kind {
            Some(kind @ (FeatureKind::Edge | FeatureKind::Corner)) => {
                let hits_of = |class| {
                    let level = thresholds.of(class).level[feature];
                    centers.map(|_, window| is_hit(kind, window, level))
                };
                let own = hits_of(RegionClass::Normal);
                let keen = classes.contains(&RegionClass::Keen);
                let keen = keen.then(|| hits_of(RegionClass::Keen));
                for (lane, step) in steps.iter_mut().enumerate() {
                    step.hits[feature] = match (step.class, &keen) {
                        (RegionClass::Keen, Some(keen)) => keen[lane],
                        _ => own[lane],
                    };
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

/// The cycle-level model of one RPU. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub struct PipelinedRpu {
    array: RpuArray,
}

impl PipelinedRpu {
    /// Makes an RPU of the design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        Self { array: RpuArray::new(design, 1) }
    }

    /// Applies one rising edge, and returns every output after it, with these inputs still applied.
    /// In a design with zones the class of the region is [`foveate_camera::RegionClass::Normal`].
    pub fn step(&mut self, input: &RpuInput, thresholds: &ThresholdInputs) -> RpuOutput {
        let &RpuInput { reset, valid, pixel, border } = input;
        let thresholds = ClassThresholdInputs::new(thresholds, None);
        if reset {
            self.array.reset(thresholds);
        } else {
            let pixels = [pixel];
            self.array.step(valid.then_some(&pixels), (&[border], None), thresholds);
        }
        self.array.outputs()[0]
    }
}
