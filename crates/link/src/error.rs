// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of comparisons. Every message names its subject and says what would be right.

use std::io;
use std::path::{Path, PathBuf};

use foveate_design::ConfigError;
use foveate_fidelity::FidelityError;
use foveate_frame::FrameError;
use foveate_pictures::chart::ChartError;
use foveate_playback::PlaybackError;
use foveate_simulator::SimulatorError;
use foveate_staging::StagingError;
use foveate_timed::TimedError;
use foveate_toolchain::ToolError;
use thiserror::Error;

/// An error that keeps a comparison from starting or finishing; nothing is written then.
#[derive(Debug, Error)]
#[non_exhaustive]
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
    Table {
        /// The name of the file.
        name: &'static str,
        /// The reason.
        source: io::Error,
    },
    /// A temporary file cannot be used.
    #[error("cannot {action} `{}`: {source}; check free space, or set TMPDIR to another folder", path.display())]
    Scratch {
        /// The action that failed, as a verb.
        action: &'static str,
        /// The path of the file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// An input is a data set, whose frames have no order.
    #[error(
        "`{name}` is a set of unrelated images, which have no rate; give a clip, for example with --images clip"
    )]
    DataSet {
        /// The name of the input.
        name: String,
    },
    /// A clip has fewer than two frames.
    #[error("`{clip}` has {frames} frame, which has no rate; at least 2 frames are needed")]
    TooFewFrames {
        /// The name of the clip.
        clip: String,
        /// The number of frames of the clip.
        frames: u64,
    },
    /// The times of the frames do not rise.
    #[error(
        "frame {frame} of `{clip}` is at {time_us} us, not after the frame before it; give increasing times, for example with --input-fps"
    )]
    TimesNotRising {
        /// The name of the clip.
        clip: String,
        /// The number of the frame.
        frame: usize,
        /// The time of the frame in microseconds.
        time_us: u64,
    },
    /// The times of a clip span more than the clocks of a link can count.
    #[error(
        "`{clip}` lasts {seconds} s, but a link is timed for at most 9223372036 s, which is 292 years; check the unit \
         of its times, for example --timestamp-unit"
    )]
    TooLong {
        /// The name of the clip.
        clip: String,
        /// The duration in seconds, rounded down.
        seconds: u64,
    },
    /// The codecs do not support this depth.
    #[error(
        "the design has {bits} bits per pixel, but codecs are compared at 8; set frame.pixel_bits = 8"
    )]
    UnsupportedDepth {
        /// The number of bits per pixel.
        bits: u32,
    },
    /// The design sends no pixels.
    #[error(
        "no pixels leave a design with hardware.forward = false, so it sends nothing over a link; leave the key out"
    )]
    NoPixels,
    /// The design is too slow for the frame rate.
    #[error(
        "`{clip}` has a frame every {interval_ns} ns, but the design needs {needed_ns} ns for one at {clock_hz} Hz; give a faster --clock, or a design that takes fewer clocks"
    )]
    TooSlow {
        /// The name of the clip.
        clip: String,
        /// The shortest time between two frames, in nanoseconds.
        interval_ns: u64,
        /// The time that the design needs for a frame, in nanoseconds.
        needed_ns: u64,
        /// The clock in Hz.
        clock_hz: u64,
    },
    /// The build of ffmpeg lacks an encoder.
    #[error(
        "ffmpeg has no encoder `{encoder}`; install a build that has it, or leave `{codec}` out of --codecs"
    )]
    NoEncoder {
        /// The name of the encoder.
        encoder: &'static str,
        /// The codec that needs the encoder.
        codec: &'static str,
    },
    /// An encoder does not support the frames.
    #[error(
        "the encoder `{encoder}` does not take `{clip}` of {width}x{height} pixels: {message}; give frames of another size with --resize, or leave `{codec}` out of --codecs"
    )]
    EncoderRefused {
        /// The name of the encoder.
        encoder: &'static str,
        /// The codec that needs the encoder.
        codec: &'static str,
        /// The name of the clip.
        clip: String,
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
        /// The message of the encoder.
        message: String,
    },
    /// An encoder or decoder lost frames.
    #[error("{codec} at {quantizer} gave {found} of {expected} frames of `{clip}`; {message}")]
    LostFrames {
        /// The name of the codec.
        codec: &'static str,
        /// The quantizer.
        quantizer: u32,
        /// The name of the clip.
        clip: String,
        /// The number of frames that came.
        found: u64,
        /// The number of frames that should have come.
        expected: u64,
        /// The message of ffmpeg.
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
