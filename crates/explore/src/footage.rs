// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips of a run, and the measurements on them; finished measurements come from the store.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_camera::{Camera, CameraConfig};
use foveate_fidelity::{ErrorTally, FidelityFigures};
use foveate_footage::boxes::{BoxFile, ClipToLabel, assign_boxes};
use foveate_footage::{
    ComparedInput, FrameSource, InputOptions, SourceFrame, input_without_secrets, is_read_once,
    open, subjects,
};
use foveate_frame::Rect;

use crate::measure::{self, CameraMeasurement};
use crate::objects::ObjectCounts;
use crate::store::{MeasurementStore, clip_identity, measurement_key};
use crate::{ExploreError, ExploreHooks, ExploreProgress};

/// The number of designs that see a clip together. More designs share the work of decoding and of
/// the ideal camera; fewer designs lose less if the run is interrupted.
pub(crate) const CAMERAS_PER_UNIT: usize = 16;

/// The number of pairs of a clip and a camera that are done, and of all pairs.
pub(crate) struct MeasurementCount {
    done: AtomicUsize,
    all: usize,
}

impl MeasurementCount {
    pub(crate) fn from_total(all: usize) -> Self {
        Self { done: AtomicUsize::new(0), all }
    }

    fn add(&self, more: usize) {
        self.done.fetch_add(more, Ordering::Relaxed);
    }

    fn progress(&self) -> ExploreProgress {
        ExploreProgress::Measuring { done_pairs: self.done.load(Ordering::Relaxed), all: self.all }
    }
}

/// The clips of a run, which have one size.
pub(crate) struct ExplorationFootage<'a> {
    pub(crate) subjects: Vec<ComparedInput>,
    /// The width and height of all frames in pixels.
    pub(crate) size: (u32, u32),
    input: &'a InputOptions,
    ideal: &'a CameraConfig,
    hooks: &'a dyn ExploreHooks,
    /// The ground-truth boxes of every clip; empty without ground truth.
    pub(crate) boxes: Vec<Arc<BoxFile>>,
}

impl<'a> ExplorationFootage<'a> {
    /// Opens the inputs. Scenes get the frame size of the ideal camera, and all frames get its bits
    /// per pixel.
    pub(crate) fn new(
        inputs: &[PathBuf],
        input: &'a InputOptions,
        ideal: &'a CameraConfig,
        hooks: &'a dyn ExploreHooks,
    ) -> Result<Self, ExploreError> {
        if let Some(once) = inputs.iter().find(|input| is_read_once(input)) {
            return Err(ExploreError::ReadOnce { input: input_without_secrets(once) });
        }
        let subjects = subjects(inputs, input)?;
        let mut first: Option<(&str, (u32, u32))> = None;
        for subject in &subjects {
            let size = open(&subject.inputs, ideal, input)?.size();
            let (name, expected) = *first.get_or_insert((&subject.name, size));
            if size != expected {
                let text = |(width, height)| format!("{width}x{height}");
                return Err(ExploreError::DifferentSizes {
                    first: name.to_owned(),
                    first_size: text(expected),
                    other: subject.name.clone(),
                    other_size: text(size),
                });
            }
        }
        let size = first.map_or((0, 0), |(_, size)| size);
        Ok(Self { subjects, size, input, ideal, hooks, boxes: Vec::new() })
    }

    /// Reads the boxes of every clip from these files, if there are any.
    pub(crate) fn with_boxes(mut self, files: &[PathBuf]) -> Result<Self, ExploreError> {
        if !files.is_empty() {
            let clips = self.subjects.iter();
            let clips = clips.map(|clip| ClipToLabel { name: &clip.name, input: &clip.inputs[0] });
            self.boxes = assign_boxes(files, &clips.collect::<Vec<_>>())?;
        }
        Ok(self)
    }

    /// Returns the objects in a frame of a clip, which is given by its number; `None` if the boxes
    /// have no entry for the frame.
    pub(crate) fn objects(
        &self,
        clip: usize,
        frame: &SourceFrame,
        source: &dyn FrameSource,
    ) -> Result<Option<Vec<Rect>>, ExploreError> {
        let Some(boxes) = self.boxes.get(clip) else { return Ok(None) };
        let origin = source.origin().expect("an input knows where its frames are from");
        Ok(boxes.object_rects(frame, &origin, self.input.crop)?)
    }

    /// Returns the measurement of every clip and camera over the whole clip.
    pub(crate) fn measure_clips(
        &self,
        cameras: &[Camera],
        store: &MeasurementStore,
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let count = MeasurementCount::from_total(self.subjects.len() * cameras.len());
        let clips = 0..self.subjects.len();
        clips.map(|clip| self.measure_clip(clip, cameras, store, &count)).collect()
    }

