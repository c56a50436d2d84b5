// SPDX-License-Identifier: MIT OR Apache-2.0
//! The player of a clip: an iterator of its frames, which are read ahead.

use std::path::Path;

use crate::{
    CropRect, FootageError, FrameSource, InputOptions, LumaRange, SetForm, SourceKind, open,
};
use foveate_camera::CameraConfig;
use foveate_tools::Interrupt;

use crate::playback::reader::{FrameReader, ReaderMessage};
use crate::playback::{PlaybackError, PlayedFrame};

/// The frames of a clip or data set, in order. The first call of `next` starts to read. The frames
/// end after an error.
pub struct ClipPlayer {
    size: (u32, u32),
    inputs: Vec<String>,
    frames: Option<u64>,
    kind: SourceKind,
    form: SetForm,
    luma: Option<LumaRange>,
    crop: Option<CropRect>,
    /// The interrupt that the source was opened with, if the player opened it.
    interrupt: Interrupt,
    limit: u64,
    state: PlayerState,
    /// The number of the next frame.
    next: u64,
    problem: Option<String>,
}

enum PlayerState {
    Opened(Box<dyn FrameSource>),
    Reading(FrameReader),
    Ended,
}

impl ClipPlayer {
    /// Opens inputs as one clip or data set, as [`crate::open`] does.
    ///
    /// # Errors
    /// Fails if the inputs cannot be opened as one clip.
    pub fn open<P: AsRef<Path>>(
        inputs: &[P],
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> Result<Self, PlaybackError> {
        let interrupt = options.interrupt.of_part();
        let options = InputOptions { interrupt: interrupt.clone(), ..options.clone() };
        let player = Self::from(open(inputs, camera, &options)?);
        Ok(Self { interrupt, ..player })
    }

    /// Ends the clip after at most this number of frames, and reads none beyond.
    #[must_use]
    pub fn limited_to(self, frames: u64) -> Self {
        Self { limit: frames, ..self }
    }

    /// Returns the width and height of every frame.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Returns the inputs as the user named them.
    #[must_use]
    pub fn inputs(&self) -> &[String] {
        &self.inputs
    }

    /// Returns the number of all frames, if it is known. It may be wrong for a video.
    #[must_use]
    pub fn frames(&self) -> Option<u64> {
        self.frames
    }

    /// Returns the relation between the frames.
    #[must_use]
    pub fn kind(&self) -> SourceKind {
        self.kind
    }

    /// Returns the kind of the files and of the labels of a set.
    #[must_use]
    pub fn form(&self) -> &SetForm {
        &self.form
    }

    /// Returns the part of each frame that is kept, if the frames are cropped.
    #[must_use]
    pub fn crop(&self) -> Option<CropRect> {
        self.crop
    }

    /// Returns the range of luma, if the input is video.
    #[must_use]
    pub fn luma(&self) -> Option<LumaRange> {
        self.luma
    }

    /// After the last frame, returns the problem because of which the clip ended too early. The
    /// frames before it are valid.
    #[must_use]
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Returns the reader, which is started if the clip was only opened, or `None` after the end.
    fn reader(&mut self) -> Result<Option<&mut FrameReader>, FootageError> {
        match std::mem::replace(&mut self.state, PlayerState::Ended) {
            PlayerState::Opened(source) => {
                let reader = FrameReader::start(source, self.limit, self.interrupt.clone())?;
                self.state = PlayerState::Reading(reader);
            }
            other => self.state = other,
        }
        Ok(match &mut self.state {
            PlayerState::Reading(reader) => Some(reader),
            PlayerState::Opened(_) | PlayerState::Ended => None,
        })
    }

    fn next_frame(&mut self) -> Result<Option<PlayedFrame>, PlaybackError> {
        let (kind, number) = (self.kind, self.next);
        let Some(reader) = self.reader()? else { return Ok(None) };
        match reader.receive() {
            ReaderMessage::Frame(frame, origin) => {
                let used = reader.used.clone();
                self.next += 1;
                Ok(Some(PlayedFrame::new((frame, origin), number, kind, used)))
            }
            ReaderMessage::End(problem) => {
                (self.state, self.problem) = (PlayerState::Ended, problem);
                if number == 0 && self.limit > 0 {
                    let inputs = self.inputs.join(", ");
                    return Err(FootageError::NoFrames { inputs }.into());
                }
                Ok(None)
            }
            ReaderMessage::Failed(error) => {
                self.state = PlayerState::Ended;
                Err(error.into())
            }
        }
    }
}

impl From<Box<dyn FrameSource>> for ClipPlayer {
    fn from(source: Box<dyn FrameSource>) -> Self {
        Self {
            size: source.size(),
            inputs: source.inputs().to_vec(),
            frames: source.frames(),
            kind: source.kind(),
            form: source.form(),
            luma: source.luma(),
            crop: source.crop(),
            interrupt: Interrupt::default(),
            limit: u64::MAX,
            state: PlayerState::Opened(source),
            next: 0,
            problem: None,
        }
    }
}

impl Iterator for ClipPlayer {
    type Item = Result<PlayedFrame, PlaybackError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_frame().transpose()
    }
}

impl std::fmt::Debug for ClipPlayer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ClipPlayer").field("inputs", &self.inputs).finish_non_exhaustive()
    }
}
