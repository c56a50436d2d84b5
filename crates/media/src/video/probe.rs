// SPDX-License-Identifier: MIT OR Apache-2.0
//! The query of ffprobe before a video is decoded: its streams, container, codec and pixel format.

use std::path::Path;
use std::time::Duration;

use foveate_tools::{Invocation, Tool, Toolchain};
use serde::Deserialize;

use super::streams::{self, StreamChoice, VideoStream};
use super::{VideoMedium, formats};
use crate::FootageError;
use crate::orientation::FrameTurn;

/// The time limit of ffprobe. A file that takes longer cannot be read.
const LIMIT: Duration = Duration::from_secs(60);

#[derive(Clone, Debug, PartialEq)]
pub(super) struct VideoProperties {
    /// The number of the stream among the video streams, from 0.
    pub(super) stream: usize,
    /// A warning if there are other streams that may have been meant.
    pub(super) stream_warning: Option<String>,
    /// The number of frames, if the container states it.
    pub(super) frames: Option<u64>,
    /// The names of the container, separated by commas.
    pub(super) container: String,
    /// The duration in seconds, if the container states it.
    pub(super) duration_s: Option<f64>,
    pub(super) codec: String,
    /// The name of the pixel format. It is empty for a medium that was not probed.
    pub(super) pixel_format: String,
    /// The turn after which the frames stand upright, or a text that says why there is none.
    pub(super) turn: Result<FrameTurn, String>,
    /// The name of the range of its values: `tv`, `pc`, or empty if the stream does not state it.
    pub(super) colour_range: String,
}

#[derive(Deserialize)]
struct FfprobeAnswer {
    #[serde(default)]
    streams: Vec<VideoStream>,
    #[serde(default)]
    format: FfprobeContainer,
}

#[derive(Default, Deserialize)]
struct FfprobeContainer {
    #[serde(default)]
    format_name: String,
    duration: Option<String>,
}

impl Default for VideoProperties {
    fn default() -> Self {
        let (container, codec) = (String::new(), String::new());
        let (pixel_format, colour_range) = (String::new(), String::new());
        let turn = Ok(FrameTurn::default());
        let (stream, stream_warning) = (0, None);
        Self {
            stream,
            stream_warning,
            frames: None,
            container,
            duration_s: None,
            codec,
            pixel_format,
            colour_range,
            turn,
        }
    }
}

impl VideoProperties {
    /// Runs ffprobe, and chooses a video stream. A camera is not probed, since it may refuse to be
    /// opened twice.
    pub(super) fn probe(
        tools: &Toolchain,
        medium: &VideoMedium,
        wanted: Option<usize>,
    ) -> Result<Self, FootageError> {
        if medium.is_camera() {
            return Ok(Self { stream: wanted.unwrap_or(0), ..Self::default() });
        }
        let ffprobe = tools.find(Tool::Ffprobe)?.path;
        let ask = Invocation::new(&ffprobe)
            .args(["-v", "error", "-select_streams", "v"])
            .args([
                "-show_entries",
                "stream=pix_fmt,codec_name,color_range,width,height,nb_frames:format=format_name,duration:\
                 stream_disposition:stream_side_data=displaymatrix",
            ])
            .args(["-of", "json"])
            .args(medium.arguments())
            .timeout(LIMIT);
        let output = tools.run(&ask)?;
        let refused = |problem: String| medium.no_frame_error(problem);
        if !output.is_success() {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            if formats::is_refusal(&said) {
                return Err(refused(unread_format_problem(tools, &ffprobe, medium)?));
            }
            let said =
                said.lines().last().unwrap_or("ffprobe refuses it").replace(char::is_control, " ");
            // The message has the name already.
            let said =
                said.rsplit_once(": ").map_or(said.as_str(), |(_, reason)| reason).to_owned();
            return Err(refused(said));
        }
        let answer: FfprobeAnswer = serde_json::from_slice(&output.stdout)
            .map_err(|error| refused(format!("ffprobe's answer cannot be read: {error}")))?;
        let mut streams = answer.streams;
        let choice = streams::choose(&medium.name(), &streams, wanted).map_err(refused)?;
        let StreamChoice { stream: number, warning } = choice;
        let stream = streams.swap_remove(number);
        let frames = stream.frames();
        let matrix = stream.side_data_list.into_iter().find_map(|data| data.displaymatrix);
        Ok(Self {
            stream: number,
            stream_warning: warning,
            frames,
            container: answer.format.format_name,
            duration_s: answer.format.duration.and_then(|text| text.parse().ok()),
            codec: stream.codec_name,
            pixel_format: stream.pix_fmt,
            turn: matrix.map_or(Ok(FrameTurn::default()), |text| turn_of_matrix(&text)),
            colour_range: stream.color_range,
        })
    }

    /// Returns true if black is 16 and white is 235, of 8 bits, in the luma of the stream. Grey formats have all
    /// values, whatever range is stated, as in ffmpeg. Other streams that state no range have the narrow one.
    pub(super) fn has_narrow_range(&self) -> bool {
        let starts =
            |prefixes: &[&str]| prefixes.iter().any(|own| self.pixel_format.starts_with(own));
        !starts(&["yuvj", "gray", "ya", "mono"]) && self.colour_range != "pc"
    }
}

/// Returns the turn of a display matrix, as ffprobe prints it: three lines of three numbers, of which 65536 is
/// one.
fn turn_of_matrix(text: &str) -> Result<FrameTurn, String> {
    let rows = text.lines().filter_map(|line| line.split_once(':'));
    let numbers: Vec<i64> = rows
        .flat_map(|(_, row)| row.split_whitespace())
        .filter_map(|word| word.parse().ok())
        .collect();
    let linear = match numbers.as_slice() {
        [a, b, _, c, d, ..] => [*a, *b, *c, *d].map(i64::signum),
        _ => return Err("its display matrix cannot be read".to_owned()),
    };
    FrameTurn::of_axes(linear).ok_or_else(|| {
        "its display matrix turns the frames by other angles than 90, 180 and 270 degrees; leave the option out"
            .to_owned()
    })
}

/// Returns a text that names the format of a file that is not read. ffprobe names it only among its
/// debug messages. The list of formats holds for this run, too, so that no other file is opened.
fn unread_format_problem(
    tools: &Toolchain,
    ffprobe: &Path,
    medium: &VideoMedium,
) -> Result<String, FootageError> {
    let ask =
        Invocation::new(ffprobe).args(["-v", "debug"]).args(medium.arguments()).timeout(LIMIT);
    let said = tools.run(&ask)?.stderr;
    let said = String::from_utf8_lossy(&said);
    let name = formats::refused(&said).unwrap_or("unknown").replace(char::is_control, " ");
    if formats::is_sound(&name) {
        return Ok(format!("it is sound (`{name}`), not video, whatever its name is"));
    }
    Ok(format!(
        "its format is `{name}`, whatever its name is, and only formats that hold their frames themselves are read; \
         make a plain video of it first, for example with `ffmpeg -i FILE -c:v ffv1 OUT.mkv`"
    ))
}