    /// Returns the measurement of every camera over one clip, which is given by its number.
    pub(crate) fn measure_clip(
        &self,
        clip: usize,
        cameras: &[Camera],
        store: &MeasurementStore,
        count: &MeasurementCount,
    ) -> Result<Vec<CameraMeasurement>, ExploreError> {
        let keys = self.measurement_keys(clip, cameras);
        let mut found: Vec<Option<CameraMeasurement>> =
            keys.iter().map(|key| store.get(key)).collect();
        count.add(found.iter().flatten().count());
        let missing: Vec<usize> =
            (0..cameras.len()).filter(|&index| found[index].is_none()).collect();
        for some in missing.chunks(CAMERAS_PER_UNIT) {
            let together: Vec<Camera> = some.iter().map(|&index| cameras[index].clone()).collect();
            let whole = std::slice::from_ref(&(0..u64::MAX));
            let measured = self.measure_parts(clip, &together, whole, &|| count.progress())?;
            for (&index, mut parts) in some.iter().zip(measured) {
                let Some(measured) = parts.pop() else { continue };
                // A clip that ended early may be complete the next time.
                if measured.problem.is_none() {
                    store.put(&keys[index], &measured)?;
                }
                found[index] = Some(measured);
                count.add(1);
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// Returns the names of the measurements of some cameras over one clip, which is given by its
    /// number.
    pub(crate) fn measurement_keys(&self, clip: usize, cameras: &[Camera]) -> Vec<String> {
        let clip = clip_identity(&self.subjects[clip], self.input);
        let ideal = self.ideal.to_toml();
        cameras.iter().map(|camera| measurement_key(&clip, &ideal, camera.config())).collect()
    }

    /// Returns the number of bits per pixel.
    pub(crate) fn pixel_bits(&self) -> u32 {
        self.ideal.frame.pixel_bits
    }

    /// Reports progress.
    ///
    /// # Errors
    /// Fails if the work is to stop.
    pub(crate) fn report_progress(&self, progress: ExploreProgress) -> Result<(), ExploreError> {
        self.hooks.progress(progress);
        if self.hooks.cancelled() { Err(ExploreError::Cancelled) } else { Ok(()) }
    }

    /// Opens a clip from its beginning.
    pub(crate) fn open(
        &self,
        subject: &ComparedInput,
    ) -> Result<Box<dyn FrameSource>, ExploreError> {
        Ok(open(&subject.inputs, self.ideal, self.input)?)
    }

    /// Returns the figures of every camera over the first halves of all clips, and the counts of
    /// objects. `halves` has the number of frames of each first half. `before` is the number of
    /// cameras that were done before, for progress.
    pub(crate) fn measure_first_halves(
        &self,
        cameras: &[Camera],
        halves: &[(u64, u64)],
        before: usize,
    ) -> Result<Vec<(FidelityFigures, ObjectCounts)>, ExploreError> {
        let mut found = Vec::new();
        let all = before + cameras.len();
        for some in cameras.chunks(CAMERAS_PER_UNIT) {
            let mut sums: Vec<Option<(ErrorTally, ObjectCounts)>> = vec![None; some.len()];
            let done = before + found.len();
            let tell = || ExploreProgress::Measuring { done_pairs: done, all };
            for (clip, &(half, _)) in halves.iter().enumerate() {
                let measured =
                    self.measure_parts(clip, some, std::slice::from_ref(&(0..half)), &tell)?;
                for (sum, part) in sums.iter_mut().zip(measured.into_iter().flatten()) {
                    match sum {
                        Some((tally, objects)) => {
                            tally.merge(&part.tally);
                            objects.merge(part.objects);
                        }
                        None => *sum = Some((part.tally, part.objects)),
                    }
                }
            }
            let figures =
                |(tally, objects): &(ErrorTally, ObjectCounts)| (tally.figures(), *objects);
            found.extend(sums.iter().flatten().map(figures));
        }
        Ok(found)
    }

    /// Measures cameras on parts of one clip, which is given by its number, without the store.
    pub(crate) fn measure_parts(
        &self,
        clip: usize,
        cameras: &[Camera],
        parts: &[Range<u64>],
        tell: &(dyn Fn() -> ExploreProgress + Sync),
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let go_on = || {
            self.hooks.progress(tell());
            !self.hooks.cancelled()
        };
        let boxes = self.boxes.get(clip).map(AsRef::as_ref);
        let (subject, input, ideal) = (&self.subjects[clip], self.input, self.ideal);
        measure::MeasuredClip { subject, input, ideal, parts, boxes, go_on: &go_on }
            .measure(cameras)
    }
}
