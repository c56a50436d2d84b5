// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong. Every message names the thing and says what would be right.

use std::io;
use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_fidelity::FidelityError;
use foveate_footage::FootageError;
use foveate_frame::FrameError;
use foveate_pictures::chart::ChartError;
use foveate_simulator::SimulatorError;
use foveate_staging::StagingError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// A comparison that cannot be started or finished; nothing is written then.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LinkError {
    /// An input cannot be read.
    #[error(transparent)]
    Footage(FootageError),
    /// The configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A frame of another size.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A decoded frame of another size.
    #[error(transparent)]
    Fidelity(#[from] FidelityError),
    /// The pixel camera cannot be made.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// ffmpeg is missing or failed.
    #[error(transparent)]
    Tool(ToolError),
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// A table cannot be written.
    #[error("cannot write the table `{name}`: {source}")]
    Table {
        /// The file.
        name: &'static str,
        /// Why.
        source: io::Error,
    },
    /// A temporary file cannot be used.
    #[error("cannot {action} `{}`: {source}; check free space, or set TMPDIR to another folder", path.display())]
    Scratch {
        /// What was tried.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Images without order.
    #[error(
        "`{name}` is a set of unrelated images, which have no rate; `link` needs clips, for example with --images clip"
    )]
    Set {
        /// The input.
        name: String,
    },
    /// A clip without an interval.
    #[error("`{clip}` has {frames} frame, which makes no rate; at least 2 are needed")]
    OneFrame {
        /// The clip.
        clip: String,
        /// How many it has.
        frames: u64,
    },
    /// Frames that do not follow each other.
    #[error(
        "frame {frame} of `{clip}` is at {time_us} us, not after the frame before it; give times that rise, for example with --input-fps"
    )]
    Times {
        /// The clip.
        clip: String,
        /// The frame.
        frame: usize,
        /// Its time.
        time_us: u64,
    },
    /// Pixels that codecs do not take.
    #[error(
        "the design has {bits} bits per pixel, but codecs are compared with 8; set frame.pixel_bits = 8"
    )]
    Depth {
        /// Bits per pixel.
        bits: u32,
    },
    /// A design that sends nothing.
    #[error(
        "no pixels leave a design with hardware.forward = false, so it sends nothing over a link; leave the key out"
    )]
    NoPixels,
    /// A design that cannot follow its frames.
    #[error(
        "`{clip}` has a frame every {interval_ns} ns, but the design needs {needed_ns} ns for one at {clock_hz} Hz; give a faster --clock, or a design that takes fewer clocks"
    )]
    TooSlow {
        /// The clip.
        clip: String,
        /// The shortest time between two frames.
        interval_ns: u64,
        /// What the design needs.
        needed_ns: u64,
        /// The clock.
        clock_hz: u64,
    },
    /// ffmpeg was built without an encoder.
    #[error(
        "ffmpeg has no encoder `{encoder}`; install a build that has it, or leave `{codec}` out of --codecs"
    )]
    NoEncoder {
        /// The encoder.
        encoder: &'static str,
        /// The codec that needs it.
        codec: &'static str,
    },
    /// An encoder does not take the frames.
    #[error(
        "the encoder `{encoder}` does not take `{clip}` of {width}x{height} pixels: {said}; give frames of another size with --resize, or leave `{codec}` out of --codecs"
    )]
    Refused {
        /// The encoder.
        encoder: &'static str,
        /// The codec that needs it.
        codec: &'static str,
        /// The clip.
        clip: String,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// What the encoder said.
        said: String,
    },
    /// An encoder or decoder lost frames.
    #[error("{codec} at {quantizer} gave {found} of {expected} frames of `{clip}`; {said}")]
    Frames {
        /// The codec.
        codec: &'static str,
        /// Its quantizer.
        quantizer: u32,
        /// The clip.
        clip: String,
        /// Frames that came.
        found: u64,
        /// Frames that should have come.
        expected: u64,
        /// What ffmpeg said.
        said: String,
    },
    /// The user stopped it.
    #[error("interrupted; nothing was written")]
    Cancelled,
}

impl From<ToolError> for LinkError {
    fn from(error: ToolError) -> Self {
        if error.is_interrupted() { Self::Cancelled } else { Self::Tool(error) }
    }
}

impl From<FootageError> for LinkError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Cancelled,
            error => Self::Footage(error),
        }
    }
}
