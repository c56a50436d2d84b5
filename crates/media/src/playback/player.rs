// SPDX-License-Identifier: MIT OR Apache-2.0
//! The player of a clip ([`ClipPlayer`]): an iterator of frames that a separate thread reads, a
//! few frames ahead of the work on them ([`FrameReader`]). Reading and work run in parallel,
//! and memory is bounded. When a [`PlayedFrame`] is dropped, its memory goes back to the reader
//! and is used again. Cameras of several depths see it as [`FrameDepths`].

use crate::playback::PlaybackError;
use crate::{
    CropRect, FootageError, FrameOrigin, FrameSource, InputOptions, LumaRange, SetForm,
    SourceFrame, SourceKind, open,
};
use foveate_camera::CameraConfig;
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::{ByteFrame, convert_depth};
use foveate_tools::Interrupt;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{Builder, JoinHandle};

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

/// A frame of a clip or data set.
#[derive(Debug)]
pub struct PlayedFrame {
    /// The number of the frame in its clip, from 0.
    pub number: u64,
    /// The relation between the frames of the clip.
    pub kind: SourceKind,
    /// The origin of the frame, if the source knows it.
    pub origin: Option<FrameOrigin>,
    /// The frame; `None` only while it is dropped.
    shown: Option<SourceFrame>,
    used: Sender<SourceFrame>,
}

impl PlayedFrame {
    pub(crate) fn new(
        (shown, origin): (SourceFrame, Option<FrameOrigin>),
        number: u64,
        kind: SourceKind,
        used: Sender<SourceFrame>,
    ) -> Self {
        Self { number, kind, origin, shown: Some(shown), used }
    }

    /// Returns true if the frame has no frame before it: the first frame of a clip, and every frame
    /// of a data set. A camera is reset before such a frame.
    #[must_use]
    pub fn is_first(&self) -> bool {
        match self.kind {
            SourceKind::Clip => self.number == 0,
            SourceKind::Set => true,
        }
    }

    /// Shows the frame to a camera of its depth, which is reset before a first frame.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size and depth.
    pub fn show_to<'a>(&self, engine: &'a mut Engine) -> Result<&'a FrameOutcome, PlaybackError> {
        self.show_pixels_to(engine, &self.frame)
    }

    /// Shows these pixels, which are the frame in the camera's depth, as [`PlayedFrame::show_to`]
    /// does.
    pub(crate) fn show_pixels_to<'a>(
        &self,
        engine: &'a mut Engine,
        pixels: &ByteFrame,
    ) -> Result<&'a FrameOutcome, PlaybackError> {
        if self.is_first() {
            engine.reset();
        }
        Ok(engine.step_byte_frame(pixels)?)
    }
}

impl Deref for PlayedFrame {
    type Target = SourceFrame;

    fn deref(&self) -> &SourceFrame {
        self.shown.as_ref().expect("it is there until the drop")
    }
}

impl Drop for PlayedFrame {
    fn drop(&mut self) {
        if let Some(shown) = self.shown.take() {
            // A reader that has ended needs no memory.
            let _ = self.used.send(shown);
        }
    }
}

/// A frame in its own depth and in other depths.
#[derive(Debug)]
pub struct FrameDepths<'a> {
    own: &'a PlayedFrame,
    others: BTreeMap<u32, ByteFrame>,
}

impl<'a> FrameDepths<'a> {
    /// Converts the frame to all depths in `depths`, in bits per pixel.
    ///
    /// # Errors
    /// Fails if a depth is out of range.
    pub fn from_frame(
        own: &'a PlayedFrame,
        depths: impl IntoIterator<Item = u32>,
    ) -> Result<Self, PlaybackError> {
        Self::from_disturbed(own, None, depths)
    }

    /// Does the same with other pixels in place of the frame's, if there are any.
    ///
    /// # Errors
    /// Fails if a depth is out of range.
    pub fn from_disturbed(
        own: &'a PlayedFrame,
        disturbed: Option<&ByteFrame>,
        depths: impl IntoIterator<Item = u32>,
    ) -> Result<Self, PlaybackError> {
        let mut others = BTreeMap::new();
        let shown = disturbed.unwrap_or(&own.frame);
        for bits in depths {
            if bits != shown.bits() && !others.contains_key(&bits) {
                others.insert(bits, at_depth(shown, bits)?);
            }
        }
        others.extend(disturbed.map(|frame| (frame.bits(), frame.clone())));
        Ok(Self { own, others })
    }

