// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of the denoiser that is shipped, and readers of their tables.

use std::collections::BTreeMap;
use std::fs::File;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use foveate_design::DesignConfig;
use foveate_inference::{
    Computation, Detector, Framing, Inference, InferenceError, InferenceOptions, InferenceSummary,
    PixelMapping, RecordOptions, VisionOptions, read_accelerator,
};
use foveate_media::{InputOptions, RunHooks, SilentHooks};
use foveate_network::ExecutionMode;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");

/// A run with `frames` frames of every scene.
pub(crate) struct RunSetup<'a> {
    pub(crate) inputs: &'a [&'a str],
    pub(crate) frames: u32,
    pub(crate) computed: Computation,
    pub(crate) accelerator: Option<&'a str>,
    pub(crate) reference: bool,
    pub(crate) framing: Framing,
    pub(crate) sight: bool,
    /// The standard deviations of noise on whole frames.
    pub(crate) noise: &'a [f64],
    pub(crate) detector: Option<Detector>,
    /// The files of ground-truth boxes.
    pub(crate) boxes: &'a [PathBuf],
    /// The network, if it is not the denoiser.
    pub(crate) network: Option<&'a Path>,
    /// Further settings of the camera's configuration.
    pub(crate) camera: &'a str,
}

impl Default for RunSetup<'_> {
    fn default() -> Self {
        Self {
            inputs: &["scene:street"],
            frames: 4,
            computed: Computation::Mode(ExecutionMode::Exact),
            accelerator: None,
            reference: false,
            framing: Framing::Same,
            sight: false,
            noise: &[],
            detector: None,
            boxes: &[],
            network: None,
            camera: "",
        }
    }
}

impl RunSetup<'_> {
    /// Writes the folder `out` in `folder`. Frames have 64x48 pixels.
    pub(crate) fn write(&self, folder: &Path) -> Result<InferenceSummary, InferenceError> {
        self.write_with_hooks(folder, &SilentHooks)
    }

    pub(crate) fn write_with_hooks(
        &self,
        folder: &Path,
        hooks: &dyn RunHooks,
    ) -> Result<InferenceSummary, InferenceError> {
        let mut config = DesignConfig::from_toml(self.camera).unwrap();
        (config.camera.frame.width, config.camera.frame.height) = (Some(64), Some(48));
        let input = InputOptions { frames: Some(self.frames), ..InputOptions::default() };
        let inputs: Vec<PathBuf> = self.inputs.iter().map(PathBuf::from).collect();
        let options = InferenceOptions {
            computation: self.computed,
            accelerator: self.accelerator.map(|name| read_accelerator(name).unwrap()),
            with_whole_computation: self.reference,
            with_whole_frames: self.sight,
            noise: self.noise.to_vec(),
            frame_interval: NonZeroU32::MIN,
            record: RecordOptions { arrays: true, pictures: false },
            command: Vec::new(),
            overwrite: true,
        };
        let vision_options = VisionOptions {
            framing: self.framing,
            mapping: PixelMapping { mean: vec![0.0], scale: vec![1.0] },
            detector: self.detector.clone(),
        };
        Inference::new(
            &config,
            self.network.unwrap_or(Path::new(DENOISER)),
            vision_options,
            (&inputs, self.boxes),
            &input,
        )?
        .run(&folder.join("out"), &options, hooks)
    }
}

/// A row by the names of its columns.
pub(crate) type TableRow = BTreeMap<String, Field>;

/// Reads the rows of a table of `out`.
pub(crate) fn rows(folder: &Path, table: &str) -> Vec<TableRow> {
    let file = File::open(folder.join("out").join(table)).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let row = |row: parquet::record::Row| {
        row.get_column_iter().map(|(name, field)| (name.clone(), field.clone())).collect()
    };
    reader.get_row_iter(None).unwrap().map(|found| row(found.unwrap())).collect()
}

#[allow(clippy::cast_precision_loss, reason = "sums are compared")]
pub(crate) fn number(row: &TableRow, column: &str) -> f64 {
    match &row[column] {
        Field::Long(value) => *value as f64,
        Field::Double(value) => *value,
        other => panic!("{column} is {other}"),
    }
}

pub(crate) fn text<'a>(row: &'a TableRow, column: &str) -> &'a str {
    match &row[column] {
        Field::Str(value) => value,
        other => panic!("{column} is {other}"),
    }
}

/// Returns whether the frame of a row is part of the means.
pub(crate) fn is_counted(row: &TableRow) -> bool {
    row["counted"] == Field::Bool(true)
}

/// Returns whether two sums are equal except for the order of their terms.
pub(crate) fn is_near(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-9 * one.abs().max(other.abs())
}
