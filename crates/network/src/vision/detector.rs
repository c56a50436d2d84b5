// SPDX-License-Identifier: MIT OR Apache-2.0
//! The format in which detections are read from a network, and the selection of those that count.

use std::fmt;

use super::detection::{Detection, suppress_overlapping};
use super::detection_format::{DetectionFormat, OutputTensor};

/// The lowest score of detections that are used for average precision, whatever the score of a
/// detector is.
pub(super) const MIN_SCORE: f32 = 0.01;

/// A format of detections, and the selection of those that count.
#[derive(Clone, Debug, PartialEq)]
pub struct Detector {
    /// The format.
    pub format: DetectionFormat,
    /// The lowest score of detections that count, from 0 to 1.
    pub score: f32,
    /// The largest overlap of detections of a class. Of detections that overlap more, the one with
    /// the highest score counts.
    pub overlap: f64,
    /// The classes that count, by their numbers from 0; empty for all.
    pub classes: Vec<usize>,
    /// The lowest height of detections that count, in pixels of the frame.
    pub height: f64,
}

impl Detector {
    /// Returns a detector with usual settings: a score of 0.3, an overlap of 0.45, all classes and
    /// all heights.
    #[must_use]
    pub fn new(head: DetectionFormat) -> Self {
        Self { format: head, score: 0.3, overlap: 0.45, classes: Vec::new(), height: 0.0 }
    }

    /// Returns the detections with at least the score that average precision needs, in descending
    /// order of score and in pixels of the input.
    pub(super) fn read_detections(
        &self,
        outputs: &[OutputTensor],
        input: (usize, usize),
    ) -> Vec<Detection> {
        let least = self.score.min(MIN_SCORE);
        let mut found = self.format.decode(outputs, input, least);
        found
            .retain(|detection| self.classes.is_empty() || self.classes.contains(&detection.class));
        suppress_overlapping(found, self.overlap)
    }

    /// Returns true if a detection, in pixels of the frame, counts.
    pub(super) fn accepts(&self, detection: &Detection) -> bool {
        detection.score >= self.score && detection.rect.height() >= self.height
    }
}

/// Parses a detector as users write it: `yolox`, or
/// `yolox,score=0.3,overlap=0.45,classes=0+2,height=80`.
///
/// # Errors
/// Fails if the text is no detector; the message tells what is expected.
pub fn parse_detector(text: &str) -> Result<Detector, String> {
    let mut words = text.split(',');
    let name = words.next().unwrap_or_default();
    let format =
        DetectionFormat::ALL.into_iter().find(|format| format.name() == name).ok_or_else(|| {
            let names = DetectionFormat::ALL.map(DetectionFormat::name);
            format!("`{name}` is not a format of detections; expected {}", names.join(", "))
        })?;
    let mut detector = Detector::new(format);
    for word in words {
        let syntax_message = || {
            format!(
                "`{word}`: expected score=S and overlap=S from 0 to 1, classes=C+C.. with numbers from 0, or height=PIXELS"
            )
        };
        let (key, value) = word.split_once('=').ok_or_else(syntax_message)?;
        let real = |most: f64| value.parse().ok().filter(|value| (0.0..=most).contains(value));
        match key {
            #[allow(clippy::cast_possible_truncation, reason = "a share")]
            "score" => detector.score = real(1.0).ok_or_else(syntax_message)? as f32,
            "overlap" => detector.overlap = real(1.0).ok_or_else(syntax_message)?,
            "height" => detector.height = real(1e6).ok_or_else(syntax_message)?,
            "classes" => {
                let classes = value.split('+').map(|class| class.parse().ok());
                detector.classes = classes.collect::<Option<_>>().ok_or_else(syntax_message)?;
            }
            _ => return Err(syntax_message()),
        }
    }
    Ok(detector)
}

impl fmt::Display for Detector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},score={},overlap={}", self.format, self.score, self.overlap)?;
        if !self.classes.is_empty() {
            let classes: Vec<_> = self.classes.iter().map(ToString::to_string).collect();
            write!(f, ",classes={}", classes.join("+"))?;
        }
        if self.height > 0.0 {
            write!(f, ",height={}", self.height)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn detectors_are_read_as_they_are_written() {
        for text in [
            "yolox,score=0.3,overlap=0.45",
            "ssd,score=0.5,overlap=0.3,classes=0+2",
            "yolov8,score=0.25,overlap=0.7,height=80",
        ] {
            assert_eq!(parse_detector(text).unwrap().to_string(), text);
        }
        assert_eq!(parse_detector("yunet"), Ok(Detector::new(DetectionFormat::Yunet)));
        for (wrong, expected) in [
            ("yolo", "yolox, yolov5"),
            ("yolox,score", "score=S"),
            ("yolox,score=2", "`score=2`"),
            ("yolox,classes=person", "numbers from 0"),
            ("yolox,height=-1", "`height=-1`"),
            ("yolox,width=1", "`width=1`"),
        ] {
            let problem = parse_detector(wrong).unwrap_err();
            assert!(problem.contains(expected), "{problem}");
        }
    }

    #[test]
    fn only_classes_that_are_named_are_read() {
        let values = vec![4., 4., 2., 2., 1., 0.9, 0.1, 12., 4., 2., 2., 1., 0.2, 0.4];
        let output = OutputTensor { name: "out".to_owned(), shape: vec![1, 2, 7], values };
        let found = |text: &str| {
            let detector = parse_detector(text).unwrap();
            let found = detector.read_detections(std::slice::from_ref(&output), (16, 16));
            found
                .iter()
                .map(|detection| (detection.class, detector.accepts(detection)))
                .collect::<Vec<_>>()
        };
        assert_eq!(found("yolov5"), [(0, true), (1, true)]);
        assert_eq!(found("yolov5,classes=1"), [(1, true)]);
        assert_eq!(found("yolov5,score=0.5"), [(0, true), (1, false)]);
        assert_eq!(found("yolov5,height=3"), [(0, false), (1, false)]);
    }
}
