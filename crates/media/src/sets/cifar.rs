// SPDX-License-Identifier: MIT OR Apache-2.0
//! CIFAR images of 32x32 pixels in colour. Binary batches have the published format (CIFAR-10: a
//! label and three planes per image; CIFAR-100: two labels, of which the second, finer one is
//! kept). Sheets are pictures of 1024 columns in which each row is one image in row-major order.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use foveate_pixels::{ByteFrame, Frame, convert_depth, luma};

use super::{damaged, unreadable};
use crate::source::feed::FrameFeed;
use crate::source::set_form::{SetFiles, SetForm, SetLabels};
use crate::{FootageError, SourceFrame, SourceKind, picture};

const SIDE: u32 = 32;
const AREA: usize = 1024;
/// The number of columns of a sheet.
pub(crate) const WIDTH: u32 = 1024;

/// Returns the number of labels before every image of a batch of this length in bytes, or `None` if
/// the length is not that of a batch.
pub(crate) fn labels_in_batch(length: u64) -> Option<usize> {
    (1..=2).find(|&labels| {
        let record = (labels + 3 * AREA) as u64;
        length > 0 && length.is_multiple_of(record)
    })
}

/// The images of a binary batch.
pub(crate) struct CifarBatch {
    path: PathBuf,
    file: BufReader<File>,
    record: Vec<u8>,
    total: u64,
    next: u64,
    bits: u32,
}

impl CifarBatch {
    pub(crate) fn open(path: &Path, bits: u32) -> Result<Self, FootageError> {
        let file = File::open(path).map_err(unreadable(path))?;
        let length = file.metadata().map_err(unreadable(path))?.len();
        let labels = labels_in_batch(length).ok_or_else(|| {
            damaged(
                path,
                "its length is not a multiple of 3073 (CIFAR-10) or 3074 (CIFAR-100) bytes",
            )
        })?;
        let record = vec![0; labels + 3 * AREA];
        let total = length / record.len() as u64;
        Ok(Self { path: path.to_owned(), file: BufReader::new(file), record, total, next: 0, bits })
    }
}

impl FrameFeed for CifarBatch {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.next == self.total {
            return Ok(None);
        }
        self.file.read_exact(&mut self.record).map_err(|error| match error.kind() {
            // The length was right when the file was opened.
            ErrorKind::UnexpectedEof => damaged(&self.path, "it ends before its last image"),
            _ => unreadable(&self.path)(error),
        })?;
        let (labels, planes) = self.record.split_at(self.record.len() - 3 * AREA);
        let classes: &[u8] = if labels.len() == 1 { &[10] } else { &[20, 100] };
        if let Some((label, classes)) =
            labels.iter().zip(classes).find(|(label, most)| label >= most)
        {
            let image = self.next;
            let problem =
                format!("the label {label} of image {image} is not one of {classes} classes");
            return Err(damaged(&self.path, problem));
        }
        let (red, rest) = planes.split_at(AREA);
        let (green, blue) = rest.split_at(AREA);
        let mix = |((&r, &g), &b): ((&u8, &u8), &u8)| {
            convert_depth(luma(r.into(), g.into(), b.into()), 8, self.bits)
        };
        let pixels = red.iter().zip(green).zip(blue).map(mix).collect();
        let name = format!("{}[{}]", self.path.display(), self.next);
        self.next += 1;
        let frame = ByteFrame::from_words(SIDE, SIDE, self.bits, pixels)?;
        Ok(Some(SourceFrame { name, time_us: 0, label: labels.last().map(u8::to_string), frame }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.total)
    }

    fn kind(&self) -> SourceKind {
        SourceKind::Set
    }

    fn form(&self) -> SetForm {
        SetForm { files: SetFiles::Records, labels: SetLabels::Numbers }
    }
}

/// The images of a sheet.
pub(crate) struct CifarSheet {
    path: PathBuf,
    sheet: Frame,
    next: u32,
}

impl CifarSheet {
    pub(crate) fn open(path: &Path, bits: u32) -> Result<Self, FootageError> {
        let sheet = picture::read(path, bits)?;
        if sheet.width() as usize != AREA {
            let width = sheet.width();
            let problem =
                format!("a CIFAR sheet is 1024 pixels wide, one image per row, not {width}");
            return Err(damaged(path, problem));
        }
        Ok(Self { path: path.to_owned(), sheet, next: 0 })
    }
}

impl FrameFeed for CifarSheet {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.next == self.sheet.height() {
            return Ok(None);
        }
        let pixels = self.sheet.row(self.next).to_vec();
        let name = format!("{}[{}]", self.path.display(), self.next);
        self.next += 1;
        let frame = ByteFrame::from_words(SIDE, SIDE, self.sheet.bits(), pixels)?;
        Ok(Some(SourceFrame { name, time_us: 0, label: None, frame }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.sheet.height().into())
    }

    fn kind(&self) -> SourceKind {
        SourceKind::Set
    }

    fn form(&self) -> SetForm {
        SetForm { files: SetFiles::Records, labels: SetLabels::None }
    }
}
