// SPDX-License-Identifier: MIT OR Apache-2.0
//! The way from an input to a source: scenes, cameras, standard input, files, folders and patterns.
//!
//! Inputs keep the order in which they are given; the files of one folder or pattern are in natural
//! order. The content of a file decides its kind. Its extension decides if the content does not.

mod content_kind;
mod entry;
mod expansion;
mod file_kind;
mod pattern;
mod sequence;
mod skip_reason;
mod skipped_entries;
mod zip_listing;

use self::zip_listing::open_zip;
use content_kind::is_archive_start;
pub(crate) use content_kind::unread_image_type_by_content;
pub(crate) use entry::{EntryKind, entries, entry_kind};
pub use expansion::matched_images;
pub(crate) use expansion::{expand, sequence_of};
use file_kind::FileKind;
pub(crate) use pattern::{is_pattern, skipped_by_pattern};
pub(crate) use sequence::SequenceName;
pub use skip_reason::{SkipReason, SkippedInput};
pub(crate) use skip_reason::{find_same_number, skip_sentences};
pub(crate) use skipped_entries::{
    collect_skipped_of_clip, collect_skipped_of_set, skipped_folder, unreadable_entry,
};
pub(crate) use zip_listing::{image_names_of_zip, skipped_of_zip};

use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use foveate_camera::CameraConfig;
use foveate_pixels::{Scene, SceneParameters};
use foveate_tools::{Interrupt, InterruptibleReader, standard_input, unpacked};

use crate::address::{CameraAddress, input_without_secrets};
use crate::options::{ImageRelation, InputOptions};
use crate::picture::ClipImage;
use crate::raw::open_raw;
use crate::raw_layout::RawLayout;
use crate::sets::cifar::{CifarBatch, CifarSheet};
use crate::sets::idx::IdxImages;
use crate::sets::{open_pipe, open_unpacked};
use crate::source::feed::{AdjustedSource, FrameAdjustment, FrameFeed};
use crate::source::file_feeds::{ImageFile, ImageFiles, SceneFeed};
use crate::source::timestamped_feed::TimestampedFeed;
use crate::stream::StreamFeed;
use crate::video::{VideoFeed, VideoMedium};
use crate::y4m::{Y4mFormat, open_y4m};
use crate::{FootageError, FrameSource, SourceKind, picture};

/// The side of a scene in pixels if the configuration gives no size.
const SCENE_SIDE: u32 = 224;

/// Opens inputs as one source of frames with the configuration's bits per pixel. Scenes also take
/// their size from the configuration.
///
/// # Errors
/// Fails if an input does not exist or cannot be read, or if there are several inputs that are not
/// all images.
pub fn open<P: AsRef<Path>>(
    inputs: &[P],
    config: &CameraConfig,
    options: &InputOptions,
) -> Result<Box<dyn FrameSource>, FootageError> {
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    let feed = open_feed(&inputs, config, options)?;
    if options.bayer.is_some() && !feed.reads_mosaics() {
        let problem = "a mosaic is a grey image, or raw video in a grey format; leave the option out for other \
                       inputs"
            .to_owned();
        return Err(FootageError::Option { option: "--bayer", problem });
    }
    let feed = match &options.timestamps {
        Some(file) => Box::new(TimestampedFeed::new(feed, file.clone(), &options.interrupt)?),
        None => feed,
    };
    let names = inputs.iter().map(|input| input_without_secrets(input)).collect();
    Ok(Box::new(AdjustedSource::new(names, feed, FrameAdjustment::from_options(options))?))
}

/// Returns the part of an input that follows a prefix, such as the name of a scene.
fn strip_prefix_of<'a>(prefix: &str, input: &'a Path) -> Option<&'a str> {
    input.to_str()?.strip_prefix(prefix)
}

/// Returns true if an input is neither a file nor a folder, but can be read only once: a FIFO, a
/// socket, `/dev/stdin`.
fn is_pipe(input: &Path) -> bool {
    std::fs::metadata(input).is_ok_and(|known| !known.is_file() && !known.is_dir())
}

/// Returns true if the input has the name of a camera of this machine.
fn is_camera_device(input: &Path) -> bool {
    input.to_str().is_some_and(|name| name.starts_with("/dev/video"))
}

/// Returns true if an input is a source of its own and not a regular file.
pub(crate) fn is_non_file_source(input: &Path) -> bool {
    is_read_once(input) || strip_prefix_of("scene:", input).is_some()
}

/// Returns true if an input cannot be read a second time: standard input, a pipe, a camera.
#[must_use]
pub fn is_read_once(input: &Path) -> bool {
    input == Path::new("-") || is_camera(input) || is_pipe(input)
}

