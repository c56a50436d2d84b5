// SPDX-License-Identifier: MIT OR Apache-2.0
//! The public interface of the engine.

use foveate_camera::{Camera, RegionClass};
use foveate_pixels::Frame;

use crate::pixels::BorrowedFrame;
use crate::plan::{CameraPlan, index};
use crate::typed_engine::{KeptBuffers, TypedEngine};
use crate::workers::{MAX_THREADS, Workers};
use crate::{EngineError, FrameOutcome, InstructionSet};
use foveate_pixels::{ByteFrame, FramePixels};

/// The options of an engine. They do not change what it computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EngineOptions {
    /// The number of threads, the calling thread included, at most [`MAX_THREADS`]; 0 takes one per
    /// processor. A single frame of less than some ten thousand pixels is not worth dividing and
    /// stays on the calling thread. Several small frames in one call are divided.
    pub threads: usize,
    /// Permits the engine to skip regions that are bit-identical to the last frame.
    pub skips_identical_regions: bool,
    /// The vector instructions.
    pub level: InstructionSet,
}

impl Default for EngineOptions {
    /// Returns options for one thread, with skipping and the best instructions of this processor.
    fn default() -> Self {
        Self { threads: 1, skips_identical_regions: true, level: InstructionSet::detect() }
    }
}

#[derive(Debug)]
pub(crate) enum EngineCore {
    Bytes(TypedEngine<u8>),
    Words(TypedEngine<u16>),
}

impl EngineCore {
    /// Sets the classes of all regions, which have been checked.
    fn set_classes(&mut self, classes: &[RegionClass]) {
        match self {
            Self::Bytes(core) => core.set_classes(classes),
            Self::Words(core) => core.set_classes(classes),
        }
    }
}

/// An RCM with its renderer. It computes what the model's `FunctionalCamera` computes.
#[derive(Debug)]
pub struct Engine {
    pub(crate) camera: Camera,
    pub(crate) workers: Workers,
    pub(crate) core: EngineCore,
    pub(crate) outcome: FrameOutcome,
    /// The outcomes of the last batch, followed by unused ones if an earlier batch was longer.
    pub(crate) batch_outcomes: Vec<FrameOutcome>,
    /// The bytes of a frame that was given as words.
    narrowed_pixels: Vec<u8>,
}

