// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of a comparison, as it is in the JSON file.

use serde::Serialize;

use crate::link::{LinkFigures, Quality, UnbufferedFigures};

/// The version of the JSON format; it changes if a key changes its meaning or is removed.
pub(crate) const FORMAT_VERSION: u32 = 3;

/// The name of the setting that a codec's curve varies.
pub(crate) const QUANTIZER: &str = "quantizer";

/// The report of a comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkReport {
    /// The version of the JSON format.
    pub format_version: u32,
    /// The version of the program.
    pub foveate_version: &'static str,
    /// The version banner of ffmpeg.
    pub ffmpeg: String,
    /// The preset of x264 and x265.
    pub effort: &'static str,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
    /// The rate of the link in bits per second.
    pub link_bits_per_second: u64,
    /// The clock of the array in Hz. Without one, the array takes no time.
    pub clock_hz: Option<u64>,
    /// The clips, in the order of the inputs.
    pub clips: Vec<ClipReport>,
}

/// The report of one clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipReport {
    /// The name of the clip.
    pub name: String,
    /// The inputs as the user named them.
    pub inputs: Vec<String>,
    /// The reason why the clip ended early, if it did.
    pub problem: Option<String>,
    /// The fingerprint of the design.
    pub design: String,
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The number of frames.
    pub frames: u64,
    /// The time from the first frame to the end of the last frame, in ns.
    pub duration_ns: u64,
    /// The most clocks that the array adds to a time after the pixels that it waits for have been
    /// read. The clocks of a raster core are those of this clip, at the clock of the array, or
    /// without one at the slowest that keeps up.
    pub array_clocks: u64,
    /// The slowest clock in Hz at which the array keeps up with the frames.
    pub needed_clock_hz: u64,
    /// The senders: cameras, then codecs.
    pub senders: Vec<SenderReport>,
    /// The points of bytes against quality.
    pub curves: Vec<CurvePoint>,
}

/// The report of one sender of a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SenderReport {
    /// The name of the sender.
    pub sender: &'static str,
    /// The figure in which a codec must equal the region camera, `psnr` or `ssim`; `None` for a
    /// camera.
    pub equal: Option<&'static str>,
    /// The quantizer of a codec.
    pub quantizer: Option<u32>,
    /// The result of the search for a codec's quantizer. `equal` is the coarsest quantizer that is
    /// good enough; `finest` did not reach the quality of the region camera; `coarsest` is still
    /// better.
    #[serde(rename = "found")]
    pub search_result: Option<&'static str>,
    /// The quality of the receiver's frames; `None` for a sender without frames.
    pub quality: Option<Quality>,
    /// The load on the link.
    pub figures: LinkFigures,
    /// The figures without a buffer between array and link; only for the array of a raster design.
    pub unbuffered: Option<UnbufferedFigures>,
}

/// A point of a curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// The name of the sender.
    pub sender: &'static str,
    /// The setting that differs from point to point: a key of the design, or the quantizer.
    #[serde(rename = "knob")]
    pub setting: &'static str,
    /// The value of the setting.
    pub value: u64,
    /// The bytes per second.
    pub bytes_per_second: u64,
    /// The quality of the receiver's frames.
    pub quality: Quality,
}

impl LinkReport {
    /// Returns the reasons why clips ended early, with their names.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let problem = |clip: &ClipReport| {
            clip.problem.as_ref().map(|problem| format!("{}: {problem}", clip.name))
        };
        self.clips.iter().filter_map(problem).collect()
    }
}
