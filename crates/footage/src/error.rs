// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why there is no footage. Every message names the input and says what to do.

use std::path::{Path, PathBuf};

use foveate_camera::ConfigError;
use foveate_frame::FrameError;
use foveate_scenes::SceneError;
use foveate_toolchain::ToolError;
use thiserror::Error;

use crate::extension::is_video_name;
use crate::limits::{Crop, MAX_FILE_GIB, MAX_SIDE};

/// What the reader understands, for messages.
const TYPES: &str = "PNG, JPEG, BMP and PNM (PGM, PPM, PBM, PAM)";

/// Footage that cannot be opened or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FootageError {
    /// Nothing to simulate was named.
    #[error(
        "no input was given; name a video, images, folders, patterns such as 'frames/*.png', or scene:NAME"
    )]
    NoInput,
    /// A file or folder that does not exist.
    #[error("input `{}` does not exist; check the path", path.display())]
    Missing {
        /// The path as given.
        path: PathBuf,
    },
    /// A URL.
    #[error(
        "`{url}` is a URL, but inputs must be files, devices of this machine, or cameras by RTSP; download it first, or let \
         ffmpeg read it: ffmpeg -i '{url}' -f yuv4mpegpipe - | foveate simulate - -o out"
    )]
    Url {
        /// The address as given.
        url: String,
    },
    /// Images and videos in one place, of which only one kind can be read.
    #[error(
        "`{place}` holds images and videos ({images} and {videos}, such as `{video}`), so it is not clear which \
         to read; name the images, for example '{pattern}', or the video",
        video = video.display()
    )]
    Mixed {
        /// The folder or pattern as given.
        place: String,
        /// How many images.
        images: usize,
        /// How many videos.
        videos: usize,
        /// The first of them.
        video: PathBuf,
        /// A pattern of images that is there.
        pattern: String,
    },
    /// A file that holds no frames.
    #[error("`{}` holds no frames: {problem}", path.display())]
    Frameless {
        /// The file.
        path: PathBuf,
        /// What it is, and what to name instead.
        problem: String,
    },
    /// An image of several frames among images.
    #[error(
        "`{}` is an animated PNG among other images, where only its first frame would be read; simulate it on \
         its own to read all frames, or save the frame that you need",
        path.display()
    )]
    Animated {
        /// The file.
        path: PathBuf,
    },
    /// A pattern that no image matches.
    #[error("no image matches `{pattern}`; check the pattern (image types are {TYPES})")]
    NoMatch {
        /// The pattern as given.
        pattern: String,
    },
    /// A pattern with a syntax error.
    #[error("`{pattern}` is not a valid pattern: {problem}")]
    Pattern {
        /// The pattern as given.
        pattern: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A folder without images or clips.
    #[error("folder `{}` holds no image and no video; image types are {TYPES}", path.display())]
    EmptyFolder {
        /// The folder.
        path: PathBuf,
    },
    /// Scenes, cameras, streams and videos do not mix with other inputs in one clip.
    #[error("`{input}` cannot be combined with other inputs; give it on its own")]
    NotAlone {
        /// The input as given.
        input: String,
    },
    /// A video that gives no frame.
    #[error("{}", video_problem(path, problem))]
    Video {
        /// The file.
        path: PathBuf,
        /// What is wrong, as ffmpeg says it.
        problem: String,
    },
    /// A camera that gives no frame.
    #[error(
        "camera `{}` gives no frame: {problem}; check that it is connected (`ls /dev/video*`) and that no \
         other program uses it",
        path.display()
    )]
    Camera {
        /// The device.
        path: PathBuf,
        /// What is wrong, as ffmpeg says it.
        problem: String,
    },
    /// A camera in the network that gives no frame.
    #[error(
        "camera `{url}` gives no frame: {problem}; check the address, user and password with `ffprobe URL`, and that the \
         camera can be reached from here"
    )]
    Network {
        /// The address, without user and password.
        url: String,
        /// What is wrong, as ffmpeg says it.
        problem: String,
    },
    /// A raw stream that gives no frame.
    #[error(
        "`{name}` is not a valid YUV4MPEG2 stream: {problem}; make one with `ffmpeg -i FILE -f yuv4mpegpipe -`"
    )]
    Y4m {
        /// The file, or standard input.
        name: String,
        /// What is wrong.
        problem: String,
    },
    /// A file of many images that cannot be read.
    #[error("data set `{}` cannot be read: {problem}; copy or fetch it again", path.display())]
    DataSet {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// An option that cannot be used here.
    #[error("{option} cannot be used: {problem}")]
    Option {
        /// The option.
        option: &'static str,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A part that is not inside the frame.
    #[error(
        "--crop {}x{}+{}+{} does not lie inside the frame of {}x{} pixels",
        crop.size.0, crop.size.1, crop.at.0, crop.at.1, size.0, size.1
    )]
    Crop {
        /// The part as given.
        crop: Crop,
        /// Width and height of the frame.
        size: (u32, u32),
    },
    /// A device that is none that frames come from.
    #[error(
        "`{}` is a device, but frames come from files, pipes and cameras; name a camera as `v4l2:{}`",
        path.display(),
        path.display()
    )]
    Device {
        /// The device.
        path: PathBuf,
    },
    /// ffmpeg is missing or cannot be started.
    #[error(transparent)]
    Tool(Box<ToolError>),
    /// A file that cannot be read at all.
    #[error("cannot read `{}`: {problem}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        problem: String,
    },
    /// A file that is not an image of a known type.
    #[error("`{}` is not an image of a supported type; convert it to one of {TYPES}", path.display())]
    UnsupportedType {
        /// The file.
        path: PathBuf,
    },
    /// An image of a type that is known, but not read.
    #[error(
        "`{}` is an image of the type {name}, which is not read; convert it to PNG, for example with ImageMagick: \
         `magick '{}' '{}'`, or many at once with `mogrify -format png`; image types are {TYPES}",
        path.display(), path.display(), converted(path).display()
    )]
    ImageType {
        /// The file.
        path: PathBuf,
        /// The name of the type.
        name: &'static str,
    },
    /// An image of a supported type in a variant that is not.
    #[error("image `{}` cannot be decoded: {problem}; export it again as a plain PNG", path.display())]
    UnsupportedFeature {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        problem: String,
    },
    /// An image that ends too early.
    #[error("image `{}` is truncated: {problem}; copy or export it again", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// What is missing.
        problem: String,
    },
    /// An image that does not decode.
    #[error("image `{}` is damaged: {problem}; copy or export it again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        problem: String,
    },
    /// An image beyond the limits.
    #[error(
        "image `{}` is too large; the limits are {MAX_SIDE} pixels per side and {MAX_FILE_GIB} GiB, \
         so scale it down or cut it",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// Frames of one run that differ in size.
    #[error(
        "all frames of a run must have the same size, but `{first}` has {}x{} pixels and `{other}` has {}x{}; \
         scale them with --resize, or simulate them separately",
        first_size.0, first_size.1, other_size.0, other_size.1
    )]
    MixedSizes {
        /// Name of the first frame.
        first: String,
        /// Its width and height.
        first_size: (u32, u32),
        /// Name of the first frame that differs.
        other: String,
        /// Its width and height.
        other_size: (u32, u32),
    },
    /// A source that has no frame.
    #[error("{inputs} holds no frame; at least one is needed")]
    NoFrames {
        /// The inputs as given.
        inputs: String,
    },
    /// A frame rate of zero or without end.
    #[error("{frames} frames in {seconds} s is not a frame rate; both numbers must be at least 1")]
    FrameRate {
        /// Frames as given.
        frames: u32,
        /// Seconds as given.
        seconds: u32,
    },
    /// The system gave no thread.
    #[error("the system cannot start a thread: {reason}; try again with fewer programs running")]
    Thread {
        /// What it says.
        reason: String,
    },
    /// The user has asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The configuration does not fit.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// Pixels do not make a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The scene does not exist.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl From<ToolError> for FootageError {
    fn from(error: ToolError) -> Self {
        if error.is_interrupted() { Self::Interrupted } else { Self::Tool(Box::new(error)) }
    }
}

/// A name for an image after it was converted.
fn converted(path: &Path) -> PathBuf {
    let other = path.with_extension("png");
    if other == path { path.with_extension("converted.png") } else { other }
}

/// To play it helps with a video that is damaged, not with what never was one.
fn video_problem(path: &Path, problem: &str) -> String {
    let shown = path.display();
    if is_video_name(path) {
        return format!(
            "video `{shown}` cannot be read: {problem}; play it to check that it is complete"
        );
    }
    format!(
        "`{shown}` is not an image ({TYPES}) or a data set (IDX, CIFAR), and ffmpeg cannot read it as a video: {problem}"
    )
}
