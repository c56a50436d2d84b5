// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bench that applies frames to an array and compares every port after every edge.

use foveate_model::{ClassMapInputs, CoreInput, SerialRcm, pad, region_stream};
use foveate_pixels::Frame;

use super::expected_outputs::{ExpectedTimeline, MeaningfulOutputs, RegionResults, region_results};
use super::serial_parameters::SerialParameters;
use crate::class_maps::{ClassMapLog, ClassMapWriter};
use crate::frames::SeededRandom;
use crate::oracle::{OracleOutcome, add_to_history, check_memory};
use crate::parameters::DesignParameters;
use crate::port_thresholds::PortThresholds;

/// The pattern in which pixels come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SerialTraffic {
    /// Percentage of clocks without a pixel although the array is ready.
    pub(crate) gaps: i64,
    /// Longest pause between frames in clocks.
    pub(crate) max_pause: i64,
    /// Percentage of clocks with a pixel although the array is not ready.
    pub(crate) pushing: i64,
    /// True if clocks without inputs are skipped at once.
    pub(crate) skips: bool,
    pub(crate) seed: u64,
}

impl SerialTraffic {
    pub(crate) const DENSE: Self =
        Self { gaps: 0, max_pause: 0, pushing: 0, skips: false, seed: 0 };
}

/// The pixels of a frame in the order of the ports, and the source of the expected results.
pub(crate) struct SerialStimulus {
    pub(crate) pixels: Vec<Vec<u16>>,
    pub(crate) thresholds: PortThresholds,
    pub(crate) expected: ResultSource,
}

impl SerialStimulus {
    /// Makes the stimulus of a frame with the thresholds of a recipe.
    pub(crate) fn new(recipe: &SerialParameters, own: DesignParameters, frame: &Frame) -> Self {
        Self {
            pixels: port_pixels(recipe, frame),
            thresholds: PortThresholds::applied(&own),
            expected: ResultSource::Oracle(Box::new(own), frame.clone()),
        }
    }
}

/// The source of the expected results of a frame.
pub(crate) enum ResultSource {
    /// The oracle, for this frame with these thresholds.
    Oracle(Box<DesignParameters>, Frame),
    Given(Vec<RegionResults>),
}

/// The result of a check: a description of the first difference, if there is one.
pub(crate) type SerialCheckResult = Result<(), String>;

pub(crate) struct SerialBench {
    pub(crate) recipe: SerialParameters,
    pub(crate) rcm: SerialRcm,
    timeline: ExpectedTimeline,
    traffic: SerialTraffic,
    random: SeededRandom,
    pub(crate) edge: i64,
    /// The edge after which the run ends.
    last_edge: i64,
    /// Thresholds that are applied between frames.
    noise: PortThresholds,
    /// The log and the writer of maps, if the array has zones.
    zones: Option<(ClassMapLog, ClassMapWriter)>,
    /// The results of the oracle since the last reset.
    history: Vec<OracleOutcome>,
}

impl SerialBench {
    pub(crate) fn new(recipe: &SerialParameters, traffic: SerialTraffic) -> Self {
        let clocks = recipe.frame_pixels() + recipe.steps_per_frame();
        let zones = |_| {
            let writer = ClassMapWriter::new(&recipe.base, clocks, traffic.seed);
            (ClassMapLog::new(&recipe.base), writer)
        };
        Self {
            rcm: SerialRcm::new(recipe.design().as_serial().unwrap()),
            zones: recipe.base.zones.as_ref().map(zones),
            history: Vec::new(),
            timeline: ExpectedTimeline::new(),
            traffic,
            random: SeededRandom(traffic.seed),
            edge: 0,
            last_edge: i64::MAX,
            noise: PortThresholds::of_camera(&recipe.design()),
            recipe: recipe.clone(),
        }
    }

    /// Stops the run at that edge, whatever is under way.
    pub(crate) fn stop_after(&mut self, edge: i64) {
        self.last_edge = edge;
    }

    fn is_over(&self) -> bool {
        self.edge >= self.last_edge
    }

    /// Feeds the frames, each until the array is ready again. It must then know the references and
    /// summaries for the next frame.
    pub(crate) fn run(&mut self, jobs: &[SerialStimulus]) -> SerialCheckResult {
        for job in jobs {
            let pause = self.random.below(self.traffic.max_pause + 1);
            self.change_ignored_thresholds();
            self.idle(pause, &self.noise.clone())?;
            self.feed(job)?;
            self.wait(&job.thresholds)?;
            if !self.is_over() && !self.history.is_empty() {
                check_memory(&self.recipe.base, &self.history, &self.rcm)?;
            }
        }
        self.idle(3, &self.noise.clone())
    }

    fn feed(&mut self, job: &SerialStimulus) -> SerialCheckResult {
        for (pixel, pixels) in job.pixels.iter().enumerate() {
            self.wait(&job.thresholds)?;
            while self.random.below(100) < self.traffic.gaps {
                self.idle(1, &job.thresholds)?;
            }
            if self.is_over() {
                return Ok(());
            }
            let last = pixel + 1 == job.pixels.len();
            let results = last.then(|| self.frame_results(job));
            self.timeline.take(&self.recipe, self.edge + 1, pixel as i64, results.as_deref());
            self.step(false, true, pixels, &job.thresholds)?;
        }
        Ok(())
    }

    /// Returns the results of a frame whose last pixel is taken at the next edge.
    fn frame_results(&mut self, job: &SerialStimulus) -> Vec<RegionResults> {
        match &job.expected {
            ResultSource::Given(results) => results.clone(),
            ResultSource::Oracle(recipe, frame) => {
                let first = *self.timeline.occupied.start();
                let map = self.zones.as_ref().map(|(log, _)| log.map_of_frame(first));
                let map = map.unwrap_or_default();
                add_to_history(&mut self.history, recipe, &map, frame);
                region_results(self.history.last().unwrap())
            }
        }
    }