/// Returns true if an input is a camera, on this machine or in the network. A camera delivers
/// frames at its own rate.
#[must_use]
pub fn is_camera(input: &Path) -> bool {
    strip_prefix_of("v4l2:", input).is_some() || CameraAddress::from_input(input).is_some()
}

fn open_feed(
    inputs: &[&Path],
    config: &CameraConfig,
    options: &InputOptions,
) -> Result<Box<dyn FrameFeed>, FootageError> {
    if let (Some(special), 2..) =
        (inputs.iter().find(|input| is_non_file_source(input)), inputs.len())
    {
        return Err(FootageError::NotAlone { input: input_without_secrets(special) });
    }
    // A depth out of range is refused here, so that the message names its key.
    let bits = config.validate()?.pixel_bits();
    if let Some(layout) = options.raw {
        return open_raw_input(inputs, layout, bits, options);
    }
    if let [input] = inputs {
        if let (Some(labels), true) = (&options.labels, is_non_file_source(input)) {
            return Err(labels_without_images(labels));
        }
        if let Some(name) = strip_prefix_of("scene:", input) {
            return open_scene(name, config, options);
        }
        if let Some(device) = strip_prefix_of("v4l2:", input) {
            let camera = VideoMedium::Camera(device.into());
            return Ok(Box::new(VideoFeed::open(camera, bits, 0, options)?));
        }
        if let Some(address) = CameraAddress::from_input(input) {
            let camera = VideoMedium::Network(address);
            return Ok(Box::new(VideoFeed::open(camera, bits, 0, options)?));
        }
        if *input == Path::new("-") || is_pipe(input) {
            return Ok(Box::new(open_stream(input, bits, options)?));
        }
    }
    let mut images = Vec::new();
    let mut clips = Vec::new();
    for input in inputs {
        let mut paths = expand(input, options.images)?;
        let (mut pictures, mut others) = expansion::split_images(&mut paths)?;
        images.append(&mut pictures);
        clips.append(&mut others);
    }
    // An animated PNG and a stream of images are clips on their own. Among other images only one of
    // their frames would be read.
    if let ([image], ImageRelation::Clip) = (images.as_slice(), options.images)
        && clips.is_empty()
        && let Some(kind) = picture::clip_image(&image.path)
    {
        let kind = match kind {
            ClipImage::Animation => FileKind::Video,
            ClipImage::Stream(kind) => FileKind::ImageStream(kind),
        };
        clips.push((images.remove(0).path, kind));
    }
    let idx = |(_, kind): &(PathBuf, FileKind)| *kind == FileKind::Idx;
    if let (Some(labels), false) = (&options.labels, clips.iter().any(idx)) {
        return Err(labels_without_images(labels));
    }
    match (images.is_empty(), clips.as_slice()) {
        (true, []) => Err(FootageError::NoInput),
        (true, [(path, kind)]) => open_file_feed(path, *kind, bits, options),
        (false, []) => open_images(images, bits, options),
        (_, [(path, _), ..]) => Err(FootageError::NotAlone { input: path.display().to_string() }),
    }
}

/// Opens a stream of raw frames that can be read once, from standard input or a pipe.
fn open_stream(
    input: &Path,
    bits: u32,
    options: &InputOptions,
) -> Result<StreamFeed<Y4mFormat>, FootageError> {
    let (name, stream) = open_once(input, &options.interrupt)?;
    let failed = |error: io::Error| match options.interrupt.is_set() {
        true => FootageError::Interrupted,
        false => FootageError::Y4m { name: name.clone(), problem: error.to_string() },
    };
    let mut stream = unpacked(stream).map_err(failed)?;
    if is_archive_start(stream.fill_buf().map_err(failed)?) {
        let problem = "its directory is at its end, which a pipe gives last; write it into a file and name that";
        return Err(FootageError::Zip { path: name.into(), problem: problem.to_owned() });
    }
    open_y4m(name, stream, bits, options)
}

/// Opens standard input or a pipe. Returns it with its name in messages.
fn open_once(
    input: &Path,
    interrupt: &Interrupt,
) -> Result<(String, Box<dyn BufRead + Send>), FootageError> {
    if is_camera_device(input) {
        return Err(FootageError::Device { path: input.to_owned() });
    }
    if input != Path::new("-") {
        return Ok((input.display().to_string(), open_pipe(input, interrupt)?));
    }
    let name = "standard input".to_owned();
    let stdin = standard_input().map_err(|error| FootageError::Unreadable {
        path: name.clone().into(),
        problem: error.to_string(),
    })?;
    Ok((name, Box::new(BufReader::new(InterruptibleReader::new(stdin, interrupt)))))
}

fn labels_without_images(labels: &Path) -> FootageError {
    let shown = labels.display();
    let problem = format!("`{shown}` belongs to an IDX file of images, but no input is one");
    FootageError::Option { option: "--labels", problem }
}

