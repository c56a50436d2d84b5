// SPDX-License-Identifier: MIT OR Apache-2.0
//! A video file, written by ffmpeg through a pipe: lossless FFV1 in `.mkv`, H.264 in `.mp4`.
//!
//! The video has a constant rate, which follows from the times of its first two frames. A single
//! frame is shown for 1/30 s.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use foveate_staging::has_room;
use foveate_toolchain::{Feeder, Interrupt, Invocation, Tool, ToolError, Toolchain};

use super::picture::{RawImage, Samples};
use crate::SimulatorError;

/// The largest number of bytes of disk space that ffmpeg asks for at once.
const ROOM: u64 = 1 << 20;

/// The reason why there is no video.
#[derive(Clone)]
struct EncoderFailure {
    said: String,
    is_full: bool,
}

/// A video while it is written.
pub(super) struct VideoFile {
    path: PathBuf,
    ffmpeg: PathBuf,
    interrupt: Interrupt,
    state: State,
}

enum State {
    Empty,
    /// The first picture, which waits for the time of the second one.
    First(RawImage, u64),
    Running(Feeder),
    /// ffmpeg ended too early with this message.
    Failed(EncoderFailure),
}

impl VideoFile {
    /// Makes a file whose extension decides the format.
    pub(super) fn create(path: &Path, interrupt: &Interrupt) -> Result<Self, SimulatorError> {
        let found = Toolchain::system().cancelled_by(interrupt.flag()).find(Tool::Ffmpeg);
        let ffmpeg = found.map_err(|error| match error.is_interrupted() {
            true => SimulatorError::Cancelled,
            false => SimulatorError::NoVideo(Box::new(error)),
        });
        let (path, interrupt) = (path.to_owned(), interrupt.clone());
        Ok(Self { path, ffmpeg: ffmpeg?.path, interrupt, state: State::Empty })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Takes the next picture. If ffmpeg fails, [`VideoFile::check`] returns the error.
    pub(super) fn push(&mut self, picture: RawImage, time_us: u64) -> Result<(), SimulatorError> {
        self.state = match std::mem::replace(&mut self.state, State::Empty) {
            State::Empty => State::First(picture, time_us),
            State::First(first, start) => {
                let rate = frame_rate(time_us.saturating_sub(start));
                let feeder = self.start(&first, &rate)?;
                match self.feed(feeder, &first)? {
                    State::Running(feeder) => self.feed(feeder, &picture)?,
                    other => other,
                }
            }
            State::Running(feeder) => self.feed(feeder, &picture)?,
            failed @ State::Failed(_) => failed,
        };
        Ok(())
    }

    /// Checks that ffmpeg has taken all pictures so far.
    pub(super) fn check(&self) -> Result<(), SimulatorError> {
        let State::Failed(EncoderFailure { said, is_full }) = &self.state else { return Ok(()) };
        let (path, problem) = (self.path.clone(), said.clone());
        Err(SimulatorError::VideoOutput { path, problem, is_full: *is_full })
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        if let State::First(first, _) = &self.state {
            let feeder = self.start(first, "30")?;
            self.state = self.feed(feeder, first)?;
        }
        if let State::Running(feeder) = &mut self.state {
            match feeder.finish() {
                Ok((true, _)) => {}
                Ok((false, said)) => self.state = self.failed(said),
                Err(error) => self.state = State::given_up(&error),
            }
        }
        self.check()
    }

    fn start(&self, picture: &RawImage, rate: &str) -> Result<Feeder, SimulatorError> {
        let format = match picture.samples {
            Samples::Grey8 => "gray",
            Samples::Grey16 if cfg!(target_endian = "big") => "gray16be",
            Samples::Grey16 => "gray16le",
            Samples::Rgb8 => "rgb24",
        };
        let size = format!("{}x{}", picture.width, picture.height);
        let invocation = Invocation::new(&self.ffmpeg)
            .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"])
            .args(["-pixel_format", format, "-video_size", &size, "-framerate", rate])
            .args(["-i", "pipe:0", "-an"])
            .args(self.codec(picture.samples))
            .arg(local(&self.path));
        Feeder::start(&invocation, &self.interrupt)
            .map_err(|error| SimulatorError::Tool(Box::new(error)))
    }

    fn codec(&self, samples: Samples) -> &'static [&'static str] {
        let lossless = self.path.extension().is_some_and(|extension| extension == "mkv");
        match (lossless, samples) {
            (true, Samples::Rgb8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0"],
            (true, Samples::Grey8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray"],
            (true, Samples::Grey16) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray16le"],
            // Many players support only 4:2:0, which needs even sides.
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

    fn feed(&self, mut feeder: Feeder, picture: &RawImage) -> Result<State, SimulatorError> {
        if feeder.write_all(&picture.bytes).is_ok() {
            return Ok(State::Running(feeder));
        }
        // ffmpeg has ended, or has taken no data since an interrupt.
        Ok(feeder.fail().map_or_else(|error| State::given_up(&error), |said| self.failed(said)))
    }

    /// Makes the failed state. The last message of ffmpeg may not be the reason for its end, so the
    /// free disk space is tested, too.
    fn failed(&self, said: Option<String>) -> State {
        let said = said.map(|line| line.trim().to_owned());
        let said = said.unwrap_or_else(|| "ffmpeg ended too early".to_owned());
        let words = ["No space left on device", "Disk quota exceeded"];
        let has_room = || self.path.parent().is_none_or(|folder| has_room(folder, ROOM));
        let is_full = words.iter().any(|words| said.contains(words)) || !has_room();
        State::Failed(EncoderFailure { said, is_full })
    }
}

impl State {
    fn given_up(error: &ToolError) -> Self {
        Self::Failed(EncoderFailure {
            said: format!("ffmpeg was given up: {error}"),
            is_full: false,
        })
    }
}

/// Returns a path as ffmpeg takes it, so that a colon in it does not start a protocol.
fn local(path: &Path) -> std::ffi::OsString {
    let mut name = std::ffi::OsString::from("file:");
    name.push(path);
    name
}

/// Returns the rate for an interval between frames in microseconds. It is a whole number, or whole
/// * 1000/1001, if rounding to microseconds gives this interval, otherwise one frame per interval.
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
