// SPDX-License-Identifier: MIT OR Apache-2.0
//! The playback of a run ([`ClipPlayback`]): each clip is shown to a camera of its own, one
//! after the other, and a [`FrameConsumer`] gets the frames. Tuning keeps them in memory,
//! because it runs the network on them many times ([`KeptClips`]).

use crate::InferenceError;
use crate::camera::{CameraSetup, KeptFrame, ReceivedFrame, ReceiverCamera};
use foveate_media::{ClipPlayer, PlaybackError, RunClips, RunMonitor};
use std::num::NonZeroU32;

pub(crate) trait FrameConsumer {
    /// Starts a clip or a data set. A data set comes with the network's input for a black screen,
    /// from which each of its frames starts.
    fn begin_clip(&mut self, clip: &str, black: Option<&[f32]>);

    fn take_frame(&mut self, seen: ReceivedFrame<'_>) -> Result<(), InferenceError>;

    /// Ends the clip, with the reason for missing frames if some are missing.
    fn end_clip(&mut self, problem: Option<String>);
}

/// The clips of a run, and the camera of each of them.
pub(crate) struct ClipPlayback<'a> {
    pub(crate) setup: CameraSetup<'a>,
    pub(crate) clips: &'a RunClips,
    /// The distance between the frames of a clip that the network sees; 1 if it sees all.
    pub(crate) every: NonZeroU32,
    pub(crate) monitor: RunMonitor<'a>,
}

/// The reason for missing frames after an interruption.
const INTERRUPTED: &str = "it was interrupted";

impl ClipPlayback<'_> {
    /// Shows some of the clips, until they end or the run is to stop. Returns whether all of them
    /// were shown.
    ///
    /// # Errors
    /// Fails if a frame cannot be read or a clip has no frames, or if the run is to stop before the
    /// first frame.
    pub(crate) fn play_clips(
        &self,
        clips: std::ops::Range<usize>,
        consumer: &mut dyn FrameConsumer,
    ) -> Result<bool, InferenceError> {
        for clip in clips {
            let before = self.monitor.frames_done();
            let opened = self.monitor.check().and_then(|()| self.clips.open(clip));
            let mut player = match opened {
                Err(PlaybackError::Interrupted) if before > 0 => return Ok(false),
                player => player?,
            };
            let mut camera = ReceiverCamera::new(self.setup, player.kind());
            consumer.begin_clip(&self.clips.clips()[clip].name, camera.black_input());
            match self.play_clip(clip, &mut player, &mut camera, consumer) {
                Err(InferenceError::Playback(PlaybackError::Interrupted))
                    if self.monitor.frames_done() > 0 =>
                {
                    consumer.end_clip(Some(INTERRUPTED.to_owned()));
                    return Ok(false);
                }
                ended => ended?,
            }
            consumer.end_clip(player.problem().map(str::to_owned));
        }
        Ok(true)
    }

    /// Shows every frame to the camera, and gives `consumer` every frame that the network sees,
    /// with its objects if its place in the input is known.
    fn play_clip(
        &self,
        clip: usize,
        player: &mut ClipPlayer,
        camera: &mut ReceiverCamera,
        consumer: &mut dyn FrameConsumer,
    ) -> Result<(), InferenceError> {
        let mut has_entry = false;
        for frame in self.monitor.watch(player) {
            let frame = frame?;
            let objects = self.clips.objects(clip, &frame)?;
            has_entry |= objects.is_some();
            if frame.number.is_multiple_of(self.every.get().into()) {
                consumer.take_frame(camera.receive_frame(&frame, objects)?)?;
            } else {
                camera.skip_frame(&frame)?;
            }
        }
        Ok(self.clips.check_entries(clip, has_entry)?)
    }
}

/// The most bytes of frames that are kept in memory.
const MAX_KEPT_BYTES: usize = 4 << 30;

#[derive(Debug, Default)]
pub(crate) struct KeptClips {
    clips: Vec<KeptClip>,
    bytes: usize,
    frames: usize,
}

/// A clip or data set whose frames are kept.
#[derive(Debug)]
struct KeptClip {
    name: String,
    black_input: Option<Vec<f32>>,
    frames: Vec<KeptFrame>,
    /// The reason for missing frames, if some are missing.
    problem: Option<String>,
}

impl KeptClip {
    fn clip_part<'a>(&'a self, frames: &'a [KeptFrame]) -> ClipPart<'a> {
        ClipPart { clip: &self.name, black: self.black_input.as_deref(), frames }
    }
}

/// Consecutive frames of one clip, or some frames of a data set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClipPart<'a> {
    pub(crate) clip: &'a str,
    /// The network's input for a black screen, from which every frame of a data set starts; `None`
    /// for a clip.
    pub(crate) black: Option<&'a [f32]>,
    pub(crate) frames: &'a [KeptFrame],
}

impl ClipPart<'_> {
    /// Returns the number of counted frames: all frames of a data set, and all frames of a clip but
    /// the first.
    fn counted_frames(&self) -> usize {
        if self.black.is_some() { self.frames.len() } else { self.frames.len().saturating_sub(1) }
    }
}

impl FrameConsumer for KeptClips {
    fn begin_clip(&mut self, clip: &str, black: Option<&[f32]>) {
        let (name, black) = (clip.to_owned(), black.map(<[f32]>::to_vec));
        self.clips.push(KeptClip { name, black_input: black, frames: Vec::new(), problem: None });
    }

    fn take_frame(&mut self, seen: ReceivedFrame<'_>) -> Result<(), InferenceError> {
        self.bytes += seen.kept_bytes();
        if self.bytes > MAX_KEPT_BYTES {
            return Err(InferenceError::TooLong { frames: self.frames });
        }
        self.frames += 1;
        self.clips
            .last_mut()
            .expect("a clip has begun")
            .frames
            .push(KeptFrame::from_received(seen));
        Ok(())
    }

    fn end_clip(&mut self, problem: Option<String>) {
        self.clips.last_mut().expect("a clip has begun").problem = problem;
    }
}

impl KeptClips {
    pub(crate) fn frames(&self) -> u64 {
        self.frames as u64
    }

    /// Returns the names of clips with missing frames, each with the reason.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &KeptClip| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// Returns the frames that a run over `clips` clips is tuned on: all clips that are kept. A
    /// single clip is split: its first half is tuned on, and its second half is returned to be
    /// reported.
    pub(crate) fn tuning_parts(
        &self,
        clips: usize,
    ) -> Result<(Vec<ClipPart<'_>>, Option<ClipPart<'_>>), InferenceError> {
        if clips == 1 {
            let [first, second] = self.halves()?;
            return Ok((vec![first], Some(second)));
        }
        let parts: Vec<_> = self.clips.iter().map(|clip| clip.clip_part(&clip.frames)).collect();
        if parts.iter().all(|part| part.counted_frames() == 0) {
            return Err(InferenceError::NoCountedFrame { clips: "clips to tune on" });
        }
        Ok((parts, None))
    }

    /// Returns both halves of the only clip, each with at least one counted frame.
    fn halves(&self) -> Result<[ClipPart<'_>; 2], InferenceError> {
        let clip = self.clips.first().expect("a clip has begun");
        // The first frame of each half of a clip is not counted.
        let least = if clip.black_input.is_some() { 2 } else { 4 };
        if self.frames < least {
            return Err(InferenceError::TooShort { frames: self.frames, least });
        }
        let (first, second) = clip.frames.split_at(self.frames / 2);
        Ok([first, second].map(|frames| clip.clip_part(frames)))
    }
}
