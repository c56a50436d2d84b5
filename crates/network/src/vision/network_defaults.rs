// SPDX-License-Identifier: MIT OR Apache-2.0
//! Guesses the detection format and the usual pixel mapping of a network, for users who open a
//! network without options.

use super::detection_format::{DetectionFormat, OutputTensor};
use super::detector::Detector;

/// The probable formats and pixel mapping of a network. It may have been trained with others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetworkDefaults {
    /// All formats that the outputs have.
    pub matching_formats: Vec<DetectionFormat>,
    /// The most likely of the formats; `None` if the match is probably by chance, as for
    /// segmentation networks.
    pub format: Option<DetectionFormat>,
    /// The mean to subtract from pixels of 0 to 1, as it is written on the command line.
    pub mean: &'static str,
    /// The scale by which pixels are then divided, as it is written on the command line.
    pub scale: &'static str,
}

/// Guesses the formats and the pixel mapping of a network with these outputs. `input` is the width
/// and the height of its input.
#[must_use]
pub fn guess_defaults(outputs: &[OutputTensor], input: (usize, usize)) -> NetworkDefaults {
    // Formats with fixed names or numbers of cells come before formats that are recognized by the
    // number of axes.
    let order = [
        DetectionFormat::Yunet,
        DetectionFormat::Yolox,
        DetectionFormat::Ssd,
        DetectionFormat::FastestDet,
        DetectionFormat::Yolov5,
        DetectionFormat::Yolov8,
    ];
    let fits: Vec<DetectionFormat> =
        order.into_iter().filter(|head| head.check(outputs, input).is_ok()).collect();
    let head = fits.iter().copied().find(|&head| is_likely(head, outputs, input));
    let (mean, scale) = head.map_or(("0", "1"), usual_mapping);
    NetworkDefaults { matching_formats: fits, format: head, mean, scale }
}

impl NetworkDefaults {
    /// The most likely detector, with the usual settings.
    #[must_use]
    pub fn detector(&self) -> Option<Detector> {
        self.format.map(Detector::new)
    }
}

/// Returns true if outputs probably have a format on purpose, and not by chance.
fn is_likely(head: DetectionFormat, outputs: &[OutputTensor], input: (usize, usize)) -> bool {
    match (head, &outputs[0].shape[..]) {
        (DetectionFormat::Yolov5, [_, cells, values])
        | (DetectionFormat::Yolov8, [_, values, cells]) => values < cells,
        // A grid as fine as the input is a segmentation, and a single cell is a classification.
        (DetectionFormat::FastestDet, [_, _, rows, columns]) => {
            rows.min(columns) > &1 && rows * 8 <= input.1 && columns * 8 <= input.0
        }
        _ => true,
    }
}

/// Returns the mean and the scale with which the project of a format prepares pixels. `YOLOX` and
/// `YuNet` (`FaceDetectorYN` of `OpenCV`) take 0 to 255, `UltraFace` takes (pixel - 127) / 128, and
/// `YOLOv5`, its successors and `FastestDet` take 0 to 1.
fn usual_mapping(head: DetectionFormat) -> (&'static str, &'static str) {
    match head {
        DetectionFormat::Yolox | DetectionFormat::Yunet => ("0", "1/255"),
        DetectionFormat::Ssd => ("127/255", "128/255"),
        DetectionFormat::Yolov5 | DetectionFormat::Yolov8 | DetectionFormat::FastestDet => {
            ("0", "1")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(shapes: &[(&str, &[usize])], input: (usize, usize)) -> NetworkDefaults {
        let output = |&(name, shape): &(&str, &[usize])| OutputTensor {
            name: name.to_owned(),
            shape: shape.to_vec(),
            values: Vec::new(),
        };
        guess_defaults(&shapes.iter().map(output).collect::<Vec<_>>(), input)
    }

    #[test]
    fn formats_are_known_by_their_outputs() {
        let of_one = |shape: &[usize], input| of(&[("out", shape)], input);
        let yolox = of_one(&[1, 3549, 85], (416, 416));
        assert_eq!((yolox.format, yolox.scale), (Some(DetectionFormat::Yolox), "1/255"));
        assert_eq!(
            yolox.matching_formats,
            [DetectionFormat::Yolox, DetectionFormat::Yolov5, DetectionFormat::Yolov8]
        );
        assert_eq!(of_one(&[1, 25200, 85], (640, 640)).format, Some(DetectionFormat::Yolov5));
        let yolov8 = of_one(&[1, 84, 8400], (640, 640));
        assert_eq!((yolov8.format, yolov8.scale), (Some(DetectionFormat::Yolov8), "1"));
        let faces = of(&[("scores", &[1, 4420, 2]), ("boxes", &[1, 4420, 4])], (320, 240));
        assert_eq!((faces.format, faces.mean), (Some(DetectionFormat::Ssd), "127/255"));
        assert_eq!(of_one(&[1, 85, 22, 22], (352, 352)).format, Some(DetectionFormat::FastestDet));
    }

    #[test]
    fn what_is_probably_no_detector_is_not_taken_for_one() {
        let classes = of(&[("logits", &[1, 1000])], (224, 224));
        assert_eq!((classes.format, classes.matching_formats.len(), classes.scale), (None, 0, "1"));
        let classes = of(&[("softmax", &[1, 1000, 1, 1])], (224, 224));
        assert_eq!(
            (classes.format, classes.matching_formats),
            (None, vec![DetectionFormat::FastestDet])
        );
        // A segmentation has as many axes as the format of FastestDet, so users may still choose
        // that format.
        let places = of(&[("out", &[1, 21, 513, 513])], (513, 513));
        assert_eq!(
            (places.format, places.matching_formats),
            (None, vec![DetectionFormat::FastestDet])
        );
    }
}
