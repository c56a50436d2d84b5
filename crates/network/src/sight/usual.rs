// SPDX-License-Identifier: MIT OR Apache-2.0
//! Guesses the detection format and the usual pixel mapping of a network, for users who open a
//! network without options.

use super::detector::Detector;
use super::head::{Head, Output};

/// The probable formats and pixel mapping of a network. It may have been trained with others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Usual {
    /// All formats that the outputs have.
    pub fits: Vec<Head>,
    /// The most likely of the formats; `None` if the match is probably by chance, as for
    /// segmentation networks.
    pub head: Option<Head>,
    /// The mean to subtract from pixels of 0 to 1, as it is written on the command line.
    pub mean: &'static str,
    /// The scale by which pixels are then divided, as it is written on the command line.
    pub scale: &'static str,
}

/// Guesses the formats and the pixel mapping of a network with these outputs. `input` is the width
/// and the height of its input.
#[must_use]
pub fn usual(outputs: &[Output], input: (usize, usize)) -> Usual {
    // Formats with fixed names or numbers of cells come before formats that are recognized by the
    // number of axes.
    let order = [Head::Yunet, Head::Yolox, Head::Ssd, Head::FastestDet, Head::Yolov5, Head::Yolov8];
    let fits: Vec<Head> =
        order.into_iter().filter(|head| head.check(outputs, input).is_ok()).collect();
    let head = fits.iter().copied().find(|&head| is_likely(head, outputs, input));
    let (mean, scale) = head.map_or(("0", "1"), mapping);
    Usual { fits, head, mean, scale }
}

impl Usual {
    /// The most likely detector, with the usual settings.
    #[must_use]
    pub fn detector(&self) -> Option<Detector> {
        self.head.map(Detector::new)
    }
}

/// Returns true if outputs that have a format probably have it on purpose.
fn is_likely(head: Head, outputs: &[Output], input: (usize, usize)) -> bool {
    match (head, &outputs[0].shape[..]) {
        (Head::Yolov5, [_, cells, values]) | (Head::Yolov8, [_, values, cells]) => values < cells,
        // A grid as fine as the input is a segmentation, and a single cell is a classification.
        (Head::FastestDet, [_, _, rows, columns]) => {
            rows.min(columns) > &1 && rows * 8 <= input.1 && columns * 8 <= input.0
        }
        _ => true,
    }
}

/// Returns the mean and the scale with which the project of a format prepares pixels. `YOLOX` and
/// `YuNet` (`FaceDetectorYN` of `OpenCV`) take 0 to 255, `UltraFace` takes (pixel - 127) / 128, and
/// `YOLOv5`, its successors and `FastestDet` take 0 to 1.
fn mapping(head: Head) -> (&'static str, &'static str) {
    match head {
        Head::Yolox | Head::Yunet => ("0", "1/255"),
        Head::Ssd => ("127/255", "128/255"),
        Head::Yolov5 | Head::Yolov8 | Head::FastestDet => ("0", "1"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(shapes: &[(&str, &[usize])], input: (usize, usize)) -> Usual {
        let output = |&(name, shape): &(&str, &[usize])| Output {
            name: name.to_owned(),
            shape: shape.to_vec(),
            values: Vec::new(),
        };
        usual(&shapes.iter().map(output).collect::<Vec<_>>(), input)
    }

    #[test]
    fn formats_are_known_by_their_outputs() {
        let of_one = |shape: &[usize], input| of(&[("out", shape)], input);
        let yolox = of_one(&[1, 3549, 85], (416, 416));
        assert_eq!((yolox.head, yolox.scale), (Some(Head::Yolox), "1/255"));
        assert_eq!(yolox.fits, [Head::Yolox, Head::Yolov5, Head::Yolov8]);
        assert_eq!(of_one(&[1, 25200, 85], (640, 640)).head, Some(Head::Yolov5));
        let yolov8 = of_one(&[1, 84, 8400], (640, 640));
        assert_eq!((yolov8.head, yolov8.scale), (Some(Head::Yolov8), "1"));
        let faces = of(&[("scores", &[1, 4420, 2]), ("boxes", &[1, 4420, 4])], (320, 240));
        assert_eq!((faces.head, faces.mean), (Some(Head::Ssd), "127/255"));
        assert_eq!(of_one(&[1, 85, 22, 22], (352, 352)).head, Some(Head::FastestDet));
    }

    #[test]
    fn what_is_probably_no_detector_is_not_taken_for_one() {
        let classes = of(&[("logits", &[1, 1000])], (224, 224));
        assert_eq!((classes.head, classes.fits.len(), classes.scale), (None, 0, "1"));
        let classes = of(&[("softmax", &[1, 1000, 1, 1])], (224, 224));
        assert_eq!((classes.head, classes.fits), (None, vec![Head::FastestDet]));
        // A segmentation has as many axes as the format of FastestDet, so users may still choose
        // that format.
        let places = of(&[("out", &[1, 21, 513, 513])], (513, 513));
        assert_eq!((places.head, places.fits), (None, vec![Head::FastestDet]));
    }
}
