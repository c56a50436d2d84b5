// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output formats of detectors, and their decoding.

use std::fmt;

use super::detection::Detection;
use foveate_pixels::{MAX_COORDINATE, Rect};

/// The strides, in pixels, of the three grids of cells that many detectors have.
const STRIDES: [usize; 3] = [8, 16, 32];

/// An output format of detectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DetectionFormat {
    /// `[1, cells, 5 + classes]`: center and logarithm of the size in cells of strides 8, 16 and
    /// 32, objectness, class scores.
    Yolox,
    /// `[1, cells, 5 + classes]`: center and size in pixels, objectness, class scores. `YOLOv5` and
    /// `YOLOv7` have this format.
    Yolov5,
    /// `[1, 4 + classes, cells]`: center and size in pixels, class scores. `YOLOv8` and `YOLO11`
    /// have this format.
    Yolov8,
    /// `[1, boxes, classes]` and `[1, boxes, 4]`: probabilities, of which the first belongs to the
    /// background, and corners as shares of the input.
    Ssd,
    /// `cls_8`, `obj_8`, `bbox_8`, and outputs of the same kinds for strides 16 and 32: center and
    /// logarithm of the size in cells. `YuNet` has this format.
    Yunet,
    /// `[1, 5 + classes, rows, columns]`: objectness, center and size, class scores. `FastestDet`
    /// has this format.
    FastestDet,
}

/// An output of a network.
#[derive(Clone, Debug)]
pub struct OutputTensor {
    /// The name in the model.
    pub name: String,
    /// The shape of the output.
    pub shape: Vec<usize>,
    /// The values in row-major order; empty if only the shape is needed.
    pub values: Vec<f32>,
}

