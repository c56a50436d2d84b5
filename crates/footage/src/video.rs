// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video through an ffmpeg process, frame by frame through a pipe: memory does not grow with it.
//!
//! * Luma is the Y plane as it was coded, without a change of range: what was 16..235 stays so, and a
//!   clip gives the same bits by way of `ffmpeg -f yuv4mpegpipe`. RGB video becomes luma as images do.
//! * ffmpeg's `showinfo` filter says size, format and time of a frame on the standard error before the
//!   frame itself comes through the pipe, so that times are the container's, and a change of size in
//!   mid-stream is seen. `-fps_mode passthrough` keeps ffmpeg from repeating or dropping frames.
//! * A late start is sought where that gives the same frames, see [`seek`].
//! * Rotation is ignored, as EXIF is.

mod decoder;
mod log;
mod probe;
mod seek;
mod truncated;

use std::path::{Path, PathBuf};

use foveate_frame::Raster;
use foveate_toolchain::{Tool, Toolchain};

use self::decoder::{Decoder, Ffmpeg, Start};
use self::log::Shown;
use self::probe::Probe;
use crate::source::feed::Feed;
use crate::{FootageError, FrameRate, SourceFrame};

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

    /// Why there is no frame.
    fn refused(&self, problem: String) -> FootageError {
        let path = self.path().to_owned();
        match self {
            Self::File(_) => FootageError::Video { path, problem },
            Self::Camera(_) => FootageError::Camera { path, problem },
        }
    }

    fn is_camera(&self) -> bool {
        matches!(self, Self::Camera(_))
    }
}

/// The frames of a video.
pub(crate) struct Video {
    medium: Medium,
    decoder: Decoder,
    total: Option<u64>,
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
    ) -> Result<Self, FootageError> {
        let tools = Toolchain::system();
        // Starting a program of ffmpeg's size takes as long as decoding some dozen frames.
        let (found, probe) = std::thread::scope(|scope| {
            let found = scope.spawn(|| tools.find(Tool::Ffmpeg));
            let probe = Probe::of(&tools, &medium);
            (found.join(), probe)
        });
        let found = found.unwrap_or_else(|_| tools.find(Tool::Ffmpeg))?;
        let probe = probe?;
        let ffmpeg = Ffmpeg { found, medium: medium.clone(), conversion: probe.conversion() };
        let sought = seek::start(&tools, &ffmpeg, &probe, start_us)?;
        let (decoder, first_pts) = match sought {
            Some(sought) => (sought.decoder, Some(sought.first_pts)),
            None => (Decoder::start(&ffmpeg, Start::Plain)?, None),
        };
        Ok(Self {
            medium,
            decoder,
            total: probe.frames,
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
        let mut problem = self.decoder.conclude();
        if let Medium::File(path) = &self.medium {
            problem = truncated::problem(path).or(problem);
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
        let Some(shown) = self.decoder.announced() else {
            self.conclude()?;
            return Ok(None);
        };
        let name = self.medium.path().display().to_string();
        match self.raster(&shown) {
            Ok(frame) => {
                let time_us = self.time_us(&shown);
                self.frames += 1;
                Ok(Some(SourceFrame { name, time_us, label: None, frame }))
            }
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
