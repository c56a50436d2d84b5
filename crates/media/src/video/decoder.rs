// SPDX-License-Identifier: MIT OR Apache-2.0
//! A running ffmpeg that decodes a video, from its beginning or from a later position. It announces
//! every frame and returns its pixels.

use std::io::{self, Read};
use std::time::{Duration, Instant};

use foveate_tools::{Interrupt, Invocation, LocatedTool, ProgramReader, ToolError};

use super::VideoMedium;
use super::ffmpeg_log::{AnnouncedFrame, FfmpegLog, LogEntry};
use crate::samples::SampleLayout;

/// The time after which ffmpeg gives up on a network camera that does not answer.
const NETWORK_TIMEOUT: Duration = Duration::from_secs(10);
/// The time that ffmpeg looks at a stream before it says anything about it.
const PROBING_TIME: Duration = Duration::from_secs(5);

pub(super) struct DecodingParameters {
    pub(super) found: LocatedTool,
    pub(super) medium: VideoMedium,
    /// The names of the container, as ffprobe gives them. It is empty for a medium that was not
    /// probed.
    pub(super) container: String,
    /// The number of the stream among the video streams, from 0.
    pub(super) stream: usize,
    /// The filter that leaves luma, or the colours from which luma is computed.
    pub(super) conversion: String,
    pub(super) interrupt: Interrupt,
}

impl DecodingParameters {
    /// Returns the command line up to and including the input.
    pub(super) fn input(&self, start: StartPosition<'_>) -> Invocation {
        let input = Invocation::new(&self.found.path)
            .args(["-hide_banner", "-nostdin", "-nostats", "-loglevel", "repeat+level+info"])
            .arg("-noautorotate");
        let input = match self.medium {
            // Before ffmpeg 5.0 the option was called `-stimeout`, and `-timeout` made ffmpeg wait
            // for a caller.
            VideoMedium::Network(_) => {
                let option = if self.is_version_or_later(5, 0) { "-timeout" } else { "-stimeout" };
                input.args([option.to_owned(), NETWORK_TIMEOUT.as_micros().to_string()])
            }
            VideoMedium::File(_) | VideoMedium::ImageStream(..) | VideoMedium::Camera(_) => input,
        };
        let input = match start {
            StartPosition::BeginningWithOwnTimes => input,
            StartPosition::BeginningWithContainerTimes => input.arg("-copyts"),
            StartPosition::SeekTo(place) => {
                input.args(["-copyts", "-noaccurate_seek", "-ss", place])
            }
        };
        input
            .args(self.medium.arguments())
            .args(["-map".to_owned(), format!("0:v:{}", self.stream)])
    }

    /// Returns true if ffmpeg has this version or a later one. Builds between releases have no
    /// version, and count as new.
    fn is_version_or_later(&self, major: u32, minor: u32) -> bool {
        self.found.version.as_ref().is_none_or(|version| version.is_at_least(major, minor))
    }

    fn decoding(&self, start: StartPosition<'_>) -> Invocation {
        self.with_frame_output(self.input(start))
    }

    /// Completes a command line so that every frame is announced and written to the pipe.
    pub(super) fn with_frame_output(&self, input: Invocation) -> Invocation {
        // The option has another name before ffmpeg 5.1.
        let passthrough = if self.is_version_or_later(5, 1) { "-fps_mode" } else { "-vsync" };
        input
            .arg("-vf")
            .arg(format!("{},showinfo=checksum=0", self.conversion))
            // Frames keep their sizes, and no two frames get the same time.
            .args(["-autoscale", "0", "-enc_time_base", "1:1000000"])
            // Frames are written to the pipe directly, not through a buffer.
            .args([passthrough, "passthrough", "-avioflags", "direct"])
            .args(["-f", "rawvideo", "pipe:1"])
    }
}

/// The position at which decoding starts, and the origin of the times of frames.
#[derive(Clone, Copy, Debug)]
pub(super) enum StartPosition<'a> {
    /// Starts at the beginning, with times from there.
    BeginningWithOwnTimes,
    /// Starts at the beginning, with the container's own times.
    BeginningWithContainerTimes,
    /// Starts at the last possible position before this many seconds, with the container's own
    /// times.
    SeekTo(&'a str),
}

/// A running ffmpeg.
pub(super) struct VideoDecoder {
    stream: ProgramReader,
    log: FfmpegLog,
    /// A frame that was announced but not taken.
    announced_frame: Option<AnnouncedFrame>,
    /// The longest time without a picture.
    silence_limit: Option<Duration>,
}

