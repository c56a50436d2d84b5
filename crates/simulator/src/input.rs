// SPDX-License-Identifier: MIT OR Apache-2.0
//! From what a user names to a source: `scene:NAME`, or files, folders and patterns.
//!
//! Arguments keep the order in which they are given; the files of one folder or pattern are in natural
//! order. Folders are not searched below their first level, and hidden files are passed over.

use std::fs;
use std::path::{Path, PathBuf};

use foveate_scenes::{Scene, SceneSize};
use foveate_spec::Config;
use glob::{MatchOptions, Pattern};

use crate::source::{ImageFiles, SceneSource};
use crate::{FrameRate, SimulatorError, Source, natural_order};

/// Files with these extensions are taken from folders and patterns.
const EXTENSIONS: [&str; 9] = ["png", "jpg", "jpeg", "bmp", "pgm", "ppm", "pbm", "pnm", "pam"];
/// Side of a scene where the configuration does not say.
const SCENE_SIDE: u32 = 224;

/// Choices on how inputs are read.
#[derive(Clone, Copy, Debug, Default)]
pub struct InputOptions {
    /// At most this many frames; of a scene, exactly this many.
    pub frames: Option<u32>,
    /// Frames per second, for the times of frames.
    pub frame_rate: FrameRate,
}

/// Opens inputs as one source of frames with the configuration's bits per pixel. Scenes also take
/// their size from it.
///
/// # Errors
/// When an input does not exist, holds no image, or its first image cannot be read.
pub fn open<P: AsRef<Path>>(
    inputs: &[P],
    config: &Config,
    options: &InputOptions,
) -> Result<Box<dyn Source>, SimulatorError> {
    let scene = inputs.iter().find_map(|input| scene_name(input.as_ref()));
    if let Some(name) = scene {
        if inputs.len() > 1 {
            return Err(SimulatorError::SceneNotAlone { scene: format!("scene:{name}") });
        }
        return scene_source(name, config, options);
    }
    let mut paths = Vec::new();
    for input in inputs {
        paths.append(&mut expand(input.as_ref())?);
    }
    if paths.is_empty() {
        return Err(SimulatorError::NoInput);
    }
    if let Some(frames) = options.frames {
        paths.truncate(frames as usize);
    }
    let names = inputs.iter().map(|input| input.as_ref().display().to_string()).collect();
    // A depth out of range is refused here, with the name of its key, not by a frame.
    let bits = config.validate()?.pixel_bits();
    Ok(Box::new(ImageFiles::new(names, paths, bits, options.frame_rate)?))
}

fn scene_name(input: &Path) -> Option<&str> {
    input.to_str()?.strip_prefix("scene:")
}

fn scene_source(
    name: &str,
    config: &Config,
    options: &InputOptions,
) -> Result<Box<dyn Source>, SimulatorError> {
    let scene = Scene::find(name)?;
    // Sizes out of range are refused here, not brought into range silently.
    config.validate()?;
    let size = SceneSize {
        width: config.frame.width.unwrap_or(SCENE_SIDE),
        height: config.frame.height.unwrap_or(SCENE_SIDE),
        bits: config.frame.pixel_bits,
        region_size: config.region.size,
        frames: options.frames.unwrap_or(scene.default_frames()),
    };
    Ok(Box::new(SceneSource::new(scene, size, options.frame_rate)))
}

/// The files that one argument stands for.
fn expand(input: &Path) -> Result<Vec<PathBuf>, SimulatorError> {
    if input.is_dir() {
        return folder(input);
    }
    if input.exists() {
        return Ok(vec![input.to_owned()]);
    }
    match input.to_str() {
        Some(text) if text.contains(['*', '?', '[']) => pattern(text),
        _ => Err(SimulatorError::Missing { path: input.to_owned() }),
    }
}

fn folder(path: &Path) -> Result<Vec<PathBuf>, SimulatorError> {
    let unreadable = |error: std::io::Error| SimulatorError::Unreadable {
        path: path.to_owned(),
        problem: error.to_string(),
    };
    let mut files = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable)? {
        files.push(entry.map_err(unreadable)?.path());
    }
    let images = images_of(files);
    if images.is_empty() {
        return Err(SimulatorError::EmptyFolder { path: path.to_owned() });
    }
    Ok(images)
}

fn pattern(text: &str) -> Result<Vec<PathBuf>, SimulatorError> {
    let invalid = |error: glob::PatternError| SimulatorError::Pattern {
        pattern: text.to_owned(),
        problem: error.to_string(),
    };
    Pattern::new(text).map_err(invalid)?;
    let options = MatchOptions { require_literal_leading_dot: true, ..MatchOptions::new() };
    let mut files = Vec::new();
    for found in glob::glob_with(text, options).map_err(invalid)? {
        files.push(found.map_err(|error| SimulatorError::Unreadable {
            path: error.path().to_owned(),
            problem: error.error().to_string(),
        })?);
    }
    let images = images_of(files);
    if images.is_empty() {
        return Err(SimulatorError::NoMatch { pattern: text.to_owned() });
    }
    Ok(images)
}

/// Keeps images, by name, and sorts them.
fn images_of(files: Vec<PathBuf>) -> Vec<PathBuf> {
    let hidden =
        |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    let image = |path: &Path| {
        path.extension().is_some_and(|extension| {
            EXTENSIONS.iter().any(|known| extension.eq_ignore_ascii_case(known))
        })
    };
    let mut images: Vec<PathBuf> =
        files.into_iter().filter(|path| image(path) && !hidden(path) && path.is_file()).collect();
    images.sort_by(|a, b| natural_order(a, b));
    images
}
