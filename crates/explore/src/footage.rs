// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clips of a run, and the measurements on them; finished measurements come from the store.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use foveate_camera::{Camera, CameraConfig};
use foveate_media::{ClipReading, InputOptions, RunClips, RunHooks, RunMonitor, RunProgress};

use super::progress::measuring_progress;
use crate::measure::{CameraMeasurement, MeasuredClip};
use crate::store::{MeasurementStore, clip_identity, measurement_key};
use crate::{Disturbance, ExploreError};

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

    fn progress(&self) -> RunProgress<'static> {
        measuring_progress(self.done.load(Ordering::Relaxed), self.all)
    }
}

/// The clips of a run, which have one size, and the ideal camera that others are compared with.
pub(crate) struct ExplorationFootage<'a> {
    pub(crate) clips: RunClips,
    /// The width and height of all frames in pixels.
    pub(crate) size: (u32, u32),
    ideal: &'a CameraConfig,
    /// The disturbance of the frames that cameras see.
    pub(crate) disturbance: Option<Disturbance>,
    pub(crate) hooks: &'a dyn RunHooks,
}

impl<'a> ExplorationFootage<'a> {
    /// Opens the inputs, with the boxes of objects if there are any. Scenes get the frame size of
    /// the ideal camera, and all frames get its bits per pixel.
    pub(crate) fn new(
        (inputs, boxes): (&[PathBuf], &[PathBuf]),
        input: &InputOptions,
        ideal: &'a CameraConfig,
        hooks: &'a dyn RunHooks,
    ) -> Result<Self, ExploreError> {
        let clips = RunClips::new(inputs, boxes, ideal, input)?;
        let size = clips.common_format(ClipReading::Repeated)?.size;
        Ok(Self { clips, size, ideal, disturbance: None, hooks })
    }

    /// Returns the same clips with another ideal camera for the same frames.
    pub(crate) fn with_ideal(self, ideal: &'a CameraConfig) -> Self {
        Self { ideal, ..self }
    }

    /// Returns the same clips with a disturbance of the frames that cameras see.
    pub(crate) fn disturbed(self, disturbance: Option<Disturbance>) -> Self {
        Self { disturbance, ..self }
    }

    pub(crate) fn measure_clips(
        &self,
        cameras: &[Camera],
        store: &MeasurementStore,
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let count = MeasurementCount::from_total(self.clips.clips().len() * cameras.len());
        let clips = 0..self.clips.clips().len();
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
            let measured = self.measure_parts(clip, &together, whole, &|_| count.progress())?;
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
        let (clip, ideal) = self.clip_texts(clip);
        cameras.iter().map(|camera| measurement_key(&clip, &ideal, camera.config())).collect()
    }

    /// Returns a text that identifies a clip, which is given by its number, and the TOML of the
    /// ideal camera. All measurements of the clip depend on both.
    pub(crate) fn clip_texts(&self, clip: usize) -> (String, String) {
        let mut text = clip_identity(&self.clips.clips()[clip], self.clips.options());
        text.extend(self.disturbance.map(|own| format!("\n{own} of clip {clip}")));
        (text, self.ideal.to_toml())
    }

    pub(crate) fn pixel_bits(&self) -> u32 {
        self.ideal.frame.pixel_bits
    }

    /// Returns the measurement of every camera in every part of all clips. `parts` gives the parts
    /// of a clip by its number. `before` is the number of cameras that were done before, for
    /// progress.
    pub(crate) fn measure_clip_parts(
        &self,
        cameras: &[Camera],
        parts: impl Fn(usize) -> Vec<Range<u64>>,
        before: usize,
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let mut found = Vec::new();
        let all = before + cameras.len();
        for some in cameras.chunks(CAMERAS_PER_UNIT) {
            let mut sums = vec![vec![None; parts(0).len()]; some.len()];
            let done = before + found.len();
            let stage = |_| measuring_progress(done, all);
            for clip in 0..self.clips.clips().len() {
                let measured = self.measure_parts(clip, some, &parts(clip), &stage)?;
                let all_sums = sums.iter_mut().flatten();
                for (sum, part) in all_sums.zip(measured.into_iter().flatten()) {
                    CameraMeasurement::merge(sum, Some(part));
                }
            }
            found.extend(sums.into_iter().map(|parts| parts.into_iter().flatten().collect()));
        }
        Ok(found)
    }

    /// Measures cameras on parts of one clip, which is given by its number, without the store.
    /// `stage` is reported after every frame.
    pub(crate) fn measure_parts(
        &self,
        clip: usize,
        cameras: &[Camera],
        parts: &[Range<u64>],
        stage: &(dyn Fn(u64) -> RunProgress<'static> + Sync),
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let monitor = &RunMonitor::of_stage(self.hooks, stage);
        let (clips, ideal) = (&self.clips, self.ideal);
        let disturbance = self.disturbance;
        MeasuredClip { clips, clip, ideal, parts, disturbance, monitor }.measure(cameras)
    }
}