    /// Waits until the array is ready again.
    fn wait(&mut self, thresholds: &PortThresholds) -> SerialCheckResult {
        while !self.timeline.is_ready(self.edge) && !self.is_over() {
            if self.traffic.skips && self.random.below(3) > 0 {
                let left = self.timeline.ready_from - self.edge;
                let longest = if self.random.below(2) == 0 { 9 } else { left + 2 };
                let clocks = 1 + self.random.below(longest);
                self.skip(clocks)?;
                continue;
            }
            let pushed = self.random.below(100) < self.traffic.pushing;
            let junk = self.ignored_pixels();
            self.step(false, pushed, &junk, thresholds)?;
        }
        Ok(())
    }

    fn idle(&mut self, clocks: i64, thresholds: &PortThresholds) -> SerialCheckResult {
        for _ in 0..clocks {
            if !self.is_over() {
                let junk = self.ignored_pixels();
                self.step(false, false, &junk, thresholds)?;
            }
        }
        Ok(())
    }

    pub(crate) fn reset(&mut self, valid: bool) -> SerialCheckResult {
        self.timeline.reset(self.edge + 1);
        self.history.clear();
        let junk = self.ignored_pixels();
        self.change_ignored_thresholds();
        self.step(true, valid, &junk, &self.noise.clone())
    }

    fn step(
        &mut self,
        reset: bool,
        valid: bool,
        pixels: &[u16],
        thresholds: &PortThresholds,
    ) -> SerialCheckResult {
        self.edge += 1;
        let map = self.map_inputs();
        let zones = self.zones.as_ref().map(|_| thresholds.zone_inputs(map));
        match &mut self.zones {
            Some((log, _)) if reset => log.push_reset(),
            Some((log, _)) => log.push(map, self.timeline.occupied.contains(&self.edge)),
            None => {}
        }
        let idle = CoreInput::idle(pixels, &thresholds.own);
        self.rcm.step(&CoreInput { reset, valid, zones, ..idle });
        self.compare()
    }

    /// Returns the inputs of the memory of classes at the current edge.
    fn map_inputs(&mut self) -> ClassMapInputs {
        let (first, last) = (*self.timeline.occupied.start(), *self.timeline.occupied.end());
        let is_inside = (first + 2..last - 1).contains(&self.edge);
        self.zones.as_mut().map(|(_, writer)| writer.next(!is_inside)).unwrap_or_default()
    }

    fn skip(&mut self, clocks: i64) -> SerialCheckResult {
        if let Some((log, _)) = &mut self.zones {
            for edge in self.edge + 1..=self.edge + clocks {
                log.push(ClassMapInputs::default(), self.timeline.occupied.contains(&edge));
            }
        }
        self.edge += clocks;
        self.rcm.skip(clocks as u64);
        self.compare()
    }

    fn compare(&self) -> SerialCheckResult {
        let (edge, output) = (self.edge, self.rcm.output());
        if output.ready != self.timeline.is_ready(edge) {
            return Err(format!("ready_o is {} after edge {edge}", output.ready));
        }
        let is_pending = self.zones.as_ref().is_some_and(|(log, _)| log.is_pending_after(edge));
        if output.zone_pending != is_pending {
            return Err(format!("zone_pending_o is {} after edge {edge}", output.zone_pending));
        }
        let (shown, expected) =
            (MeaningfulOutputs::from_output(output), self.timeline.outputs_after(edge));
        if shown != expected {
            return Err(format!("after edge {edge}: {shown:?}, due is {expected:?}"));
        }
        Ok(())
    }

    /// Changes the thresholds between frames, which the array must ignore.
    fn change_ignored_thresholds(&mut self) {
        self.noise = PortThresholds::random(&mut self.random);
    }

    /// Returns pixels that the array must ignore.
    fn ignored_pixels(&mut self) -> Vec<u16> {
        let top = self.recipe.base.pixel_max() + 1;
        let seed = self.random.below(top);
        let ports = 0..self.rcm.output().forward_valid.len() as i64;
        ports.map(|port| ((seed + port) % top) as u16).collect()
    }
}

/// Returns the pixels of a frame in the order of the ports. A lane with an empty slot gets the
/// pixels of another region.
fn port_pixels(recipe: &SerialParameters, frame: &Frame) -> Vec<Vec<u16>> {
    let design = recipe.design();
    let padded = pad(&design, frame).unwrap();
    if recipe.raster {
        return padded.pixels().iter().map(|&pixel| vec![pixel]).collect();
    }
    let stream = |region: i64| {
        let mut pixels = Vec::new();
        let anything = region.min(recipe.regions() - 1) as u32;
        region_stream(&design, frame, anything, &mut pixels);
        pixels
    };
    let streams: Vec<Vec<u16>> = (0..recipe.lanes() * recipe.fold).map(stream).collect();
    by_port(recipe, &streams)
}

/// Converts streams by region to the order of the lanes.
pub(crate) fn by_port(recipe: &SerialParameters, streams: &[Vec<u16>]) -> Vec<Vec<u16>> {
    let mut pixels = Vec::new();
    for slot in 0..recipe.fold {
        let lane = |lane: i64| &streams[(lane * recipe.fold + slot) as usize];
        let lanes: Vec<&Vec<u16>> = (0..recipe.lanes()).map(lane).collect();
        let at = |place| lanes.iter().map(|stream| stream[place]).collect();
        pixels.extend((0..streams[0].len()).map(at));
    }
    pixels
}
