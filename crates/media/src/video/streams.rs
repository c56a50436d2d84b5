// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice among the video streams of a file. Without a wish, it is the stream that players take:
//! no attached picture, no single picture if there is a stream of several frames, and the stream
//! that is marked as default, or else the first one.

use std::collections::BTreeMap;

use serde::Deserialize;

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
/// Fails if there is no video stream, or not the one that is wanted. The message says what there is.
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
}
