// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine as its callers see it.

use foveate_camera::Camera;
use foveate_frame::Frame;

use crate::core::{Core, Keep};
use crate::pixels::Pixels;
use crate::plan::{CameraPlan, index};
use crate::workers::{MAX_THREADS, Workers};
use crate::{EngineError, FrameOutcome, Level};
use foveate_frame::{Plane, Raster};

/// How an engine runs; what it computes does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads, that of the caller among them, at most [`MAX_THREADS`]; 0 takes one per processor. Frames of fewer than some
    /// ten thousand pixels are not worth dividing, and stay on the thread of the caller unless several
    /// are given at once.
    pub threads: usize,
    /// Whether regions that are bit-identical to the last frame may be skipped.
    pub skip: bool,
    /// Vector instructions.
    pub level: Level,
}

impl Default for Options {
    /// One thread, skipping, the best instructions of this processor.
    fn default() -> Self {
        Self { threads: 1, skip: true, level: Level::detect() }
    }
}

#[derive(Debug)]
pub(crate) enum Lanes {
    Bytes(Core<u8>),
    Words(Core<u16>),
}

/// An RCM with its renderer: what the model's `FunctionalCamera` computes, fast.
#[derive(Debug)]
pub struct Engine {
    pub(crate) camera: Camera,
    pub(crate) workers: Workers,
    pub(crate) lanes: Lanes,
    pub(crate) outcome: FrameOutcome,
    /// Of a batch, and of longer ones before.
    pub(crate) outcomes: Vec<FrameOutcome>,
    /// A frame as bytes, where it came as words.
    narrow: Vec<u8>,
}

