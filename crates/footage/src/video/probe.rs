// SPDX-License-Identifier: MIT OR Apache-2.0
//! What ffprobe says of a video before it is decoded: whether it has one, and in which colours.

use std::time::Duration;

use foveate_toolchain::{Invocation, Tool, Toolchain};
use serde::Deserialize;

use super::Medium;
use crate::FootageError;

/// A file that keeps ffprobe busy for longer is none that can be read.
const LIMIT: Duration = Duration::from_secs(60);

/// What is known of a video.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Probe {
    /// The number of frames, if the container says.
    pub(super) frames: Option<u64>,
    /// Names of the container, with commas between.
    pub(super) container: String,
    /// Name of the codec.
    pub(super) codec: String,
    pixel_format: String,
}

#[derive(Deserialize)]
struct Answer {
    #[serde(default)]
    streams: Vec<Stream>,
    #[serde(default)]
    format: Container,
}

#[derive(Default, Deserialize)]
struct Container {
    #[serde(default)]
    format_name: String,
}

#[derive(Deserialize)]
struct Stream {
    #[serde(default)]
    pix_fmt: String,
    #[serde(default)]
    codec_name: String,
    nb_frames: Option<String>,
}

impl Probe {
    /// Asks ffprobe; a camera is not asked, since opening it twice may fail.
    pub(super) fn of(tools: &Toolchain, medium: &Medium) -> Result<Self, FootageError> {
        if medium.is_camera() {
            return Ok(Self::default());
        }
        let ask = Invocation::new(tools.find(Tool::Ffprobe)?.path)
            .args(["-v", "error", "-select_streams", "v:0"])
            .args(["-show_entries", "stream=pix_fmt,codec_name,nb_frames:format=format_name"])
            .args(["-of", "json"])
            .args(medium.arguments())
            .timeout(LIMIT);
        let output = tools.run(&ask)?;
        let refused = |problem: String| medium.refused(problem);
        if !output.is_success() {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            let said =
                said.lines().last().unwrap_or("ffprobe refuses it").replace(char::is_control, " ");
            // The name is in the message already.
            let said =
                said.rsplit_once(": ").map_or(said.as_str(), |(_, reason)| reason).to_owned();
            return Err(refused(said));
        }
        let answer: Answer = serde_json::from_slice(&output.stdout)
            .map_err(|error| refused(format!("ffprobe's answer cannot be read: {error}")))?;
        let stream = answer.streams.into_iter().next();
        let stream = stream.ok_or_else(|| refused("it has no video stream".to_owned()))?;
        let frames = stream.nb_frames.and_then(|number| number.parse().ok());
        Ok(Self {
            frames,
            container: answer.format.format_name,
            codec: stream.codec_name,
            pixel_format: stream.pix_fmt,
        })
    }

    /// The filter that leaves luma, or the colours that luma is made of.
    pub(super) fn conversion(&self) -> &'static str {
        let name = self.pixel_format.as_str();
        let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
        let deep_planes = name.starts_with("gbr") && name.contains(|c: char| c.is_ascii_digit());
        if starts(&["rgb48", "bgr48", "rgba64", "bgra64", "x2", "xyz", "bayer"]) || deep_planes {
            "format=rgb48le"
        } else if starts(&["rgb", "bgr", "gbr", "argb", "abgr", "0rgb", "0bgr", "pal8"]) {
            "format=rgb24"
        } else if starts(&["mono"]) {
            "format=gray"
        } else {
            // Formats that the filter does not know become planar ones of the same kind first.
            "extractplanes=y"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_decide_what_is_asked_for() {
        let conversion =
            |name: &str| Probe { pixel_format: name.to_owned(), ..Probe::default() }.conversion();
        for name in ["yuv420p", "yuvj422p", "nv12", "p010le", "gray", "gray12le", "ya8", ""] {
            assert_eq!(conversion(name), "extractplanes=y", "{name}");
        }
        for name in ["rgb24", "bgr0", "bgra", "gbrp", "pal8", "rgb555le", "0rgb"] {
            assert_eq!(conversion(name), "format=rgb24", "{name}");
        }
        for name in ["gbrp10le", "gbrap12le", "rgb48be", "rgba64le", "x2rgb10le"] {
            assert_eq!(conversion(name), "format=rgb48le", "{name}");
        }
        assert_eq!(conversion("monow"), "format=gray");
    }
}
