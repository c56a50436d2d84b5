// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips of a run: all have one size, and each is shown to its own camera, one after the other.

use crate::InferenceError;
use crate::camera::{Camera, Seen, Shown};
use foveate_design::Config;
use foveate_footage::boxes::{Boxes, Clip, assign};
use foveate_footage::{
    FootageError, Hooks, InputOptions, Progress, Source, Subject, is_read_once, open, read_ahead,
    shown_input, subjects,
};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

/// The clips and data sets of a run.
pub(crate) struct Clips {
    subjects: Vec<Subject>,
    config: Config,
    input: InputOptions,
    /// The source of a single clip, already open, because some sources cannot be opened twice.
    only: Option<Box<dyn Source>>,
    /// The width and height of all frames in pixels.
    pub(crate) size: (u32, u32),
    /// The number of frames of all clips, if it is known.
    frames: Option<u64>,
    /// The ground-truth boxes of every clip; empty without ground truth.
    boxes: Vec<Arc<Boxes>>,
}

/// A consumer of the frames of clips.
pub(crate) trait Audience {
    /// Starts a clip or a data set. A data set comes with the network's input for a black screen,
    /// from which each of its frames starts.
    fn begin(&mut self, clip: &str, black: Option<&[f32]>);

    /// Takes the next frame of the clip.
    fn look(&mut self, seen: Seen<'_>) -> Result<(), InferenceError>;

    /// Ends the clip, with the reason for missing frames if some are missing.
    fn end(&mut self, problem: Option<String>);
}

/// The state of showing clips, each to its own camera.
pub(crate) struct Showing<'a> {
    pub(crate) shown: Shown<'a>,
    pub(crate) clips: &'a mut Clips,
    /// The interval of the frames that the network sees: one of so many frames of a clip.
    pub(crate) every: NonZeroU32,
    /// The number of frames that are done.
    pub(crate) done: u64,
}

/// The reason for missing frames after an interruption.
const INTERRUPTED: &str = "it was interrupted";

impl Clips {
    /// Opens all inputs and checks that they have one size. Image files together are one clip;
    /// every other input is a clip or data set of its own. Ground-truth boxes come from one file or
    /// folder for all clips, or from one for each clip.
    pub(crate) fn new(
        inputs: &[PathBuf],
        boxes: &[PathBuf],
        config: &Config,
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
            only: None,
            size: (0, 0),
            frames: Some(0),
            boxes: Vec::new(),
        };
        for subject in subjects {
            if let Some(once) = subject.inputs.iter().find(|input| several && is_read_once(input)) {
                return Err(InferenceError::ReadOnce { input: shown_input(once) });
            }
            let source = open(&subject.inputs, &config.camera, input)?;
            let size = source.size();
            match found.subjects.first() {
                None => found.size = size,
                Some(_) if size == found.size => {}
                Some(first) => {
                    return Err(InferenceError::Sizes {
                        first: first.name.clone(),
                        first_size: found.size,
                        other: subject.name,
                        other_size: size,
                    });
                }
            }
            found.frames = found.frames.zip(source.frames()).map(|(all, own)| all + own);
            // A decoder is a process, so the decoders of many clips are not kept open.
            found.only = (!several).then_some(source);
            found.subjects.push(subject);
        }
        found.with_boxes(boxes)
    }

    /// Creates the clips of a run from one clip that is already open.
    pub(crate) fn of(
        source: Box<dyn Source>,
        boxes: &[PathBuf],
        config: &Config,
    ) -> Result<Self, InferenceError> {
        let inputs = source.inputs().iter().map(PathBuf::from).collect();
        let name = source.inputs().join(", ");
        Self {
            subjects: vec![Subject { name, inputs }],
            config: config.clone(),
            input: InputOptions::default(),
            size: source.size(),
            frames: source.frames(),
            boxes: Vec::new(),
            only: Some(source),
        }
        .with_boxes(boxes)
    }

    /// Reads the ground-truth boxes of all clips.
    fn with_boxes(mut self, files: &[PathBuf]) -> Result<Self, InferenceError> {
        if !files.is_empty() {
            let clips = self.subjects.iter();
            let clips = clips.map(|clip| Clip { name: &clip.name, input: &clip.inputs[0] });
            let clips: Vec<_> = clips.collect();
            self.boxes = assign(files, &clips)?;
        }
        Ok(self)
    }

    /// Returns whether there are ground-truth objects.
    pub(crate) fn have_boxes(&self) -> bool {
        !self.boxes.is_empty()
    }

    pub(crate) fn count(&self) -> usize {
        self.subjects.len()
    }

    /// Returns the inputs of every clip as the user named them.
    pub(crate) fn inputs(&self) -> Vec<String> {
        let all = self.subjects.iter().flat_map(|subject| &subject.inputs);
        all.map(|input| shown_input(input)).collect()
    }

    fn open(&mut self, clip: usize) -> Result<Box<dyn Source>, InferenceError> {
        let opened = self.only.take().map_or_else(
            || open(&self.subjects[clip].inputs, &self.config.camera, &self.input),
            Ok,
        );
        Ok(opened?)
    }
}

