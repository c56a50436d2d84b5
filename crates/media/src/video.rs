// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video through an ffmpeg process, frame by frame through a pipe: memory does not grow with the
//! length.
//!
//! * Luma is the Y plane as it was coded, without a change of range: 16..235 stays 16..235, unless
//!   [`LumaRange::Full`] is wanted. A clip gives the same values through `ffmpeg -f yuv4mpegpipe`.
//!   RGB video becomes luma as images do.
//! * ffmpeg's `showinfo` filter writes size, format and time of a frame to the standard error
//!   before the frame itself comes through the pipe. So times are those of the container, and a
//!   change of size in the stream is detected. `-fps_mode passthrough` prevents ffmpeg from
//!   repeating or dropping frames.
//! * Only [`formats`] that hold their frames themselves are read: a file that is a list of other
//!   files is refused.
//! * A late start uses a seek if that gives the same frames, see [`clock`].
//! * Rotation is ignored, as is the EXIF orientation of images, unless [`Orientation::Upright`] is
//!   wanted. Frames are turned here, because the filters of ffmpeg do not turn all pixel formats.

mod clock;
mod decoder;
mod ffmpeg_log;
mod formats;
mod late_start;
mod pixel_formats;
mod probe;

use std::path::{Path, PathBuf};

use foveate_pixels::ByteFrame;
use foveate_tools::{Interrupt, Tool, Toolchain};

use self::clock::VideoClock;
use self::decoder::{DecodingParameters, StartPosition, VideoDecoder};
use self::ffmpeg_log::AnnouncedFrame;
use self::probe::VideoProperties;
use crate::address::CameraAddress;
use crate::orientation::FrameTurn;
use crate::picture::StreamKind;
use crate::samples::SampleLayout;
use crate::source::feed::FrameFeed;
use crate::{
    FootageError, FrameRate, InputOptions, InputWarnings, LumaRange, Orientation, SourceFrame,
};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum VideoMedium {
    File(PathBuf),
    /// A file of images that follow each other.
    ImageStream(PathBuf, StreamKind),
    /// A Video4Linux device.
    Camera(PathBuf),
    /// A network camera with its address.
    Network(CameraAddress),
}

impl VideoMedium {
    /// Returns the arguments for ffmpeg. They allow only this kind of medium, whatever the name
    /// looks like, and no format that reads other files or addresses.
    fn arguments(&self) -> Vec<std::ffi::OsString> {
        let name = |prefix: &str, path: &Path| {
            let mut name = std::ffi::OsString::from(prefix);
            name.push(path);
            name
        };
        let words = |words: &[&str]| words.iter().map(Into::into).collect::<Vec<_>>();
        let (mut options, input) = match self {
            Self::File(path) => {
                let allowed = formats::allowed();
                let only = ["-protocol_whitelist", "file", "-format_whitelist", &allowed];
                (words(&only), name("file:", path))
            }
            Self::ImageStream(path, kind) => {
                let demuxer = kind.demuxer();
                let only = ["-protocol_whitelist", "file", "-format_whitelist", demuxer];
                (words(&[&only[..], &["-f", demuxer]].concat()), name("file:", path))
            }
            Self::Camera(path) => {
                let only = ["-format_whitelist", "video4linux2,v4l2", "-f", "v4l2"];
                (words(&only), name("", path))
            }
            // TCP loses no packet, and most routers let it pass.
            Self::Network(address) => {
                let only =
                    ["-protocol_whitelist", "rtsp,tcp,tls,udp,rtp", "-format_whitelist", "rtsp"];
                let tcp = ["-f", "rtsp", "-rtsp_transport", "tcp"];
                (words(&[only, tcp].concat()), address.url().into())
            }
        };
        options.extend(["-i".into(), input]);
        options
    }

    /// Returns the name in the form in which it may be shown, without a password.
    fn name(&self) -> String {
        match self {
            Self::File(path) | Self::ImageStream(path, _) | Self::Camera(path) => {
                path.display().to_string()
            }
            Self::Network(address) => address.without_secrets(),
        }
    }

