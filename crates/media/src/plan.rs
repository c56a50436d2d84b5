// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decision whether inputs are one clip or many, and the place of each clip's output.
//!
//! * Image files and patterns together are one clip. A single file or special input is one clip,
//!   and so is a folder of images.
//! * Several videos, data sets or folders are one clip each.
//! * A folder without images is a tree: every video and every folder of images below it is a clip,
//!   at the same place in the output. The first folder on the way to a clip is its label.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::address::input_without_secrets;
use crate::extension::is_image_name;
use crate::input::{
    EntryKind, SkipReason, SkippedInput, collect_skipped_of_clip, entries, entry_kind,
    is_non_file_source, skipped_folder, unreadable_entry,
};
use crate::{FootageError, ImageRelation, InputOptions, picture};

/// The depth to which folders are searched.
const DEPTH: usize = 8;

/// A clip of a batch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BatchClip {
    /// The inputs to open.
    pub inputs: Vec<PathBuf>,
    /// The folder of the clip's output, relative to the output of the batch.
    pub output_folder: PathBuf,
    /// The class of the clip in a labelled tree.
    pub label: Option<String>,
}

/// The way in which inputs are to be simulated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClipPlan {
    /// The inputs are one clip or set.
    One,
    /// The inputs are several clips.
    Batch(Vec<BatchClip>),
}

/// Decides between one clip and a batch.
///
/// # Errors
/// Fails if a folder cannot be read, an image has a type that is not read, or an input cannot be
/// one of several clips.
pub fn plan<P: AsRef<Path>>(
    inputs: &[P],
    options: &InputOptions,
) -> Result<ClipPlan, FootageError> {
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    let is_tree = |path: &Path| -> Result<bool, FootageError> {
        let whole = options.images == ImageRelation::Set || !path.is_dir();
        Ok(!whole && !holds_images(&entries(path)?))
    };
    match inputs.as_slice() {
        [one] if !is_tree(one)? => return Ok(ClipPlan::One),
        several if several.iter().all(|path| belongs_to_a_clip(path)) => return Ok(ClipPlan::One),
        _ => {}
    }
    // Raw video may have any name.
    let named = |path: &&&Path| options.raw.is_none() && !is_non_file_source(path);
    let mut files = inputs.iter().filter(named);
    if let Some((path, name)) =
        files.find_map(|path| Some((path, unread_image_type_of_entry(path)?)))
    {
        return Err(FootageError::ImageType { path: path.to_path_buf(), name });
    }
    let mut clips = Vec::new();
    let mut skipped = Vec::new();
    for path in &inputs {
        if inputs.len() > 1 && (is_non_file_source(path) || belongs_to_a_clip(path)) {
            return Err(FootageError::NotAlone { input: input_without_secrets(path) });
        }
        let place = if inputs.len() > 1 { name_of(path) } else { PathBuf::new() };
        if is_tree(path)? {
            let tree = tree(path)?;
            clips.extend(
                tree.clips.into_iter().map(|clip| BatchClip {
                    output_folder: place.join(clip.output_folder),
                    ..clip
                }),
            );
            skipped.extend(tree.skipped);
        } else {
            clips.push(BatchClip {
                inputs: vec![path.to_path_buf()],
                output_folder: place,
                label: None,
            });
        }
    }
    if clips.is_empty() {
        let path = inputs.first().expect("without inputs there is one clip").to_path_buf();
        return Err(no_clip_error(path, skipped));
    }
    number_duplicates(&mut clips);
    Ok(ClipPlan::Batch(clips))
}

fn no_clip_error(folder: PathBuf, skipped: Vec<SkippedInput>) -> FootageError {
    let other = skipped.into_iter().find_map(|one| match one.reason {
        SkipReason::ImageType { name } => Some(FootageError::ImageType { path: one.path, name }),
        _ => None,
    });
    other.unwrap_or(FootageError::EmptyFolder { path: folder })
}

/// Returns the name of an image type that is not read.
fn unread_image_type_of_entry(path: &Path) -> Option<&'static str> {
    match entry_kind(path) {
        EntryKind::Skipped(Some(SkipReason::ImageType { name })) => Some(name),
        _ => None,
    }
}

fn holds_images(entries: &[PathBuf]) -> bool {
    entries.iter().any(|entry| entry_kind(entry) == EntryKind::Image)
}

