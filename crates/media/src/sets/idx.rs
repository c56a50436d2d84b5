// SPDX-License-Identifier: MIT OR Apache-2.0
//! IDX files of 8-bit images (MNIST), plain or gzipped, with the labels from a second file.

use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

use super::{compressed_data_error, damaged, expect_end, is_packed, open_unpacked};
use crate::samples::SampleLayout;
use crate::source::feed::FrameFeed;
use crate::source::set_form::{IdxFile, SetFiles, SetForm, SetLabels};
use crate::{FootageError, MAX_SIDE, SourceFrame, SourceKind};

/// The first bytes of a file of images: unsigned bytes in three dimensions.
pub(crate) const MAGIC: [u8; 4] = [0, 0, 8, 3];
pub(crate) const LABEL_MAGIC: [u8; 4] = [0, 0, 8, 1];
/// The largest number of labels of a file. Labels are kept in memory, one byte each. Images are
/// read one by one, so their number is not limited.
const MAX_LABELS: u32 = 1 << 28;

/// The images of a file.
pub(crate) struct IdxImages {
    path: PathBuf,
    input: Box<dyn BufRead + Send>,
    labels: Option<Vec<u8>>,
    total: u32,
    next: u32,
    size: (u32, u32),
    bits: u32,
    form: SetForm,
}

impl IdxImages {
    /// Opens a file of images. `labels` is the file of labels; without it, the usual file of labels
    /// in the same folder is used, if it exists.
    pub(crate) fn open(
        path: &Path,
        labels: Option<&Path>,
        bits: u32,
    ) -> Result<Self, FootageError> {
        let mut input = open_unpacked(path)?;
        let magic: [u8; 4] = read(&mut *input, path)?;
        if magic != MAGIC {
            return Err(damaged(path, "it is not an IDX file of 8-bit images (00 00 08 03)"));
        }
        let [total, height, width] = [(); 3].map(|()| number(&mut *input, path));
        let (total, height, width) = (total?, height?, width?);
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            let problem =
                format!("its images have {width}x{height} pixels; sides are 1..={MAX_SIDE}");
            return Err(damaged(path, problem));
        }
        let labels = labels.map(Path::to_owned).or_else(|| find_labels(path));
        let form = form_of(path, labels.as_deref())?;
        let labels = labels.map(|file| labels_of(&file, total)).transpose()?;
        Ok(Self {
            path: path.to_owned(),
            input,
            labels,
            total,
            next: 0,
            size: (width, height),
            bits,
            form,
        })
    }
}

impl FrameFeed for IdxImages {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.next == self.total {
            expect_end(&mut *self.input, &self.path, "the last image")?;
            return Ok(None);
        }
        let (width, height) = self.size;
        let mut bytes = Vec::new();
        let size = u64::from(width) * u64::from(height);
        // Memory grows with the bytes that exist, not with the size in the header.
        (&mut *self.input)
            .take(size)
            .read_to_end(&mut bytes)
            .map_err(compressed_data_error(&self.path))?;
        let layout = SampleLayout::luma(width, height, 8);
        let frame = layout
            .byte_frame(bytes, self.bits)
            .map_err(|_| damaged(&self.path, "it ends before its last image"))?;
        let index = self.next;
        self.next += 1;
        let label = self.labels.as_ref().and_then(|labels| labels.get(index as usize));
        Ok(Some(SourceFrame {
            name: format!("{}[{index}]", self.path.display()),
            time_us: 0,
            label: label.map(u8::to_string),
            frame,
        }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.total.into())
    }

    fn kind(&self) -> SourceKind {
        SourceKind::Set
    }

    fn form(&self) -> SetForm {
        self.form.clone()
    }
}

fn form_of(images: &Path, labels: Option<&Path>) -> Result<SetForm, FootageError> {
    let file = |path: &Path| -> Result<IdxFile, FootageError> {
        let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
        Ok(IdxFile { name, packed: is_packed(path)? })
    };
    let files = SetFiles::Idx { images: file(images)?, labels: labels.map(file).transpose()? };
    let labels = if labels.is_some() { SetLabels::Numbers } else { SetLabels::None };
    Ok(SetForm { files, labels })
}

/// Returns true if a file starts as an IDX file of another kind: two zeros, a type of number, and
/// the number of dimensions.
pub(crate) fn is_other_idx(start: &[u8]) -> bool {
    let known = matches!(start, [0, 0, 0x08 | 0x09 | 0x0B..=0x0E, 1..=4, ..]);
    known && !start.starts_with(&MAGIC)
}

/// Returns true for a file of images that has no file of labels in its folder.
pub(crate) fn lacks_labels(path: &Path) -> bool {
    let start = || read(&mut *open_unpacked(path)?, path);
    path.is_file()
        && find_labels(path).is_none()
        && start().is_ok_and(|start: [u8; 4]| start == MAGIC)
}

/// Returns the usual name of the file of labels, if the file of images has its usual name.
pub(crate) fn labels_name(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let stem = name.strip_suffix(".gz").unwrap_or(name);
    let labels = stem.replace("images", "labels").replace("idx3", "idx1");
    (labels != stem).then_some(labels)
}

/// Finds the labels of `train-images-idx3-ubyte.gz` in `train-labels-idx1-ubyte`, gzipped or not.
fn find_labels(path: &Path) -> Option<PathBuf> {
    let labels = labels_name(path)?;
    let names = [labels.clone(), labels + ".gz"];
    names.iter().map(|name| path.with_file_name(name)).find(|file| file.is_file())
}

fn labels_of(path: &Path, images: u32) -> Result<Vec<u8>, FootageError> {
    let mut input = open_unpacked(path)?;
    let magic: [u8; 4] = read(&mut *input, path)?;
    if magic != LABEL_MAGIC {
        return Err(damaged(path, "it is not an IDX file of labels (00 00 08 01)"));
    }
    let total = number(&mut *input, path)?;
    if total != images {
        return Err(damaged(path, format!("it holds {total} labels for {images} images")));
    }
    if total > MAX_LABELS {
        return Err(damaged(
            path,
            format!("it holds {total} labels, but at most {MAX_LABELS} are read; split it"),
        ));
    }
    let mut labels = Vec::new();
    (&mut *input)
        .take(total.into())
        .read_to_end(&mut labels)
        .map_err(compressed_data_error(path))?;
    if labels.len() < total as usize {
        return Err(damaged(path, "it ends before its last label"));
    }
    expect_end(&mut *input, path, "the last label")?;
    Ok(labels)
}

fn number(input: &mut dyn BufRead, path: &Path) -> Result<u32, FootageError> {
    read(input, path).map(u32::from_be_bytes)
}

fn read<const SIZE: usize>(
    input: &mut dyn BufRead,
    path: &Path,
) -> Result<[u8; SIZE], FootageError> {
    let mut bytes = [0; SIZE];
    input.read_exact(&mut bytes).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged(path, "it ends inside its header"),
        _ => compressed_data_error(path)(error),
    })?;
    Ok(bytes)
}
