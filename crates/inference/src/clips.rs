// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips of a run. All have the same size. They are shown one after the other, each to its own
//! camera.

use crate::InferenceError;
use crate::camera::{CameraSetup, ReceivedFrame, ReceiverCamera};
use foveate_design::DesignConfig;
use foveate_footage::boxes::{BoxFile, ClipToLabel, assign_boxes};
use foveate_footage::{
    ComparedInput, FootageError, FrameSource, InputOptions, RunHooks, RunProgress,
    input_without_secrets, is_read_once, open, read_ahead, subjects,
};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

/// The clips and data sets of a run.
pub(crate) struct RunClips {
    subjects: Vec<ComparedInput>,
    config: DesignConfig,
    input: InputOptions,
    /// The source of a single clip, already open, because some sources cannot be opened twice.
    open_source: Option<Box<dyn FrameSource>>,
    /// The width and height of all frames in pixels.
    pub(crate) size: (u32, u32),
    /// The number of frames of all clips, if it is known.
    frames: Option<u64>,
    /// The ground-truth boxes of every clip; empty without ground truth.
    boxes: Vec<Arc<BoxFile>>,
}

/// A consumer of the frames of clips.
pub(crate) trait FrameConsumer {
    /// Starts a clip or a data set. A data set comes with the network's input for a black screen,
    /// from which each of its frames starts.
    fn begin_clip(&mut self, clip: &str, black: Option<&[f32]>);

    /// Takes the next frame of the clip.
    fn take_frame(&mut self, seen: ReceivedFrame<'_>) -> Result<(), InferenceError>;

    /// Ends the clip, with the reason for missing frames if some are missing.
    fn end_clip(&mut self, problem: Option<String>);
}

/// A run through clips in progress. Each clip is shown to its own camera.
pub(crate) struct ClipPlayback<'a> {
    pub(crate) setup: CameraSetup<'a>,
    pub(crate) clips: &'a mut RunClips,
    /// The distance between the frames of a clip that the network sees; 1 if it sees all.
    pub(crate) every: NonZeroU32,
    /// The number of frames that are done.
    pub(crate) frames_done: u64,
}

/// The reason for missing frames after an interruption.
const INTERRUPTED: &str = "it was interrupted";

impl RunClips {
    /// Opens all inputs and checks that they have one size. Image files together are one clip;
    /// every other input is a clip or data set of its own. Ground-truth boxes come from one file or
    /// folder for all clips, or from one for each clip.
    pub(crate) fn new(
        inputs: &[PathBuf],
        boxes: &[PathBuf],
        config: &DesignConfig,
        input: &InputOptions,
    ) -> Result<Self, InferenceError> {
        // Boxes belong to frame numbers, so the inputs must number their frames.
        let input = &InputOptions { numbered: !boxes.is_empty(), ..input.clone() };
        let subjects = subjects(inputs, input)?;
        let several = subjects.len() > 1;
        let mut found = Self {
            subjects: Vec::new(),
            config: config.clone(),
            input: input.clone(),
            open_source: None,
            size: (0, 0),
            frames: Some(0),
            boxes: Vec::new(),
        };
        for subject in subjects {
            if let Some(once) = subject.inputs.iter().find(|input| several && is_read_once(input)) {
                return Err(InferenceError::ReadOnce { input: input_without_secrets(once) });
            }
            let source = open(&subject.inputs, &config.camera, input)?;
            let size = source.size();
            match found.subjects.first() {
                None => found.size = size,
                Some(_) if size == found.size => {}
                Some(first) => {
                    return Err(InferenceError::DifferentSizes {
                        first: first.name.clone(),
                        first_size: found.size,
                        other: subject.name,
                        other_size: size,
                    });
                }
            }
            found.frames = found.frames.zip(source.frames()).map(|(all, own)| all + own);
            // A decoder is a process, so the decoders of many clips are not kept open.
            found.open_source = (!several).then_some(source);
            found.subjects.push(subject);
        }
        found.with_boxes(boxes)
    }

    /// Creates the clips of a run from one clip that is already open.
    pub(crate) fn from_source(
        source: Box<dyn FrameSource>,
        boxes: &[PathBuf],
        config: &DesignConfig,
    ) -> Result<Self, InferenceError> {
        let inputs = source.inputs().iter().map(PathBuf::from).collect();
        let name = source.inputs().join(", ");
        Self {
            subjects: vec![ComparedInput { name, inputs }],
            config: config.clone(),
            input: InputOptions::default(),
            size: source.size(),
            frames: source.frames(),
            boxes: Vec::new(),
            open_source: Some(source),
        }
        .with_boxes(boxes)
    }