impl VideoDecoder {
    pub(super) fn start(
        ffmpeg: &DecodingParameters,
        start: StartPosition<'_>,
    ) -> Result<Self, ToolError> {
        Self::from_invocation(ffmpeg, &ffmpeg.decoding(start))
    }

    pub(super) fn from_invocation(
        ffmpeg: &DecodingParameters,
        decoding: &Invocation,
    ) -> Result<Self, ToolError> {
        let stream = ProgramReader::start(decoding, &ffmpeg.interrupt)?;
        let log = FfmpegLog::new(ffmpeg.container.clone());
        let is_network = matches!(ffmpeg.medium, VideoMedium::Network(_));
        let silence_limit = is_network.then_some(NETWORK_TIMEOUT + PROBING_TIME);
        Ok(Self { stream, log, announced_frame: None, silence_limit })
    }

    /// Returns the next frame that ffmpeg announces. Returns `None` if no more frames follow, or if
    /// the next frame cannot be taken from the pipe.
    ///
    /// # Errors
    /// Fails on an interrupt.
    pub(super) fn next_announced(&mut self) -> Result<Option<AnnouncedFrame>, ToolError> {
        if let Some(shown) = self.announced_frame.take() {
            return Ok(Some(shown));
        }
        let begin = Instant::now();
        while let Some(line) = self.next_line(begin)? {
            match self.log.read_line(&line) {
                Some(LogEntry::Frame(shown)) => return Ok(Some(shown)),
                Some(LogEntry::UntakableFrame(problem)) => {
                    // ffmpeg would wait until the frame is taken.
                    self.stream.stop();
                    self.log.refuse(problem);
                    return Ok(None);
                }
                None => {}
            }
        }
        Ok(None)
    }

    /// Returns the next line of ffmpeg. A camera of the network that has sent no picture since
    /// `begin` for the longest time ends the video, for which ffmpeg itself may take a minute.
    fn next_line(&mut self, begin: Instant) -> Result<Option<String>, ToolError> {
        let Some(limit) = self.silence_limit else { return self.stream.next_line() };
        match self.stream.next_line_within(limit.saturating_sub(begin.elapsed())) {
            Ok(Some(line)) if line.ends_with("timed out") => {
                self.stream.stop();
                // A camera that is not there has not answered.
                if line.contains("Connection to ") {
                    self.log.read_line(&line);
                } else {
                    self.log.refuse(ToolError::Silent { limit: NETWORK_TIMEOUT }.to_string());
                }
                Ok(None)
            }
            Err(ToolError::Silent { .. }) => {
                self.stream.stop();
                self.log.refuse(ToolError::Silent { limit }.to_string());
                Ok(None)
            }
            line => line,
        }
    }

    /// Returns the next frame that ffmpeg announces without taking it.
    ///
    /// # Errors
    /// Fails on an interrupt.
    pub(super) fn peek(&mut self) -> Result<Option<AnnouncedFrame>, ToolError> {
        self.announced_frame = self.next_announced()?;
        Ok(self.announced_frame)
    }

    /// Reads the pixels of the frame that was announced last.
    pub(super) fn pixels(&mut self, layout: SampleLayout, bytes: &mut Vec<u8>) -> io::Result<()> {
        bytes.resize(layout.bytes(), 0);
        self.stream.read_exact(bytes)
    }

    /// Returns the time from one frame to another in microseconds, which is below 0 if the other
    /// one is earlier.
    pub(super) fn time_us(&self, first: i64, pts: i64) -> i128 {
        let (numerator, denominator) = self.log.time_base;
        let since = i128::from(pts) - i128::from(first);
        let scaled = since * i128::from(numerator) * 1_000_000;
        let denominator = i128::from(denominator.max(1));
        (scaled + denominator / 2).div_euclid(denominator)
    }

    /// Returns the fault that a reference was missing before the first frame.
    pub(super) fn missing_reference(&self) -> Option<String> {
        self.log.missing_reference()
    }

    /// Returns the problem of the video after its last frame, if there is one.
    ///
    /// # Errors
    /// Fails on an interrupt.
    pub(super) fn finish(&mut self) -> Result<Option<String>, ToolError> {
        let problem = self.log.problem();
        match self.stream.finish() {
            Ok((true, _)) => Ok(problem),
            Ok((false, status)) => Ok(problem.or(Some(format!("ffmpeg ended with {status}")))),
            Err(error) if error.is_interrupted() => Err(error),
            Err(error) => Ok(problem.or(Some(error.to_string()))),
        }
    }

    pub(super) fn stop(&mut self) {
        self.stream.stop();
    }
}