    /// Shows the frame to a camera in its depth, as [`PlayedFrame::show_to`] does.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size, or was not converted to its depth.
    pub fn show_to<'e>(&self, engine: &'e mut Engine) -> Result<&'e FrameOutcome, PlaybackError> {
        let bits = engine.camera().pixel_bits();
        self.own.show_pixels_to(engine, self.frame_at(bits))
    }

    /// Returns the frame with so many bits per pixel, or in its own depth if it was not converted
    /// to this one.
    #[must_use]
    pub fn frame_at(&self, bits: u32) -> &ByteFrame {
        self.others.get(&bits).unwrap_or(&self.own.frame)
    }
}

fn at_depth(frame: &ByteFrame, bits: u32) -> Result<ByteFrame, PlaybackError> {
    let (width, height, own) = (frame.width(), frame.height(), frame.bits());
    let words = frame.borrowed_pixels().to_words().into_iter();
    let pixels = words.map(|pixel| convert_depth(pixel, own, bits));
    let converted = if bits <= 8 {
        let bytes = pixels.map(|pixel| u8::try_from(pixel).expect("at most 8 bits")).collect();
        ByteFrame::from_bytes(width, height, bits, bytes)
    } else {
        ByteFrame::from_words(width, height, bits, pixels.collect())
    };
    Ok(converted?)
}

/// The number of frames that wait. Besides them, one is being read and one is being worked on.
const FRAMES_AHEAD: usize = 3;

pub(crate) enum ReaderMessage {
    /// The next frame, and its origin.
    Frame(SourceFrame, Option<FrameOrigin>),
    /// The end of the frames, with the problem because of which they ended too early.
    End(Option<String>),
    /// A frame that cannot be read, after which there is none.
    Failed(FootageError),
}

/// The thread that reads a source. The drop of this value ends it.
pub(crate) struct FrameReader {
    /// The messages; `None` only while it is dropped.
    messages: Option<Receiver<ReaderMessage>>,
    /// The way back for the memory of frames.
    pub(crate) used: Sender<SourceFrame>,
    /// The interrupt that ends a wait of this source alone.
    interrupt: Interrupt,
    thread: Option<JoinHandle<()>>,
}

impl FrameReader {
    /// Starts to read at most `limit` frames. `interrupt` is the one that the source was opened
    /// with.
    pub(crate) fn start(
        mut source: Box<dyn FrameSource>,
        limit: u64,
        interrupt: Interrupt,
    ) -> Result<Self, FootageError> {
        let (sender, messages) = sync_channel(FRAMES_AHEAD);
        let (used, returned) = channel();
        let read = move || read_frames(source.as_mut(), limit, &sender, &returned);
        let thread = Builder::new().name("reader".to_owned()).spawn(read);
        let thread = thread.map_err(|error| FootageError::Thread { reason: error.to_string() })?;
        Ok(Self { messages: Some(messages), used, interrupt, thread: Some(thread) })
    }

    /// Waits for the next message. No message follows an end or a failure.
    pub(crate) fn receive(&mut self) -> ReaderMessage {
        if let Some(Ok(message)) = self.messages.as_ref().map(Receiver::recv) {
            return message;
        }
        // Only a panic ends the thread without a last message.
        match self.thread.take().map(JoinHandle::join) {
            Some(Err(panic)) => resume_unwind(panic),
            Some(Ok(())) | None => ReaderMessage::End(None),
        }
    }
}

impl Drop for FrameReader {
    fn drop(&mut self) {
        // The thread may wait for its input, or for room among the messages.
        self.interrupt.stop_part();
        drop(self.messages.take());
        // It is waited for, because it ends ffmpeg.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn read_frames(
    source: &mut dyn FrameSource,
    limit: u64,
    messages: &SyncSender<ReaderMessage>,
    returned: &Receiver<SourceFrame>,
) {
    for _ in 0..limit {
        let (message, is_last) = match source.next_frame() {
            Ok(Some(frame)) => (ReaderMessage::Frame(frame, source.origin()), false),
            Ok(None) => (ReaderMessage::End(source.problem()), true),
            Err(error) => (ReaderMessage::Failed(error), true),
        };
        // After the work is done, nothing receives frames any more.
        if messages.send(message).is_err() || is_last {
            return;
        }
        returned.try_iter().for_each(|frame| source.recycle(frame));
    }
    let _ = messages.send(ReaderMessage::End(None));
}
