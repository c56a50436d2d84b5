// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a comparison found, as JSON has it.

use serde::Serialize;

use crate::{Figures, Quality};

/// Changes when a key changes its meaning or goes.
pub(crate) const FORMAT_VERSION: u32 = 2;

/// The knob of a codec.
pub(crate) const QUANTIZER: &str = "quantizer";

/// A comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkReport {
    /// Version of this format.
    pub format_version: u32,
    /// Version of the program.
    pub foveate_version: &'static str,
    /// What ffmpeg says of itself.
    pub ffmpeg: String,
    /// The preset of x264 and x265.
    pub effort: &'static str,
    /// Bits per second of the link.
    pub link_bits_per_second: u64,
    /// Clock of the array in Hz. Without one, times have none of the array's clocks in them.
    pub clock_hz: Option<u64>,
    /// In the order of the inputs.
    pub clips: Vec<ClipReport>,
}

/// One clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipReport {
    /// Its name.
    pub name: String,
    /// Inputs as they were given.
    pub inputs: Vec<String>,
    /// Why it ended before its end, if it did.
    pub problem: Option<String>,
    /// Fingerprint of the design.
    pub design: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of frames.
    pub frames: u64,
    /// From the first frame to the end of the last, in ns.
    pub duration_ns: u64,
    /// The most clocks that the array adds to a time, once what it waits for has been read.
    pub array_clocks: u64,
    /// The slowest clock at which the array keeps up with the frames.
    pub needed_clock_hz: u64,
    /// Cameras, then codecs.
    pub senders: Vec<SenderReport>,
    /// Bytes against quality.
    pub curves: Vec<Point>,
}

/// One sender of a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SenderReport {
    /// Its name.
    pub sender: &'static str,
    /// For a codec: in what it is to equal the region camera, `psnr` or `ssim`.
    pub equal: Option<&'static str>,
    /// For a codec: its quantizer.
    pub quantizer: Option<u32>,
    /// For a codec: whether a coarser quantizer would be too coarse. `finest` did not reach the region
    /// camera; `coarsest` is still better.
    pub found: Option<&'static str>,
    /// What the receiver sees; none of a sender without pictures.
    pub quality: Option<Quality>,
    /// What it asks of the link.
    pub figures: Figures,
}

/// A point of a curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// The sender.
    pub sender: &'static str,
    /// What differs from point to point: a key of the design, or the quantizer.
    pub knob: &'static str,
    /// Its value.
    pub value: u64,
    /// Bytes per second.
    pub bytes_per_second: u64,
    /// What the receiver sees.
    pub quality: Quality,
}

impl LinkReport {
    /// Why clips ended before their end.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let problem = |clip: &ClipReport| {
            clip.problem.as_ref().map(|problem| format!("{}: {problem}", clip.name))
        };
        self.clips.iter().filter_map(problem).collect()
    }
}
