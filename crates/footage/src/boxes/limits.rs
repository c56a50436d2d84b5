// SPDX-License-Identifier: MIT OR Apache-2.0
//! Limits of box files, so that none takes all memory.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use foveate_reading::LimitedReader;

use crate::boxes::BoxError;

/// The most boxes of a file, or of a file of a YOLO folder.
pub const MAX_BOXES: usize = 4_000_000;
/// The largest file.
const MAX_FILE: u64 = 1 << 30;

/// Opens a file that is not too large. A pipe, whose length is not known before, fails where it exceeds the limit.
pub(crate) fn open(path: &Path) -> Result<BufReader<LimitedReader<File>>, BoxError> {
    let unreadable = |source| BoxError::Io { path: path.to_owned(), source };
    let file = File::open(path).map_err(unreadable)?;
    if file.metadata().map_err(unreadable)?.len() > MAX_FILE {
        let problem = "it has more than 1 GiB, which is the limit; split it by clip".to_owned();
        return Err(BoxError::File { path: path.to_owned(), problem });
    }
    Ok(BufReader::new(LimitedReader::new(file, MAX_FILE)))
}

/// What is said of a file with too many boxes.
pub(crate) fn too_many() -> String {
    format!("more than {MAX_BOXES} boxes, which is the limit; split it by clip")
}
