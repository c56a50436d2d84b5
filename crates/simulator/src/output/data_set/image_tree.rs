// SPDX-License-Identifier: MIT OR Apache-2.0
//! A data set of PNG files below `images`, in one folder per label, and `images.csv`, which names
//! the file for every row of the arrays.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Component, Path, PathBuf};

use foveate_camera::Camera;

use super::super::cannot_write;
use super::super::csv::CsvFile;
use super::super::png_writers::PngWriters;
use super::super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use crate::output::raw_image::RawImage;

pub(super) const FOLDER: &str = "images";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileNaming {
    /// The files have the names of the input files.
    OfInputFile,
    /// The files have the number of the image as name.
    Numbers,
}

/// The folder tree and its table while they are written.
pub(super) struct ImageTreeSink {
    folder: PathBuf,
    naming: FileNaming,
    table: CsvFile,
    writers: PngWriters,
}

impl ImageTreeSink {
    pub(super) fn create(folder: &Path, names: FileNaming) -> Result<Self, SimulatorError> {
        let images = folder.join(FOLDER);
        fs::create_dir(&images).map_err(cannot_write(&images))?;
        let table = CsvFile::create(&folder.join("images.csv"), "image,file,label")?;
        Ok(Self { folder: folder.to_owned(), naming: names, table, writers: PngWriters::new()? })
    }

    /// Creates a new file for an image. Returns its path below the folder of the run.
    fn create_image_file(&self, sink_frame: &SinkFrame<'_>) -> Result<PathBuf, SimulatorError> {
        let mut relative = PathBuf::from(FOLDER);
        if let Some(label) = &sink_frame.source.label {
            relative.push(folder_name_of_label(label));
        }
        let folder = self.folder.join(&relative);
        fs::create_dir_all(&folder).map_err(cannot_write(&folder))?;
        let number = format!("{:06}", sink_frame.number);
        let stem = match self.naming {
            FileNaming::OfInputFile => {
                Path::new(&sink_frame.source.name).file_stem().and_then(OsStr::to_str)
            }
            FileNaming::Numbers => None,
        };
        let preferred = relative.join(format!("{}.png", stem.unwrap_or(&number)));
        match (create_new_file(&self.folder.join(&preferred)), stem) {
            // The name is used already: the inputs are `a.png` and `a.jpg`, or files of one name
            // from several folders.
            (Err(error), Some(stem)) if error.kind() == ErrorKind::AlreadyExists => {
                let alternative = relative.join(format!("{stem}-{number}.png"));
                let path = self.folder.join(&alternative);
                create_new_file(&path).map_err(cannot_write(&path))?;
                Ok(alternative)
            }
            (file, _) => {
                file.map_err(cannot_write(&self.folder.join(&preferred)))?;
                Ok(preferred)
            }
        }
    }
}

impl FrameSink for ImageTreeSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let relative = self.create_image_file(sink_frame)?;
        let picture = RawImage::of_screen(sink_frame, self.writers.take_spare_buffer());
        self.writers.push(self.folder.join(&relative), picture);
        let label = sink_frame.source.label.as_deref().unwrap_or_default();
        self.table.quoted_line([
            &sink_frame.number.to_string(),
            &relative.display().to_string(),
            label,
        ]);
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.writers.check_written()?;
        self.table.write_pending()
    }

    fn max_bytes_owed(&self, camera: &Camera) -> u64 {
        PngWriters::max_bytes_in_work(camera.width(), camera.height(), 2)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        self.table.write_all()?;
        self.writers.finish()
    }
}

fn create_new_file(path: &Path) -> io::Result<File> {
    File::create_new(path)
}

/// Returns a label if it is the name of a single folder, otherwise `other`.
fn folder_name_of_label(label: &str) -> &str {
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
    fn a_label_that_is_no_folder_name_becomes_other() {
        assert_eq!(["7", "a b", "..", "/", "a/b", ""].map(folder_name_of_label), {
            ["7", "a b", "other", "other", "other", "other"]
        });
    }
}
