// SPDX-License-Identifier: MIT OR Apache-2.0
//! One camera of a page: it takes frames and holds the results of the last one.

use foveate_camera::{RegionAction, RegionClass};
use foveate_design::Design;
use foveate_engine::{Engine, EventFrame, EventTable, RegionStateBefore};
use foveate_model::{
    FunctionalCamera, RegionMemory,
    explanation::{self, RegionExplanation},
};
use foveate_pixels::{Frame, FramePixels, append_luma_of_rgba};
use serde::Serialize;

use super::limits::MAX_RECORDING;
use crate::WebError;
use crate::pixels::{CameraPixels, DepthConversion};
use crate::recording::{Recording, RecordingState};

/// A camera that is shown frames.
#[derive(Debug)]
pub struct LiveCamera {
    design: Design,
    engine: Engine,
    depth: DepthConversion,
    /// The number of frames so far.
    frames: u64,
    /// The time of the last frame in microseconds.
    last_time_us: u64,
    recording: Option<Recording>,
    grey: Vec<u8>,
    pixels: CameraPixels,
    input: Vec<u8>,
    screen: Vec<u8>,
    regions: Vec<u8>,
    /// The classes of the regions in the last frame; empty for a camera without zones.
    frame_classes: Vec<RegionClass>,
    displacements: Vec<i8>,
}

/// The number of regions with each action.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ActionCounts {
    /// Regions whose pixels are sent.
    pub forward: u32,
    /// Regions whose screen stays.
    pub hold: u32,
    /// Regions whose screen becomes black.
    pub blank: u32,
    /// Regions whose means are sent.
    pub summarize: u32,
}

/// Figures of one frame: the decisions, and the pixels and means that follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct FrameSummary {
    /// The number of the frame, from 0 on since the camera was configured or reset.
    pub number: u64,
    /// The number of active regions.
    pub active: u32,
    /// The regions by action.
    pub actions: ActionCounts,
    /// The number of bits that are sent, as `foveate simulate` counts them.
    pub bits: u64,
    /// The number of regions that were not computed, because nothing had changed in them.
    pub skipped: usize,
    /// The number of regions with SRS.
    pub srs: u32,
    /// The number of regions with TRS.
    pub trs: u32,
    /// The state of the recording, if there is one.
    pub recording: Option<RecordingState>,
}

impl LiveCamera {
    pub(crate) fn new(design: Design) -> Self {
        let depth = DepthConversion::new(design.pixel_bits());
        let mut camera = Self {
            engine: Engine::new(&design),
            frames: 0,
            last_time_us: 0,
            recording: None,
            grey: Vec::new(),
            pixels: depth.empty_pixels(),
            input: Vec::new(),
            screen: Vec::new(),
            regions: Vec::new(),
            frame_classes: Vec::new(),
            displacements: Vec::new(),
            depth,
            design,
        };
        camera.engine.set_state_copying(true);
        camera.clear_frame();
        camera
    }

    /// Returns the camera, and the hardware that would compute it.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Returns the engine of the camera.
    #[must_use]
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// Forgets all frames. A recording begins again.
    pub fn reset(&mut self) {
        self.engine.reset();
        self.frames = 0;
        if let Some(recording) = &mut self.recording {
            *recording = recording.emptied();
        }
        self.clear_frame();
    }

    /// Sets the class of every region from the next frame on, and in the configuration of the camera.
    /// `codes` has a byte per region, the number of its class. References and the screen stay.
    ///
    /// # Errors
    /// Fails if a number is not that of a class, if there is not one per region, or if the camera has
    /// no zones. Nothing has changed then.
    pub fn set_classes(&mut self, codes: &[u8]) -> Result<(), WebError> {
        let class = |(region, &code)| {
            RegionClass::from_code(code).ok_or(WebError::NoSuchClass { region, code })
        };
        let classes: Vec<_> = codes.iter().enumerate().map(class).collect::<Result<_, _>>()?;
        self.engine.set_classes(&classes)?;
        let mut config = self.design.config().clone();
        if let Some(zones) = &mut config.camera.zones {
            zones.set_classes(&classes, self.design.columns());
            self.design = config.validate()?;
        }
        Ok(())
    }

