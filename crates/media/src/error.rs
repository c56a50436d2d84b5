// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of footage. Every message names the input and says what to do.

use std::path::{Path, PathBuf};

use foveate_camera::ConfigError;
use foveate_pixels::{FrameError, SceneError};
use foveate_tools::ToolError;
use thiserror::Error;

use crate::extension::is_video_name;
use crate::limits::{CropRect, MAX_FILE_GIB, MAX_SIDE};

/// The image types that can be read, for messages.
const TYPES: &str = "PNG, JPEG, BMP and PNM (PGM, PPM, PBM, PAM)";

/// The error that is returned if footage cannot be opened or read.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum FootageError {
    /// No input was given.
    #[error(
        "no input was given; name a video, images, folders, patterns such as 'frames/*.png', or scene:NAME"
    )]
    NoInput,
    /// A file or folder does not exist.
    #[error("input `{}` does not exist; check the path", path.display())]
    Missing { path: PathBuf },
    /// A configuration has the classes of its regions in an image and as text.
    #[error(
        "the configuration has both the image `zones.map` = `{map}` and `zones.classes`, which give every region a class; \
         leave one of them out"
    )]
    ClassesTwice { map: String },
    /// An image that is a map of zones has a colour that is no class.
    #[error(
        "the map `{}`: pixel ({x}, {y}) is ({red}, {green}, {blue}), which is no class; black or 0 is normal, red \
         (255, 0, 0) or 1 is off, green (0, 255, 0) or 2 is keen, white or 3 is always; in an image of 16 bits, 65535 takes \
         the place of 255",
        path.display()
    )]
    ClassColour { path: PathBuf, x: u32, y: u32, red: u16, green: u16, blue: u16 },
    /// The input is a URL.
    #[error(
        "`{url}` is a URL, but inputs must be files, devices of this machine, or cameras by RTSP; download it first, or let \
         ffmpeg read it: ffmpeg -i '{url}' -f yuv4mpegpipe - | foveate simulate - -o out"
    )]
    Url { url: String },
    /// A folder or pattern has images and videos, of which only one kind can be read.
    #[error(
        "`{place}` holds images and videos ({images} and {videos}, such as `{video}`), so it is not clear which \
         to read; name the images, for example '{pattern}', or the video",
        video = video.display()
    )]
    Mixed { place: String, images: usize, videos: usize, video: PathBuf, pattern: String },
    /// A file has no frames.
    #[error("`{}` holds no frames: {problem}", path.display())]
    Frameless { path: PathBuf, problem: String },
    /// An image of several frames is among other images.
    #[error(
        "`{}` holds several frames, as an animation or a stream of images does, and here only the first one would \
         be read; simulate it on its own, as a clip, to read all frames, or save the frame that you need",
        path.display()
    )]
    Animated { path: PathBuf },
    /// No image matches a pattern.
    #[error("no image matches `{pattern}`; check the pattern (image types are {TYPES})")]
    NoMatch { pattern: String },
    /// A pattern has a syntax error.
    #[error("`{pattern}` is not a valid pattern: {problem}")]
    Pattern { pattern: String, problem: String },
    /// A folder has neither images nor clips.
    #[error("folder `{}` holds no image and no video; image types are {TYPES}", path.display())]
    EmptyFolder { path: PathBuf },
    /// A scene, camera, stream or video is combined with other inputs in one clip.
    #[error("`{input}` cannot be combined with other inputs; give it on its own")]
    NotAlone { input: String },
    /// A video gives no frame.
    #[error("{}", video_problem(path, problem))]
    Video { path: PathBuf, problem: String },
    /// A camera of this machine gives no frame.
    #[error(
        "camera `{}` gives no frame: {problem}; check that it is connected (`ls /dev/video*`) and that no \
         other program uses it",
        path.display()
    )]
    Camera { path: PathBuf, problem: String },
    /// A network camera gives no frame.
    #[error("camera `{url}` gives no frame: {problem}; {}", network_advice(problem))]
    Network { url: String, problem: String },
    /// A raw stream gives no frame.
    #[error(
        "`{name}` is not a valid YUV4MPEG2 stream: {problem}; make one with `ffmpeg -i FILE -f yuv4mpegpipe -`"
    )]
    Y4m { name: String, problem: String },
    /// Raw video gives no frame.
    #[error("`{name}` is not raw video of this kind: {problem}")]
    Raw { name: String, problem: String },
    /// A file of times cannot be used.
    #[error("the times in `{}` cannot be used: {problem}", path.display())]
    Timestamps { path: PathBuf, problem: String },
    /// A ZIP archive cannot be read.
    #[error("the ZIP archive `{}` cannot be read: {problem}", path.display())]
    Zip { path: PathBuf, problem: String },
    /// A file of many images cannot be read.
    #[error("data set `{}` cannot be read: {problem}; copy or fetch it again", path.display())]
    DataSet { path: PathBuf, problem: String },
    /// An option cannot be used for this input.
    #[error("{option} cannot be used: {problem}")]
    Option { option: &'static str, problem: String },
    /// The part to crop does not lie inside the frame.
    #[error(
        "--crop {}x{}+{}+{} does not lie inside the frame of {}x{} pixels",
        crop.size.0, crop.size.1, crop.origin.0, crop.origin.1, size.0, size.1
    )]
    Crop { crop: CropRect, size: (u32, u32) },
    /// The input is a device that is not named as a camera.
    #[error(
        "`{}` is a device, but frames come from files, pipes and cameras; name a camera as `v4l2:{}`",
        path.display(),
        path.display()
    )]
    Device { path: PathBuf },
    /// ffmpeg is missing or cannot be started.
    #[error(transparent)]
    Tool(Box<ToolError>),
    /// A file or folder cannot be read at all.
    #[error("cannot read `{}`: {problem}", path.display())]
    Unreadable { path: PathBuf, problem: String },
    /// A file is not an image of a known type.
    #[error("`{}` is not an image of a supported type; convert it to one of {TYPES}", path.display())]
    UnsupportedType { path: PathBuf },
    /// An image has a known type that is not read.
    #[error(
        "`{}` is an image of the type {name}, which is not read; convert it to PNG, for example with ImageMagick: \
         `magick '{}' '{}'`, or many at once with `mogrify -format png`; image types are {TYPES}",
        path.display(), path.display(), converted(path).display()
    )]
    ImageType { path: PathBuf, name: &'static str },
    /// An image has a supported type, but a variant that is not supported.
    #[error("image `{}` cannot be decoded: {problem}; export it again as a plain PNG", path.display())]
    UnsupportedFeature { path: PathBuf, problem: String },
    /// An image ends too early.
    #[error("image `{}` is truncated: {problem}; copy or export it again", path.display())]
    Truncated { path: PathBuf, problem: String },
    /// An image cannot be decoded.
    #[error("image `{}` is damaged: {problem}; copy or export it again", path.display())]
    Damaged { path: PathBuf, problem: String },
    /// An image exceeds the limits.
    #[error(
        "image `{}` is too large; the limits are {MAX_SIDE} pixels per side and {MAX_FILE_GIB} GiB, \
         so scale it down or cut it",
        path.display()
    )]
    TooLarge { path: PathBuf },
    /// The frames of one run differ in size.
    #[error(
        "all frames of a run must have the same size, but `{first}` has {}x{} pixels and `{other}` has {}x{}; \
         scale them with --resize, or simulate them separately",
        first_size.0, first_size.1, other_size.0, other_size.1
    )]
    MixedSizes { first: String, first_size: (u32, u32), other: String, other_size: (u32, u32) },
    /// A source has no frame.
    #[error("{inputs} holds no frame; at least one is needed")]
    NoFrames { inputs: String },
    /// A frame rate is zero or infinite.
    #[error("{frames} frames in {seconds} s are not a frame rate; both numbers must be at least 1")]
    FrameRate { frames: u32, seconds: u32 },
    /// The system cannot start a thread.
    #[error("the system cannot start a thread: {reason}; try again with fewer programs running")]
    Thread { reason: String },
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The configuration is not valid.
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

