// SPDX-License-Identifier: MIT OR Apache-2.0
//! PNG files below `images`, in a folder per label, and `images.csv`, which names the file of every
//! row of the arrays.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use super::super::cannot_write;
use super::super::csv::{Csv, quoted};
use super::super::gallery::Picture;
use super::super::png;
use super::super::sink::{Sink, Step};
use crate::SimulatorError;

/// The folder of the images.
pub(super) const FOLDER: &str = "images";

/// What the new files are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Names {
    /// As the files that they come from.
    Own,
    /// By the number of the image.
    Numbers,
}

/// The tree and its table, open.
pub(super) struct Tree {
    folder: PathBuf,
    names: Names,
    table: Csv,
}

impl Tree {
    pub(super) fn create(folder: &Path, names: Names) -> Result<Self, SimulatorError> {
        let images = folder.join(FOLDER);
        fs::create_dir(&images).map_err(cannot_write(&images))?;
        let table = Csv::create(&folder.join("images.csv"), "image,file,label")?;
        Ok(Self { folder: folder.to_owned(), names, table })
    }

    /// A new file for an image, with its path below the folder of the run.
    fn place(&self, step: &Step<'_>) -> Result<(PathBuf, File), SimulatorError> {
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
            // `a.png` and `a.jpg`, or files of one name from several folders.
            (Err(error), Some(stem)) if error.kind() == ErrorKind::AlreadyExists => {
                let other = below.join(format!("{stem}-{number}.png"));
                let path = self.folder.join(&other);
                Ok((other, create(&path).map_err(cannot_write(&path))?))
            }
            (file, _) => {
                let file = file.map_err(cannot_write(&self.folder.join(&first)))?;
                Ok((first, file))
            }
        }
    }
}

impl Sink for Tree {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let (below, file) = self.place(step)?;
        png::encode(file, &Picture::grey(step.rendered()?))
            .map_err(cannot_write(&self.folder.join(&below)))?;
        let label = step.source.label.as_deref().unwrap_or_default();
        let (file, label) = (quoted(&below.display().to_string()), quoted(label));
        self.table.line([step.number.to_string(), file, label])
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.table.finish()
    }
}

fn create(path: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).create_new(true).open(path)
}

/// A label as the name of one folder, wherever it comes from.
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