impl Engine {
    /// An engine that has seen nothing yet, on the thread that calls it.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let options = Options::default();
        Self::on(camera, options, Workers::alone(options.level))
    }

    /// An engine that runs as asked.
    ///
    /// # Errors
    /// When it asks for more than [`MAX_THREADS`], or the system does not give the threads.
    pub fn with_options(camera: &Camera, options: Options) -> Result<Self, EngineError> {
        if options.threads > MAX_THREADS {
            return Err(EngineError::TooManyThreads {
                threads: options.threads,
                most: MAX_THREADS,
            });
        }
        let threads = match options.threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let refused = |error: rayon::ThreadPoolBuildError| EngineError::Threads {
            threads,
            reason: error.to_string(),
        };
        let workers = Workers::new(options.level, threads).map_err(refused)?;
        Ok(Self::on(camera, options, workers))
    }

    fn on(camera: &Camera, options: Options, workers: Workers) -> Self {
        let lanes = if camera.pixel_bits() <= 8 {
            Lanes::Bytes(Core::new(CameraPlan::new(camera), options.skip))
        } else {
            Lanes::Words(Core::new(CameraPlan::new(camera), options.skip))
        };
        let outcome = FrameOutcome::new(camera.features().len(), index(camera.regions()));
        Self {
            camera: camera.clone(),
            workers,
            lanes,
            outcome,
            outcomes: Vec::new(),
            narrow: Vec::new(),
        }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The vector instructions in use.
    #[must_use]
    pub fn level(&self) -> Level {
        self.workers.level
    }

    /// Forgets every frame.
    pub fn reset(&mut self) {
        match &mut self.lanes {
            Lanes::Bytes(core) => core.reset(),
            Lanes::Words(core) => core.reset(),
        }
    }

    /// Takes the next frame from the model's type. Up to 8 bits this copies it;
    /// [`Engine::step_u8`] does not.
    ///
    /// # Errors
    /// When the frame is not of the camera's size and depth; nothing has changed then.
    pub fn step(&mut self, frame: &Frame) -> Result<&FrameOutcome, EngineError> {
        self.check_kind((frame.width(), frame.height(), frame.bits()))?;
        let (width, height) = (index(frame.width()), index(frame.height()));
        let Self { workers, lanes, outcome, narrow, .. } = self;
        match lanes {
            Lanes::Bytes(core) => {
                // No pixel of up to 8 bits is cut; without a way to fail the loop stays one of vectors.
                let byte = |&pixel: &u16| u8::try_from(pixel).unwrap_or(u8::MAX);
                narrow.clear();
                narrow.extend(frame.pixels().iter().map(byte));
                let raw = Pixels { values: &narrow[..], stride: width, width, height };
                core.step(&[raw], workers, outcome, Keep::nothing());
            }
            Lanes::Words(core) => {
                let raw = Pixels { values: frame.pixels(), stride: width, width, height };
                core.step(&[raw], workers, outcome, Keep::nothing());
            }
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame where it lies.
    ///
    /// # Errors
    /// When the frame is not of the camera's size and depth; nothing has changed then.
    pub fn step_raster(&mut self, frame: &Raster) -> Result<&FrameOutcome, EngineError> {
        self.check_kind((frame.width(), frame.height(), frame.bits()))?;
        match frame.plane() {
            Plane::Bytes(pixels) => self.step_u8(pixels, index(frame.width())),
            Plane::Words(pixels) => self.step_u16(pixels, index(frame.width())),
        }
    }

    fn check_kind(&self, given: (u32, u32, u32)) -> Result<(), EngineError> {
        let expected = (self.camera.width(), self.camera.height(), self.camera.pixel_bits());
        if given == expected {
            return Ok(());
        }
        let kind = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
        Err(EngineError::FrameKind { given: kind(given), expected: kind(expected) })
    }

    /// Takes the next frame of a camera with up to 8 bits per pixel, where it lies: rows of bytes,
    /// `stride` apart.
    ///
    /// # Errors
    /// When that is no frame of the camera; nothing has changed then.
    pub fn step_u8(&mut self, pixels: &[u8], stride: usize) -> Result<&FrameOutcome, EngineError> {
        let raw = Pixels::checked(&self.camera, pixels, stride)?;
        let Self { workers, lanes, outcome, .. } = self;
        match lanes {
            Lanes::Bytes(core) => core.step(&[raw], workers, outcome, Keep::nothing()),
            Lanes::Words(_) => return Err(self.wrong_lanes("u16", "u8")),
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame of a camera with 9 to 16 bits per pixel, where it lies.
    ///
    /// # Errors
    /// When that is no frame of the camera; nothing has changed then.
    pub fn step_u16(
        &mut self,
        pixels: &[u16],
        stride: usize,
    ) -> Result<&FrameOutcome, EngineError> {
        let raw = Pixels::checked(&self.camera, pixels, stride)?;
        let Self { workers, lanes, outcome, .. } = self;
        match lanes {
            Lanes::Words(core) => core.step(&[raw], workers, outcome, Keep::nothing()),
            Lanes::Bytes(_) => return Err(self.wrong_lanes("u8", "u16")),
        }
        Ok(&self.outcome)
    }

    pub(crate) fn wrong_lanes(&self, expected: &'static str, given: &'static str) -> EngineError {
        EngineError::LaneWidth { bits: self.camera.pixel_bits(), expected, given }
    }

    /// What the last frame has led to.
    #[must_use]
    pub fn outcome(&self) -> &FrameOutcome {
        &self.outcome
    }

    /// What is on the screen after the last frame.
    #[must_use]
    pub fn rendered(&self) -> Plane<'_> {
        match &self.lanes {
            Lanes::Bytes(core) => Plane::Bytes(&core.screen),
            Lanes::Words(core) => Plane::Words(&core.screen),
        }
    }

    /// Appends the denoised pixels of a region in the last frame, with its padding, row by row.
    ///
    /// # Panics
    /// When the camera has no such region.
    pub fn denoised_region(&self, region: u32, pixels: &mut Vec<u16>) {
        match &self.lanes {
            Lanes::Bytes(core) => core.denoised_region(region, pixels),
            Lanes::Words(core) => core.denoised_region(region, pixels),
        }
    }

    /// Appends the means that a region has sent last, row by row of blocks; nothing where regions send none.
    ///
    /// # Panics
    /// When the camera has no such region.
    pub fn summary(&self, region: u32, means: &mut Vec<u16>) {
        match &self.lanes {
            Lanes::Bytes(core) => core.summary(region, means),
            Lanes::Words(core) => core.summary(region, means),
        }
    }
}
