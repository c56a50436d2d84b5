// SPDX-License-Identifier: MIT OR Apache-2.0
//! ffmpeg at work on a video: announced frames and their pixels, from its beginning or from a place
//! in it.

use std::io::{self, Read};

use foveate_toolchain::{Invocation, Located, Stream, ToolError};

use super::Medium;
use super::log::{FfmpegLog, Info, Shown};
use crate::samples::Layout;

/// How a video is decoded.
pub(super) struct Ffmpeg {
    pub(super) found: Located,
    pub(super) medium: Medium,
    /// The filter that leaves luma, or the colours that luma is made of.
    pub(super) conversion: &'static str,
}

impl Ffmpeg {
    /// Up to its input.
    pub(super) fn input(&self, start: Start<'_>) -> Invocation {
        let input = Invocation::new(&self.found.path)
            .args(["-hide_banner", "-nostdin", "-nostats", "-loglevel", "repeat+level+info"])
            .arg("-noautorotate");
        let input = match start {
            Start::Plain => input,
            Start::First => input.arg("-copyts"),
            Start::At(place) => input.args(["-copyts", "-noaccurate_seek", "-ss", place]),
        };
        input.args(self.medium.arguments()).args(["-map", "0:v:0"])
    }

    fn decoding(&self, start: Start<'_>) -> Invocation {
        // The option had another name before ffmpeg 5.1; builds between releases have no version.
        let renamed = self.found.version.as_ref().is_none_or(|version| version.reaches(5, 1));
        let passthrough = if renamed { "-fps_mode" } else { "-vsync" };
        self.input(start)
            .arg("-vf")
            .arg(format!("{},showinfo=checksum=0", self.conversion))
            // Frames stay as large as they are, and two never fall on one tick.
            .args(["-autoscale", "0", "-enc_time_base", "1:1000000"])
            // A frame goes into the pipe at once, not copied into a buffer and in pieces.
            .args([passthrough, "passthrough", "-avioflags", "direct"])
            .args(["-f", "rawvideo", "pipe:1"])
    }
}

/// Where decoding starts, and what the times of frames are counted from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Start<'a> {
    /// At the beginning, and from there.
    Plain,
    /// At the beginning, with the container's own times.
    First,
    /// At the last place before this many seconds, as ffmpeg counts them, where it can; with the
    /// container's own times.
    At(&'a str),
}

/// A running ffmpeg.
pub(super) struct Decoder {
    stream: Stream,
    log: FfmpegLog,
    /// A frame that was announced and not taken.
    ahead: Option<Shown>,
}

impl Decoder {
    pub(super) fn start(ffmpeg: &Ffmpeg, start: Start<'_>) -> Result<Self, ToolError> {
        let stream = Stream::start(&ffmpeg.decoding(start))?;
        Ok(Self { stream, log: FfmpegLog::default(), ahead: None })
    }

    /// The next frame that ffmpeg announces, or `None` when it will announce no more.
    pub(super) fn announced(&mut self) -> Option<Shown> {
        if let Some(shown) = self.ahead.take() {
            return Some(shown);
        }
        while let Some(line) = self.stream.next_line() {
            if let Some(Info::Frame(shown)) = self.log.take(&line) {
                return Some(shown);
            }
        }
        None
    }

    /// The same, to be announced again.
    pub(super) fn peek(&mut self) -> Option<Shown> {
        self.ahead = self.announced();
        self.ahead
    }

    /// The pixels of the frame that was announced last.
    pub(super) fn pixels(&mut self, layout: Layout, bytes: &mut Vec<u8>) -> io::Result<()> {
        bytes.resize(layout.bytes(), 0);
        self.stream.read_exact(bytes)
    }

    /// Time from one frame to another.
    pub(super) fn time_us(&self, first: i64, pts: i64) -> u64 {
        let (numerator, denominator) = self.log.time_base;
        let since = i128::from(pts) - i128::from(first);
        let scaled = since.max(0) * i128::from(numerator) * 1_000_000;
        let denominator = i128::from(denominator.max(1));
        u64::try_from((scaled + denominator / 2) / denominator).unwrap_or(u64::MAX)
    }

    /// After the last frame: what was wrong.
    pub(super) fn conclude(&mut self) -> Option<String> {
        let problem = self.log.problem();
        match self.stream.finish() {
            Ok((true, _)) => problem,
            Ok((false, status)) => problem.or(Some(format!("ffmpeg ended with {status}"))),
            Err(error) => problem.or(Some(error.to_string())),
        }
    }

    pub(super) fn stop(&mut self) {
        self.stream.stop();
    }
}
