// SPDX-License-Identifier: MIT OR Apache-2.0
//! The network on whole frames, which the network behind the camera is compared with.

use super::ceiling::NoiseCeiling;
use super::interval::ConfidenceIntervals;
use super::precision::Curve;
use super::shots::Shots;
use super::summary::{Received, Sight, Truth, psnr};
use crate::camera::{Original, Seen, frames_of};
use foveate_design::Camera;
use foveate_frame::Plane;
use foveate_network::Executor;
use foveate_network::sight::{
    Detection, Findings, Found, Looking, Pairs, SAME_OBJECT, Sums, Witness,
};

/// The network on whole frames, and its agreement with the network behind the camera.
pub(crate) struct Judge<'a> {
    witness: &'a Witness,
    /// The network that runs on whole frames.
    looking: Looking<'a>,
    sums: Sums,
    noise: NoiseCeiling,
    received: Received,
    /// The precision curves against ground truth: of whole frames, and of the receiver's screen.
    truth: Option<[Curve; 2]>,
    shots: Shots,
    rows: Vec<DetectionRow>,
    seconds: f64,
}

/// The comparison of one frame in figures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SightFrame {
    pub(crate) agreement: f64,
    pub(crate) sent_bytes: f64,
    /// The PSNR of the receiver's screen in decibels; `None` if it equals the whole frame.
    pub(crate) picture_psnr: Option<f64>,
    pub(crate) found: Option<Found>,
}

/// The detections of the counted frames.
#[derive(Debug)]
pub(crate) struct Detected {
    pub(crate) shots: Shots,
    pub(crate) rows: Vec<DetectionRow>,
}

/// A row of the table of detections.
#[derive(Clone, Debug)]
pub(crate) struct DetectionRow {
    pub(crate) clip: String,
    pub(crate) frame: u64,
    pub(crate) name: String,
    /// Whether the detection is in the whole frame, or else on the receiver's screen.
    pub(crate) is_whole: bool,
    /// Whether the detection is in both.
    pub(crate) is_both: bool,
    pub(crate) detection: Detection,
}

impl<'a> Judge<'a> {
    /// Creates the comparison before its first frame. `noise` has standard deviations in grey
    /// levels of 8 bits; `with_truth` says whether there are ground-truth objects.
    pub(crate) fn new(
        witness: &'a Witness,
        camera: &Camera,
        noise: &[f64],
        with_truth: bool,
    ) -> Self {
        Self {
            witness,
            looking: witness.look_at(frames_of(camera)),
            sums: Sums::default(),
            noise: NoiseCeiling::new(noise, camera.pixel_max()),
            received: Received::new(camera),
            truth: with_truth.then(Default::default),
            shots: Shots::new(camera),
            rows: Vec::new(),
            seconds: 0.0,
        }
    }

    /// Runs the network on a whole frame, and compares its findings with those of `other`, which
    /// ran on the receiver's screen. Only a counted frame is part of the sums.
    pub(crate) fn look(
        &mut self,
        (clip, clip_number): (&str, u64),
        seen: Seen<'_>,
        other: &Executor<'_>,
        is_counted: bool,
    ) -> Option<SightFrame> {
        let original = seen.original?;
        let seconds = self.looking.run(Plane::Words(original.frame)).as_secs_f64();
        let (whole, found) = (self.looking.findings(), self.witness.findings(other));
        let pairs = self.witness.pairs(&whole, &found);
        let sums = Sums::of(&whole, &found, pairs.as_ref());
        let squared_error = squared_error(original.frame, seen.screen);
        let frame = SightFrame {
            agreement: sums.agreement(),
            sent_bytes: self.received.bytes(seen.sent),
            picture_psnr: psnr(squared_error, self.received.pixels, self.received.max),
            found: sums.found(),
        };
        if is_counted {
            self.sums.add(&sums);
            self.received.add(seen.sent, squared_error);
            self.seconds += seconds;
            self.add_truth(original, &whole, &found);
            let at = (clip_number, seen.number);
            let network = (self.witness, &mut self.looking);
            self.noise.look(network, (original.frame, &whole), at);
            if let Some(pairs) = pairs {
                self.tell(clip, seen, &pairs);
                self.shots.add(clip, seen, pairs);
            }
        }
        Some(frame)
    }

    fn add_truth(&mut self, original: Original<'_>, whole: &Findings, seen: &Findings) {
        let Some(detector) = self.witness.detector() else { return };
        let Some((curves, objects)) = self.truth.as_mut().zip(original.objects) else { return };
        for (curve, findings) in curves.iter_mut().zip([whole, seen]) {
            let found = findings.detections.as_deref().unwrap_or_default();
            curve.add(found, objects, SAME_OBJECT, detector.height);
        }
    }

    /// Adds the detections of a frame to the table.
    fn tell(&mut self, clip: &str, seen: Seen<'_>, pairs: &Pairs) {
        let both = [(true, &pairs.whole), (false, &pairs.seen)];
        for (is_whole, (detection, is_both)) in both
            .into_iter()
            .flat_map(|(is_whole, found)| found.iter().map(move |one| (is_whole, one)))
        {
            self.rows.push(DetectionRow {
                clip: clip.to_owned(),
                frame: seen.number,
                name: seen.name.to_owned(),
                is_whole,
                is_both: *is_both,
                detection: detection.clone(),
            });
        }
    }

    /// Returns the detections, if they were read.
    pub(crate) fn detected(self) -> Option<Detected> {
        let Self { witness, shots, rows, .. } = self;
        witness.detector().is_some().then_some(Detected { shots, rows })
    }

    /// Returns the comparison of all counted frames.
    pub(crate) fn sight(&self) -> Sight {
        let detector = self.witness.detector();
        let score = detector.map_or(0.0, |detector| detector.score);
        let truth = self.truth.as_ref().map(|[whole, seen]| Truth {
            objects: whole.objects(),
            whole_ap50: whole.average_precision(),
            seen_ap50: seen.average_precision(),
            whole_recall: whole.recall(score),
            seen_recall: seen.recall(score),
        });
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let seconds = self.seconds / self.sums.frames.max(1) as f64;
        Sight {
            agreement: self.sums.agreement(),
            intervals: ConfidenceIntervals::of(&self.sums),
            noise: self.noise.found(),
            relative_rms: self.sums.distance.relative(),
            classes: self.sums.classes(),
            same_places: self.sums.places(),
            detections: detector.and_then(|detector| self.sums.detections(detector)),
            truth,
            picture_psnr: self.received.psnr(),
            sent_bytes: self.received.bytes_per_frame(),
            sent_share: self.received.share(),
            seconds_per_frame: seconds,
        }
    }
}

fn squared_error(one: &[u16], other: &[u16]) -> f64 {
    let squares = one.iter().zip(other).map(|(&one, &other)| u64::from(one.abs_diff(other)).pow(2));
    #[allow(clippy::cast_precision_loss, reason = "a mean is made of it")]
    let sum = squares.sum::<u64>() as f64;
    sum
}
