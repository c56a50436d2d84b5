// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decides whether inputs are one clip or many, and where the output of each goes.
//!
//! * Image files and patterns together are one clip, a single file or special input is one, and so is
//!   a folder of images.
//! * Several videos, data sets or folders are a clip each.
//! * A folder without images is a tree: every video below it and every folder of images below it is
//!   a clip, at the same place in the output; the first folder on the way to it is its label.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::extension::{VIDEO_EXTENSIONS, extension_in, is_image_name};
use crate::input::{entries, is_special};
use crate::{FootageError, ImagesAs, InputOptions, picture};

/// The depth to which folders are searched, so that a link to a parent folder does not lead to an endless search.
const DEPTH: u32 = 8;

/// A clip of a batch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clip {
    /// The inputs to open.
    pub inputs: Vec<PathBuf>,
    /// The folder of its output, below the output of the batch.
    pub place: PathBuf,
    /// Its class, in a labelled tree.
    pub label: Option<String>,
}

/// How inputs are to be simulated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClipPlan {
    /// As one clip or set.
    One,
    /// As several clips.
    Batch(Vec<Clip>),
}

/// Decides between one clip and a batch.
///
/// # Errors
/// When a folder cannot be read, or an input cannot be one of several clips.
pub fn plan<P: AsRef<Path>>(
    inputs: &[P],
    options: &InputOptions,
) -> Result<ClipPlan, FootageError> {
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    let tree = |path: &Path| -> Result<bool, FootageError> {
        let whole = options.images == ImagesAs::Set || !path.is_dir();
        Ok(!whole && !entries(path)?.iter().any(|entry| is_image_name(entry) && entry.is_file()))
    };
    match inputs.as_slice() {
        [one] if !tree(one)? => return Ok(ClipPlan::One),
        several if several.iter().all(|path| belongs_to_a_clip(path)) => return Ok(ClipPlan::One),
        _ => {}
    }
    let mut clips = Vec::new();
    for path in &inputs {
        if inputs.len() > 1 && (is_special(path) || belongs_to_a_clip(path)) {
            return Err(FootageError::NotAlone { input: path.display().to_string() });
        }
        let place = if inputs.len() > 1 { name_of(path) } else { PathBuf::new() };
        if tree(path)? {
            walk(path, &place, None, 0, &mut clips)?;
        } else {
            clips.push(Clip { inputs: vec![path.to_path_buf()], place, label: None });
        }
    }
    if clips.is_empty() {
        let path = inputs.first().expect("without inputs there is one clip").to_path_buf();
        return Err(FootageError::EmptyFolder { path });
    }
    set_apart(&mut clips);
    Ok(ClipPlan::Batch(clips))
}

/// An image file, a pattern, or something that is not there, which opening will say.
fn belongs_to_a_clip(path: &Path) -> bool {
    !is_special(path)
        && !path.is_dir()
        && (!path.exists() || is_image_name(path) || picture::is_image(path))
}

fn walk(
    folder: &Path,
    place: &Path,
    label: Option<&str>,
    depth: u32,
    clips: &mut Vec<Clip>,
) -> Result<(), FootageError> {
    let entries = entries(folder)?;
    let clip = |path: &Path, place: PathBuf| Clip {
        inputs: vec![path.to_owned()],
        place,
        label: label.map(str::to_owned),
    };
    if depth > 0 && entries.iter().any(|entry| is_image_name(entry) && entry.is_file()) {
        clips.push(clip(folder, place.to_owned()));
        return Ok(());
    }
    for entry in &entries {
        let place = place.join(name_of(entry));
        if entry.is_dir() && depth < DEPTH {
            // A folder of images names a clip; only what is above clips names a class.
            let own = entry.file_name().map(|name| name.to_string_lossy().into_owned());
            let frames = self::entries(entry)?.iter().any(|e| is_image_name(e) && e.is_file());
            let below = if label.is_none() && !frames { own.as_deref() } else { label };
            walk(entry, &place, below, depth + 1, clips)?;
        } else if entry.is_file() && extension_in(entry, &VIDEO_EXTENSIONS) {
            clips.push(clip(entry, place));
        }
    }
    Ok(())
}

/// The name of a clip: that of its file without the extension, or of its folder.
fn name_of(path: &Path) -> PathBuf {
    let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
    // `..` and `/` have none.
    name.map_or_else(|| PathBuf::from("clip"), PathBuf::from)
}

/// Numbers clips whose place is taken, by another or as the folder of others.
fn set_apart(clips: &mut [Clip]) {
    let above =
        |clip: &Clip| clip.place.ancestors().skip(1).map(Path::to_owned).collect::<Vec<_>>();
    let mut taken: HashSet<PathBuf> = clips.iter().flat_map(above).collect();
    for clip in clips {
        let first = clip.place.clone();
        let mut number = 2;
        while !taken.insert(clip.place.clone()) {
            let mut name = first.clone().into_os_string();
            name.push(format!("-{number}"));
            clip.place = name.into();
            number += 1;
        }
    }
}
