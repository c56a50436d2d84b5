// SPDX-License-Identifier: MIT OR Apache-2.0
//! The playback of a run: each clip is shown to a camera of its own, one after the other.

use crate::InferenceError;
use crate::camera::{CameraSetup, ReceivedFrame, ReceiverCamera};
use foveate_media::{ClipPlayer, PlaybackError, RunClips, RunMonitor};
use std::num::NonZeroU32;

pub(crate) trait FrameConsumer {
    /// Starts a clip or a data set. A data set comes with the network's input for a black screen,
    /// from which each of its frames starts.
    fn begin_clip(&mut self, clip: &str, black: Option<&[f32]>);

    /// Takes the next frame of the clip.
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
    /// The monitor of the run, over all clips.
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
