// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits of box files, which keep their memory bounded.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use foveate_tools::LimitedReader;

use crate::boxes::BoxError;

/// The largest number of boxes in a file. In a YOLO folder the limit holds for each file.
pub const MAX_BOXES: usize = 4_000_000;
/// The largest size of a file in bytes.
const MAX_FILE: u64 = 1 << 30;

/// Opens a file that is not too large. The length of a pipe is not known in advance, so reading
/// fails at the limit.
pub(crate) fn open(path: &Path) -> Result<BufReader<LimitedReader<File>>, BoxError> {
    let unreadable = |source| BoxError::Io { path: path.to_owned(), source };
    let file = foveate_tools::open_file(path).map_err(unreadable)?;
    if file.metadata().map_err(unreadable)?.len() > MAX_FILE {
        let problem = "it has more than 1 GiB, which is the limit; split it by clip".to_owned();
        return Err(BoxError::File { path: path.to_owned(), problem });
    }
    Ok(BufReader::new(LimitedReader::new(file, MAX_FILE)))
}

/// Returns the message for a file with too many boxes.
pub(crate) fn too_many_boxes() -> String {
    format!("more than {MAX_BOXES} boxes, which is the limit; split it by clip")
}
