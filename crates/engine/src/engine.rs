// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine as its callers see it.

use foveate_model::Frame;
use foveate_spec::Design;

use crate::core::Core;
use crate::pixels::Pixels;
use crate::plan::{Plan, index};
use crate::workers::Workers;
use crate::{EngineError, Level, Outcome};
use foveate_lanes::Lane;

/// How an engine runs; what it computes does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Threads, that of the caller among them; 0 takes one per processor. Frames of fewer than some
    /// ten thousand pixels are not worth dividing, and stay on the thread of the caller.
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

/// What is on the screen, without padding, row by row with nothing between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rendered<'a> {
    /// Of a design with up to 8 bits per pixel.
    Bytes(&'a [u8]),
    /// Of a design with more.
    Words(&'a [u16]),
}

#[derive(Debug)]
enum Lanes {
    Bytes(Core<u8>),
    Words(Core<u16>),
}

/// An RCM with its renderer: what [`foveate_model::Camera`] computes, fast.
#[derive(Debug)]
pub struct Engine {
    design: Design,
    workers: Workers,
    lanes: Lanes,
    outcome: Outcome,
    /// A frame as bytes, where it came as words.
    narrow: Vec<u8>,
}

impl Engine {
    /// An engine that has seen nothing yet, on the thread that calls it.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let options = Options::default();
        Self::on(design, options, Workers::alone(options.level))
    }

    /// An engine that runs as asked.
    ///
    /// # Errors
    /// When the system does not give the threads.
    pub fn with_options(design: &Design, options: Options) -> Result<Self, EngineError> {
        let threads = match options.threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        let refused = |error: rayon::ThreadPoolBuildError| EngineError::Threads {
            threads,
            reason: error.to_string(),
        };
        let workers = Workers::new(options.level, threads).map_err(refused)?;
        Ok(Self::on(design, options, workers))
    }

    fn on(design: &Design, options: Options, workers: Workers) -> Self {
        let lanes = if design.pixel_bits() <= 8 {
            Lanes::Bytes(Core::new(Plan::new(design), options.skip, &workers))
        } else {
            Lanes::Words(Core::new(Plan::new(design), options.skip, &workers))
        };
        let outcome = Outcome::new(design.features().len(), index(design.regions()));
        Self { design: design.clone(), workers, lanes, outcome, narrow: Vec::new() }
    }

    /// The design.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
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
    /// When the frame is not of the design's size and depth; nothing has changed then.
    pub fn step(&mut self, frame: &Frame) -> Result<&Outcome, EngineError> {
        let expected = (self.design.width(), self.design.height(), self.design.pixel_bits());
        let given = (frame.width(), frame.height(), frame.bits());
        if given != expected {
            let kind = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
            return Err(EngineError::FrameKind { given: kind(given), expected: kind(expected) });
        }
        let (width, height) = (index(frame.width()), index(frame.height()));
        let Self { workers, lanes, outcome, narrow, .. } = self;
        match lanes {
            Lanes::Bytes(core) => {
                let byte = |&pixel: &u16| u8::try_from(pixel).unwrap_or(u8::MAX);
                narrow.clear();
                narrow.extend(frame.pixels().iter().map(byte));
                let raw = Pixels { values: &narrow[..], stride: width, width, height };
                core.step(raw, workers, outcome);
            }
            Lanes::Words(core) => {
                let raw = Pixels { values: frame.pixels(), stride: width, width, height };
                core.step(raw, workers, outcome);
            }
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame of a design with up to 8 bits per pixel, where it lies: rows of bytes,
    /// `stride` apart.
    ///
    /// # Errors
    /// When that is no frame of the design; nothing has changed then.
    pub fn step_u8(&mut self, pixels: &[u8], stride: usize) -> Result<&Outcome, EngineError> {
        let raw = checked(&self.design, pixels, stride)?;
        match &mut self.lanes {
            Lanes::Bytes(core) => core.step(raw, &self.workers, &mut self.outcome),
            Lanes::Words(_) => return Err(self.wrong_lanes("u16", "u8")),
        }
        Ok(&self.outcome)
    }

    /// Takes the next frame of a design with 9 to 16 bits per pixel, where it lies.
    ///
    /// # Errors
    /// When that is no frame of the design; nothing has changed then.
    pub fn step_u16(&mut self, pixels: &[u16], stride: usize) -> Result<&Outcome, EngineError> {
        let raw = checked(&self.design, pixels, stride)?;
        match &mut self.lanes {
            Lanes::Words(core) => core.step(raw, &self.workers, &mut self.outcome),
            Lanes::Bytes(_) => return Err(self.wrong_lanes("u8", "u16")),
        }
        Ok(&self.outcome)
    }

    fn wrong_lanes(&self, expected: &'static str, given: &'static str) -> EngineError {
        EngineError::LaneWidth { bits: self.design.pixel_bits(), expected, given }
    }

    /// What the last frame has led to.
    #[must_use]
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// What is on the screen after the last frame.
    #[must_use]
    pub fn rendered(&self) -> Rendered<'_> {
        match &self.lanes {
            Lanes::Bytes(core) => Rendered::Bytes(&core.screen),
            Lanes::Words(core) => Rendered::Words(&core.screen),
        }
    }
}

impl Rendered<'_> {
    /// The pixels as words, copied: what [`Frame`] holds.
    #[must_use]
    pub fn to_words(self) -> Vec<u16> {
        match self {
            Self::Bytes(pixels) => pixels.iter().map(|&pixel| pixel.into()).collect(),
            Self::Words(pixels) => pixels.to_vec(),
        }
    }
}

/// The pixels as a frame of the design.
fn checked<'a, T: Lane>(
    design: &Design,
    values: &'a [T],
    stride: usize,
) -> Result<Pixels<'a, T>, EngineError> {
    let (width, height) = (index(design.width()), index(design.height()));
    let needed = (height - 1).saturating_mul(stride.max(width)).saturating_add(width);
    if stride < width || values.len() < needed {
        let given = values.len();
        return Err(EngineError::FrameLength { given, stride, width, height, needed });
    }
    let raw = Pixels { values, stride, width, height };
    let max = u64::from(design.pixel_max());
    // Where the type holds no more than the bits, there is nothing to look for.
    let rows = if max < T::MAX.into() { 0..height } else { 0..0 };
    for y in rows {
        let largest = raw.row(y).iter().copied().fold(T::default(), T::max);
        if largest.into() > max {
            let x = raw.row(y).iter().position(|&pixel| pixel == largest).unwrap_or_default();
            let (bits, max) = (design.pixel_bits(), design.pixel_max());
            return Err(EngineError::PixelRange { x, y, value: largest.into(), bits, max });
        }
    }
    Ok(raw)
}
