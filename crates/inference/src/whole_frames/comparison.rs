// SPDX-License-Identifier: MIT OR Apache-2.0
//! The network on whole frames, which the network behind the camera is compared with
//! ([`WholeFrameComparison`]). The frames with the most lost and added detections are kept as
//! the receiver shows them ([`KeptScreens`]).

use super::noise::NoiseComparison;
use super::precision::{ConfidenceIntervals, PrecisionCurve};
use super::summary::{GroundTruthFigures, ReceiverTally, WholeFrameAgreement, psnr_of_error};
use crate::camera::{OriginalFrame, ReceivedFrame, frame_format_of};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use foveate_camera::Camera;
use foveate_network::Executor;
use foveate_network::vision::{
    AgreementSums, Detection, DetectionCounts, DetectionPairs, FrameFindings, SAME_OBJECT_OVERLAP,
    VisionNetwork, VisionRun,
};
use foveate_pixels::{FramePixels, convert_depth};
use image::{ImageFormat, ImageResult, Luma};
use std::io::Cursor;

/// The network on whole frames, and its agreement with the network behind the camera.
pub(crate) struct WholeFrameComparison<'a> {
    vision_network: &'a VisionNetwork,
    whole_frame_network: VisionRun<'a>,
    sums: AgreementSums,
    noise: NoiseComparison,
    received: ReceiverTally,
    /// The precision curves against ground truth: of whole frames, and of the receiver's screen.
    truth_curves: Option<[PrecisionCurve; 2]>,
    kept_screens: KeptScreens,
    rows: Vec<DetectionRow>,
    seconds: f64,
}

/// The comparison of one frame in figures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameAgreement {
    pub(crate) agreement: f64,
    pub(crate) sent_bytes: f64,
    /// The PSNR of the receiver's screen in decibels; `None` if it equals the whole frame.
    pub(crate) picture_psnr: Option<f64>,
    pub(crate) found: Option<DetectionCounts>,
}

#[derive(Debug)]
pub(crate) struct CountedDetections {
    pub(crate) shots: KeptScreens,
    pub(crate) rows: Vec<DetectionRow>,
}

/// A row of the table of detections.
#[derive(Clone, Debug, Default)]
pub(crate) struct DetectionRow {
    pub(crate) clip: String,
    pub(crate) frame: u64,
    pub(crate) name: String,
    /// True if the detection is in the whole frame; false if it is on the receiver's screen.
    pub(crate) is_whole: bool,
    pub(crate) is_in_both: bool,
    pub(crate) detection: Detection,
}

impl<'a> WholeFrameComparison<'a> {
    /// Creates the comparison before its first frame. `noise` has standard deviations in grey
    /// levels of 8 bits; `with_truth` says whether there are ground-truth objects.
    pub(crate) fn new(
        vision_network: &'a VisionNetwork,
        camera: &Camera,
        noise: &[f64],
        with_truth: bool,
    ) -> Self {
        Self {
            vision_network,
            whole_frame_network: vision_network.start_run(frame_format_of(camera)),
            sums: AgreementSums::default(),
            noise: NoiseComparison::new(noise, camera.pixel_max()),
            received: ReceiverTally::new(camera),
            truth_curves: with_truth.then(Default::default),
            kept_screens: KeptScreens::new(camera),
            rows: Vec::new(),
            seconds: 0.0,
        }
    }

    /// Runs the network on a whole frame, and compares its findings with those of `other`, which
    /// ran on the receiver's screen. Only a counted frame is part of the sums.
    pub(crate) fn compare_frame(
        &mut self,
        (clip, clip_number): (&str, u64),
        seen: ReceivedFrame<'_>,
        other: &Executor<'_>,
        is_counted: bool,
    ) -> Option<FrameAgreement> {
        let original = seen.original?;
        let seconds =
            self.whole_frame_network.run(FramePixels::Words(original.frame)).as_secs_f64();
        let (whole, found) =
            (self.whole_frame_network.findings(), self.vision_network.findings(other));
        let pairs = self.vision_network.match_detections(&whole, &found);
        let sums = AgreementSums::from_frame(&whole, &found, pairs.as_ref());
        let squared_error = squared_error(original.frame, seen.screen);
        let frame = FrameAgreement {
            agreement: sums.agreement(),
            sent_bytes: self.received.mean_bytes(seen.sent),
            picture_psnr: psnr_of_error(squared_error, self.received.pixels, self.received.max),
            found: sums.total_counts(),
        };
        if is_counted {
            self.sums.add(&sums);
            self.received.add(seen.sent, squared_error);
            self.seconds += seconds;
            self.add_truth(original, &whole, &found);
            let at = (clip_number, seen.number);
            let network = (self.vision_network, &mut self.whole_frame_network);
            self.noise.add_frame(network, (original.frame, &whole), at);
            if let Some(pairs) = pairs {
                self.add_rows(clip, seen, &pairs);
                self.kept_screens.add(clip, seen, pairs);
            }
        }
        Some(frame)
    }

