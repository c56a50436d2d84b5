// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files that an argument stands for. Hidden files are passed over.

use std::fs;
use std::path::{Path, PathBuf};

use glob::{MatchOptions, Pattern};

use super::sniff::{self, FileKind};
use crate::extension::{VIDEO_EXTENSIONS, extension_in, is_image_name};
use crate::options::ImagesAs;
use crate::source::files::ImageFile;
use crate::{FootageError, natural_order, picture};

/// The entries of a folder in natural order, without hidden ones.
pub(crate) fn entries(folder: &Path) -> Result<Vec<PathBuf>, FootageError> {
    let unreadable = |error: std::io::Error| FootageError::Unreadable {
        path: folder.to_owned(),
        problem: error.to_string(),
    };
    let mut entries = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        entries.push(entry.map_err(unreadable)?.path());
    }
    Ok(in_order(entries))
}

/// The files that one argument stands for, with labels.
pub(crate) fn expand(input: &Path, images: ImagesAs) -> Result<Vec<ImageFile>, FootageError> {
    if input.is_dir() {
        return match images {
            ImagesAs::Set => labelled(input),
            ImagesAs::Clip | ImagesAs::CifarSheet => folder(input),
        };
    }
    if input.exists() {
        return Ok(vec![plain(input.to_owned())]);
    }
    match input.to_str() {
        Some(text) if is_url(text) => Err(FootageError::Url { url: text.to_owned() }),
        Some(text) if text.contains(['*', '?', '[']) => pattern(text),
        _ => Err(FootageError::Missing { path: input.to_owned() }),
    }
}

/// `https://...` and its kin.
fn is_url(text: &str) -> bool {
    let scheme = text.split_once("://").map(|(scheme, _)| scheme);
    scheme.is_some_and(|scheme| {
        !scheme.is_empty() && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+.-".contains(c))
    })
}

/// Images apart from files that are a source each.
#[allow(clippy::type_complexity, reason = "two lists")]
pub(super) fn split(
    files: &mut Vec<ImageFile>,
) -> Result<(Vec<ImageFile>, Vec<(PathBuf, FileKind)>), FootageError> {
    let (mut images, mut others) = (Vec::new(), Vec::new());
    for file in files.drain(..) {
        if is_image_name(&file.path) || picture::is_image(&file.path) {
            images.push(file);
        } else {
            others.push((file.path.clone(), sniff::kind(&file.path)?));
        }
    }
    Ok((images, others))
}

fn plain(path: PathBuf) -> ImageFile {
    ImageFile { path, label: None }
}

/// The images of a folder, or the one clip that it holds.
fn folder(path: &Path) -> Result<Vec<ImageFile>, FootageError> {
    let files: Vec<PathBuf> = entries(path)?.into_iter().filter(|path| path.is_file()).collect();
    let of = |known: &dyn Fn(&Path) -> bool| -> Vec<ImageFile> {
        files.iter().filter(|path| known(path)).cloned().map(plain).collect()
    };
    let images = of(&is_image_name);
    let clips = of(&|path| extension_in(path, &VIDEO_EXTENSIONS));
    match (images.as_slice(), clips.as_slice()) {
        ([image, ..], [clip, ..]) => {
            let pattern = path.join("*").with_extension(image.path.extension().unwrap_or_default());
            Err(FootageError::Mixed {
                place: path.display().to_string(),
                images: images.len(),
                videos: clips.len(),
                video: clip.path.clone(),
                pattern: pattern.display().to_string(),
            })
        }
        ([_, ..], []) => Ok(images),
        ([], [_, ..]) => Ok(clips),
        ([], []) => Err(FootageError::EmptyFolder { path: path.to_owned() }),
    }
}

/// The images of a folder without a label, then those of each sub-folder under its name.
fn labelled(path: &Path) -> Result<Vec<ImageFile>, FootageError> {
    let entries_here = entries(path)?;
    let image = |path: &Path| is_image_name(path) && path.is_file();
    let mut files: Vec<ImageFile> =
        entries_here.iter().filter(|path| image(path)).cloned().map(plain).collect();
    for class in entries_here.iter().filter(|path| path.is_dir()) {
        let label = class.file_name().map(|name| name.to_string_lossy().into_owned());
        let images = entries(class)?.into_iter().filter(|path| image(path));
        files.extend(images.map(|path| ImageFile { path, label: label.clone() }));
    }
    match (files.is_empty(), entries_here.iter().any(|path| extension_in(path, &VIDEO_EXTENSIONS)))
    {
        (false, _) => Ok(files),
        (true, false) => Err(FootageError::EmptyFolder { path: path.to_owned() }),
        (true, true) => {
            let problem = format!(
                "folder `{}` holds clips but no images, and a set needs images; \
                 use `foveate simulate` to run the clips as a batch",
                path.display()
            );
            Err(FootageError::Option { option: "--images set", problem })
        }
    }
}

fn pattern(text: &str) -> Result<Vec<ImageFile>, FootageError> {
    let invalid = |error: glob::PatternError| FootageError::Pattern {
        pattern: text.to_owned(),
        problem: error.to_string(),
    };
    Pattern::new(text).map_err(invalid)?;
    let options = MatchOptions { require_literal_leading_dot: true, ..MatchOptions::new() };
    let mut files = Vec::new();
    for found in glob::glob_with(text, options).map_err(invalid)? {
        files.push(found.map_err(|error| FootageError::Unreadable {
            path: error.path().to_owned(),
            problem: error.error().to_string(),
        })?);
    }
    let known = |path: &PathBuf| path.is_file() && is_image_name(path);
    let files = in_order(files);
    let videos: Vec<&PathBuf> =
        files.iter().filter(|path| extension_in(path, &VIDEO_EXTENSIONS)).collect();
    let images: Vec<_> = files.iter().filter(|path| known(path)).cloned().map(plain).collect();
    match (images.as_slice(), videos.as_slice()) {
        ([], []) => Err(FootageError::NoMatch { pattern: text.to_owned() }),
        ([], [video, ..]) => Err(FootageError::Option {
            option: "the pattern",
            problem: format!(
                "`{text}` matches videos, such as `{}`, but a pattern is for images; name the videos or \
                 their folder, or leave the quotation marks out",
                video.display()
            ),
        }),
        ([image, ..], [video, ..]) => Err(FootageError::Mixed {
            place: text.to_owned(),
            images: images.len(),
            videos: videos.len(),
            video: video.to_path_buf(),
            pattern: image
                .path
                .with_file_name("*")
                .with_extension(image.path.extension().unwrap_or_default())
                .display()
                .to_string(),
        }),
        ([_, ..], []) => Ok(images),
    }
}

fn in_order(mut paths: Vec<PathBuf>) -> Vec<PathBuf> {
    let hidden =
        |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    paths.retain(|path| !hidden(path));
    paths.sort_by(|a, b| natural_order(a, b));
    paths
}
