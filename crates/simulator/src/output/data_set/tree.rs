// SPDX-License-Identifier: MIT OR Apache-2.0
//! A data set of PNG files below `images`, in one folder per label, and `images.csv`, which names
//! the file for every row of the arrays.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use foveate_camera::Camera;

use super::super::cannot_write;
use super::super::crew::Crew;
use super::super::csv::Csv;
use super::super::picture::RawImage;
use super::super::sink::{Sink, Step};
use crate::SimulatorError;

/// The name of the folder of images.
pub(super) const FOLDER: &str = "images";

/// The naming of the new files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Names {
    /// The files have the names of the input files.
    Own,
    /// The files have the number of the image as name.
    Numbers,
}

/// The folder tree and its table while they are written.
pub(super) struct Tree {
    folder: PathBuf,
    names: Names,
    table: Csv,
    crew: Crew,
}

impl Tree {
    pub(super) fn create(folder: &Path, names: Names) -> Result<Self, SimulatorError> {
        let images = folder.join(FOLDER);
        fs::create_dir(&images).map_err(cannot_write(&images))?;
        let table = Csv::create(&folder.join("images.csv"), "image,file,label")?;
        Ok(Self { folder: folder.to_owned(), names, table, crew: Crew::new()? })
    }

    /// Creates a new file for an image. Returns its path below the folder of the run.
    fn place(&self, step: &Step<'_>) -> Result<PathBuf, SimulatorError> {
        let mut below = PathBuf::from(FOLDER);
        if let Some(label) = &step.source.label {
            below.push(single(label));
        }
        let folder = self.folder.join(&below);
        fs::create_dir_all(&folder).map_err(cannot_write(&folder))?;
        let number = format!("{:06}", step.number);
        let stem = match self.names {
            Names::Own => Path::new(&step.source.name).file_stem().and_then(OsStr::to_str),
            Names::Numbers => None,
        };
        let first = below.join(format!("{}.png", stem.unwrap_or(&number)));
        match (create(&self.folder.join(&first)), stem) {
            // The name is used already: the inputs are `a.png` and `a.jpg`, or files of one name
            // from several folders.
            (Err(error), Some(stem)) if error.kind() == ErrorKind::AlreadyExists => {
                let other = below.join(format!("{stem}-{number}.png"));
                let path = self.folder.join(&other);
                create(&path).map_err(cannot_write(&path))?;
                Ok(other)
            }
            (file, _) => {
                file.map_err(cannot_write(&self.folder.join(&first)))?;
                Ok(first)
            }
        }
    }
}

impl Sink for Tree {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let below = self.place(step)?;
        let picture = RawImage::grey(step, self.crew.spare());
        self.crew.push(self.folder.join(&below), picture);
        let label = step.source.label.as_deref().unwrap_or_default();
        self.table.quoted([&step.number.to_string(), &below.display().to_string(), label]);
        Ok(())
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.crew.write_out(all)?;
        self.table.write_out(all)
    }

    fn owed(&self, camera: &Camera) -> u64 {
        Crew::owed(camera.width(), camera.height(), 2)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        self.table.write_out(true)?;
        self.crew.finish()
    }
}

fn create(path: &Path) -> io::Result<File> {
    File::create_new(path)
}

/// Returns a label if it is the name of a single folder, otherwise `other`.
fn single(label: &str) -> &str {
    let mut parts = Path::new(label).components();
    match (parts.next(), parts.next()) {
        (Some(Component::Normal(_)), None) => label,
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_one_folder() {
        assert_eq!(["7", "a b", "..", "/", "a/b", ""].map(single), {
            ["7", "a b", "other", "other", "other", "other"]
        });
    }
}
