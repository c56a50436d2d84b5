// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video through an ffmpeg process, frame by frame through a pipe: memory does not grow with it.
//!
//! * Luma is the Y plane as it was coded, without a change of range: what was 16..235 stays so, and a
//!   clip gives the same bits by way of `ffmpeg -f yuv4mpegpipe`. RGB video becomes luma as images do.
//! * ffmpeg's `showinfo` filter says size, format and time of a frame on the standard error before the
//!   frame itself comes through the pipe, so that times are the container's, and a change of size in
//!   mid-stream is seen. `-fps_mode passthrough` keeps ffmpeg from repeating or dropping frames.
//! * Rotation is ignored, as EXIF is.

mod log;
mod probe;
mod truncated;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use foveate_model::Frame;
use foveate_toolchain::{Invocation, Stream, Tool, Toolchain};

use self::log::{Info, Report, Shown};
use self::probe::Probe;
use crate::source::feed::Feed;
use crate::{FrameRate, SimulatorError, SourceFrame, convert_depth, luma};

/// What to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Medium {
    File(PathBuf),
    /// A Video4Linux device.
    Camera(PathBuf),
}

impl Medium {
    /// As ffmpeg takes it: local files and nothing else, whatever the name looks like.
    fn arguments(&self) -> Vec<std::ffi::OsString> {
        let name = |prefix: &str, path: &Path| {
            let mut name = std::ffi::OsString::from(prefix);
            name.push(path);
            name
        };
        match self {
            Self::File(path) => vec![
                "-protocol_whitelist".into(),
                "file,pipe".into(),
                "-i".into(),
                name("file:", path),
            ],
            Self::Camera(path) => {
                vec!["-f".into(), "v4l2".into(), "-i".into(), name("", path)]
            }
        }
    }

    fn path(&self) -> &Path {
        match self {
            Self::File(path) | Self::Camera(path) => path,
        }
    }

    fn is_camera(&self) -> bool {
        matches!(self, Self::Camera(_))
    }
}

/// The frames of a video.
pub(crate) struct Video {
    medium: Medium,
    stream: Stream,
    total: Option<u64>,
    bits: u32,
    rate: FrameRate,
    report: Report,
    bytes: Vec<u8>,
    first_pts: Option<i64>,
    frames: u64,
    problem: Option<String>,
}

impl Video {
    pub(crate) fn open(medium: Medium, bits: u32, rate: FrameRate) -> Result<Self, SimulatorError> {
        let tools = Toolchain::system();
        let ffmpeg = tools.find(Tool::Ffmpeg)?;
        let probe = Probe::of(&tools, &medium)?;
        // The option had another name before ffmpeg 5.1; builds between releases have no version.
        let renamed = ffmpeg.version.is_none_or(|version| version.reaches(5, 1));
        let passthrough = if renamed { "-fps_mode" } else { "-vsync" };
        let invocation = Invocation::new(ffmpeg.path)
            .args(["-hide_banner", "-nostdin", "-nostats", "-loglevel", "repeat+level+info"])
            .arg("-noautorotate")
            .args(medium.arguments())
            .args(["-map", "0:v:0", "-vf"])
            .arg(format!("{},showinfo=checksum=0", probe.conversion()))
            // Frames stay as large as they are, and two never fall on one tick.
            .args(["-autoscale", "0", "-enc_time_base", "1:1000000"])
            .args([passthrough, "passthrough", "-f", "rawvideo", "pipe:1"]);
        let stream = Stream::start(&invocation)?;
        Ok(Self {
            medium,
            stream,
            total: probe.frames,
            bits,
            rate,
            report: Report::default(),
            bytes: Vec::new(),
            first_pts: None,
            frames: 0,
            problem: None,
        })
    }

    /// The next frame that ffmpeg announces, or `None` when it will announce no more.
    fn announced(&mut self) -> Option<Shown> {
        while let Some(line) = self.stream.next_line() {
            if let Some(Info::Frame(shown)) = self.report.take(&line) {
                return Some(shown);
            }
        }
        None
    }

    fn pixels(&mut self, shown: &Shown) -> io::Result<Vec<u16>> {
        let samples = shown.width as usize * shown.height as usize * shown.format.channels();
        self.bytes.resize(samples * shown.format.bytes_per_sample(), 0);
        self.stream.read_exact(&mut self.bytes)?;
        let (depth, bits) = (shown.format.bits, self.bits);
        let deep = || self.bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]]));
        let flat = || self.bytes.iter().map(|&byte| u16::from(byte));
        Ok(match (shown.format.colour, shown.format.bytes_per_sample()) {
            (false, 1) => flat().map(|value| convert_depth(value, depth, bits)).collect(),
            (false, _) => deep().map(|value| convert_depth(value, depth, bits)).collect(),
            (true, 1) => mixed(&flat().collect::<Vec<_>>(), depth, bits),
            (true, _) => mixed(&deep().collect::<Vec<_>>(), depth, bits),
        })
    }

    /// Time since the first frame by the container; of frames to which it gives none, by the rate.
    fn time_us(&mut self, shown: &Shown) -> u64 {
        let Some(pts) = shown.pts else { return self.rate.time_us(self.frames) };
        let since = i128::from(pts) - i128::from(*self.first_pts.get_or_insert(pts));
        let (numerator, denominator) = self.report.time_base;
        let scaled = since.max(0) * i128::from(numerator) * 1_000_000;
        let denominator = i128::from(denominator.max(1));
        u64::try_from((scaled + denominator / 2) / denominator).unwrap_or(u64::MAX)
    }

    /// What is to be said once there are no more frames.
    fn conclude(&mut self) -> Result<(), SimulatorError> {
        let status = self.stream.finish();
        let mut problem = self.report.problem();
        match status {
            Ok((true, _)) => {}
            Ok((false, status)) => {
                problem = problem.or(Some(format!("ffmpeg ended with {status}")));
            }
            Err(error) => problem = problem.or(Some(error.to_string())),
        }
        if let Medium::File(path) = &self.medium {
            problem = truncated::problem(path).or(problem);
        }
        if self.frames == 0 {
            return Err(SimulatorError::Video {
                path: self.medium.path().to_owned(),
                problem: problem.unwrap_or_else(|| "it holds no frame".to_owned()),
            });
        }
        self.problem = problem;
        Ok(())
    }
}

impl Feed for Video {
    fn next(&mut self) -> Result<Option<SourceFrame>, SimulatorError> {
        if self.problem.is_some() {
            return Ok(None);
        }
        let Some(shown) = self.announced() else {
            self.conclude()?;
            return Ok(None);
        };
        let name = self.medium.path().display().to_string();
        let frame = self.pixels(&shown).map_err(|error| error.to_string()).and_then(|pixels| {
            Frame::new(shown.width, shown.height, self.bits, pixels).map_err(|e| e.to_string())
        });
        match frame {
            Ok(frame) => {
                let time_us = self.time_us(&shown);
                self.frames += 1;
                Ok(Some(SourceFrame { name, time_us, label: None, frame }))
            }
            Err(problem) if self.frames == 0 => {
                Err(SimulatorError::Video { path: self.medium.path().to_owned(), problem })
            }
            Err(problem) => {
                self.problem = Some(problem);
                Ok(None)
            }
        }
    }

    fn total(&self) -> Option<u64> {
        self.total
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    fn is_stream(&self) -> bool {
        true
    }
}

fn mixed(samples: &[u16], depth: u32, bits: u32) -> Vec<u16> {
    let mix = |rgb: &[u16]| convert_depth(luma(rgb[0], rgb[1], rgb[2]), depth, bits);
    samples.chunks_exact(3).map(mix).collect()
}