impl DetectionFormat {
    /// All formats.
    pub const ALL: [Self; 6] =
        [Self::Yolox, Self::Yolov5, Self::Yolov8, Self::Ssd, Self::Yunet, Self::FastestDet];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Yolox => "yolox",
            Self::Yolov5 => "yolov5",
            Self::Yolov8 => "yolov8",
            Self::Ssd => "ssd",
            Self::Yunet => "yunet",
            Self::FastestDet => "fastestdet",
        }
    }

    /// The outputs of the format, in words.
    fn expected_outputs(self) -> &'static str {
        match self {
            Self::Yolox => {
                "one output [1, cells, 5 + classes], with the cells of strides 8, 16 and 32 of the input"
            }
            Self::Yolov5 => "an output [1, cells, 5 + classes]",
            Self::Yolov8 => "an output [1, 4 + classes, cells]",
            Self::Ssd => "an output [1, boxes, classes] and one [1, boxes, 4]",
            Self::Yunet => {
                "outputs cls_8, obj_8 and bbox_8 of [1, cells, 1] and [1, cells, 4], and the same of strides 16 and 32"
            }
            Self::FastestDet => "an output [1, 5 + classes, rows, columns]",
        }
    }

    /// Checks that outputs have this format. `input` is the width and the height of the network's
    /// input.
    ///
    /// # Errors
    /// Fails if they have another format; the message names the expected and the actual outputs.
    pub fn check(self, outputs: &[OutputTensor], input: (usize, usize)) -> Result<(), String> {
        let first = first_shape(outputs);
        let fits = match self {
            Self::Yolox => {
                let cells: usize =
                    STRIDES.iter().map(|stride| (input.0 / stride) * (input.1 / stride)).sum();
                matches!(first, &[1, own, values] if own == cells && values > 5)
            }
            Self::Yolov5 => matches!(first, &[1, _, values] if values > 5),
            Self::Yolov8 => matches!(first, &[1, values, _] if values > 4),
            Self::Ssd => scores_and_boxes(outputs).is_some(),
            Self::Yunet => STRIDES.iter().all(|&stride| {
                let cells = (input.0 / stride) * (input.1 / stride);
                let has_shape = |name: &str, values| {
                    let output = grid_output(outputs, name, stride);
                    output.is_some_and(|output| output.shape == [1, cells, values])
                };
                has_shape("cls", 1) && has_shape("obj", 1) && has_shape("bbox", 4)
            }),
            Self::FastestDet => matches!(first, &[1, values, _, _] if values > 5),
        };
        if fits {
            return Ok(());
        }
        let found: Vec<_> =
            outputs.iter().map(|output| format!("`{}` {:?}", output.name, output.shape)).collect();
        let found = if found.is_empty() { "no output".to_owned() } else { found.join(", ") };
        let (format, expected) = (self.name(), self.expected_outputs());
        Err(format!("detections of {format} need {expected}, but the network has {found}"))
    }

    /// The number of classes in outputs of this format.
    #[must_use]
    pub fn class_count(self, outputs: &[OutputTensor]) -> usize {
        let values = |axis: usize, others: usize| {
            first_shape(outputs).get(axis).map_or(0, |values| values.saturating_sub(others))
        };
        match self {
            Self::Yolox | Self::Yolov5 => values(2, 5),
            Self::Yolov8 => values(1, 4),
            Self::FastestDet => values(1, 5),
            Self::Yunet => 1,
            Self::Ssd => scores_and_boxes(outputs).map_or(0, |(scores, _)| scores.shape[2] - 1),
        }
    }

    /// Decodes the detections with a score of at least `least`: the most likely class of every
    /// cell, in pixels of the input. The outputs must have passed [`DetectionFormat::check`].
    #[must_use]
    pub fn decode(
        self,
        outputs: &[OutputTensor],
        input: (usize, usize),
        least: f32,
    ) -> Vec<Detection> {
        match self {
            Self::Yolox => decode_yolox(&outputs[0], input, least),
            Self::Yolov5 => {
                let [_, _, values] = outputs[0].shape[..] else { return Vec::new() };
                let rows = outputs[0].values.chunks_exact(values);
                let read = |row: &[f32]| {
                    most_likely_class(&row[5..], row[4], least, corners_from_center(&row[..4]))
                };
                rows.filter_map(read).collect()
            }
            Self::Yolov8 => {
                let [_, values, cells] = outputs[0].shape[..] else { return Vec::new() };
                let cell_values = |cell: usize| -> Vec<f32> {
                    (0..values).map(|value| outputs[0].values[value * cells + cell]).collect()
                };
                let read = |row: Vec<f32>| {
                    most_likely_class(&row[4..], 1.0, least, corners_from_center(&row[..4]))
                };
                (0..cells).map(cell_values).filter_map(read).collect()
            }
            Self::Ssd => decode_ssd(outputs, input, least),
            Self::Yunet => STRIDES
                .iter()
                .flat_map(|&stride| decode_yunet(outputs, stride, input.0 / stride, least))
                .collect(),
            Self::FastestDet => decode_fastestdet(&outputs[0], input, least),
        }
    }
}

