// SPDX-License-Identifier: MIT OR Apache-2.0
//! The assignment of box files to clips.
//!
//! One file is for all clips; several files are for one clip each, in their order. A path that does
//! not exist as given is searched in the folder of the clip, and in the folder above it. So
//! `gt/gt.txt` finds the boxes of every MOT sequence whose images are in `img1`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::boxes::{BoxError, BoxFile};

/// A clip that needs boxes.
#[derive(Clone, Copy, Debug)]
pub struct ClipToLabel<'a> {
    /// The name of the clip in messages.
    pub name: &'a str,
    /// The folder of the clip, or its first file.
    pub input: &'a Path,
}

/// Reads the boxes of every clip, in the order of the clips. A file that several clips share is
/// read once.
///
/// # Errors
/// Fails if the numbers of files and of clips differ, a file does not exist or cannot be read, or
/// clips would share a file that goes by frame numbers.
pub fn assign_boxes(
    files: &[PathBuf],
    clips: &[ClipToLabel<'_>],
) -> Result<Vec<Arc<BoxFile>>, BoxError> {
    let per_clip: Vec<&PathBuf> = match files {
        [one] => clips.iter().map(|_| one).collect(),
        several if several.len() == clips.len() => several.iter().collect(),
        _ => return Err(BoxError::FileCount { files: files.len(), clips: clips.len() }),
    };
    let mut read: HashMap<PathBuf, (Arc<BoxFile>, &str)> = HashMap::new();
    let mut found = Vec::new();
    for (clip, file) in clips.iter().zip(per_clip) {
        let path = find_box_file(file, clip)?;
        if let Some((boxes, owner)) = read.get(&path) {
            if boxes.is_for_one_clip() {
                let (one, other) = ((*owner).to_owned(), clip.name.to_owned());
                return Err(BoxError::Shared { path, one, other });
            }
            found.push(Arc::clone(boxes));
            continue;
        }
        let boxes = Arc::new(BoxFile::read(&path)?);
        found.push(Arc::clone(&boxes));
        read.insert(path, (boxes, clip.name));
    }
    Ok(found)
}

/// Finds the file as given, or in the folder of the clip or the one above it.
fn find_box_file(file: &Path, clip: &ClipToLabel<'_>) -> Result<PathBuf, BoxError> {
    let folder = if clip.input.is_dir() { Some(clip.input) } else { clip.input.parent() };
    let above = folder.and_then(Path::parent);
    let beside = [folder, above].into_iter().flatten().map(|folder| folder.join(file));
    let missing = || BoxError::Missing { path: file.to_owned(), clip: clip.name.to_owned() };
    std::iter::once(file.to_owned()).chain(beside).find(|path| path.exists()).ok_or_else(missing)
}
