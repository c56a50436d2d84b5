// SPDX-License-Identifier: MIT OR Apache-2.0
//! The formats of box files. The content of a file decides its format, not its name.

pub(crate) mod coco;
pub(crate) mod csv_table;
pub(crate) mod field;
pub(crate) mod mot;
pub(crate) mod yolo;

use std::io::Read;
use std::path::Path;

use crate::boxes::BoxError;
use crate::boxes::limits;

/// A format of boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxFormat {
    /// `gt.txt` of MOT16, MOT17 and MOT20.
    Mot,
    /// A JSON document of images and annotations.
    Coco,
    /// A folder with a text file for every image.
    Yolo,
    /// A CSV table with the columns file, x0, y0, x1, y1.
    Csv,
}

impl BoxFormat {
    /// Returns the name of the format in messages and notes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mot => "MOT",
            Self::Coco => "COCO",
            Self::Yolo => "YOLO",
            Self::Csv => "CSV",
        }
    }

    /// Detects the format of a file or folder: JSON begins with a brace, MOT with a number, CSV
    /// with the names of its columns.
    pub(crate) fn detect(path: &Path) -> Result<Self, BoxError> {
        if path.is_dir() {
            return Ok(Self::Yolo);
        }
        let wrong = |problem: &str| {
            let problem = format!(
                "{problem}; expected rows of MOT, JSON of COCO, CSV with the columns {}, or a folder of YOLO \
                 files",
                csv_table::COLUMNS.join(", ")
            );
            BoxError::File { path: path.to_owned(), problem }
        };
        for byte in limits::open(path)?.bytes() {
            let byte = byte.map_err(|source| BoxError::Io { path: path.to_owned(), source })?;
            return match byte {
                // Blank lines and the byte order mark of UTF-8 are skipped.
                b' ' | b'\t' | b'\r' | b'\n' | 0xEF | 0xBB | 0xBF => continue,
                b'{' => Ok(Self::Coco),
                b'[' => Err(wrong("it is a list of results, not ground truth")),
                b'0'..=b'9' | b'-' | b'+' | b'.' => Ok(Self::Mot),
                b'"' | b'A'..=b'Z' | b'a'..=b'z' | b'_' => Ok(Self::Csv),
                _ => Err(wrong("it is in no known format")),
            };
        }
        Err(wrong("it is empty"))
    }
}
