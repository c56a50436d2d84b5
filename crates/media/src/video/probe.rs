// SPDX-License-Identifier: MIT OR Apache-2.0
//! The query of ffprobe before a video is decoded ([`VideoProperties`]): its streams,
//! container, codec and pixel format. Without a wish, the stream that players take is chosen
//! ([`choose`]): no attached picture, no single picture if there is a stream of several frames,
//! and the stream that is marked as default, or else the first one.
//!
//! AVI files that end early are noticed by their length ([`truncation_problem`]): ffmpeg
//! decodes the existing frames and reports nothing if the cut is between two frames. For other
//! containers it reports the cut.

use super::{VideoMedium, formats};
use crate::FootageError;
use crate::orientation::FrameTurn;
use foveate_tools::{Invocation, Tool, Toolchain};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::Duration;

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
        let choice = choose(&medium.name(), &streams, wanted).map_err(refused)?;
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

    /// Returns true if black is 16 and white is 235, of 8 bits, in the luma of the stream. Grey
    /// formats have all values, whatever range is stated, as in ffmpeg. Other streams that state no
    /// range have the narrow one.
    pub(super) fn has_narrow_range(&self) -> bool {
        let starts =
            |prefixes: &[&str]| prefixes.iter().any(|own| self.pixel_format.starts_with(own));
        !starts(&["yuvj", "gray", "ya", "mono"]) && self.colour_range != "pc"
    }
}

/// Returns the turn of a display matrix, as ffprobe prints it: three lines of three numbers, of
/// which 65536 is one.
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

/// A video stream, as ffprobe describes it.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct VideoStream {
    pub(super) pix_fmt: String,
    pub(super) codec_name: String,
    pub(super) color_range: String,
    width: u32,
    height: u32,
    nb_frames: Option<String>,
    disposition: BTreeMap<String, u8>,
    pub(super) side_data_list: Vec<StreamSideData>,
}

#[derive(Debug, Deserialize)]
pub(super) struct StreamSideData {
    pub(super) displaymatrix: Option<String>,
}

impl VideoStream {
    /// Returns the number of frames, if the container states it.
    pub(super) fn frames(&self) -> Option<u64> {
        self.nb_frames.as_ref().and_then(|number| number.parse().ok())
    }

    fn has_mark(&self, name: &str) -> bool {
        self.disposition.get(name).is_some_and(|&mark| mark != 0)
    }

    /// Returns true for a cover and for the thumbnails of chapters.
    fn is_attached(&self) -> bool {
        self.has_mark("attached_pic") || self.has_mark("timed_thumbnails")
    }

    fn is_single_picture(&self) -> bool {
        self.has_mark("still_image") || self.frames() == Some(1)
    }

    fn describe(&self, number: usize) -> String {
        let mark = match (self.is_attached(), self.has_mark("default")) {
            (true, _) => ", attached picture",
            (false, true) => ", default",
            (false, false) => "",
        };
        format!("{number} ({}, {}x{}{mark})", self.codec_name, self.width, self.height)
    }
}

/// The chosen stream.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct StreamChoice {
    /// The number among the video streams, from 0.
    pub(super) stream: usize,
    /// A warning if the user should know that there are others.
    pub(super) warning: Option<String>,
}

/// Chooses a stream of the file `name`.
///
/// # Errors
/// Fails if there is no video stream, or not the one that is wanted. The message says what there
/// is.
pub(super) fn choose(
    name: &str,
    streams: &[VideoStream],
    wanted: Option<usize>,
) -> Result<StreamChoice, String> {
    let list = |numbers: &[usize]| {
        let described = numbers.iter().map(|&number| streams[number].describe(number));
        described.collect::<Vec<_>>().join(", ")
    };
    let all: Vec<usize> = (0..streams.len()).collect();
    if all.is_empty() {
        return Err("it has no video stream".to_owned());
    }
    if let Some(stream) = wanted {
        return match streams.get(stream) {
            Some(_) => Ok(StreamChoice { stream, warning: None }),
            None => Err(format!("it has no video stream {stream}; it has {}", list(&all))),
        };
    }
    let mut videos = all.clone();
    videos.retain(|&number| !streams[number].is_attached());
    if videos.is_empty() {
        return Err(format!(
            "it has no video, only pictures that are attached to its sound: {}; --video-stream reads one",
            list(&all)
        ));
    }
    if videos.iter().any(|&number| !streams[number].is_single_picture()) {
        videos.retain(|&number| !streams[number].is_single_picture());
    }
    let marked = videos.iter().find(|&&number| streams[number].has_mark("default"));
    let stream = *marked.unwrap_or(&videos[0]);
    let warning = (videos.len() > 1).then(|| {
        format!(
            "`{name}` has {} video streams: {}; stream {stream} is read, --video-stream reads another one",
            videos.len(),
            list(&videos)
        )
    });
    Ok(StreamChoice { stream, warning })
}

