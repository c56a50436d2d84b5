// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video through an ffmpeg process, frame by frame through a pipe: memory does not grow with it.
//!
//! * Luma is the Y plane as it was coded, without a change of range: what was 16..235 stays so, and a
//!   clip gives the same bits by way of `ffmpeg -f yuv4mpegpipe`. RGB video becomes luma as images do.
//! * ffmpeg's `showinfo` filter says size, format and time of a frame on the standard error before the
//!   frame itself comes through the pipe, so that times are the container's, and a change of size in
//!   mid-stream is seen. `-fps_mode passthrough` keeps ffmpeg from repeating or dropping frames.
//! * Only [`formats`] that hold their frames themselves are read: a file that is a list of others is refused.
//! * A late start is sought where that gives the same frames, see [`seek`].
//! * Rotation is ignored, as EXIF is.

mod decoder;
mod formats;
mod log;
mod pixels;
mod probe;
mod seek;
mod truncated;

use std::path::{Path, PathBuf};

use foveate_frame::Raster;
use foveate_toolchain::{Interrupt, Tool, Toolchain};

use self::decoder::{Decoder, Ffmpeg, Start};
use self::log::Shown;
use self::probe::Probe;
use crate::address::Address;
use crate::source::feed::Feed;
use crate::{FootageError, FrameRate, SourceFrame};

/// How long a camera in the network may be silent, in microseconds, before ffmpeg gives up.
const NETWORK_TIMEOUT_US: &str = "10000000";

/// What to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Medium {
    File(PathBuf),
    /// A Video4Linux device.
    Camera(PathBuf),
    /// A camera in the network, by its address.
    Network(Address),
}

impl Medium {
    /// As ffmpeg takes it: nothing else than what it is, whatever the name looks like, and nothing that reads other
    /// files or addresses.
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
            Self::Camera(path) => {
                let only = ["-format_whitelist", "video4linux2,v4l2", "-f", "v4l2"];
                (words(&only), name("", path))
            }
            // Over TCP no packet is lost, and every router lets it through.
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

    /// As it may be shown: without a password.
    fn name(&self) -> String {
        match self {
            Self::File(path) | Self::Camera(path) => path.display().to_string(),
            Self::Network(address) => address.shown(),
        }
    }

    /// Why there is no frame.
    fn refused(&self, problem: String) -> FootageError {
        match self.clone() {
            Self::File(path) => FootageError::Video { path, problem },
            Self::Camera(path) => FootageError::Camera { path, problem },
            Self::Network(_) => FootageError::Network { url: self.name(), problem },
        }
    }

    /// Whether it may refuse to be opened twice.
    fn is_camera(&self) -> bool {
        matches!(self, Self::Camera(_) | Self::Network(_))
    }
}

/// The frames of a video.
pub(crate) struct Video {
    medium: Medium,
    decoder: Decoder,
    total: Option<u64>,
    /// The number of its coded frames, as far as is known.
    pixel_format: String,
    interrupt: Interrupt,
    bits: u32,
    rate: FrameRate,
    /// Memory for the next frame.
    bytes: Vec<u8>,
    first_pts: Option<i64>,
    frames: u64,
    problem: Option<String>,
}

impl Video {
    /// Opens it; frames before `start_us` are not wanted, and may be missing.
    pub(crate) fn open(
        medium: Medium,
        bits: u32,
        rate: FrameRate,
        start_us: u64,
        interrupt: &Interrupt,
    ) -> Result<Self, FootageError> {
        let tools = Toolchain::system().cancelled_by(interrupt.flag());
        // Starting a program of ffmpeg's size takes as long as decoding some dozen frames.
        let (found, probe) = std::thread::scope(|scope| {
            let found = scope.spawn(|| tools.find(Tool::Ffmpeg));
            let probe = Probe::of(&tools, &medium);
            (found.join(), probe)
        });
        let found = found.unwrap_or_else(|_| tools.find(Tool::Ffmpeg))?;
        let probe = probe?;
        let conversion = pixels::conversion(&probe.pixel_format);
        let interrupt = interrupt.clone();
        let ffmpeg = Ffmpeg { found, medium: medium.clone(), conversion, interrupt };
        let sought = seek::start(&tools, &ffmpeg, &probe, start_us)?;
        let (decoder, first_pts) = match sought {
            Some(sought) => (sought.decoder, Some(sought.first_pts)),
            None => (Decoder::start(&ffmpeg, Start::Plain)?, None),
        };
        Ok(Self {
            medium,
            decoder,
            total: probe.frames,
            pixel_format: probe.pixel_format,
            interrupt: ffmpeg.interrupt,
            bits,
            rate,
            bytes: Vec::new(),
            first_pts,
            frames: 0,
            problem: None,
        })
    }

    fn raster(&mut self, shown: &Shown) -> Result<Raster, String> {
        let mut bytes = std::mem::take(&mut self.bytes);
        self.decoder.pixels(shown.layout, &mut bytes).map_err(|error| error.to_string())?;
        shown.layout.raster(bytes, self.bits).map_err(|error| error.to_string())
    }

    /// Time since the first frame by the container; of frames to which it gives none, by the rate.
    fn time_us(&mut self, shown: &Shown) -> u64 {
        let Some(pts) = shown.pts else { return self.rate.time_us(self.frames) };
        let first = *self.first_pts.get_or_insert(pts);
        self.decoder.time_us(first, pts)
    }

    /// What is to be said once there are no more frames.
    fn conclude(&mut self) -> Result<(), FootageError> {
        let mut problem = self.decoder.conclude()?;
        match &self.medium {
            Medium::File(path) => problem = truncated::problem(path).or(problem),
            // ffmpeg repeats the address and its parts.
            Medium::Network(address) => problem = problem.map(|text| address.redact(&text)),
            Medium::Camera(_) => {}
        }
        if let Some(said) = problem.as_mut().filter(|said| said.contains("Impossible to convert")) {
            *said =
                format!("ffmpeg cannot convert its pixel format `{}` ({said})", self.pixel_format);
        }
        if self.frames == 0 && self.first_pts.is_none() {
            let problem = problem.unwrap_or_else(|| "it holds no frame".to_owned());
            return Err(self.medium.refused(problem));
        }
        self.problem = problem;
        Ok(())
    }
}

impl Feed for Video {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.problem.is_some() {
            return Ok(None);
        }
        let Some(shown) = self.decoder.announced()? else {
            self.conclude()?;
            return Ok(None);
        };
        let name = self.medium.name();
        match self.raster(&shown) {
            Ok(frame) => {
                let time_us = self.time_us(&shown);
                self.frames += 1;
                Ok(Some(SourceFrame { name, time_us, label: None, frame }))
            }
            Err(_) if self.interrupt.is_set() => Err(FootageError::Interrupted),
            Err(problem) if self.frames == 0 => Err(self.medium.refused(problem)),
            Err(problem) => {
                self.problem = Some(problem);
                Ok(None)
            }
        }
    }

    fn total(&self) -> Option<u64> {
        self.total
    }

    fn give_back(&mut self, bytes: Vec<u8>) {
        self.bytes = bytes;
    }

    fn stop(&mut self) {
        self.decoder.stop();
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    fn is_stream(&self) -> bool {
        true
    }
}