    /// Reads the ground-truth boxes of all clips.
    fn with_boxes(mut self, files: &[PathBuf]) -> Result<Self, InferenceError> {
        if !files.is_empty() {
            let clips = self.subjects.iter();
            let clips = clips.map(|clip| ClipToLabel { name: &clip.name, input: &clip.inputs[0] });
            let clips: Vec<_> = clips.collect();
            self.boxes = assign_boxes(files, &clips)?;
        }
        Ok(self)
    }

    /// Returns whether there are ground-truth objects.
    pub(crate) fn has_boxes(&self) -> bool {
        !self.boxes.is_empty()
    }

    pub(crate) fn count(&self) -> usize {
        self.subjects.len()
    }

    /// Returns the inputs of every clip as the user named them.
    pub(crate) fn inputs(&self) -> Vec<String> {
        let all = self.subjects.iter().flat_map(|subject| &subject.inputs);
        all.map(|input| input_without_secrets(input)).collect()
    }

    fn open(&mut self, clip: usize) -> Result<Box<dyn FrameSource>, InferenceError> {
        let opened = self.open_source.take().map_or_else(
            || open(&self.subjects[clip].inputs, &self.config.camera, &self.input),
            Ok,
        );
        Ok(opened?)
    }
}

impl ClipPlayback<'_> {
    /// Shows some of the clips, until they end or `hooks` cancels. Returns whether all of them were
    /// shown.
    ///
    /// # Errors
    /// Fails if a frame cannot be read or a clip has no frames, or if `hooks` cancels before the
    /// first frame.
    pub(crate) fn play_clips(
        &mut self,
        clips: std::ops::Range<usize>,
        hooks: &mut dyn RunHooks,
        audience: &mut dyn FrameConsumer,
    ) -> Result<bool, InferenceError> {
        for clip in clips {
            if self.frames_done > 0 && hooks.is_cancelled() {
                return Ok(false);
            }
            let mut source = match self.clips.open(clip) {
                Err(InferenceError::Cancelled) if self.frames_done > 0 => return Ok(false),
                source => source?,
            };
            let kind = source.kind();
            let mut camera = ReceiverCamera::new(self.setup, kind);
            audience.begin_clip(&self.clips.subjects[clip].name, camera.black_input());
            let before = self.frames_done;
            let ended = match self.play_clip(clip, source.as_mut(), &mut camera, hooks, audience) {
                // The wait for a frame was cancelled.
                Err(InferenceError::Cancelled) => false,
                ended => ended?,
            };
            match (ended, self.frames_done - before) {
                (false, 0) if before == 0 => return Err(InferenceError::Cancelled),
                (true, 0) => {
                    let inputs = source.inputs().join(", ");
                    return Err(FootageError::NoFrames { inputs }.into());
                }
                (false, _) => {
                    audience.end_clip(Some(INTERRUPTED.to_owned()));
                    return Ok(false);
                }
                (true, _) => audience.end_clip(source.problem()),
            }
        }
        Ok(true)
    }

    /// Shows every frame to the camera, and gives `audience` every frame that the network sees,
    /// with its objects if its place in the input is known. Returns whether the clip was shown to
    /// its end.
    fn play_clip(
        &mut self,
        clip: usize,
        source: &mut dyn FrameSource,
        camera: &mut ReceiverCamera,
        hooks: &mut dyn RunHooks,
        audience: &mut dyn FrameConsumer,
    ) -> Result<bool, InferenceError> {
        let (total, boxes) = (self.clips.frames, self.clips.boxes.get(clip));
        let (mut fits, mut number) = (boxes.is_none(), 0_u64);
        read_ahead(source, |frames| {
            while let Some((current, origin)) = frames.next()? {
                if hooks.is_cancelled() {
                    return Ok(false);
                }
                let objects = match boxes.zip(origin) {
                    Some((boxes, at)) => {
                        boxes.object_rects(&current, &at, self.clips.input.crop)?
                    }
                    None => None,
                };
                fits |= objects.is_some();
                if number.is_multiple_of(self.every.get().into()) {
                    audience.take_frame(camera.receive_frame(&current, objects)?)?;
                } else {
                    camera.skip_frame(&current)?;
                }
                number += 1;
                frames.recycle(current);
                self.frames_done += 1;
                hooks.progress(RunProgress { done: self.frames_done, total });
            }
            match boxes.filter(|_| !fits) {
                Some(boxes) => Err(boxes.no_entry_error(&self.clips.subjects[clip].name).into()),
                None => Ok(true),
            }
        })
    }
}
