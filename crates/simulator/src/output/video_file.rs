// SPDX-License-Identifier: MIT OR Apache-2.0
//! A video file, written by ffmpeg through a pipe: lossless FFV1 in `.mkv`, H.264 in `.mp4`.
//!
//! The video has a constant rate, which follows from the times of its first two frames. A single
//! frame is shown for 1/30 s.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use foveate_media::PlaybackError;
use foveate_tools::{Interrupt, Invocation, ProgramWriter, Tool, ToolError, Toolchain, has_room};

use super::raw_image::{RawImage, SampleFormat};
use crate::SimulatorError;

/// The largest number of bytes of disk space that ffmpeg asks for at once.
const ENCODER_SPACE_BYTES: u64 = 1 << 20;

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
    encoder: EncoderState,
}

enum EncoderState {
    Empty,
    /// The first picture, which waits for the time of the second one.
    OnePicture(RawImage, u64),
    Running(ProgramWriter),
    /// ffmpeg ended too early with this message.
    Failed(EncoderFailure),
}

impl VideoFile {
    /// Makes a file whose extension decides the format.
    pub(super) fn create(path: &Path, interrupt: &Interrupt) -> Result<Self, SimulatorError> {
        let found = Toolchain::system().with_cancel_flag(interrupt.flag()).find(Tool::Ffmpeg);
        let ffmpeg = found.map_err(|error| match error.is_interrupted() {
            true => PlaybackError::Interrupted.into(),
            false => SimulatorError::NoVideo(Box::new(error)),
        });
        let (path, interrupt) = (path.to_owned(), interrupt.clone());
        Ok(Self { path, ffmpeg: ffmpeg?.path, interrupt, encoder: EncoderState::Empty })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Takes the next picture. If ffmpeg fails, [`VideoFile::check_encoder`] returns the error.
    pub(super) fn push(&mut self, picture: RawImage, time_us: u64) -> Result<(), SimulatorError> {
        self.encoder = match std::mem::replace(&mut self.encoder, EncoderState::Empty) {
            EncoderState::Empty => EncoderState::OnePicture(picture, time_us),
            EncoderState::OnePicture(first, start) => {
                let rate = frame_rate(time_us.saturating_sub(start));
                let writer = self.start(&first, &rate)?;
                match self.feed(writer, &first)? {
                    EncoderState::Running(writer) => self.feed(writer, &picture)?,
                    other => other,
                }
            }
            EncoderState::Running(writer) => self.feed(writer, &picture)?,
            failed @ EncoderState::Failed(_) => failed,
        };
        Ok(())
    }

    /// Checks that ffmpeg has taken all pictures so far.
    pub(super) fn check_encoder(&self) -> Result<(), SimulatorError> {
        let EncoderState::Failed(EncoderFailure { said, is_full }) = &self.encoder else {
            return Ok(());
        };
        let (path, problem) = (self.path.clone(), said.clone());
        Err(SimulatorError::VideoOutput { path, problem, is_full: *is_full })
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        if let EncoderState::OnePicture(first, _) = &self.encoder {
            let writer = self.start(first, "30")?;
            self.encoder = self.feed(writer, first)?;
        }
        if let EncoderState::Running(writer) = &mut self.encoder {
            match writer.finish() {
                Ok((true, _)) => {}
                Ok((false, said)) => self.encoder = self.failed_state(said),
                Err(error) => self.encoder = EncoderState::of_tool_error(&error),
            }
        }
        self.check_encoder()
    }

    fn start(&self, picture: &RawImage, rate: &str) -> Result<ProgramWriter, SimulatorError> {
        let format = match picture.samples {
            SampleFormat::Grey8 => "gray",
            SampleFormat::Grey16 if cfg!(target_endian = "big") => "gray16be",
            SampleFormat::Grey16 => "gray16le",
            SampleFormat::Rgb8 => "rgb24",
        };
        let size = format!("{}x{}", picture.width, picture.height);
        let invocation = Invocation::new(&self.ffmpeg)
            .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"])
            .args(["-pixel_format", format, "-video_size", &size, "-framerate", rate])
            .args(["-i", "pipe:0", "-an"])
            .args(self.codec_arguments(picture.samples))
            .arg(file_argument(&self.path));
        ProgramWriter::start(&invocation, &self.interrupt)
            .map_err(|error| SimulatorError::Tool(Box::new(error)))
    }

    fn codec_arguments(&self, samples: SampleFormat) -> &'static [&'static str] {
        let lossless = self.path.extension().is_some_and(|extension| extension == "mkv");
        match (lossless, samples) {
            (true, SampleFormat::Rgb8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0"],
            (true, SampleFormat::Grey8) => &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray"],
            (true, SampleFormat::Grey16) => {
                &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "gray16le"]
            }
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

    fn feed(
        &self,
        mut writer: ProgramWriter,
        picture: &RawImage,
    ) -> Result<EncoderState, SimulatorError> {
        if writer.write_all(&picture.bytes).is_ok() {
            return Ok(EncoderState::Running(writer));
        }
        // ffmpeg has ended, or has taken no data since an interrupt.
        Ok(writer.finish_after_failed_write().map_or_else(
            |error| EncoderState::of_tool_error(&error),
            |said| self.failed_state(said),
        ))
    }

    /// Makes the failed state. The last message of ffmpeg may not be the reason for its end, so the
    /// free disk space is tested, too.
    fn failed_state(&self, message: Option<String>) -> EncoderState {
        let message = message.map(|line| line.trim().to_owned());
        let message = message.unwrap_or_else(|| "ffmpeg ended too early".to_owned());
        let reasons = ["No space left on device", "Disk quota exceeded"];
        let has_room =
            || self.path.parent().is_none_or(|folder| has_room(folder, ENCODER_SPACE_BYTES));
        let is_full = reasons.iter().any(|reason| message.contains(reason)) || !has_room();
        EncoderState::Failed(EncoderFailure { said: message, is_full })
    }
}

impl EncoderState {
    fn of_tool_error(error: &ToolError) -> Self {
        Self::Failed(EncoderFailure { said: format!("ffmpeg failed: {error}"), is_full: false })
    }
}

/// Returns a path as ffmpeg takes it, so that a colon in it does not start a protocol.
fn file_argument(path: &Path) -> std::ffi::OsString {
    let mut name = std::ffi::OsString::from("file:");
    name.push(path);
    name
}

/// Returns the rate for an interval between frames in microseconds. The rate is a whole number, or
/// a whole number times 1000/1001, if its interval is this one after rounding to microseconds.
/// Otherwise it is one frame per interval.
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