impl fmt::Display for DetectionFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Returns the corners of a rectangle with this center and size.
fn corners_from_center(values: &[f32]) -> [f32; 4] {
    let [x, y, width, height] = [values[0], values[1], values[2], values[3]];
    [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
}

/// Returns a detection of the most likely class, if its score is high enough and the corners are
/// valid.
fn most_likely_class(
    classes: &[f32],
    factor: f32,
    least: f32,
    corners: [f32; 4],
) -> Option<Detection> {
    let best = classes.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let (class, &class_score) = best?;
    checked_detection(class, class_score * factor, least, corners)
}

fn checked_detection(class: usize, score: f32, least: f32, corners: [f32; 4]) -> Option<Detection> {
    let corners = corners.map(|value| f64::from(value).clamp(-MAX_COORDINATE, MAX_COORDINATE));
    let rect = Rect::from_corners(corners).ok()?;
    (score >= least).then_some(Detection { class, score, rect })
}

fn decode_yolox(output: &OutputTensor, input: (usize, usize), least: f32) -> Vec<Detection> {
    let [_, _, values] = output.shape[..] else { return Vec::new() };
    let cells = STRIDES.iter().flat_map(|&stride| {
        let columns = input.0 / stride;
        (0..columns * (input.1 / stride)).map(move |cell| (stride, cell % columns, cell / columns))
    });
    let read = |(row, (stride, column, row_of_cell)): (&[f32], (usize, usize, usize))| {
        let corners = corners_in_cell(&row[..4], stride, column, row_of_cell);
        most_likely_class(&row[5..], row[4], least, corners)
    };
    output.values.chunks_exact(values).zip(cells).filter_map(read).collect()
}

/// Returns the corners of a rectangle from a center in cells and the logarithm of a size.
#[allow(clippy::cast_precision_loss, reason = "an input has fewer pixels than a float holds")]
fn corners_in_cell(values: &[f32], stride: usize, column: usize, row: usize) -> [f32; 4] {
    let stride = stride as f32;
    let (x, y) = ((values[0] + column as f32) * stride, (values[1] + row as f32) * stride);
    corners_from_center(&[x, y, values[2].exp() * stride, values[3].exp() * stride])
}

/// Returns the output of a kind and a stride, such as `cls_8`.
fn grid_output<'a>(
    outputs: &'a [OutputTensor],
    kind: &str,
    stride: usize,
) -> Option<&'a OutputTensor> {
    let name = format!("{kind}_{stride}");
    outputs.iter().find(|output| output.name == name)
}

fn decode_yunet(
    outputs: &[OutputTensor],
    stride: usize,
    columns: usize,
    least: f32,
) -> Vec<Detection> {
    let values_of =
        |kind| grid_output(outputs, kind, stride).map_or(&[][..], |output| &output.values);
    let (classes, objects, places) = (values_of("cls"), values_of("obj"), values_of("bbox"));
    let read = |(cell, ((class, object), place)): (usize, ((&f32, &f32), &[f32]))| {
        let score = (class.clamp(0.0, 1.0) * object.clamp(0.0, 1.0)).sqrt();
        checked_detection(
            0,
            score,
            least,
            corners_in_cell(place, stride, cell % columns, cell / columns),
        )
    };
    classes.iter().zip(objects).zip(places.chunks_exact(4)).enumerate().filter_map(read).collect()
}

/// Returns the shape of the first output, which is empty if there is no output.
fn first_shape(outputs: &[OutputTensor]) -> &[usize] {
    outputs.first().map_or(&[], |output| &output.shape)
}

fn scores_and_boxes(outputs: &[OutputTensor]) -> Option<(&OutputTensor, &OutputTensor)> {
    let is_boxes = |output: &&OutputTensor| matches!(output.shape[..], [1, _, 4]);
    let has_name_of_boxes =
        |output: &&OutputTensor| ["box", "loc"].iter().any(|word| output.name.contains(word));
    let mut boxes = outputs.iter().filter(is_boxes);
    let boxes = boxes.clone().find(has_name_of_boxes).or_else(|| boxes.next())?;
    let fits = |output: &&OutputTensor| {
        output.name != boxes.name
            && matches!(output.shape[..], [1, count, classes] if count == boxes.shape[1] && classes > 1)
    };
    Some((outputs.iter().find(fits)?, boxes))
}

#[allow(clippy::cast_precision_loss, reason = "an input has fewer pixels than a float holds")]
fn decode_ssd(outputs: &[OutputTensor], input: (usize, usize), least: f32) -> Vec<Detection> {
    let Some((scores, boxes)) = scores_and_boxes(outputs) else { return Vec::new() };
    let [_, _, classes] = scores.shape[..] else { return Vec::new() };
    let (width, height) = (input.0 as f32, input.1 as f32);
    let read = |(shares, corners): (&[f32], &[f32])| {
        let corners =
            [corners[0] * width, corners[1] * height, corners[2] * width, corners[3] * height];
        // The first class is the background, so classes count from the second.
        most_likely_class(&shares[1..], 1.0, least, corners)
    };
    scores.values.chunks_exact(classes).zip(boxes.values.chunks_exact(4)).filter_map(read).collect()
}