/// Returns what to do about a camera of the network, by what ffmpeg says about it.
fn network_advice(problem: &str) -> &'static str {
    let has = |parts: &[&str]| parts.iter().any(|part| problem.contains(part));
    if has(&["461 Unsupported", "Nonmatching transport"]) {
        "it sends over UDP only, and only TCP is read; allow RTP over TCP (interleaved) in its settings, or put a relay \
         in between, for example MediaMTX"
    } else if has(&["matches no streams"]) {
        "it sends no video, perhaps only sound; check the path of the address, which `ffprobe URL` shows"
    } else if has(&["PPS", "VPS", "decode_slice_header", "no frame!"]) {
        "it has sent no key frame, with which decoding begins; set a shorter interval of key frames in its settings"
    } else if has(&["sent nothing"]) {
        "it has answered, but it sends no pictures; check that it is on and that no other program holds its stream"
    } else if has(&["401 Unauthorized", "403 Forbidden"]) {
        "check user and password with `ffprobe URL`"
    } else if has(&["404 Not Found"]) {
        "check the path of the address with `ffprobe URL`"
    } else {
        "check the address, user and password with `ffprobe URL`, and that the camera can be reached from here"
    }
}

/// Returns a name for an image after its conversion to PNG.
fn converted(path: &Path) -> PathBuf {
    let other = path.with_extension("png");
    if other == path { path.with_extension("converted.png") } else { other }
}

/// Returns the message for a video without frames. The advice to play it helps only if the file has
/// the name of a video.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The problems are those of ffmpeg 5.1 with a server of each kind.
    #[test]
    fn the_advice_for_a_network_camera_names_the_cause() {
        for (problem, part) in [
            (
                "ffmpeg reports 2 faults, the first: method SETUP failed: 461 Unsupported Transport",
                "UDP",
            ),
            ("ffmpeg reports 2 faults, the first: Nonmatching transport in server reply", "UDP"),
            ("ffmpeg reports: Stream map '0:v:0' matches no streams.", "sound"),
            ("ffmpeg reports 603 faults, the first: non-existing PPS 0 referenced", "key frame"),
            ("it has sent nothing for 10 s", "sends no pictures"),
            (
                "ffmpeg reports 2 faults, the first: method DESCRIBE failed: 401 Unauthorized",
                "check user and password with",
            ),
            (
                "ffmpeg reports 2 faults, the first: method DESCRIBE failed: 404 Not Found",
                "the path",
            ),
            (
                "ffmpeg reports: Connection to tcp://127.0.0.1:9 failed: Connection refused",
                "reached from here",
            ),
            ("ffmpeg reports 404 faults, the first: Invalid data found", "reached from here"),
            (
                "ffmpeg reports: Connection to tcp://10.9.9.9:554 failed: Connection timed out",
                "reached from here",
            ),
        ] {
            let advice = network_advice(problem);
            assert!(advice.contains(part), "{problem}: {advice}");
        }
    }
}
