// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame loop of the studies: every clip is decoded once, frame by frame, for all designs of a
//! study. Clips run in parallel in their own threads, and the engines of one clip run in rayon's
//! threads.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use foveate_design::{Design, DesignConfig};
use foveate_engine::{Engine, FrameOutcome};
use foveate_footage::{
    ComparedInput, FootageError, FrameSource, InputOptions, SourceFrame, SourceKind, open,
};
use foveate_simulator::{BatchHooks, BatchProgress};
use rayon::prelude::*;

use crate::StudyError;

/// The result of one clip: a value per design, and the guide of the clip.
#[derive(Debug)]
pub(crate) struct ClipResult<T, G = ()> {
    pub(crate) name: String,
    pub(crate) inputs: Vec<String>,
    pub(crate) kind: SourceKind,
    pub(crate) frames: u64,
    /// The reason why the clip ended early, if it did.
    pub(crate) problem: Option<String>,
    pub(crate) points: Vec<(Design, T)>,
    pub(crate) annotator: G,
}

/// A guide sees every frame of a clip before the designs do, and computes what is the same for all
/// of them.
pub(crate) trait FrameAnnotator: Send + Sync {
    fn annotate(&mut self, frame: &SourceFrame, source: &dyn FrameSource)
    -> Result<(), StudyError>;
}

impl FrameAnnotator for () {
    fn annotate(&mut self, _: &SourceFrame, _: &dyn FrameSource) -> Result<(), StudyError> {
        Ok(())
    }
}

/// A frame and the outcome of an engine for it.
pub(crate) struct FrameResult<'a> {
    /// True if this is the first frame of a clip, in which every region counts as changed.
    pub(crate) is_without_reference: bool,
    pub(crate) time_us: u64,
    pub(crate) outcome: &'a FrameOutcome,
}

/// The inputs of a study, and the hooks of its caller.
pub(crate) struct StudyRunner<'a> {
    pub(crate) subjects: &'a [ComparedInput],
    /// The configuration that determines how clips are opened: bits per pixel, and the size of
    /// scenes.
    pub(crate) config: &'a DesignConfig,
    pub(crate) input: &'a InputOptions,
    pub(crate) hooks: &'a dyn BatchHooks,
}

impl StudyRunner<'_> {
    /// Shows every clip to an engine of each configuration. `see` adds a frame to the value of a
    /// design. The results are in the order of clips and configurations, on any number of threads.
    pub(crate) fn run_clips<T: Default + Send>(
        &self,
        configs: &[DesignConfig],
        see: impl Fn(&mut T, &Design, &FrameResult<'_>) + Sync,
    ) -> Result<Vec<ClipResult<T>>, StudyError> {
        self.run_annotated_clips(
            configs,
            |_| (),
            |(), value, design, seen| see(value, design, seen),
        )
    }

    /// Shows every clip to an engine of each configuration, with a guide for every clip, which is
    /// given by its number.
    pub(crate) fn run_annotated_clips<T: Default + Send, G: FrameAnnotator>(
        &self,
        configs: &[DesignConfig],
        guide: impl Fn(usize) -> G + Sync,
        see: impl Fn(&G, &mut T, &Design, &FrameResult<'_>) + Sync,
    ) -> Result<Vec<ClipResult<T, G>>, StudyError> {
        let (next, done, frames) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicU64::new(0));
        let results: Vec<Mutex<Option<_>>> =
            self.subjects.iter().map(|_| Mutex::new(None)).collect();
        let tell = || {
            self.hooks.progress(BatchProgress {
                clips: done.load(Ordering::Relaxed),
                total_clips: self.subjects.len(),
                frames: frames.load(Ordering::Relaxed),
            });
        };
        let work = || {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let (Some(subject), Some(slot)) = (self.subjects.get(number), results.get(number))
                else {
                    return;
                };
                let count = || {
                    frames.fetch_add(1, Ordering::Relaxed);
                    tell();
                };
                let result = self.run_clip(subject, configs, guide(number), &see, &count);
                *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
                done.fetch_add(1, Ordering::Relaxed);
                tell();
            }
        };
        let threads = rayon::current_num_threads();
        std::thread::scope(|scope| {
            for _ in 0..threads.min(self.subjects.len()) {
                scope.spawn(work);
            }
        });
        let result = |slot: Mutex<Option<Result<_, _>>>| {
            let slot = slot.into_inner().unwrap_or_else(PoisonError::into_inner);
            slot.expect("the threads end when every clip was seen")
        };
        results.into_iter().map(result).collect()
    }

    fn run_clip<T: Default + Send, G: FrameAnnotator>(
        &self,
        subject: &ComparedInput,
        configs: &[DesignConfig],
        mut guide: G,
        see: &(impl Fn(&G, &mut T, &Design, &FrameResult<'_>) + Sync),
        count: &dyn Fn(),
    ) -> Result<ClipResult<T, G>, StudyError> {
        let mut source = open(&subject.inputs, &self.config.camera, self.input)?;
        let (width, height) = source.size();
        let design = |config: &DesignConfig| config.validate_for_frames(width, height);
        let designs = configs.iter().map(design).collect::<Result<Vec<_>, _>>()?;
        let mut points: Vec<(Engine, T)> =
            designs.iter().map(|design| (Engine::new(design), T::default())).collect();
        let mut frame = 0;
        while let Some(current) = source.next_frame()? {
            if self.hooks.is_cancelled() {
                return Err(StudyError::Cancelled);
            }
            let set = source.kind() == SourceKind::Set;
            guide.annotate(&current, source.as_ref())?;
            let guide = &guide;
            points.par_iter_mut().zip(&designs).try_for_each(|((camera, value), design)| {
                if set {
                    camera.reset();
                }
                let outcome = camera.step_byte_frame(&current.frame)?;
                let (without_reference, time_us) = (!set && frame == 0, current.time_us);
                see(
                    guide,
                    value,
                    design,
                    &FrameResult { is_without_reference: without_reference, time_us, outcome },
                );
                Ok::<_, StudyError>(())
            })?;
            frame += 1;
            count();
        }
        let inputs = source.inputs().to_vec();
        if frame == 0 {
            return Err(FootageError::NoFrames { inputs: inputs.join(", ") }.into());
        }
        Ok(ClipResult {
            name: subject.name.clone(),
            inputs,
            kind: source.kind(),
            frames: frame,
            problem: source.problem(),
            points: designs.into_iter().zip(points.into_iter().map(|(_, value)| value)).collect(),
            annotator: guide,
        })
    }
}