impl Engine {
    /// Makes an engine in its reset state that runs on the calling thread.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let options = EngineOptions::default();
        Self::build(camera, options, Workers::calling_thread(options.level))
    }

    /// Makes an engine in its reset state that runs with these options.
    ///
    /// # Errors
    /// Fails if more than [`MAX_THREADS`] threads are asked for, or if the system cannot start
    /// them.
    pub fn with_options(camera: &Camera, options: EngineOptions) -> Result<Self, EngineError> {
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
        let thread_error = |error: rayon::ThreadPoolBuildError| EngineError::Threads {
            threads,
            reason: error.to_string(),
        };
        let workers = Workers::new(options.level, threads).map_err(thread_error)?;
        Ok(Self::build(camera, options, workers))
    }

    fn build(camera: &Camera, options: EngineOptions, workers: Workers) -> Self {
        let mut core = if camera.pixel_bits() <= 8 {
            EngineCore::Bytes(TypedEngine::new(
                CameraPlan::new(camera),
                options.skips_identical_regions,
            ))
        } else {
            EngineCore::Words(TypedEngine::new(
                CameraPlan::new(camera),
                options.skips_identical_regions,
            ))
        };
        let outcome = FrameOutcome::new(camera, index(camera.regions()));
        core.set_classes(&camera.configured_classes());
        Self {
            camera: camera.clone(),
            workers,
            core,
            outcome,
            batch_outcomes: Vec::new(),
            narrowed_pixels: Vec::new(),
        }
    }

    /// Returns the camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the vector instructions in use.
    #[must_use]
    pub fn level(&self) -> InstructionSet {
        self.workers.level
    }

    /// Sets the class of every region, numbered row by row, from the next frame on. A new
    /// engine has the classes of the configuration.
    ///
    /// # Errors
    /// Returns the errors of [`Camera::check_classes`]. The classes are then unchanged.
    pub fn set_classes(&mut self, classes: &[RegionClass]) -> Result<(), EngineError> {
        self.camera.check_classes(classes)?;
        self.core.set_classes(classes);
        Ok(())
    }

    /// Returns the class of every region in the next frame, or an empty slice for a camera without
    /// zones.
    #[must_use]
    pub fn classes(&self) -> &[RegionClass] {
        match &self.core {
            EngineCore::Bytes(core) => core.classes(),
            EngineCore::Words(core) => core.classes(),
        }
    }

    /// Returns the engine to its reset state, with a black screen and without references. The
    /// classes of the regions stay.
    pub fn reset(&mut self) {
        match &mut self.core {
            EngineCore::Bytes(core) => core.reset(),
            EngineCore::Words(core) => core.reset(),
        }
    }

    /// Forgets what a region has sent, because it was lost before it reached the receiver. If
    /// sending a region makes its reference, the region has no valid reference in the next frame,
    /// and the screen counts as showing no summary of it. [`Engine::rendered`] does not change.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    pub fn forget_region(&mut self, region: u32) {
        match &mut self.core {
            EngineCore::Bytes(core) => core.forget_region(region),
            EngineCore::Words(core) => core.forget_region(region),
        }
    }

    /// Takes the next frame in the model's type. This copies a frame of up to 8 bits per pixel;
    /// [`Engine::step_u8`] does not.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size and depth. The state is unchanged then.
    pub fn step(&mut self, frame: &Frame) -> Result<&FrameOutcome, EngineError> {
        self.check_size_and_depth((frame.width(), frame.height(), frame.bits()))?;
        let (width, height) = (index(frame.width()), index(frame.height()));
        let Self { workers, core, outcome, narrowed_pixels: narrow, .. } = self;
        match core {
            EngineCore::Bytes(core) => {
                // Every pixel fits into a byte; a conversion without a way to fail lets the loop
                // vectorise.
                let byte = |&pixel: &u16| u8::try_from(pixel).unwrap_or(u8::MAX);
                narrow.clear();
                narrow.extend(frame.pixels().iter().map(byte));
                let raw = BorrowedFrame { values: &narrow[..], stride: width, width, height };
                core.step(&[raw], workers, outcome, KeptBuffers::none());
            }
            EngineCore::Words(core) => {
                let raw = BorrowedFrame { values: frame.pixels(), stride: width, width, height };
                core.step(&[raw], workers, outcome, KeptBuffers::none());
            }
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame without copying it.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size and depth. The state is unchanged then.
    pub fn step_byte_frame(&mut self, frame: &ByteFrame) -> Result<&FrameOutcome, EngineError> {
        self.check_size_and_depth((frame.width(), frame.height(), frame.bits()))?;
        match frame.borrowed_pixels() {
            FramePixels::Bytes(pixels) => self.step_u8(pixels, index(frame.width())),
            FramePixels::Words(pixels) => self.step_u16(pixels, index(frame.width())),
        }
    }

    /// Takes the next frame, whose rows follow each other without a gap.
    ///
    /// # Errors
    /// Fails as [`Engine::check_pixels`] does. The state is unchanged then.
    pub fn step_pixels(&mut self, pixels: FramePixels<'_>) -> Result<&FrameOutcome, EngineError> {
        let width = index(self.camera.width());
        match pixels {
            FramePixels::Bytes(pixels) => self.step_u8(pixels, width),
            FramePixels::Words(pixels) => self.step_u16(pixels, width),
        }
    }

    /// Checks that pixels whose rows follow each other without a gap are a frame of the camera.
    ///
    /// # Errors
    /// Fails if the pixels have the wrong type or number, or if one of them is out of range.
    pub fn check_pixels(&self, pixels: FramePixels<'_>) -> Result<(), EngineError> {
        let width = index(self.camera.width());
        match (&self.core, pixels) {
            (EngineCore::Bytes(_), FramePixels::Bytes(pixels)) => {
                BorrowedFrame::new_checked(&self.camera, pixels, width).map(|_| ())
            }
            (EngineCore::Words(_), FramePixels::Words(pixels)) => {
                BorrowedFrame::new_checked(&self.camera, pixels, width).map(|_| ())
            }
            (EngineCore::Bytes(_), FramePixels::Words(_)) => {
                Err(self.wrong_pixel_type("u8", "u16"))
            }
            (EngineCore::Words(_), FramePixels::Bytes(_)) => {
                Err(self.wrong_pixel_type("u16", "u8"))
            }
        }
    }

    fn check_size_and_depth(&self, given: (u32, u32, u32)) -> Result<(), EngineError> {
        let expected = (self.camera.width(), self.camera.height(), self.camera.pixel_bits());
        if given == expected {
            return Ok(());
        }
        let description = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
        Err(EngineError::FrameSizeOrDepth {
            given: description(given),
            expected: description(expected),
        })
    }

    /// Takes the next frame of a camera with up to 8 bits per pixel without copying it. Its rows
    /// start `stride` bytes apart.
    ///
    /// # Errors
    /// Fails if the pixels are not a frame of the camera. The state is unchanged then.
    pub fn step_u8(&mut self, pixels: &[u8], stride: usize) -> Result<&FrameOutcome, EngineError> {
        let raw = BorrowedFrame::new_checked(&self.camera, pixels, stride)?;
        let Self { workers, core, outcome, .. } = self;
        match core {
            EngineCore::Bytes(core) => core.step(&[raw], workers, outcome, KeptBuffers::none()),
            EngineCore::Words(_) => return Err(self.wrong_pixel_type("u16", "u8")),
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame of a camera with 9 to 16 bits per pixel without copying it. Its rows
    /// start `stride` words apart.
    ///
    /// # Errors
    /// Fails if the pixels are not a frame of the camera. The state is unchanged then.
    pub fn step_u16(
        &mut self,
        pixels: &[u16],
        stride: usize,
    ) -> Result<&FrameOutcome, EngineError> {
        let raw = BorrowedFrame::new_checked(&self.camera, pixels, stride)?;
        let Self { workers, core, outcome, .. } = self;
        match core {
            EngineCore::Words(core) => core.step(&[raw], workers, outcome, KeptBuffers::none()),
            EngineCore::Bytes(_) => return Err(self.wrong_pixel_type("u8", "u16")),
        }
        Ok(&self.outcome)
    }

    pub(crate) fn wrong_pixel_type(
        &self,
        expected: &'static str,
        given: &'static str,
    ) -> EngineError {
        EngineError::PixelWidth { bits: self.camera.pixel_bits(), expected, given }
    }

    /// Returns the outcome of the last frame.
    #[must_use]
    pub fn outcome(&self) -> &FrameOutcome {
        &self.outcome
    }

    /// Returns the screen after the last frame.
    #[must_use]
    pub fn rendered(&self) -> FramePixels<'_> {
        match &self.core {
            EngineCore::Bytes(core) => FramePixels::Bytes(&core.screen),
            EngineCore::Words(core) => FramePixels::Words(&core.screen),
        }
    }

    /// Appends the denoised pixels of a region of the last frame, with its padding, in row-major
    /// order.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    pub fn denoised_region(&self, region: u32, pixels: &mut Vec<u16>) {
        match &self.core {
            EngineCore::Bytes(core) => core.denoised_region(region, pixels),
            EngineCore::Words(core) => core.denoised_region(region, pixels),
        }
    }

    /// Appends the means that a region sent last, row by row of blocks. Appends nothing if regions
    /// of this camera send no summaries.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    pub fn summary(&self, region: u32, means: &mut Vec<u16>) {
        match &self.core {
            EngineCore::Bytes(core) => core.summary(region, means),
            EngineCore::Words(core) => core.summary(region, means),
        }
    }
}
