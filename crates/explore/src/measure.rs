// SPDX-License-Identifier: MIT OR Apache-2.0
//! The measurement of a clip: the frames go once through the ideal camera, and through the engine
//! of every camera.

use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_fidelity::{ErrorTally, Fidelity};
use foveate_footage::boxes::BoxFile;
use foveate_footage::{ComparedInput, FrameSource, InputOptions, SourceKind, open};
use foveate_frame::ByteFrame;
use foveate_frame::Rect;
use foveate_ideal::{IdealCamera, IdealOutcome};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::ExploreError;
use crate::depths::FrameDepths;
use crate::objects::ObjectCounts;

/// The number of frames that are ready before the engines need them.
const FRAMES_AHEAD: usize = 2;

/// The measurement of a camera over a part of a clip. It does not depend on the machine and the
/// time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CameraMeasurement {
    /// The errors against the ideal camera.
    pub(crate) tally: ErrorTally,
    /// The counts of objects, if there are boxes.
    #[serde(default)]
    pub(crate) objects: ObjectCounts,
    /// The reason why the clip ended early, if it did.
    pub(crate) problem: Option<String>,
}

/// A clip and the ideal camera that others are compared with on it.
pub(crate) struct MeasuredClip<'a> {
    pub(crate) subject: &'a ComparedInput,
    pub(crate) input: &'a InputOptions,
    /// The configuration of the ideal camera, for frames of the clip's size.
    pub(crate) ideal: &'a CameraConfig,
    /// The parts of the clip that are measured separately, as ranges of frame numbers.
    pub(crate) parts: &'a [Range<u64>],
    /// The ground-truth boxes of the clip, if there are any.
    pub(crate) boxes: Option<&'a BoxFile>,
    /// A callback after every frame, which returns whether to go on.
    pub(crate) go_on: &'a (dyn Fn() -> bool + Sync),
}

/// A frame and the outcome of the ideal camera for it.
struct IdealFrame {
    number: u64,
    frame: ByteFrame,
    ideal: IdealOutcome,
    objects: Vec<Rect>,
}

/// A camera that is measured.
struct MeasuredCamera {
    camera: Camera,
    engine: Engine,
    /// The errors of the camera, for each part.
    fidelity: Vec<Fidelity>,
    objects: Vec<ObjectCounts>,
}

impl MeasuredClip<'_> {
    /// Returns the measurement of every camera in every part.
    pub(crate) fn measure(
        &self,
        cameras: &[Camera],
    ) -> Result<Vec<Vec<CameraMeasurement>>, ExploreError> {
        let source = open(&self.subject.inputs, self.ideal, self.input)?;
        let (width, height) = source.size();
        let ideal = &self.ideal.validate_for_frames(width, height)?;
        let candidate = |camera| MeasuredCamera::new(ideal, camera, self.parts.len());
        let mut candidates = cameras.iter().map(candidate).collect::<Result<Vec<_>, _>>()?;
        let kind = source.kind();
        let problem = thread::scope(|scope| {
            let (give, take) = sync_channel(FRAMES_AHEAD);
            let end = self.parts.iter().map(|part| part.end).max().expect("a clip has a part");
            let judge = scope.spawn(move || self.run_ideal(source, ideal, end, &give));
            let seen = self.run_cameras(&mut candidates, kind, take);
            let problem = judge.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            // An error of the engines explains why nobody took the frames, so it comes first.
            seen.and(problem)
        })?;
        let measured = |candidate: MeasuredCamera| {
            let parts = candidate.fidelity.into_iter().zip(candidate.objects);
            let one = |(fidelity, objects): (Fidelity, ObjectCounts)| CameraMeasurement {
                tally: fidelity.tally().clone(),
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
        kind: SourceKind,
        frames: Receiver<IdealFrame>,
    ) -> Result<(), ExploreError> {
        for judged in frames {
            if !(self.go_on)() {
                return Err(ExploreError::Cancelled);
            }
            let part = self.parts.iter().position(|part| part.contains(&judged.number));
            let Some(part) = part else { continue };
            let frames = FrameDepths::from_frame(
                &judged.frame,
                candidates.iter().map(|one| one.camera.pixel_bits()),
            )?;
            candidates
                .par_iter_mut()
                .try_for_each(|one| one.add_frame(&judged, &frames, part, kind))?;
        }
        Ok(())
    }

    /// Decodes the clip and shows it to the ideal camera until frame `end`, or until the receiver
    /// of the frames is gone. Returns the reason why the clip ended early, if it did. Objects of a
    /// clip's first frame do not count, because it has no reference.
    fn run_ideal(
        &self,
        mut source: Box<dyn FrameSource>,
        ideal: &Camera,
        end: u64,
        give: &SyncSender<IdealFrame>,
    ) -> Result<Option<String>, ExploreError> {
        let mut camera = IdealCamera::new(ideal);
        let mut number = 0;
        while number < end {
            let Some(current) = source.next_frame()? else { return Ok(source.problem()) };
            let set = source.kind() == SourceKind::Set;
            if set {
                camera.reset();
            }
            let ideal = camera.step(&current.frame)?.clone();
            let objects = match self.boxes.filter(|_| set || number > 0) {
                Some(boxes) => {
                    let origin = source.origin().expect("an input knows where its frames are from");
                    boxes.object_rects(&current, &origin, self.input.crop)?.unwrap_or_default()
                }
                None => Vec::new(),
            };
            if give.send(IdealFrame { number, frame: current.frame, ideal, objects }).is_err() {
                return Ok(None);
            }
            number += 1;
        }
        Ok(None)
    }
}

impl MeasuredCamera {
    fn new(ideal: &Camera, camera: &Camera, parts: usize) -> Result<Self, ExploreError> {
        let fidelity = (0..parts).map(|_| Fidelity::new(ideal, camera));
        Ok(Self {
            engine: Engine::new(camera),
            fidelity: fidelity.collect::<Result<_, _>>()?,
            objects: vec![ObjectCounts::default(); parts],
            camera: camera.clone(),
        })
    }

    fn add_frame(
        &mut self,
        judged: &IdealFrame,
        frames: &FrameDepths<'_>,
        part: usize,
        kind: SourceKind,
    ) -> Result<(), ExploreError> {
        if kind == SourceKind::Set {
            self.fidelity[part].next_clip();
        }
        frames.step_engine(&mut self.engine, kind)?;
        let (outcome, screen) = (self.engine.outcome(), self.engine.rendered());
        self.objects[part].add_frame(&self.camera, &judged.objects, &outcome.active);
        Ok(self.fidelity[part].add(&judged.frame, &judged.ideal, outcome, screen)?)
    }
}
