// SPDX-License-Identifier: MIT OR Apache-2.0
//! The data set of a run over a set: every image as a receiver would see it, in the form of the set
//! that it came from, with labels.

mod idx_files;
mod image_tree;

use std::path::Path;

use serde::Serialize;

use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use foveate_media::{SetFiles, SetForm, SetLabels};
use foveate_output::npy::{ElementType, NpyWriter};

/// The paths of a data set, relative to the folder of its run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DataSetPaths {
    /// The IDX file, or the folder of images.
    pub images: String,
    /// The IDX file of labels, if the set has one.
    pub labels: Option<String>,
    /// The names of the classes in the order of their numbers in `labels.npy`. It is empty if
    /// labels are numbers.
    pub classes: Vec<String>,
}

impl DataSetPaths {
    pub(super) fn of(form: &SetForm) -> Self {
        let (images, labels) = match &form.files {
            SetFiles::Idx { images, labels } => {
                (images.name.clone(), labels.as_ref().map(|file| file.name.clone()))
            }
            SetFiles::Images | SetFiles::Records => (image_tree::FOLDER.to_owned(), None),
        };
        let classes = match &form.labels {
            SetLabels::Names(names) => names.clone(),
            SetLabels::None | SetLabels::Numbers => Vec::new(),
        };
        Self { images, labels, classes }
    }
}

pub(super) fn data_set_sinks(
    folder: &Path,
    form: &SetForm,
) -> Result<Vec<Box<dyn FrameSink>>, SimulatorError> {
    let mut sinks: Vec<Box<dyn FrameSink>> = Vec::new();
    if form.labels != SetLabels::None {
        let file = NpyWriter::create(&folder.join("labels.npy"), ElementType::Signed64, &[])?;
        sinks.push(Box::new(LabelNumberSink { labels: form.labels.clone(), file }));
    }
    match &form.files {
        SetFiles::Idx { images, labels } => {
            sinks.append(&mut idx_files::idx_sinks(folder, images, labels.as_ref())?);
        }
        SetFiles::Images => sinks.push(Box::new(image_tree::ImageTreeSink::create(
            folder,
            image_tree::FileNaming::OfInputFile,
        )?)),
        SetFiles::Records => {
            sinks.push(Box::new(image_tree::ImageTreeSink::create(
                folder,
                image_tree::FileNaming::Numbers,
            )?));
        }
    }
    Ok(sinks)
}

/// The file `labels.npy` while it is written.
struct LabelNumberSink {
    labels: SetLabels,
    file: NpyWriter,
}

impl FrameSink for LabelNumberSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let number = self.labels.number(sink_frame.source.label.as_deref());
        self.file.push(std::iter::once(number.cast_unsigned()));
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending()?)
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        Ok(self.file.finish()?)
    }
}
