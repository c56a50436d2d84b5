// SPDX-License-Identifier: MIT OR Apache-2.0
//! The data set of a run over a set: every image as a receiver would see it, in the form of the set
//! that it came from, with labels.

mod idx;
mod tree;

use std::path::Path;

use serde::Serialize;

use super::sink::{Sink, Step};
use crate::SimulatorError;
use foveate_files::npy::{Element, NpyWriter};
use foveate_footage::{Labels, SetFiles, SetForm};

/// The paths of a data set, relative to the folder of its run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DataSet {
    /// The IDX file, or the folder of images.
    pub images: String,
    /// The IDX file of labels, if the set has one.
    pub labels: Option<String>,
    /// The names of the classes in the order of their numbers in `labels.npy`. It is empty if
    /// labels are numbers.
    pub classes: Vec<String>,
}

impl DataSet {
    pub(super) fn of(form: &SetForm) -> Self {
        let (images, labels) = match &form.files {
            SetFiles::Idx { images, labels } => {
                (images.name.clone(), labels.as_ref().map(|file| file.name.clone()))
            }
            SetFiles::Images | SetFiles::Records => (tree::FOLDER.to_owned(), None),
        };
        let classes = match &form.labels {
            Labels::Names(names) => names.clone(),
            Labels::None | Labels::Numbers => Vec::new(),
        };
        Self { images, labels, classes }
    }
}

/// Returns the sinks that write the data set.
pub(super) fn sinks(folder: &Path, form: &SetForm) -> Result<Vec<Box<dyn Sink>>, SimulatorError> {
    let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
    if form.labels != Labels::None {
        let file = NpyWriter::create(&folder.join("labels.npy"), Element::Signed64, &[])?;
        sinks.push(Box::new(Numbers { labels: form.labels.clone(), file }));
    }
    match &form.files {
        SetFiles::Idx { images, labels } => {
            sinks.append(&mut idx::sinks(folder, images, labels.as_ref())?);
        }
        SetFiles::Images => sinks.push(Box::new(tree::Tree::create(folder, tree::Names::Own)?)),
        SetFiles::Records => {
            sinks.push(Box::new(tree::Tree::create(folder, tree::Names::Numbers)?));
        }
    }
    Ok(sinks)
}

/// The file `labels.npy` while it is written.
struct Numbers {
    labels: Labels,
    file: NpyWriter,
}

impl Sink for Numbers {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let number = self.labels.number(step.source.label.as_deref());
        self.file.push(std::iter::once(number.cast_unsigned()));
        Ok(())
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        Ok(self.file.write_out(all)?)
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        Ok(self.file.finish()?)
    }
}