/// Returns true for an image file, a pattern, and a path that does not exist. Opening reports the
/// latter.
fn belongs_to_a_clip(path: &Path) -> bool {
    !is_non_file_source(path)
        && !path.is_dir()
        && (!path.exists() || is_image_name(path) || picture::is_image(path))
}

/// The clips of a folder without images, and its entries that are not read although the user may
/// have meant them.
#[derive(Default)]
pub(crate) struct ClipTree {
    clips: Vec<BatchClip>,
    pub(crate) skipped: Vec<SkippedInput>,
}

/// A folder of a tree during the search.
struct TreeFolder<'a> {
    /// The place of the folder's clips in the output.
    place: &'a Path,
    label: Option<&'a str>,
    /// The folder and the folders above it, with links resolved.
    above: &'a [PathBuf],
}

/// Searches a folder without images for clips.
pub(crate) fn tree(folder: &Path) -> Result<ClipTree, FootageError> {
    let mut tree = ClipTree::default();
    let above = [resolved(folder)];
    let root = TreeFolder { place: Path::new(""), label: None, above: &above };
    tree.search(&root, &entries(folder)?);
    Ok(tree)
}

/// Resolves the links in a path, so that a loop of links can be found.
fn resolved(folder: &Path) -> PathBuf {
    folder.canonicalize().unwrap_or_else(|_| folder.to_owned())
}

impl ClipTree {
    fn search(&mut self, branch: &TreeFolder<'_>, listed: &[PathBuf]) {
        for entry in listed {
            match entry_kind(entry) {
                EntryKind::Video => {
                    self.clips.push(branch.clip(entry, branch.place.join(name_of(entry))));
                }
                EntryKind::Folder => self.enter(branch, entry),
                EntryKind::Skipped(reason) => {
                    self.skipped.extend(reason.map(|reason| SkippedInput::new(entry, reason)));
                }
                // Images make their folder a clip, and a tree has no images at its top.
                EntryKind::Image => {}
            }
        }
    }

    /// Searches a folder in a folder. It is a clip if it has images, otherwise a branch of the
    /// tree.
    fn enter(&mut self, branch: &TreeFolder<'_>, folder: &Path) {
        let real = resolved(folder);
        if branch.above.contains(&real) {
            self.skipped.push(SkippedInput::new(folder, SkipReason::LinkLoop));
            return;
        }
        if branch.above.len() > DEPTH {
            self.skipped.extend(skipped_folder(folder, SkipReason::TooDeep));
            return;
        }
        let listed = match entries(folder) {
            Ok(listed) => listed,
            Err(error) => {
                self.skipped.push(unreadable_entry(folder, &error));
                return;
            }
        };
        let place = branch.place.join(name_of(folder));
        if holds_images(&listed) {
            self.clips.push(branch.clip(folder, place));
            collect_skipped_of_clip(&listed, &mut self.skipped);
            return;
        }
        // The name of a folder of images is the name of a clip; a class is the name of a folder
        // above clips.
        let own = folder.file_name().map(|name| name.to_string_lossy().into_owned());
        let above = [branch.above, &[real]].concat();
        let label = branch.label.or(own.as_deref());
        self.search(&TreeFolder { place: &place, label, above: &above }, &listed);
    }
}

impl TreeFolder<'_> {
    fn clip(&self, input: &Path, place: PathBuf) -> BatchClip {
        BatchClip {
            inputs: vec![input.to_owned()],
            output_folder: place,
            label: self.label.map(str::to_owned),
        }
    }
}

/// Returns the name of a clip: that of its file without the extension, or that of its folder.
fn name_of(path: &Path) -> PathBuf {
    let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
    // `..` and `/` have no name.
    name.map_or_else(|| PathBuf::from("clip"), PathBuf::from)
}

/// Adds a number to clips whose place is already used, by another clip or as the folder of others.
fn number_duplicates(clips: &mut [BatchClip]) {
    let above = |clip: &BatchClip| {
        clip.output_folder.ancestors().skip(1).map(Path::to_owned).collect::<Vec<_>>()
    };
    let mut taken: HashSet<PathBuf> = clips.iter().flat_map(above).collect();
    // A batch writes a file of this name beside the folders of its clips.
    taken.insert(PathBuf::from("summary.json"));
    for clip in clips {
        let first = clip.output_folder.clone();
        let mut number = 2;
        while !taken.insert(clip.output_folder.clone()) {
            let mut name = first.clone().into_os_string();
            name.push(format!("-{number}"));
            clip.output_folder = name.into();
            number += 1;
        }
    }
}