/// Returns a text about the missing bytes if the file is an AVI and shorter than its header states.
pub(super) fn truncation_problem(path: &Path) -> Option<String> {
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok().filter(std::fs::Metadata::is_file)?.len();
    let mut start = [0; 12];
    file.read_exact(&mut start).ok()?;
    missing_bytes(&start, length)
        .map(|bytes| format!("the file is truncated, {bytes} bytes are missing"))
}

fn missing_bytes(start: &[u8; 12], length: u64) -> Option<u64> {
    let [b'R', b'I', b'F', b'F', size @ .., b'A', b'V', b'I', b' '] = start else { return None };
    let [a, b, c, d] = *size;
    let said = u64::from(u32::from_le_bytes([a, b, c, d]));
    // A recorder that was killed leaves 0, or the largest number.
    let missing = (said + 8).checked_sub(length).filter(|&bytes| bytes > 0)?;
    (said != u64::from(u32::MAX)).then_some(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(frames: &str, marks: &[&str]) -> VideoStream {
        let disposition = marks.iter().map(|&mark| (mark.to_owned(), 1)).collect();
        let nb_frames = (!frames.is_empty()).then(|| frames.to_owned());
        VideoStream { codec_name: "h264".to_owned(), nb_frames, disposition, ..Default::default() }
    }

    #[test]
    fn the_stream_that_players_take_is_chosen() {
        let chosen = |streams: &[VideoStream]| choose("a.mp4", streams, None).unwrap();
        for (expected, streams) in [
            (0, vec![stream("25", &[])]),
            (1, vec![stream("", &["attached_pic"]), stream("25", &[])]),
            (1, vec![stream("", &["timed_thumbnails", "default"]), stream("25", &[])]),
            (1, vec![stream("1", &["default"]), stream("25", &[])]),
            (1, vec![stream("", &["still_image"]), stream("", &[])]),
            (0, vec![stream("1", &[]), stream("", &["attached_pic"])]),
        ] {
            assert_eq!(chosen(&streams), StreamChoice { stream: expected, warning: None });
        }
        let several = [stream("25", &[]), stream("10", &["default"]), stream("5", &[])];
        let StreamChoice { stream: number, warning } = chosen(&several);
        assert_eq!(number, 1);
        let warning = warning.unwrap();
        assert!(warning.contains("3 video streams: 0 (h264, 0x0), 1 (h264, 0x0, default), 2"));
        assert!(warning.contains("stream 1 is read"), "{warning}");
        assert_eq!(chosen(&[stream("25", &[]), stream("10", &[])]).stream, 0);
    }

    #[test]
    fn a_wish_is_met_or_refused() {
        let streams = [stream("", &["attached_pic"]), stream("25", &[])];
        let wish = |number| choose("a.mp4", &streams, Some(number));
        assert_eq!(wish(0).unwrap(), StreamChoice { stream: 0, warning: None });
        assert!(wish(2).unwrap_err().contains("no video stream 2; it has 0 (h264, 0x0, attached"));
        assert!(choose("a", &streams[..1], None).unwrap_err().contains("only pictures"));
        assert_eq!(choose("a", &[], None).unwrap_err(), "it has no video stream");
    }

    #[test]
    fn an_avi_knows_its_length() {
        let start = b"RIFF\x64\x00\x00\x00AVI ";
        assert_eq!(missing_bytes(start, 108), None);
        assert_eq!(missing_bytes(start, 109), None);
        assert_eq!(missing_bytes(start, 100), Some(8));
        assert_eq!(missing_bytes(b"RIFF\x64\x00\x00\x00WAVE", 20), None);
        assert_eq!(missing_bytes(b"RIFF\xFF\xFF\xFF\xFFAVI ", 20), None);
    }
}