    /// Returns the error for a medium without a frame.
    fn no_frame_error(&self, problem: String) -> FootageError {
        match self.clone() {
            Self::File(path) | Self::ImageStream(path, _) => FootageError::Video { path, problem },
            Self::Camera(path) => FootageError::Camera { path, problem },
            Self::Network(_) => FootageError::Network { url: self.name(), problem },
        }
    }

    /// Returns true if the medium may refuse to be opened twice.
    fn is_camera(&self) -> bool {
        matches!(self, Self::Camera(_) | Self::Network(_))
    }
}

/// The frames of a video.
pub(crate) struct VideoFeed {
    medium: VideoMedium,
    ffmpeg: DecodingParameters,
    codec: String,
    decoder: VideoDecoder,
    /// True if decoding began at a later position.
    is_sought: bool,
    total: Option<u64>,
    /// The pixel format as ffprobe names it.
    pixel_format: String,
    interrupt: Interrupt,
    bits: u32,
    rate: FrameRate,
    clock: VideoClock,
    warnings: InputWarnings,
    luma: LumaRange,
    turn: FrameTurn,
    /// True if the luma of the stream is expanded.
    is_expanded: bool,
    /// The memory for the next frame.
    bytes: Vec<u8>,
    first_pts: Option<i64>,
    frames: u64,
    problem: Option<String>,
}

impl VideoFeed {
    /// Opens a medium. Frames before `start_us` are not needed, and may be missing.
    pub(crate) fn open(
        medium: VideoMedium,
        bits: u32,
        start_us: u64,
        options: &InputOptions,
    ) -> Result<Self, FootageError> {
        let &InputOptions { frame_rate: rate, luma, orientation, ref interrupt, .. } = options;
        let warnings = options.warnings.clone();
        if medium.is_camera() && luma == LumaRange::Full {
            let problem = format!(
                "the range of the camera `{}` is not known; leave the option out",
                medium.name()
            );
            return Err(FootageError::Option { option: "--luma full", problem });
        }
        let tools = Toolchain::system().with_cancel_flag(interrupt.flag());
        // Starting ffmpeg takes as long as decoding some dozen frames, so it runs in parallel with
        // ffprobe.
        let (found, probe) = std::thread::scope(|scope| {
            let found = scope.spawn(|| tools.find(Tool::Ffmpeg));
            let probe = VideoProperties::probe(&tools, &medium, options.video_stream);
            (found.join(), probe)
        });
        let found = found.unwrap_or_else(|_| tools.find(Tool::Ffmpeg))?;
        let probe = probe?;
        probe.stream_warning.iter().for_each(|warning| warnings.add(warning.clone()));
        let conversion = pixel_formats::conversion_filter(&probe.pixel_format);
        let is_expanded = luma == LumaRange::Full && probe.has_narrow_range();
        let turn = match orientation {
            Orientation::Stored => FrameTurn::default(),
            Orientation::Upright => probe.turn.clone().map_err(|problem| FootageError::Option {
                option: "--orientation upright",
                problem: format!("`{}`: {problem}", medium.name()),
            })?,
        };
        let interrupt = interrupt.clone();
        let ffmpeg = DecodingParameters {
            found,
            medium: medium.clone(),
            container: probe.container.clone(),
            stream: probe.stream,
            conversion,
            interrupt,
        };
        let sought = late_start::start(&tools, &ffmpeg, &probe, start_us)?;
        let is_sought = sought.is_some();
        let (decoder, first_pts) = match sought {
            Some(sought) => (sought.decoder, Some(sought.first_pts)),
            None => (VideoDecoder::start(&ffmpeg, StartPosition::BeginningWithOwnTimes)?, None),
        };
        Ok(Self {
            medium,
            codec: probe.codec,
            decoder,
            is_sought,
            total: probe.frames,
            pixel_format: probe.pixel_format,
            interrupt: ffmpeg.interrupt.clone(),
            ffmpeg,
            bits,
            rate,
            clock: VideoClock::new(rate),
            warnings,
            luma,
            turn,
            is_expanded,
            bytes: Vec::new(),
            first_pts,
            frames: 0,
            problem: None,
        })
    }