    /// Makes the screen and the input black and removes all decisions, as before the first frame.
    fn clear_frame(&mut self) {
        let pixels = self.design.width() as usize * self.design.height() as usize;
        for plane in [&mut self.input, &mut self.screen] {
            plane.clear();
            plane.resize(pixels, 0);
        }
        self.regions.clear();
        self.regions.resize(self.design.regions() as usize, 0);
        self.displacements.clear();
    }

    /// Takes a frame of 8-bit grey, a byte per pixel. `time_us` is the time since the first frame
    /// in microseconds; without it, there are 30 frames per second.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size. Nothing has changed then.
    pub fn step_grey(
        &mut self,
        frame: &[u8],
        time_us: Option<u64>,
    ) -> Result<FrameSummary, WebError> {
        self.check_length(frame, 1)?;
        self.grey.clear();
        self.grey.extend_from_slice(frame);
        self.step(time_us)
    }

    /// Takes a frame in colour, four bytes per pixel, as a canvas has it.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size. Nothing has changed then.
    pub fn step_rgba(
        &mut self,
        frame: &[u8],
        time_us: Option<u64>,
    ) -> Result<FrameSummary, WebError> {
        self.check_length(frame, 4)?;
        self.grey.clear();
        append_luma_of_rgba(frame, &mut self.grey);
        self.step(time_us)
    }

    fn check_length(&self, frame: &[u8], each: usize) -> Result<(), WebError> {
        let (width, height) = (self.design.width(), self.design.height());
        let needed = width as usize * height as usize * each;
        if frame.len() == needed {
            return Ok(());
        }
        Err(WebError::FrameLength { given: frame.len(), needed, each, width, height })
    }

    /// Shows the engine the frame in `grey`.
    fn step(&mut self, time_us: Option<u64>) -> Result<FrameSummary, WebError> {
        let stride = self.design.width() as usize;
        self.frame_classes.clear();
        self.frame_classes.extend_from_slice(self.engine.classes());
        self.depth.to_camera(&self.grey, &mut self.pixels);
        match &self.pixels {
            CameraPixels::Bytes(pixels) => self.engine.step_u8(pixels, stride)?,
            CameraPixels::Words(pixels) => self.engine.step_u16(pixels, stride)?,
        };
        self.depth.to_grey(self.pixels.plane(), &mut self.input);
        self.depth.to_grey(self.engine.rendered(), &mut self.screen);
        self.regions.clear();
        self.regions.extend(self.engine.outcome().region_bytes());
        self.list_displacements();
        let (camera, number, outcome) = (&*self.design, self.frames, self.engine.outcome());
        self.last_time_us = time_us.unwrap_or((number * 1_000_000 + 15) / 30);
        if let Some(recording) = &mut self.recording {
            let moment = EventFrame { camera, number, time_us: self.last_time_us, outcome };
            recording.push(&moment, MAX_RECORDING);
        }
        self.frames += 1;
        Ok(self.frame_summary())
    }

    /// Lists the displacements of the last frame, each with the vote of its feature.
    fn list_displacements(&mut self) {
        self.displacements.clear();
        let outcome = self.engine.outcome();
        let mut features = self.design.features().iter().zip(&outcome.scores);
        let found = features.find(|(feature, _)| feature.kind().is_displacement());
        let Some((feature, scores)) = found else { return };
        for (displacement, &score) in outcome.displacements.iter().zip(scores) {
            let vote = i8::from(score >= feature.min_score());
            self.displacements.extend([displacement.dx, displacement.dy, vote]);
        }
    }

    /// Begins to record the results of every frame, for all regions or only for those that send
    /// something. With `on` false it ends the recording and forgets it.
    pub fn set_recording(&mut self, on: bool, only_active: bool) {
        let table = || EventTable::new(&self.design, only_active);
        self.recording = on.then(|| Recording::new(table()));
    }

