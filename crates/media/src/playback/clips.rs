// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips and data sets of a run, with their ground-truth boxes.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::boxes::{BoxFile, ClipToLabel, assign_boxes};
use crate::{
    ComparedInput, InputOptions, Orientation, input_without_secrets, is_read_once, matched_images,
    subjects, turned_images_warning,
};
use foveate_camera::CameraConfig;
use foveate_pixels::Rect;

use crate::playback::{ClipPlayer, InputError, PlaybackError, PlayedFrame};

/// The clips and data sets of a run. Image files together are one clip; every other input is a clip
/// or data set of its own.
#[derive(Debug)]
pub struct RunClips {
    clips: Vec<ComparedInput>,
    camera: CameraConfig,
    options: InputOptions,
    /// The player of a single clip that is already open, because some inputs cannot be opened
    /// twice.
    opened: Mutex<Option<ClipPlayer>>,
    /// The ground-truth boxes of every clip; empty without ground truth.
    boxes: Vec<Arc<BoxFile>>,
}

/// The number of times that a run reads each of its clips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipReading {
    /// Each clip is read once, so a single clip may be an input that cannot be opened twice.
    Once,
    /// Each clip may be read several times.
    Repeated,
}

/// The size that all clips of a run have, and the number of their frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommonFormat {
    /// The width and height of all frames in pixels.
    pub size: (u32, u32),
    /// The number of frames of all clips, if it is known.
    pub frames: Option<u64>,
}