impl Showing<'_> {
    /// Shows some of the clips, until they end or `hooks` cancels. Returns whether all of them were
    /// shown.
    ///
    /// # Errors
    /// Fails if a frame cannot be read or a clip has no frames, or if `hooks` cancels before the
    /// first frame.
    pub(crate) fn show(
        &mut self,
        clips: std::ops::Range<usize>,
        hooks: &mut dyn Hooks,
        audience: &mut dyn Audience,
    ) -> Result<bool, InferenceError> {
        for clip in clips {
            if self.done > 0 && hooks.cancelled() {
                return Ok(false);
            }
            let mut source = match self.clips.open(clip) {
                Err(InferenceError::Cancelled) if self.done > 0 => return Ok(false),
                source => source?,
            };
            let kind = source.kind();
            let mut camera = Camera::new(self.shown, kind);
            audience.begin(&self.clips.subjects[clip].name, camera.black());
            let before = self.done;
            let ended = match self.watch(clip, source.as_mut(), &mut camera, hooks, audience) {
                // The wait for a frame was cancelled.
                Err(InferenceError::Cancelled) => false,
                ended => ended?,
            };
            match (ended, self.done - before) {
                (false, 0) if before == 0 => return Err(InferenceError::Cancelled),
                (true, 0) => {
                    let inputs = source.inputs().join(", ");
                    return Err(FootageError::NoFrames { inputs }.into());
                }
                (false, _) => {
                    audience.end(Some(INTERRUPTED.to_owned()));
                    return Ok(false);
                }
                (true, _) => audience.end(source.problem()),
            }
        }
        Ok(true)
    }

    /// Shows every frame to the camera, and gives `audience` every frame that the network sees,
    /// with its objects if its place in the input is known. Returns whether the clip was shown to
    /// its end.
    fn watch(
        &mut self,
        clip: usize,
        source: &mut dyn Source,
        camera: &mut Camera,
        hooks: &mut dyn Hooks,
        audience: &mut dyn Audience,
    ) -> Result<bool, InferenceError> {
        let (total, boxes) = (self.clips.frames, self.clips.boxes.get(clip));
        let (mut fits, mut number) = (boxes.is_none(), 0_u64);
        read_ahead(source, |frames| {
            while let Some((current, origin)) = frames.next()? {
                if hooks.cancelled() {
                    return Ok(false);
                }
                let objects = match boxes.zip(origin) {
                    Some((boxes, at)) => boxes.objects(&current, &at, self.clips.input.crop)?,
                    None => None,
                };
                fits |= objects.is_some();
                if number.is_multiple_of(self.every.get().into()) {
                    audience.look(camera.see(&current, objects)?)?;
                } else {
                    camera.pass(&current)?;
                }
                number += 1;
                frames.give_back(current);
                self.done += 1;
                hooks.progress(Progress { done: self.done, total });
            }
            match boxes.filter(|_| !fits) {
                Some(boxes) => Err(boxes.none_fit(&self.clips.subjects[clip].name).into()),
                None => Ok(true),
            }
        })
    }
}
