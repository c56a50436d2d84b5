// SPDX-License-Identifier: MIT OR Apache-2.0
//! The measurement of a clip ([`MeasuredClip`]): the frames go once through the ideal camera,
//! and through the engine of every camera. It also counts the ground-truth objects of which a
//! camera sends at least half ([`ObjectCounts`]).

use crate::disturbance::{ClipDisturbance, FrameDisturbance};
use crate::{Disturbance, ExploreError};
use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_ideal::{IdealCamera, IdealOutcome};
use foveate_measure::{CandidateFrame, DecisionAreas, ErrorTally, Fidelity, FrameOrder};
use foveate_media::boxes::RegionGrid;
use foveate_media::{ClipPlayer, FrameDepths, PlayedFrame, RunClips, RunMonitor, SourceKind};
use foveate_pixels::Rect;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

/// The number of frames that are ready before the engines need them.
const FRAMES_AHEAD: usize = 2;

/// The measurement of a camera over a part of a clip. It does not depend on the machine and the
/// time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CameraMeasurement {
    /// The errors against the ideal camera.
    pub(crate) tally: ErrorTally,
    /// The areas of the decisions of every frame; not stored.
    #[serde(skip)]
    pub(crate) frames: Vec<DecisionAreas>,
    /// The counts of objects, if there are boxes.
    #[serde(default)]
    pub(crate) objects: ObjectCounts,
    /// The reason why the clip ended early, if it did.
    pub(crate) problem: Option<String>,
}

impl CameraMeasurement {
    /// Adds the measurement of the same part of the next clip to a sum.
    pub(crate) fn merge(sum: &mut Option<Self>, next: Option<Self>) {
        match (sum.as_mut(), next) {
            (Some(sum), Some(next)) => {
                sum.tally.merge(&next.tally);
                sum.frames.extend(next.frames);
                sum.objects.merge(next.objects);
            }
            (None, next) => *sum = next,
            (Some(_), None) => {}
        }
    }
}

/// A clip and the ideal camera that others are compared with on it.
pub(crate) struct MeasuredClip<'a> {
    pub(crate) clips: &'a RunClips,
    pub(crate) clip: usize,
    /// The configuration of the ideal camera, for frames of the clip's size.
    pub(crate) ideal: &'a CameraConfig,
    /// The parts of the clip that are measured separately, as ranges of frame numbers.
    pub(crate) parts: &'a [Range<u64>],
    /// The disturbance of the frames that cameras see.
    pub(crate) disturbance: Option<Disturbance>,
    pub(crate) monitor: &'a RunMonitor<'a>,
}

/// A frame and the outcome of the ideal camera for it.
struct IdealFrame {
    frame: PlayedFrame,
    disturbed: FrameDisturbance,
    ideal: IdealOutcome,
    objects: Vec<Rect>,
}

struct MeasuredCamera {
    camera: Camera,
    engine: Engine,
    /// The errors of the camera, for each part.
    fidelity: Vec<Fidelity>,
    frames: Vec<Vec<DecisionAreas>>,
    objects: Vec<ObjectCounts>,
    /// The denoised frame, and the denoised pixels of a region.
    denoised: (Vec<u16>, Vec<u16>),
}