    fn add_truth(
        &mut self,
        original: OriginalFrame<'_>,
        whole: &FrameFindings,
        seen: &FrameFindings,
    ) {
        let Some(detector) = self.vision_network.detector() else { return };
        let Some((curves, objects)) = self.truth_curves.as_mut().zip(original.objects) else {
            return;
        };
        for (curve, findings) in curves.iter_mut().zip([whole, seen]) {
            let found = findings.detections.as_deref().unwrap_or_default();
            curve.add_frame(found, objects, SAME_OBJECT_OVERLAP, detector.height);
        }
    }

    /// Adds the detections of a frame to the table.
    fn add_rows(&mut self, clip: &str, seen: ReceivedFrame<'_>, pairs: &DetectionPairs) {
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
                is_in_both: *is_both,
                detection: detection.clone(),
            });
        }
    }

    pub(crate) fn into_detections(self) -> Option<CountedDetections> {
        let Self { vision_network, kept_screens: shots, rows, .. } = self;
        vision_network.detector().is_some().then_some(CountedDetections { shots, rows })
    }

    /// Returns the comparison of all counted frames.
    pub(crate) fn summary(&self) -> WholeFrameAgreement {
        let detector = self.vision_network.detector();
        let score = detector.map_or(0.0, |detector| detector.score);
        let truth = self.truth_curves.as_ref().map(|[whole, seen]| GroundTruthFigures {
            objects: whole.objects(),
            whole_ap50: whole.average_precision(),
            seen_ap50: seen.average_precision(),
            whole_recall: whole.recall(score),
            seen_recall: seen.recall(score),
        });
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let seconds = self.seconds / self.sums.frames.max(1) as f64;
        WholeFrameAgreement {
            agreement: self.sums.agreement(),
            intervals: ConfidenceIntervals::from_sums(&self.sums),
            noise: self.noise.results(),
            relative_rms: self.sums.distance.relative_rms(),
            classes: self.sums.class_agreement(),
            same_places: self.sums.position_share(),
            detections: detector.and_then(|detector| self.sums.detection_agreement(detector)),
            truth,
            picture_psnr: self.received.psnr(),
            sent_bytes: self.received.bytes_per_frame(),
            sent_share: self.received.sent_share(),
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

/// The number of frames that are kept.
const MAX_SCREENS: usize = 6;

/// A frame with its detections.
#[derive(Clone, Debug)]
pub(crate) struct KeptScreen {
    pub(crate) clip: String,
    pub(crate) number: u64,
    pub(crate) name: String,
    pub(crate) pairs: DetectionPairs,
    screen: Vec<u16>,
}

/// The frames with the most differences.
#[derive(Debug)]
pub(crate) struct KeptScreens {
    width: u32,
    height: u32,
    bits: u32,
    kept: Vec<KeptScreen>,
}

impl KeptScreen {
    pub(crate) fn detection_counts(&self) -> DetectionCounts {
        self.pairs.total_counts()
    }

    /// Returns the number of detections that are lost or added.
    fn differences(&self) -> u64 {
        let found = self.detection_counts();
        found.whole - found.kept + found.added
    }
}

impl KeptScreens {
    pub(super) fn new(camera: &Camera) -> Self {
        let (width, height, bits) = (camera.width(), camera.height(), camera.pixel_bits());
        Self { width, height, bits, kept: Vec::new() }
    }

    /// Keeps a frame if it has more lost and added detections than one of the kept frames.
    pub(super) fn add(&mut self, clip: &str, seen: ReceivedFrame<'_>, pairs: DetectionPairs) {
        let shot = KeptScreen {
            clip: clip.to_owned(),
            number: seen.number,
            name: seen.name.to_owned(),
            pairs,
            screen: Vec::new(),
        };
        let least = self.kept.last().map_or(0, KeptScreen::differences);
        if self.kept.len() == MAX_SCREENS && shot.differences() <= least {
            return;
        }
        let before = self.kept.iter().take_while(|one| one.differences() >= shot.differences());
        let at = before.count();
        self.kept.insert(at, KeptScreen { screen: seen.screen.to_vec(), ..shot });
        self.kept.truncate(MAX_SCREENS);
    }

    /// Returns the kept frames, those with the most differences first.
    pub(crate) fn screens(&self) -> &[KeptScreen] {
        &self.kept
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Returns the screen of a frame as a PNG in base64.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub(crate) fn png_base64(&self, shot: &KeptScreen) -> ImageResult<String> {
        let byte = |&pixel: &u16| {
            u8::try_from(convert_depth(pixel, self.bits, 8)).expect("a pixel of 8 bits is a byte")
        };
        let pixels = shot.screen.iter().map(byte).collect();
        let picture =
            image::ImageBuffer::<Luma<u8>, Vec<u8>>::from_raw(self.width, self.height, pixels);
        let mut bytes = Cursor::new(Vec::new());
        picture.expect("a screen has all pixels").write_to(&mut bytes, ImageFormat::Png)?;
        Ok(STANDARD.encode(bytes.into_inner()))
    }
}
