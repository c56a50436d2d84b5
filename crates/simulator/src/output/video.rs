// SPDX-License-Identifier: MIT OR Apache-2.0
//! A video file, through ffmpeg at the other end of a pipe: lossless FFV1 in `.mkv`, H.264 in `.mp4`.
//!
//! The video runs at one rate, that of its first two frames; a single frame is shown for 1/30 s.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;

use foveate_toolchain::{Tool, Toolchain, apart};

use super::cannot_write;
use super::gallery::{Picture, Samples};
use crate::SimulatorError;

/// A video in the making.
pub(super) struct VideoFile {
    path: PathBuf,
    ffmpeg: PathBuf,
    state: State,
}

enum State {
    Empty,
    /// The first picture waits for the time of the second.
    First(Picture, u64),
    Running(Encoder),
}

/// The process, and what it complains about.
struct Encoder {
    child: Child,
    complaints: Option<JoinHandle<String>>,
}

impl VideoFile {
    /// A file whose extension says what it is.
    pub(super) fn create(path: &Path) -> Result<Self, SimulatorError> {
        let found = Toolchain::system().find(Tool::Ffmpeg);
        let ffmpeg = found.map_err(|error| SimulatorError::NoVideo(Box::new(error)))?.path;
        Ok(Self { path: path.to_owned(), ffmpeg, state: State::Empty })
    }

    pub(super) fn push(&mut self, picture: Picture, time_us: u64) -> Result<(), SimulatorError> {
        match std::mem::replace(&mut self.state, State::Empty) {
            State::Empty => self.state = State::First(picture, time_us),
            State::First(first, start) => {
                let rate = frame_rate(time_us.saturating_sub(start));
                let encoder = self.start(&first, &rate)?;
                self.state = State::Running(encoder);
                self.feed(&first.bytes)?;
                self.feed(&picture.bytes)?;
            }
            State::Running(encoder) => {
                self.state = State::Running(encoder);
                self.feed(&picture.bytes)?;
            }
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        if let State::First(first, _) = &self.state {
            let encoder = self.start(first, "30")?;
            let state = std::mem::replace(&mut self.state, State::Running(encoder));
            if let State::First(first, _) = state {
                self.feed(&first.bytes)?;
            }
        }
        match &mut self.state {
            State::Running(encoder) => {
                drop(encoder.child.stdin.take());
                let status = encoder.child.wait().map_err(cannot_write(&self.path))?;
                if status.success() { Ok(()) } else { Err(self.failure()) }
            }
            State::Empty | State::First(..) => Ok(()),
        }
    }

    fn start(&self, picture: &Picture, rate: &str) -> Result<Encoder, SimulatorError> {
        let format = match picture.samples {
            Samples::Grey8 => "gray",
            Samples::Grey16 if cfg!(target_endian = "big") => "gray16be",
            Samples::Grey16 => "gray16le",
            Samples::Rgb8 => "rgb24",
        };
        let size = format!("{}x{}", picture.width, picture.height);
        let mut command = Command::new(&self.ffmpeg);
        command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"]);
        command.args(["-pixel_format", format, "-video_size", &size, "-framerate", rate]);
        command.args(["-i", "pipe:0", "-an"]).args(self.codec(picture.samples)).arg(&self.path);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        apart(&mut command);
        let mut child = command.spawn().map_err(cannot_write(&self.path))?;
        let complaints = child.stderr.take().map(|mut stderr| {
            std::thread::spawn(move || {
                let mut text = Vec::new();
                let _ = stderr.read_to_end(&mut text);
                String::from_utf8_lossy(&text).into_owned()
            })
        });
        Ok(Encoder { child, complaints })
    }

    fn codec(&self, samples: Samples) -> &'static [&'static str] {
        let lossless = self.path.extension().is_some_and(|extension| extension == "mkv");
        match (lossless, samples) {
            (true, Samples::Rgb8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0"],
            (true, Samples::Grey8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray"],
            (true, Samples::Grey16) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray16le"],
            // Players want 4:2:0, which wants even sides.
            (false, _) => &[
                "-vf",
                "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                "-c:v",
                "libx264",
                "-crf",
                "16",
                "-pix_fmt",
                "yuv420p",
                "-movflags",
                "+faststart",
            ],
        }
    }

    fn feed(&mut self, bytes: &[u8]) -> Result<(), SimulatorError> {
        let State::Running(encoder) = &mut self.state else { return Ok(()) };
        let written = encoder.child.stdin.as_mut().map_or(Ok(()), |pipe| pipe.write_all(bytes));
        written.map_err(|_| self.failure())
    }

    /// Why ffmpeg has ended too early.
    fn failure(&mut self) -> SimulatorError {
        let mut said = String::new();
        if let State::Running(encoder) = &mut self.state {
            drop(encoder.child.stdin.take());
            let _ = encoder.child.wait();
            let complaints = encoder.complaints.take().and_then(|thread| thread.join().ok());
            said = complaints.unwrap_or_default();
        }
        let problem = said.lines().map(str::trim).rfind(|line| !line.is_empty());
        SimulatorError::VideoOutput {
            path: self.path.clone(),
            problem: problem.unwrap_or("ffmpeg ended too early").to_owned(),
        }
    }
}

impl Drop for Encoder {
    /// Nothing of an unfinished video is of use.
    fn drop(&mut self) {
        drop(self.child.stdin.take());
        if !matches!(self.child.try_wait(), Ok(Some(_))) {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// The rate that an interval between frames stands for: whole, or whole * 1000/1001, where rounding
/// to microseconds gives that interval, else one frame per interval.
fn frame_rate(interval_us: u64) -> String {
    if interval_us == 0 {
        return "30".to_owned();
    }
    let nearest = ((1_000_000 + interval_us / 2) / interval_us).max(1);
    let rounded = |span: u64| (span + nearest / 2) / nearest;
    if rounded(1_000_000) == interval_us {
        nearest.to_string()
    } else if rounded(1_001_000) == interval_us {
        format!("{}/1001", nearest * 1000)
    } else {
        format!("1000000/{interval_us}")
    }
}

#[cfg(test)]
mod tests {
    use super::frame_rate;

    #[test]
    fn common_rates_are_recognized() {
        let expected = [(33_333, "30"), (33_367, "30000/1001"), (41_708, "24000/1001")];
        for (interval, rate) in expected {
            assert_eq!(frame_rate(interval), rate);
        }
        assert_eq!([40_000, 1_000_000, 12_345].map(frame_rate), ["25", "1", "1000000/12345"]);
        assert_eq!([0, 2_000_000].map(frame_rate), ["30", "1000000/2000000"]);
    }
}