    fn read_frame(&mut self, shown: &AnnouncedFrame) -> Result<ByteFrame, String> {
        let mut bytes = std::mem::take(&mut self.bytes);
        self.decoder.pixels(shown.layout, &mut bytes).map_err(|error| error.to_string())?;
        let is_expanded = self.is_expanded && !shown.layout.is_colour;
        let layout = SampleLayout { is_expanded, ..shown.layout };
        let frame = layout.byte_frame(bytes, self.bits);
        frame.and_then(|frame| self.turn.turned(frame)).map_err(|error| error.to_string())
    }

    /// Returns the time since the first frame in microseconds, by the container, or by the rate if
    /// the container gives the frame no time.
    fn time_us(&mut self, shown: &AnnouncedFrame) -> u64 {
        let stated_us = match shown.pts {
            None => self.rate.time_us(self.frames).into(),
            Some(pts) => self.decoder.time_us(*self.first_pts.get_or_insert(pts), pts),
        };
        self.clock.time_us(self.frames, stated_us)
    }

    /// Determines the problem of the video, if any, once there are no more frames.
    fn determine_problem(&mut self) -> Result<(), FootageError> {
        let mut problem = self.decoder.finish()?;
        if problem.is_none()
            && let Some(missing) = self.decoder.missing_reference()
            && (self.is_sought || late_start::begins_cleanly(&self.ffmpeg, &self.codec)?)
        {
            problem = Some(missing);
        }
        match &self.medium {
            VideoMedium::File(path) => {
                problem = probe::truncation_problem(path).or(problem);
            }
            // Messages of ffmpeg repeat the address and its parts.
            VideoMedium::Network(address) => problem = problem.map(|text| address.redact(&text)),
            VideoMedium::Camera(_) | VideoMedium::ImageStream(..) => {}
        }
        if let Some(said) = problem.as_mut().filter(|said| said.contains("Impossible to convert")) {
            *said =
                format!("ffmpeg cannot convert its pixel format `{}` ({said})", self.pixel_format);
        }
        if self.frames == 0 && self.first_pts.is_none() {
            let problem = problem.unwrap_or_else(|| "it holds no frame".to_owned());
            return Err(self.medium.no_frame_error(problem));
        }
        self.problem = problem;
        Ok(())
    }
}

impl FrameFeed for VideoFeed {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.problem.is_some() {
            return Ok(None);
        }
        let Some(shown) = self.decoder.next_announced()? else {
            self.determine_problem()?;
            return Ok(None);
        };
        let name = self.medium.name();
        match self.read_frame(&shown) {
            Ok(frame) => {
                let time_us = self.time_us(&shown);
                self.frames += 1;
                Ok(Some(SourceFrame { name, time_us, label: None, frame }))
            }
            Err(_) if self.interrupt.is_set() => Err(FootageError::Interrupted),
            Err(problem) if self.frames == 0 => Err(self.medium.no_frame_error(problem)),
            Err(problem) => {
                self.problem = Some(problem);
                Ok(None)
            }
        }
    }

    fn total(&self) -> Option<u64> {
        self.total
    }

    fn recycle(&mut self, bytes: Vec<u8>) {
        self.bytes = bytes;
    }

    fn stop(&mut self) {
        if let Some(warning) = self.clock.warning(&self.medium.name()) {
            self.warnings.add(warning);
        }
        self.decoder.stop();
    }

    fn luma(&self) -> Option<LumaRange> {
        Some(self.luma)
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    fn is_stream(&self) -> bool {
        true
    }
}