impl RunClips {
    /// Finds the clips, and reads their ground-truth boxes from one file or folder for all clips,
    /// or from one for each clip. The frames are opened for cameras of this configuration.
    ///
    /// # Errors
    /// Fails if an input does not exist, or if the boxes cannot be read or do not fit the clips.
    pub fn new(
        inputs: &[PathBuf],
        boxes: &[PathBuf],
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> Result<Self, PlaybackError> {
        // Boxes belong to frame numbers, so the inputs must number their frames.
        let numbered = options.numbered || !boxes.is_empty();
        let options = InputOptions { numbered, ..options.clone() };
        let clips = subjects(inputs, &options)?;
        let (opened, camera) = (Mutex::new(None), camera.clone());
        Self { clips, camera, options, opened, boxes: Vec::new() }.with_boxes(boxes)
    }

    /// Makes the clips of a run from one clip that is already open.
    ///
    /// # Errors
    /// Fails if the boxes cannot be read.
    pub fn from_player(player: ClipPlayer, boxes: &[PathBuf]) -> Result<Self, PlaybackError> {
        let inputs = player.inputs().iter().map(PathBuf::from).collect();
        let clips = vec![ComparedInput { name: player.inputs().join(", "), inputs }];
        let luma = player.luma().unwrap_or_default();
        let options = InputOptions { luma, crop: player.crop(), ..InputOptions::default() };
        let (camera, opened) = (CameraConfig::default(), Mutex::new(Some(player)));
        Self { clips, camera, options, opened, boxes: Vec::new() }.with_boxes(boxes)
    }

    fn with_boxes(mut self, files: &[PathBuf]) -> Result<Self, PlaybackError> {
        if !files.is_empty() {
            let clips = self.clips.iter();
            let clips = clips.map(|clip| ClipToLabel { name: &clip.name, input: &clip.inputs[0] });
            self.boxes = assign_boxes(files, &clips.collect::<Vec<_>>())?;
            for (clip, boxes) in self.clips.iter().zip(&self.boxes) {
                for input in &clip.inputs {
                    let images = matched_images(input, self.options.images);
                    boxes.check_images(&images)?;
                    if self.options.orientation == Orientation::Stored {
                        let warning = turned_images_warning(&images);
                        warning.into_iter().for_each(|text| self.options.warnings.add(text));
                    }
                }
            }
            let left_out = self.boxes.iter().filter_map(|boxes| boxes.left_out_in_words());
            left_out.for_each(|sentence| self.options.warnings.add(sentence));
        }
        Ok(self)
    }

    /// Opens every clip, and returns the size that all have.
    ///
    /// # Errors
    /// Fails if a clip cannot be opened as often as the run reads it, or if the sizes differ.
    pub fn common_format(&self, reading: ClipReading) -> Result<CommonFormat, PlaybackError> {
        self.check_reading(reading)?;
        let (mut common, mut frames) = (None, Some(0));
        for (number, clip) in self.clips.iter().enumerate() {
            let player = self.open(number)?;
            let (size, first) = (player.size(), &self.clips[0].name);
            let first_size = *common.get_or_insert(size);
            if size != first_size {
                let (first, other, other_size) = (first.clone(), clip.name.clone(), size);
                return Err(
                    InputError::DifferentSizes { first, first_size, other, other_size }.into()
                );
            }
            frames = frames.zip(player.frames()).map(|(all, own): (u64, u64)| all + own);
            // A decoder is a process, so the decoders of many clips are not kept open.
            if reading == ClipReading::Once && self.clips.len() == 1 {
                *self.opened() = Some(player);
            }
        }
        Ok(CommonFormat { size: common.unwrap_or_default(), frames })
    }

    fn check_reading(&self, reading: ClipReading) -> Result<(), PlaybackError> {
        let mut inputs = self.clips.iter().flat_map(|clip| &clip.inputs);
        let once =
            inputs.find(|input| is_read_once(input)).map(|input| input_without_secrets(input));
        match (reading, once) {
            (ClipReading::Once, Some(input)) if self.clips.len() > 1 => {
                Err(InputError::ReadOnceAmongOthers { input }.into())
            }
            (ClipReading::Repeated, Some(input)) => Err(InputError::ReadOnce { input }.into()),
            (ClipReading::Once | ClipReading::Repeated, _) => Ok(()),
        }
    }

    /// Opens a clip, which is given by its number.
    ///
    /// # Errors
    /// Fails if the clip cannot be opened.
    pub fn open(&self, clip: usize) -> Result<ClipPlayer, PlaybackError> {
        let opened = self.opened().take();
        opened.map_or_else(
            || ClipPlayer::open(&self.clips[clip].inputs, &self.camera, &self.options),
            Ok,
        )
    }

    fn opened(&self) -> MutexGuard<'_, Option<ClipPlayer>> {
        self.opened.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the clips with their names and inputs.
    #[must_use]
    pub fn clips(&self) -> &[ComparedInput] {
        &self.clips
    }

    /// Returns the options by which the clips are read.
    #[must_use]
    pub fn options(&self) -> &InputOptions {
        &self.options
    }

    /// Returns the inputs of all clips as the user named them.
    #[must_use]
    pub fn inputs(&self) -> Vec<String> {
        let all = self.clips.iter().flat_map(|clip| &clip.inputs);
        all.map(|input| input_without_secrets(input)).collect()
    }

    /// Returns the ground-truth boxes of a clip, which is given by its number, if there are any.
    #[must_use]
    pub fn boxes(&self, clip: usize) -> Option<&Arc<BoxFile>> {
        self.boxes.get(clip)
    }

    /// Returns the objects in a frame of a clip, which is given by its number; `None` if there are
    /// no boxes, or none with an entry for the frame.
    ///
    /// # Errors
    /// Fails if the boxes of the frame are ambiguous.
    pub fn objects(
        &self,
        clip: usize,
        frame: &PlayedFrame,
    ) -> Result<Option<Vec<Rect>>, PlaybackError> {
        let Some((boxes, origin)) = self.boxes(clip).zip(frame.origin) else { return Ok(None) };
        Ok(boxes.object_rects(frame, &origin, self.options.crop)?)
    }

    /// Checks that some frame of a clip had an entry in its boxes, if there are boxes.
    ///
    /// # Errors
    /// Fails if there are boxes and `has_entry` is false.
    pub fn check_entries(&self, clip: usize, has_entry: bool) -> Result<(), PlaybackError> {
        match self.boxes(clip).filter(|_| !has_entry) {
            Some(boxes) => Err(boxes.no_entry_error(&self.clips[clip].name).into()),
            None => Ok(()),
        }
    }
}