impl MeasuredClip<'_> {
    pub(crate) fn measure(
        &self,
        cameras: &[Camera],
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let end = self.parts.iter().map(|part| part.end).max().expect("a clip has a part");
        let player = self.clips.open(self.clip)?.limited_to(end);
        let (width, height) = player.size();
        let ideal = &self.ideal.validate_for_frames(width, height)?;
        let candidate = |camera| MeasuredCamera::new(ideal, camera, self.parts.len());
        let mut candidates = cameras.iter().map(candidate).collect::<Result<Vec<_>, _>>()?;
        let problem = thread::scope(|scope| {
            let (give, take) = sync_channel(FRAMES_AHEAD);
            let judge = scope.spawn(move || self.run_ideal(player, ideal, &give));
            let seen = self.run_cameras(&mut candidates, take);
            let problem = judge.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            // An error of the engines explains why nobody took the frames, so it comes first.
            seen.and(problem)
        })?;
        if problem.is_some() {
            // An interrupt may have ended ffmpeg, which then looks like a damaged clip.
            self.monitor.check()?;
        }
        let measured = |candidate: MeasuredCamera| {
            let MeasuredCamera { fidelity, frames, objects, .. } = candidate;
            let parts = fidelity.into_iter().zip(frames).zip(objects);
            let one = |((fidelity, frames), objects): ((Fidelity, _), _)| CameraMeasurement {
                tally: fidelity.into_tally(),
                frames,
                objects,
                problem: problem.clone(),
            };
            parts.map(one).collect()
        };
        Ok(candidates.into_iter().map(measured).collect())
    }

    /// Shows every frame to every camera.
    fn run_cameras(
        &self,
        candidates: &mut [MeasuredCamera],
        frames: Receiver<IdealFrame>,
    ) -> Result<(), ExploreError> {
        for ideal_frame in frames {
            self.monitor.add_frame();
            self.monitor.check()?;
            let part = self.parts.iter().position(|part| part.contains(&ideal_frame.frame.number));
            let Some(part) = part else { continue };
            let depths = candidates.iter().map(|one| one.camera.pixel_bits());
            let shown = ideal_frame.disturbed.shown.as_ref();
            let frames = FrameDepths::from_disturbed(&ideal_frame.frame, shown, depths)?;
            candidates
                .par_iter_mut()
                .try_for_each(|one| one.add_frame(&ideal_frame, &frames, part))?;
        }
        Ok(())
    }

    /// Shows the clip to the ideal camera, until it ends or the receiver of the frames is gone.
    /// Returns the reason why the clip ended early, if it did. Objects of a clip's first frame do
    /// not count, because it has no reference.
    fn run_ideal(
        &self,
        mut player: ClipPlayer,
        ideal: &Camera,
        give: &SyncSender<IdealFrame>,
    ) -> Result<Option<String>, ExploreError> {
        let mut camera = IdealCamera::new(ideal);
        let mut disturbance = ClipDisturbance::new(self.disturbance, self.clip);
        for frame in &mut player {
            let frame = frame?;
            if frame.is_first() {
                camera.reset();
            }
            let disturbed = disturbance.disturb(&frame.frame, frame.number)?;
            let truth = disturbed.truth.as_ref().unwrap_or(&frame.frame);
            let ideal = camera.step(truth)?.clone();
            let objects = match frame.kind {
                SourceKind::Clip if frame.is_first() => None,
                SourceKind::Clip | SourceKind::Set => self.clips.objects(self.clip, &frame)?,
            };
            let objects = objects.unwrap_or_default();
            if give.send(IdealFrame { frame, disturbed, ideal, objects }).is_err() {
                return Ok(None);
            }
        }
        Ok(player.problem().map(str::to_owned))
    }
}

impl MeasuredCamera {
    fn new(ideal: &Camera, camera: &Camera, parts: usize) -> Result<Self, ExploreError> {
        let fidelity = (0..parts).map(|_| Fidelity::new(ideal, camera));
        Ok(Self {
            engine: Engine::new(camera),
            fidelity: fidelity.collect::<Result<_, _>>()?,
            frames: vec![Vec::new(); parts],
            objects: vec![ObjectCounts::default(); parts],
            denoised: (vec![0; (camera.width() * camera.height()) as usize], Vec::new()),
            camera: camera.clone(),
        })
    }

    fn add_frame(
        &mut self,
        ideal_frame: &IdealFrame,
        frames: &FrameDepths<'_>,
        part: usize,
    ) -> Result<(), ExploreError> {
        let IdealFrame { frame, disturbed, ideal, objects } = ideal_frame;
        if frame.kind == SourceKind::Set {
            self.fidelity[part].next_clip();
        }
        frames.show_to(&mut self.engine)?;
        self.read_denoised();
        let (outcome, screen) = (self.engine.outcome(), self.engine.rendered());
        self.objects[part].add_frame(&self.camera, objects, &outcome.active);
        let candidate = CandidateFrame { outcome, screen, denoised: &self.denoised.0 };
        let order = frame_order(frame);
        let truth = disturbed.truth.as_ref().unwrap_or(&frame.frame);
        self.frames[part].push(self.fidelity[part].add(truth, ideal, candidate, order)?);
        Ok(())
    }

