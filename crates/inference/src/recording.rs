// SPDX-License-Identifier: MIT OR Apache-2.0
//! The network's outputs as files that grow frame by frame: an array of each output, and PNG files
//! of outputs that are frames.

use crate::InferenceError;
use foveate_network::{Executor, Network, TensorForm};
use foveate_output::npy::{ElementType, NpyWriter};
use foveate_tools::{StagedFolder, StagingError};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use serde::Serialize;

pub(crate) const OUTPUTS_FOLDER: &str = "outputs";
/// The largest number of letters of a file's name.
const MAX_NAME_LETTERS: usize = 100;

/// The files of the outputs that are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RecordOptions {
    /// True if NumPy arrays of shape `[frames, ...shape]` are written.
    pub arrays: bool,
    /// True if PNG files are written of the outputs with one or three channels and the size of the
    /// input.
    pub pictures: bool,
}

/// An output of the network and its files.
#[derive(Clone, Debug, Serialize)]
pub struct RecordedOutput {
    /// The name of the output in the model.
    pub name: String,
    /// The shape of the output for one frame.
    pub shape: Vec<usize>,
    /// The type of a value, with NumPy's name.
    pub dtype: &'static str,
    /// The path of the array, if it is written.
    pub array: Option<String>,
    /// The folder of the PNG files, if they are written.
    pub pictures: Option<String>,
}

/// The open files of all outputs.
pub(crate) struct OutputRecorder<'a> {
    staging: &'a StagedFolder,
    outputs: Vec<OutputFiles>,
    frames: u64,
}

/// The open files of one output.
struct OutputFiles {
    value: usize,
    recorded: RecordedOutput,
    array: Option<NpyWriter>,
}

impl<'a> OutputRecorder<'a> {
    /// Creates the files of all outputs.
    ///
    /// # Errors
    /// Fails if a file cannot be written, or if pictures are wanted and no output can be shown as
    /// one.
    pub(crate) fn new(
        staging: &'a StagedFolder,
        network: &Network,
        record: RecordOptions,
    ) -> Result<Self, InferenceError> {
        let mut outputs: Vec<OutputFiles> = Vec::new();
        if !record.arrays && !record.pictures {
            return Ok(Self { staging, outputs, frames: 0 });
        }
        let values = || network.outputs().iter().zip(network.output_names());
        let is_picture = |value: usize| is_picture(network.form(value), network.input());
        if record.pictures && !values().any(|(&value, _)| is_picture(value)) {
            let shapes = values().map(|(&value, name)| {
                format!("`{name}` is {}", shape_text(network.form(value).shape()))
            });
            return Err(InferenceError::NoPictureOutput {
                outputs: shapes.collect::<Vec<_>>().join(", "),
            });
        }
        let folder = staging.folder().join(OUTPUTS_FOLDER);
        std::fs::create_dir(&folder)
            .map_err(|source| StagingError::Unwritable { path: folder.clone(), source })?;
        for (&value, name) in values() {
            let taken = outputs.iter().flat_map(|output| output.recorded.files());
            let file = free_name(name, &taken.collect::<Vec<_>>());
            let shape = network.form(value).shape().to_vec();
            let path = folder.join(format!("{file}.npy"));
            let array =
                record.arrays.then(|| NpyWriter::create(&path, ElementType::Float32, &shape));
            let told = RecordedOutput {
                name: name.clone(),
                shape,
                dtype: "float32",
                array: record.arrays.then(|| format!("{OUTPUTS_FOLDER}/{file}.npy")),
                pictures: (record.pictures && is_picture(value))
                    .then(|| format!("{OUTPUTS_FOLDER}/{file}")),
            };
            outputs.push(OutputFiles { value, recorded: told, array: array.transpose()? });
        }
        Ok(Self { staging, outputs, frames: 0 })
    }

    /// Writes the outputs of a frame.
    ///
    /// # Errors
    /// Fails if they cannot be written.
    pub(crate) fn push(&mut self, executor: &Executor<'_>) -> Result<(), InferenceError> {
        for output in &mut self.outputs {
            let tensor = executor.tensor(output.value);
            let values = tensor.real_values();
            if let Some(array) = &mut output.array {
                array.push(values.iter().map(|value| value.to_bits().into()));
                array.write_pending()?;
            }
            if let Some(pictures) = &output.recorded.pictures {
                let name = format!("{pictures}/{:06}.png", self.frames);
                self.staging.write(&name, &png(tensor.form(), &values))?;
            }
        }
        self.frames += 1;
        Ok(())
    }

