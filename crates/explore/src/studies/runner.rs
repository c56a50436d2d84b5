// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame loop of the studies: every clip is decoded once, frame by frame, for all designs of a
//! study. Clips run in parallel in their own threads, and the engines of one clip run in rayon's
//! threads.

use foveate_design::{Design, DesignConfig};
use foveate_engine::{Engine, FrameOutcome};
use foveate_media::{
    PlaybackError, PlayedFrame, RunClips, RunMonitor, SourceKind, run_in_parallel,
};
use rayon::prelude::*;

use crate::studies::StudyError;

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
    fn annotate(&mut self, frame: &PlayedFrame) -> Result<(), PlaybackError>;
}

impl FrameAnnotator for () {
    fn annotate(&mut self, _: &PlayedFrame) -> Result<(), PlaybackError> {
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

/// The clips of a study, and the monitor of its run.
pub(crate) struct StudyRunner<'a> {
    pub(crate) clips: &'a RunClips,
    /// The design, which a study may vary.
    pub(crate) config: &'a DesignConfig,
    pub(crate) monitor: RunMonitor<'a>,
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
        let results = run_in_parallel(self.clips.clips().len(), |number| {
            let result = self.run_clip(number, configs, guide(number), &see);
            self.monitor.add_clip();
            Some(result)
        });
        results.into_iter().flatten().collect()
    }

    fn run_clip<T: Default + Send, G: FrameAnnotator>(
        &self,
        number: usize,
        configs: &[DesignConfig],
        mut guide: G,
        see: &(impl Fn(&G, &mut T, &Design, &FrameResult<'_>) + Sync),
    ) -> Result<ClipResult<T, G>, StudyError> {
        let mut player = self.clips.open(number)?;
        let (width, height) = player.size();
        let design = |config: &DesignConfig| config.validate_for_frames(width, height);
        let designs = configs.iter().map(design).collect::<Result<Vec<_>, _>>()?;
        let mut points: Vec<(Engine, T)> =
            designs.iter().map(|design| (Engine::new(design), T::default())).collect();
        let mut frames = 0;
        for frame in self.monitor.watch(&mut player) {
            let frame = frame?;
            guide.annotate(&frame)?;
            let is_without_reference = match frame.kind {
                SourceKind::Clip => frame.is_first(),
                SourceKind::Set => false,
            };
            let (guide, time_us) = (&guide, frame.time_us);
            points.par_iter_mut().zip(&designs).try_for_each(|((camera, value), design)| {
                let outcome = frame.show_to(camera)?;
                see(guide, value, design, &FrameResult { is_without_reference, time_us, outcome });
                Ok::<_, StudyError>(())
            })?;
            frames += 1;
        }
        Ok(ClipResult {
            name: self.clips.clips()[number].name.clone(),
            inputs: player.inputs().to_vec(),
            kind: player.kind(),
            frames,
            problem: player.problem().map(str::to_owned),
            points: designs.into_iter().zip(points.into_iter().map(|(_, value)| value)).collect(),
            annotator: guide,
        })
    }
}
