// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of comparisons. Every message names its subject and says what would be right.

use std::io;
use std::path::{Path, PathBuf};

use foveate_camera::ConfigError;
use foveate_measure::FidelityError;
use foveate_media::PlaybackError;
use foveate_output::chart::ChartError;
use foveate_pixels::FrameError;
use foveate_simulator::SimulatorError;
use foveate_timed::TimedError;
use foveate_tools::{StagingError, ToolError};
use thiserror::Error;

/// An error that keeps a comparison from starting or finishing; nothing is written then.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum LinkError {
    /// The clips cannot be played, or the user stopped the comparison.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// A frame has another size than the camera.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A decoded frame has another size than the input.
    #[error(transparent)]
    Fidelity(#[from] FidelityError),
    /// The pixel camera cannot be created.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// The timed model of the array cannot take a frame.
    #[error(transparent)]
    Timed(#[from] TimedError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// The tool ffmpeg is missing or failed.
    #[error(transparent)]
    Tool(ToolError),
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// A table cannot be written.
    #[error("cannot write the table `{name}`: {source}")]
    Table { name: &'static str, source: io::Error },
    /// A temporary file cannot be used.
    #[error("cannot {action} `{}`: {source}; check free space, or set TMPDIR to another folder", path.display())]
    Scratch { action: &'static str, path: PathBuf, source: io::Error },
    /// An input is a data set, whose frames have no order.
    #[error(
        "`{name}` is a set of unrelated images, which have no rate; give a clip, for example with --images clip"
    )]
    DataSet { name: String },
    /// A clip has fewer than two frames.
    #[error("`{clip}` has {frames} frame, which has no rate; at least 2 frames are needed")]
    TooFewFrames { clip: String, frames: u64 },
    /// The times of the frames do not rise.
    #[error(
        "frame {frame} of `{clip}` is at {time_us} us, not after the frame before it; give increasing times, for example with --input-fps"
    )]
    TimesNotRising { clip: String, frame: usize, time_us: u64 },
    /// The times of a clip span more than the clocks of a link can count.
    #[error(
        "`{clip}` lasts {seconds} s, but a link is timed for at most 9223372036 s, which is 292 years; check the unit \
         of its times, for example --timestamp-unit"
    )]
    TooLong { clip: String, seconds: u64 },
    /// The codecs do not support this depth.
    #[error(
        "the design has {bits} bits per pixel, but codecs are compared at 8; set frame.pixel_bits = 8"
    )]
    UnsupportedDepth { bits: u32 },
    /// The design sends no pixels.
    #[error(
        "no pixels leave a design with hardware.forward = false, so it sends nothing over a link; leave the key out"
    )]
    NoPixels,
    /// The design is too slow for the frame rate.
    #[error(
        "`{clip}` has a frame every {interval_ns} ns, but the design needs {needed_ns} ns for one at {clock_hz} Hz; give a faster --clock, or a design that takes fewer clocks"
    )]
    TooSlow { clip: String, interval_ns: u64, needed_ns: u64, clock_hz: u64 },
    /// The build of ffmpeg lacks an encoder.
    #[error(
        "ffmpeg has no encoder `{encoder}`; install a build that has it, or leave `{codec}` out of --codecs"
    )]
    NoEncoder { encoder: &'static str, codec: &'static str },
    /// An encoder does not support the frames.
    #[error(
        "the encoder `{encoder}` does not take `{clip}` of {width}x{height} pixels: {message}; give frames of another size with --resize, or leave `{codec}` out of --codecs"
    )]
    EncoderRefused {
        encoder: &'static str,
        codec: &'static str,
        clip: String,
        width: u32,
        height: u32,
        message: String,
    },
    /// An encoder or decoder lost frames.
    #[error("{codec} at {quantizer} gave {found} of {expected} frames of `{clip}`; {message}")]
    LostFrames {
        codec: &'static str,
        quantizer: u32,
        clip: String,
        found: u64,
        expected: u64,
        message: String,
    },
}

impl From<ToolError> for LinkError {
    fn from(error: ToolError) -> Self {
        if error.is_interrupted() { PlaybackError::Interrupted.into() } else { Self::Tool(error) }
    }
}

/// Returns a function that adds a temporary file's path to an error of the system.
pub(crate) fn scratch_error(
    action: &'static str,
    path: &Path,
) -> impl Fn(io::Error) -> LinkError + use<> {
    let path = path.to_owned();
    move |source| LinkError::Scratch { action, path: path.clone(), source }
}