fn open_images(
    files: Vec<ImageFile>,
    bits: u32,
    options: &InputOptions,
) -> Result<Box<dyn FrameFeed>, FootageError> {
    let kind = match (options.images, files.as_slice()) {
        (ImageRelation::Clip, _) => SourceKind::Clip,
        (ImageRelation::Set, _) => SourceKind::Set,
        (ImageRelation::CifarSheet, [sheet]) => {
            return Ok(Box::new(CifarSheet::open(&sheet.path, bits)?));
        }
        (ImageRelation::CifarSheet, _) => {
            let sheets =
                format!("{} files are given; simulate one CIFAR sheet at a time", files.len());
            return Err(FootageError::Option { option: "--images", problem: sheets });
        }
    };
    let bytes_of = |_, path: &Path| picture::bytes_of(path);
    Ok(Box::new(ImageFiles::new(files, Box::new(bytes_of), bits, options, kind)))
}

fn open_file_feed(
    path: &Path,
    kind: FileKind,
    bits: u32,
    options: &InputOptions,
) -> Result<Box<dyn FrameFeed>, FootageError> {
    Ok(match kind {
        FileKind::Idx => Box::new(IdxImages::open(path, options.labels.as_deref(), bits)?),
        FileKind::CifarBatch => Box::new(CifarBatch::open(path, bits)?),
        FileKind::Y4m => {
            let name = path.display().to_string();
            Box::new(open_y4m(name, open_unpacked(path)?, bits, options)?)
        }
        FileKind::Zip => Box::new(open_zip(path, bits, options)?),
        FileKind::ImageStream(kind) => {
            let medium = VideoMedium::ImageStream(path.to_owned(), kind);
            Box::new(VideoFeed::open(medium, bits, 0, options)?)
        }
        FileKind::Video => {
            let sought = options.selection.start_us.filter(|_| !options.numbered);
            let start = sought.unwrap_or(0);
            let medium = VideoMedium::File(path.to_owned());
            Box::new(VideoFeed::open(medium, bits, start, options)?)
        }
    })
}

fn open_scene(
    name: &str,
    config: &CameraConfig,
    options: &InputOptions,
) -> Result<Box<dyn FrameFeed>, FootageError> {
    let scene = Scene::find(name)?;
    let size = SceneParameters {
        width: config.frame.width.unwrap_or(SCENE_SIDE),
        height: config.frame.height.unwrap_or(SCENE_SIDE),
        bits: config.frame.pixel_bits,
        region_size: config.region.size,
        frames: options.frames.unwrap_or(scene.default_frames()),
    };
    Ok(Box::new(SceneFeed::new(scene, size, options.frame_rate)))
}

/// Opens raw video from one file or pipe. Only a name that ends with `.gz` says that a file is
/// gzipped, because pixels may begin as a gzipped file does.
fn open_raw_input(
    inputs: &[&Path],
    layout: RawLayout,
    bits: u32,
    options: &InputOptions,
) -> Result<Box<dyn FrameFeed>, FootageError> {
    let refused = |shown: &str| FootageError::Option {
        option: "--raw",
        problem: format!(
            "raw video is one file, pipe or `-`, and `{shown}` is not; leave the option out"
        ),
    };
    let [input] = inputs else {
        let shown: Vec<String> = inputs.iter().map(|input| input_without_secrets(input)).collect();
        return Err(refused(&shown.join(", ")));
    };
    let shown = input_without_secrets(input);
    if let Some(labels) = &options.labels {
        return Err(labels_without_images(labels));
    }
    let is_name = |text: &str| is_pattern(text) || SequenceName::parse(text).is_some();
    let is_other = strip_prefix_of("scene:", input).is_some() || is_camera(input) || input.is_dir();
    if is_other || (!input.exists() && input.to_str().is_some_and(is_name)) {
        return Err(refused(&shown));
    }
    if *input == Path::new("-") || is_pipe(input) {
        let (name, stream) = open_once(input, &options.interrupt)?;
        return Ok(Box::new(open_raw(name, None, stream, layout, bits, options)?));
    }
    if !input.exists() {
        return Err(FootageError::Missing { path: shown.into() });
    }
    if has_gzip_name(input) {
        let stream = open_unpacked(input)?;
        return Ok(Box::new(open_raw(shown, None, stream, layout, bits, options)?));
    }
    let file = foveate_tools::open_file(input).map_err(|error| FootageError::Unreadable {
        path: input.to_path_buf(),
        problem: error.to_string(),
    })?;
    let length = file.metadata().ok().map(|known| known.len());
    let stream = Box::new(BufReader::new(file));
    Ok(Box::new(open_raw(shown, length, stream, layout, bits, options)?))
}

fn has_gzip_name(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"))
}