    /// Reads the denoised frame of the engine, without padding.
    fn read_denoised(&mut self) {
        let (plane, pixels) = &mut self.denoised;
        let side = self.camera.region_size() as usize;
        let (width, columns) = (self.camera.width() as usize, self.camera.columns());
        for region in 0..self.camera.regions() {
            pixels.clear();
            self.engine.denoised_region(region, pixels);
            let (left, top) =
                ((region % columns) as usize * side, (region / columns) as usize * side);
            let shown = side.min(width - left);
            let rows = plane.chunks_exact_mut(width).skip(top);
            for (row, pixels) in rows.zip(pixels.chunks_exact(side)) {
                row[left..left + shown].copy_from_slice(&pixels[..shown]);
            }
        }
    }
}

/// Returns the order of a frame in its clip; all images of a data set count.
pub(crate) fn frame_order(frame: &PlayedFrame) -> FrameOrder {
    match frame.kind {
        SourceKind::Clip if frame.number == 0 => FrameOrder::First,
        SourceKind::Clip | SourceKind::Set => FrameOrder::Later,
    }
}

/// Counts of objects over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ObjectCounts {
    all: u64,
    /// The number of objects of which at least half of the regions are active.
    sent: u64,
}

impl ObjectCounts {
    pub(crate) fn add_frame(&mut self, camera: &Camera, objects: &[Rect], active: &[bool]) {
        let (side, width, height) = (camera.region_size(), camera.width(), camera.height());
        let grid = RegionGrid { side, width, height };
        for object in objects {
            let (yes, regions) = grid.count_votes(object, active);
            self.all += 1;
            self.sent += u64::from(2 * yes >= regions);
        }
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.all += other.all;
        self.sent += other.sent;
    }

    /// Returns the share that is sent; `None` if there are no objects.
    pub(crate) fn recall(self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
        (self.all > 0).then(|| self.sent as f64 / self.all as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_media::{InputOptions, PlaybackError, RunHooks, RunProgress};
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Hooks that cancel after they have been asked a number of times.
    struct PatientHooks {
        patience: usize,
        questions: AtomicUsize,
    }

    impl RunHooks for PatientHooks {
        fn progress(&self, _progress: &RunProgress<'_>) {}

        fn is_cancelled(&self) -> bool {
            self.questions.fetch_add(1, Ordering::Relaxed) >= self.patience
        }
    }

    /// A clip has two frames and a part of a third one. If the run is cancelled after the second
    /// frame, the clip may have ended for that reason.
    #[test]
    fn a_clip_that_ends_early_in_a_cancelled_run_is_an_interruption() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("clip.y4m");
        let frame = [b"FRAME\n".to_vec(), vec![90; 16 * 16]].concat();
        let file = [&b"YUV4MPEG2 W16 H16 F30:1 Cmono\n"[..], &frame, &frame, &frame[..50]].concat();
        std::fs::write(&path, file).unwrap();
        let ideal = CameraConfig::from_toml("[frame]\nwidth = 16\nheight = 16\n").unwrap();
        let options = InputOptions::default();
        let clips = RunClips::new(&[path], &[], &ideal, &options).unwrap();
        let measured = |patience| {
            let hooks = PatientHooks { patience, questions: AtomicUsize::new(0) };
            let monitor = &RunMonitor::of_frames(&hooks, None);
            let parts = std::slice::from_ref(&(0..u64::MAX));
            let clip = MeasuredClip {
                clips: &clips,
                clip: 0,
                ideal: &ideal,
                parts,
                disturbance: None,
                monitor,
            };
            clip.measure(&[ideal.validate().unwrap()])
        };
        let ended_early = measured(usize::MAX).unwrap();
        assert!(ended_early[0][0].problem.is_some());
        assert_eq!(ended_early[0][0].tally.figures().frames, 2);
        let interrupted = measured(2).unwrap_err();
        assert!(
            matches!(interrupted, ExploreError::Playback(PlaybackError::Interrupted)),
            "{interrupted}"
        );
    }
}