    /// Completes the files. Returns the outputs with their files.
    ///
    /// # Errors
    /// Fails if they cannot be written.
    pub(crate) fn finish(self) -> Result<Vec<RecordedOutput>, InferenceError> {
        let finished = self.outputs.into_iter().map(|output| {
            output.array.map_or(Ok(()), NpyWriter::finish)?;
            Ok(output.recorded)
        });
        finished.collect()
    }
}

/// Returns whether an output can be shown as a frame: it has one or three channels and the size of
/// the input.
fn is_picture(form: &TensorForm, input: &TensorForm) -> bool {
    let (shape, input) = (form.shape(), input.shape());
    shape.len() == 4 && shape[0] == 1 && [1, 3].contains(&shape[1]) && shape[2..] == input[2..]
}

/// Encodes an output as a PNG, with 0 as black and 1 as white. Values beyond are clamped, and NaN
/// is black.
fn png(form: &TensorForm, values: &[f32]) -> Vec<u8> {
    let (channels, places) = (form.shape()[1], form.position_count());
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    let shown = |value: f32| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let bytes: Vec<u8> = (0..places)
        .flat_map(|place| (0..channels).map(move |channel| channel * places + place))
        .map(|at| shown(values[at]))
        .collect();
    let colour = if channels == 3 { ExtendedColorType::Rgb8 } else { ExtendedColorType::L8 };
    let side = |length: usize| u32::try_from(length).expect("a side of a frame");
    let mut file = Vec::new();
    PngEncoder::new(&mut file)
        .write_image(&bytes, side(form.width()), side(form.height()), colour)
        .expect("there are as many bytes as the picture has, and memory takes them");
    file
}

impl RecordedOutput {
    /// Returns the file and the folder of the output.
    fn files(&self) -> impl Iterator<Item = String> {
        [self.array.clone(), self.pictures.clone()].into_iter().flatten()
    }
}

/// Returns a safe file name for a tensor of any name. Neither the array nor the folder of that name
/// is in `taken`, even if upper and lower case are not distinguished.
pub(crate) fn free_name(name: &str, taken: &[String]) -> String {
    let safe = |letter: char| {
        if letter.is_ascii_alphanumeric() || letter == '-' { letter } else { '_' }
    };
    let stem: String = name.chars().map(safe).take(MAX_NAME_LETTERS).collect();
    let stem = if stem.is_empty() { "output".to_owned() } else { stem };
    let is_taken = |file: &str| {
        let all = [format!("{OUTPUTS_FOLDER}/{file}"), format!("{OUTPUTS_FOLDER}/{file}.npy")];
        taken.iter().any(|taken| all.iter().any(|file| file.eq_ignore_ascii_case(taken)))
    };
    let numbered = (2..).map(|number| format!("{stem}_{number}"));
    let mut names = std::iter::once(stem.clone()).chain(numbered);
    names.find(|file| !is_taken(file)).expect("some number is free")
}

fn shape_text(shape: &[usize]) -> String {
    shape.iter().map(ToString::to_string).collect::<Vec<_>>().join("x")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_and_no_two_are_alike() {
        let mut files = Vec::new();
        let long = "x".repeat(300);
        for name in ["output", "Output", "../a/b:0", "__/a.b:0", "", "\"<é>\"", &long, "output_2"]
        {
            let file = free_name(name, &files);
            files.push(format!("{OUTPUTS_FOLDER}/{file}.npy"));
        }
        let long = format!("outputs/{}.npy", "x".repeat(100));
        let expected = [
            "outputs/output.npy",
            "outputs/Output_2.npy",
            "outputs/___a_b_0.npy",
            "outputs/___a_b_0_2.npy",
            "outputs/output_3.npy",
            "outputs/_____.npy",
            &long,
            "outputs/output_2_2.npy",
        ];
        assert_eq!(files, expected);
    }

    #[test]
    fn pictures_are_what_has_the_size_of_the_input() {
        let form = |shape: &[usize]| TensorForm::features(shape.to_vec());
        let input = form(&[1, 1, 4, 6]);
        for (shape, expected) in [
            (&[1, 1, 4, 6][..], true),
            (&[1, 3, 4, 6], true),
            (&[1, 2, 4, 6], false),
            (&[1, 1, 6, 4], false),
            (&[1, 24], false),
        ] {
            assert_eq!(is_picture(&form(shape), &input), expected, "{shape:?}");
        }
    }

    #[test]
    fn channels_lie_side_by_side_and_what_is_beyond_is_cut() {
        let values = [0.0, 1.0, -3.0, 9.0, f32::NAN, 0.5];
        let file = png(&TensorForm::features(vec![1, 3, 1, 2]), &values);
        let picture = image::load_from_memory(&file).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (2, 1));
        // These are red, green and blue of both pixels: 0, -3 and NaN; 1, 9 and 0.5.
        assert_eq!(picture.into_raw(), [0, 0, 0, 255, 255, 128]);
    }
}