#[allow(clippy::cast_precision_loss, reason = "an input has fewer pixels than a float holds")]
fn decode_fastestdet(output: &OutputTensor, input: (usize, usize), least: f32) -> Vec<Detection> {
    let [_, values, rows, columns] = output.shape[..] else { return Vec::new() };
    let (wide, high) = (input.0 as f32 / columns as f32, input.1 as f32 / rows as f32);
    let sigmoid = |value: f32| 1.0 / (1.0 + (-value).exp());
    let read = |cell: usize| {
        let at = |value: usize| output.values[value * rows * columns + cell];
        let x = (at(1).tanh() + (cell % columns) as f32) * wide;
        let y = (at(2).tanh() + (cell / columns) as f32) * high;
        let (width, height) = (sigmoid(at(3)) * input.0 as f32, sigmoid(at(4)) * input.1 as f32);
        let classes: Vec<f32> = (5..values).map(|value| at(value).powf(0.4)).collect();
        most_likely_class(
            &classes,
            at(0).powf(0.6),
            least,
            corners_from_center(&[x, y, width, height]),
        )
    };
    (0..rows * columns).filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(name: &str, shape: &[usize], values: Vec<f32>) -> OutputTensor {
        assert_eq!(values.len(), shape.iter().product::<usize>());
        OutputTensor { name: name.to_owned(), shape: shape.to_vec(), values }
    }

    fn only_detection(
        format: DetectionFormat,
        outputs: &[OutputTensor],
        input: (usize, usize),
    ) -> (usize, f32, [f64; 4]) {
        format.check(outputs, input).unwrap();
        let found = format.decode(outputs, input, 0.3);
        let [detection] = &found[..] else { panic!("{found:?}") };
        let rect = detection.rect;
        let corners = [rect.x0, rect.y0, rect.x1, rect.y1];
        (detection.class, detection.score, corners.map(|value| (value * 1000.0).round() / 1000.0))
    }

    /// The grids have 8x4, 4x2 and 2x1 cells. The object is in cell (2, 1) of the second grid.
    #[test]
    fn yolox_counts_cells_of_three_grids() {
        let mut values = vec![0.0; 42 * 7];
        let cell = 32 + 6;
        values[cell * 7..][..7].copy_from_slice(&[
            0.5,
            0.25,
            2.0_f32.ln(),
            4.0_f32.ln(),
            0.8,
            0.1,
            0.9,
        ]);
        let outputs = [output("output", &[1, 42, 7], values)];
        // The center is at (2.5, 1.25) cells of 16 pixels, and the size is 32 x 64 pixels.
        let found = only_detection(DetectionFormat::Yolox, &outputs, (64, 32));
        assert_eq!((found.0, found.2), (1, [24., -12., 56., 52.]));
        assert!((found.1 - 0.72).abs() < 1e-6);
    }

    #[test]
    fn yolov5_and_yolov8_are_in_pixels() {
        let row = [20.0, 10.0, 8.0, 4.0];
        let mut values = vec![0.0; 3 * 7];
        values[7..11].copy_from_slice(&row);
        values[11..14].copy_from_slice(&[0.5, 0.9, 0.2]);
        let outputs = [output("out", &[1, 3, 7], values)];
        assert_eq!(
            only_detection(DetectionFormat::Yolov5, &outputs, (64, 64)),
            (0, 0.45, [16., 8., 24., 12.])
        );
        assert_eq!(DetectionFormat::Yolov5.class_count(&outputs), 2);
        let mut values = vec![0.0; 6 * 3];
        for (value, number) in row.into_iter().chain([0.2, 0.6]).enumerate() {
            values[value * 3 + 2] = number;
        }
        let outputs = [output("out", &[1, 6, 3], values)];
        assert_eq!(
            only_detection(DetectionFormat::Yolov8, &outputs, (64, 64)),
            (1, 0.6, [16., 8., 24., 12.])
        );
        assert_eq!(DetectionFormat::Yolov8.class_count(&outputs), 2);
    }

    #[test]
    fn ssd_has_a_background_and_shares_of_the_input() {
        let outputs = [
            output("boxes", &[1, 2, 4], vec![0.0, 0.0, 1.0, 1.0, 0.25, 0.5, 0.75, 1.0]),
            output("scores", &[1, 2, 3], vec![0.9, 0.05, 0.05, 0.1, 0.1, 0.8]),
        ];
        assert_eq!(
            only_detection(DetectionFormat::Ssd, &outputs, (320, 240)),
            (1, 0.8, [80., 120., 240., 240.])
        );
        // The background is not counted as a class.
        assert_eq!(DetectionFormat::Ssd.class_count(&outputs), 2);
    }

    #[test]
    fn yunet_takes_the_mean_of_two_scores() {
        let mut outputs = Vec::new();
        for (stride, cells) in [(8, 8), (16, 2), (32, 0)] {
            for (kind, values) in [("cls", 1), ("obj", 1), ("bbox", 4)] {
                let name = format!("{kind}_{stride}");
                outputs.push(output(&name, &[1, cells, values], vec![0.0; cells * values]));
            }
        }
        // The index is that of cell (1, 1) in the first grid, which has 4 columns.
        outputs[0].values[5] = 0.64;
        outputs[1].values[5] = 1.5;
        outputs[2].values[20..24].copy_from_slice(&[0.5, 0.5, 0.0, 0.0]);
        assert_eq!(
            only_detection(DetectionFormat::Yunet, &outputs, (32, 16)),
            (0, 0.8, [8., 8., 16., 16.])
        );
    }

    #[test]
    fn fastestdet_is_in_shares_of_cells_and_input() {
        let mut values = vec![0.0; 7 * 6];
        for (value, number) in [1.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0].into_iter().enumerate() {
            values[value * 6 + 4] = number;
        }
        let outputs = [output("758", &[1, 7, 2, 3], values)];
        // Cell (1, 1) begins at (32, 32). Half of the input is 48 x 32 pixels.
        assert_eq!(
            only_detection(DetectionFormat::FastestDet, &outputs, (96, 64)),
            (1, 1.0, [8., 16., 56., 48.])
        );
    }

    #[test]
    fn other_outputs_are_refused_with_their_shapes() {
        let outputs = [output("logits", &[1, 1000], vec![0.0; 1000])];
        for head in DetectionFormat::ALL {
            let problem = head.check(&outputs, (64, 64)).unwrap_err();
            assert!(problem.contains("`logits` [1, 1000]"), "{problem}");
            assert!(problem.contains(head.name()), "{problem}");
            let problem = head.check(&[], (64, 64)).unwrap_err();
            assert!(problem.ends_with("but the network has no output"), "{problem}");
        }
        // The input has another size than the number of cells requires.
        let outputs = [output("output", &[1, 42, 7], vec![0.0; 42 * 7])];
        assert!(DetectionFormat::Yolox.check(&outputs, (64, 64)).is_err());
    }

    #[test]
    fn a_value_that_is_no_number_is_no_detection() {
        let outputs = [output("out", &[1, 1, 7], vec![f32::NAN, 0., 1., 1., 1., 1., 1.])];
        assert!(DetectionFormat::Yolov5.decode(&outputs, (8, 8), 0.1).is_empty());
        let outputs = [output("out", &[1, 1, 7], vec![1., 1., 1., 1., f32::NAN, 1., 1.])];
        assert!(DetectionFormat::Yolov5.decode(&outputs, (8, 8), 0.1).is_empty());
        let outputs = [output("out", &[1, 1, 7], vec![1., 1., f32::INFINITY, 1., 1., 1., 1.])];
        assert_eq!(DetectionFormat::Yolov5.decode(&outputs, (8, 8), 0.1).len(), 1);
    }
}