    /// Returns the recording as `events.csv`.
    ///
    /// # Errors
    /// Fails if nothing is recorded.
    pub fn recorded_events(&self) -> Result<&[u8], WebError> {
        self.recording.as_ref().map(Recording::csv).ok_or(WebError::NotRecording)
    }

    /// Explains why the region in column `x` and row `y` of the last frame, called `name`, was sent
    /// or not.
    ///
    /// # Errors
    /// Fails if there was no frame yet, or if there is no such region.
    pub fn explain(&self, (x, y): (u32, u32), name: &str) -> Result<RegionExplanation, WebError> {
        let design = &self.design;
        let (columns, rows) = (design.columns(), design.rows());
        if x >= columns || y >= rows {
            return Err(WebError::NoSuchRegion { x, y, columns, rows });
        }
        let shown = self.engine.rendered_before().ok_or(WebError::NoFrameYet)?;
        let frame = |pixels| {
            Frame::new(design.width(), design.height(), design.pixel_bits(), pixels)
                .expect("what an engine holds are frames of its camera")
        };
        let remembered = |region| {
            let RegionStateBefore { reference, summary } =
                self.engine.region_state_before(region).unwrap_or_default();
            RegionMemory { reference, summary }
        };
        let region = y * columns + x;
        let mut model = FunctionalCamera::resume(design, &frame(shown.to_words()), remembered)?;
        if design.zones().is_some() {
            model.set_classes(&self.frame_classes)?;
        }
        let before = model.region_memory(region);
        let outcome = model.step(&frame(self.pixels.plane().to_words()))?;
        let moment = explanation::FrameIdentification {
            number: self.frames - 1,
            name,
            t_us: self.last_time_us,
        };
        Ok(RegionExplanation::from_outcome(design, moment, region, before, outcome))
    }

    fn frame_summary(&self) -> FrameSummary {
        let (design, outcome) = (&self.design, self.engine.outcome());
        let mut actions = ActionCounts::default();
        for action in &outcome.actions {
            *match action {
                RegionAction::Forward => &mut actions.forward,
                RegionAction::Hold => &mut actions.hold,
                RegionAction::Blank => &mut actions.blank,
                RegionAction::Summarize => &mut actions.summarize,
            } += 1;
        }
        let count = |bits: &[bool]| bits.iter().map(|&bit| u32::from(bit)).sum();
        FrameSummary {
            number: self.frames - 1,
            active: count(&outcome.active),
            actions,
            bits: design.bits_sent(1, design.values_sent_per_frame(&outcome.actions)),
            skipped: outcome.skipped,
            srs: count(&outcome.srs),
            trs: count(&outcome.trs),
            recording: self.recording.as_ref().map(Recording::recording_state),
        }
    }

    /// Returns the last frame as the camera has seen it, in pixels of P bits; empty before the
    /// first frame.
    #[must_use]
    pub fn pixels(&self) -> FramePixels<'_> {
        self.pixels.plane()
    }

    /// Returns the last frame as the camera has seen it, as 8-bit grey.
    #[must_use]
    pub fn input(&self) -> &[u8] {
        &self.input
    }

    /// Returns the receiver's screen after the last frame, as 8-bit grey.
    #[must_use]
    pub fn screen(&self) -> &[u8] {
        &self.screen
    }

    /// Returns a byte per region, as [`foveate_engine::FrameOutcome::region_bytes`] packs them.
    #[must_use]
    pub fn regions(&self) -> &[u8] {
        &self.regions
    }

    /// Returns three numbers per region: the columns to the right and the rows down by which its
    /// content has moved, and 1 if `flow` votes. It is empty for a camera without `flow`, and before
    /// the first frame.
    #[must_use]
    pub fn displacements(&self) -> &[i8] {
        &self.displacements
    }

    /// Returns the scores of a feature, region by region.
    ///
    /// # Errors
    /// Fails if the camera has no such feature.
    pub fn scores(&self, feature: u32) -> Result<&[u64], WebError> {
        let scores = &self.engine.outcome().scores;
        let none = WebError::NoSuchFeature { index: feature, count: scores.len() };
        scores.get(feature as usize).map(Vec::as_slice).ok_or(none)
    }
}
