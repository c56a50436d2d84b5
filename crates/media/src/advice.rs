// SPDX-License-Identifier: MIT OR Apache-2.0
//! Warnings about inputs that can be read, but perhaps not as the user expects: some files are
//! ignored, or a file looks like another kind of file.

use std::path::{Path, PathBuf};

use foveate_pixels::Frame;

use crate::extension::is_image_name;
use crate::input::{
    EntryKind, SkippedInput, collect_skipped_of_clip, collect_skipped_of_set, entries, entry_kind,
    expand, find_same_number, image_names_of_zip, is_non_file_source, is_pattern, sequence_of,
    skip_sentences, skipped_by_pattern, skipped_of_zip,
};
use crate::plan::tree;
use crate::sets::{cifar, idx};
use crate::source::file_feeds::ImageFile;
use crate::{ImageRelation, InputOptions, picture};

/// Returns warnings about the inputs, one sentence each. Inputs that [`open`](crate::open) refuses
/// give no warning.
#[must_use]
pub fn input_warnings<P: AsRef<Path>>(inputs: &[P], options: &InputOptions) -> Vec<String> {
    let mut said = Vec::new();
    // Raw video may have any name and any content.
    if options.raw.is_some() {
        return said;
    }
    for input in inputs.iter().map(AsRef::as_ref).filter(|input| !is_non_file_source(input)) {
        said.extend(skip_sentences(input, &skipped_of(input, options.images)));
        let files = expand(input, options.images).unwrap_or_default();
        said.extend(duplicate_number_warning(&files, options.images));
        if options.labels.is_none() {
            let others = files.iter().filter(|file| !is_image_name(&file.path));
            let bare = others.filter(|file| idx::lacks_labels(&file.path));
            said.extend(bare.map(|file| missing_labels_warning(&file.path)));
        }
        // The first file stands for the others.
        if let Some(file) = files.first() {
            said.extend(sheet_warning(&file.path, options.images));
        }
    }
    said
}

/// Returns the entries of folders and patterns among the inputs that are not read although the user
/// may have meant them.
#[must_use]
pub fn skipped_inputs<P: AsRef<Path>>(inputs: &[P], options: &InputOptions) -> Vec<SkippedInput> {
    let inputs = inputs.iter().map(AsRef::as_ref).filter(|input| !is_non_file_source(input));
    inputs.flat_map(|input| skipped_of(input, options.images)).collect()
}

/// Returns the entries of an input that are not read. An input that cannot be read at all has none.
fn skipped_of(input: &Path, images: ImageRelation) -> Vec<SkippedInput> {
    let mut found = Vec::new();
    if input.is_dir() {
        let listed = entries(input).unwrap_or_default();
        let has_images = listed.iter().any(|path| entry_kind(path) == EntryKind::Image);
        match images {
            ImageRelation::Set => collect_skipped_of_set(&listed, 0, &mut found),
            _ if has_images => collect_skipped_of_clip(&listed, &mut found),
            _ => found = tree(input).map(|tree| tree.skipped).unwrap_or_default(),
        }
    } else if input.exists() {
        found = skipped_of_zip(input, images);
    } else if let Some((_, name)) = sequence_of(input) {
        found = name.gaps();
    } else if let Some(text) = input.to_str().filter(|text| is_pattern(text)) {
        found = skipped_by_pattern(text);
    }
    found
}

/// Describes the [`skipped_inputs`] entries: one sentence for each reason, with the number of
/// entries and one example.
#[must_use]
pub fn skipped_in_words<P: AsRef<Path>>(inputs: &[P], options: &InputOptions) -> Vec<String> {
    let inputs = inputs.iter().map(AsRef::as_ref).filter(|input| !is_non_file_source(input));
    inputs.flat_map(|input| skip_sentences(input, &skipped_of(input, options.images))).collect()
}

/// Warns of two frames of a clip that have the same number.
fn duplicate_number_warning(files: &[ImageFile], images: ImageRelation) -> Option<String> {
    let archived: Vec<_> = match files {
        [archive] => image_names_of_zip(&archive.path, images),
        _ => Vec::new(),
    };
    let paths: Vec<&Path> = match archived.is_empty() {
        true => files.iter().map(|file| file.path.as_path()).collect(),
        false => archived.iter().map(|path| &**path).collect(),
    };
    let (one, other) = find_same_number(&paths).filter(|_| images == ImageRelation::Clip)?;
    Some(format!(
        "`{}` and `{}` have the same number, and both are read, one after the other; remove one if they are the \
         same frame",
        one.display(),
        other.display()
    ))
}

fn missing_labels_warning(path: &Path) -> String {
    let expected = idx::labels_name(path).map_or_else(String::new, |name| format!(" ({name})"));
    format!(
        "`{}` has no file of labels beside it{expected}, so its images have no labels; name one with --labels",
        path.display()
    )
}

/// Returns a warning if images, which have ground-truth boxes, are turned by their EXIF data, but
/// are read as they are stored: boxes are mostly drawn on upright pictures.
#[must_use]
pub fn turned_images_warning(images: &[PathBuf]) -> Option<String> {
    /// The number of images that are looked at.
    const SAMPLE: usize = 64;
    let sample = &images[..images.len().min(SAMPLE)];
    let turned: Vec<_> = sample.iter().filter(|path| picture::is_turned(path)).collect();
    let first = turned.first()?;
    Some(format!(
        "{} of the first {} images, such as `{}`, are turned by their EXIF data, and are read as they are stored; \
         if the boxes were drawn on the upright pictures, add --orientation upright",
        turned.len(),
        sample.len(),
        first.display()
    ))
}

/// Warns of a CIFAR sheet that is read as a photograph, and of a photograph that is read as a
/// sheet.
fn sheet_warning(path: &Path, images: ImageRelation) -> Option<String> {
    let wide = is_image_name(path) && picture::width(path) == Some(cifar::WIDTH);
    let sheet = wide && looks_like_sheet(&picture::read(path, 8).ok()?);
    let shown = path.display();
    match images {
        ImageRelation::Clip | ImageRelation::Set if sheet => Some(format!(
            "`{shown}` looks like a CIFAR sheet, one image of 32x32 pixels per row, but is read as one \
             picture; --images cifar-sheet reads its rows"
        )),
        ImageRelation::CifarSheet if wide && !sheet => Some(format!(
            "`{shown}` looks like a photograph, but every row of it is read as an image of 32x32 pixels; \
             leave --images cifar-sheet out if it is one picture"
        )),
        _ => None,
    }
}

/// Returns true if every row of a picture is probably a picture of its own. Then a pixel resembles
/// the pixel 32 columns further, which is below it in the small picture, more than the pixel in the
/// next row, which belongs to another one.
fn looks_like_sheet(frame: &Frame) -> bool {
    const SIDE: usize = 32;
    let (mut along, mut across) = ((0_u64, 0_u64), (0_u64, 0_u64));
    for y in 0..frame.height() {
        let row = frame.row(y);
        for (a, b) in row.iter().zip(&row[SIDE..]) {
            along = (along.0 + u64::from(a.abs_diff(*b)), along.1 + 1);
        }
        if y + 1 < frame.height() {
            for (a, b) in row.iter().zip(frame.row(y + 1)) {
                across = (across.0 + u64::from(a.abs_diff(*b)), across.1 + 1);
            }
        }
    }
    // The mean differences are compared as products. A single row of this width is not a
    // photograph.
    across.1 == 0 || along.0 * across.1 < across.0 * along.1
}
