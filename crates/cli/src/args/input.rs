// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs of a command: how they are read ([`InputArgs`]), and what is checked before they
//! are. Standard input feeds only one argument ([`refuse_second_reader`]), and an output
//! replaces none of the inputs ([`check_output`]).

use super::at_least_one;
use crate::error::CliError;
use crate::{interrupt, notice};
use clap::error::ErrorKind;
use clap::{ArgMatches, Args, Command, Error, ValueEnum};
use foveate_media::{
    BayerPattern, ClipPlan, CropRect, FrameRate, FrameSelection, ImageRelation, InputOptions,
    InputWarnings, LumaRange, MAX_SIDE, Orientation, RawLayout, TimestampUnit, TimestampsFile,
    input_warnings, parse_time, plan,
};
use foveate_tools::{FolderKind, StagedFolder};
use std::path::{Path, PathBuf};

/// The options that say how inputs are read.
#[derive(Args, Debug)]
#[command(next_help_heading = "Input options")]
pub(crate) struct InputArgs {
    /// Take at most this many frames per second, chosen by their times; no frame is repeated
    #[arg(long, value_name = "RATE", value_parser = FrameRate::parse)]
    pub(crate) input_fps: Option<FrameRate>,
    /// Take at most this many frames of every clip. A scene is made with exactly this many, of
    /// which --start, --end and --input-fps choose
    #[arg(long, visible_alias = "frames", value_name = "N", value_parser = at_least_one())]
    pub(crate) max_frames: Option<u32>,
    /// Frame rate of images and of raw video, which have no times of their own
    #[arg(long, value_name = "RATE", default_value = "30", value_parser = FrameRate::parse)]
    pub(crate) rate: FrameRate,
    /// Skip frames before this time: seconds, or HH:MM:SS
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub(crate) start: Option<u64>,
    /// Skip frames at this time or later
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub(crate) end: Option<u64>,
    /// Take this part of every frame
    #[arg(long, value_name = "WxH+X+Y", value_parser = parse_crop)]
    pub(crate) crop: Option<CropRect>,
    /// Scale every frame by area, after cropping
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) resize: Option<(u32, u32)>,
    /// Range of the luma of video: as it was coded, where black is mostly 16 and white 235, or the
    /// full range, to which players and OpenCV expand it
    #[arg(long, value_enum, value_name = "RANGE", default_value = "coded")]
    pub(crate) luma: LumaChoice,
    /// Orientation of images and video: as they are stored, or upright, as the EXIF data and the
    /// marks of phones say
    #[arg(long, value_enum, value_name = "HOW", default_value = "stored")]
    pub(crate) orientation: OrientationChoice,
    /// Video stream that is read of a file with several, from 0. Without it, the stream that
    /// players take is read, and other streams are named
    #[arg(long, value_name = "N")]
    pub(crate) video_stream: Option<usize>,
    /// Read raw video of this size and pixel format, for example 640x480,gray16le, from a file, a
    /// pipe or -
    #[arg(long, value_name = "WxH,FORMAT", value_parser = RawLayout::parse)]
    pub(crate) raw: Option<RawLayout>,
    /// Colours of the upper left 2x2 pixels of a mosaic, row by row; grey images and raw video are
    /// then mosaics of a Bayer filter
    #[arg(long, value_enum, value_name = "PATTERN")]
    pub(crate) bayer: Option<BayerChoice>,
    /// File with the times of images or of raw video: one line per frame, which may also name its
    /// file
    #[arg(long, value_name = "FILE")]
    pub(crate) timestamps: Option<PathBuf>,
    /// Unit of the times in --timestamps
    #[arg(long, value_enum, value_name = "UNIT", default_value = "s", requires = "timestamps")]
    pub(crate) timestamp_unit: TimestampUnitChoice,
    /// Meaning of image files: frames of a clip, a set of unrelated images (sub-folders are
    /// labels), or CIFAR sheets with one image per row [default: clip; for `dataset`: set]
    #[arg(long, value_enum, value_name = "WHAT")]
    pub(crate) images: Option<ImagesChoice>,
    /// Labels of an IDX file, if they are not beside it
    #[arg(long, value_name = "FILE")]
    pub(crate) labels: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum LumaChoice {
    Coded,
    Full,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum OrientationChoice {
    Stored,
    Upright,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum BayerChoice {
    Rggb,
    Bggr,
    Grbg,
    Gbrg,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum TimestampUnitChoice {
    S,
    Ms,
    Us,
    Ns,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum ImagesChoice {
    Clip,
    Set,
    CifarSheet,
}

/// Refuses inputs that are several clips, for a command that takes one.
pub(crate) fn refuse_several_clips<P: AsRef<Path>>(
    inputs: &[P],
    options: &InputOptions,
) -> Result<(), CliError> {
    let ClipPlan::Batch(clips) = plan(inputs, options)? else { return Ok(()) };
    let first = clips[0].inputs[0].display();
    Err(CliError::Usage(format!(
        "the inputs are {} clips, and this command takes one; name one of them, for example `{first}`",
        clips.len()
    )))
}

/// Refuses an output folder that cannot be written, or whose replacement by `--force` would delete
/// one of the inputs. `kind` is the kind of the folders that may be replaced.
pub(crate) fn check_output<P: AsRef<Path>>(
    folder: &Path,
    kind: FolderKind,
    force: bool,
    inputs: &[P],
) -> Result<(), CliError> {
    StagedFolder::check(folder, kind, force)?;
    let Ok(folder) = folder.canonicalize() else { return Ok(()) };
    let is_within = |input: &Path| {
        // The last part of an input may be a pattern.
        let own = input.canonicalize().or_else(|_| match input.parent() {
            Some(above) if !above.as_os_str().is_empty() => above.canonicalize(),
            _ => Err(std::io::ErrorKind::NotFound.into()),
        });
        own.is_ok_and(|own| own.starts_with(&folder))
    };
    match inputs.iter().map(AsRef::as_ref).find(|input| is_within(input)) {
        None => Ok(()),
        Some(input) => Err(CliError::Usage(format!(
            "`{}` lies in the folder `{}`, which --force would replace with everything in it; choose \
             another folder for --output",
            input.display(),
            folder.display()
        ))),
    }
}

/// Warns the user about inputs that can be read, but perhaps not as they were meant.
pub(crate) fn warn_about_inputs<P: AsRef<Path>>(inputs: &[P], options: &InputOptions) {
    for sentence in input_warnings(inputs, options) {
        notice::print_warning(&sentence);
    }
}

impl InputArgs {
    /// Returns the options for reading inputs. `images` is the meaning of image files if `--images`
    /// is not given.
    pub(crate) fn options(&self, images: ImageRelation) -> InputOptions {
        InputOptions {
            frames: self.max_frames,
            frame_rate: self.rate,
            selection: FrameSelection {
                start_us: self.start,
                end_us: self.end,
                rate: self.input_fps,
            },
            crop: self.crop,
            resize: self.resize,
            luma: match self.luma {
                LumaChoice::Coded => LumaRange::Coded,
                LumaChoice::Full => LumaRange::Full,
            },
            orientation: match self.orientation {
                OrientationChoice::Stored => Orientation::Stored,
                OrientationChoice::Upright => Orientation::Upright,
            },
            video_stream: self.video_stream,
            raw: self.raw,
            bayer: self.bayer.map(BayerChoice::pattern),
            timestamps: self
                .timestamps
                .clone()
                .map(|path| TimestampsFile { path, unit: self.timestamp_unit.unit() }),
            images: match self.images {
                None => images,
                Some(ImagesChoice::Clip) => ImageRelation::Clip,
                Some(ImagesChoice::Set) => ImageRelation::Set,
                Some(ImagesChoice::CifarSheet) => ImageRelation::CifarSheet,
            },
            labels: self.labels.clone(),
            numbered: false,
            interrupt: interrupt::stop_request(),
            warnings: InputWarnings::of_process(),
        }
    }
}

impl BayerChoice {
    fn pattern(self) -> BayerPattern {
        match self {
            Self::Rggb => BayerPattern::Rggb,
            Self::Bggr => BayerPattern::Bggr,
            Self::Grbg => BayerPattern::Grbg,
            Self::Gbrg => BayerPattern::Gbrg,
        }
    }
}

impl TimestampUnitChoice {
    fn unit(self) -> TimestampUnit {
        match self {
            Self::S => TimestampUnit::Seconds,
            Self::Ms => TimestampUnit::Milliseconds,
            Self::Us => TimestampUnit::Microseconds,
            Self::Ns => TimestampUnit::Nanoseconds,
        }
    }
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |part: &str| part.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    text.split_once('x')
        .and_then(|(width, height)| Some((side(width)?, side(height)?)))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT, each 1 to {MAX_SIDE}, for example 640x360"))
}

fn parse_crop(text: &str) -> Result<CropRect, String> {
    let wrong = || "expected WIDTHxHEIGHT+X+Y, for example 320x240+16+0".to_owned();
    let mut parts = text.split('+');
    let size = parts.next().and_then(|size| parse_size(size).ok()).ok_or_else(wrong)?;
    let mut next = || parts.next().and_then(|part| part.parse().ok());
    let at = next().zip(next()).ok_or_else(wrong)?;
    if parts.next().is_some() { Err(wrong()) } else { Ok(CropRect { size, origin: at }) }
}

/// The arguments of frames and packets, which are read from standard input if they are `-`.
const STREAMS: [&str; 4] = ["inputs", "input", "stream", "clip"];

/// The arguments of a configuration.
const CONFIGS: [&str; 2] = ["config", "file"];

/// Refuses `--config -` beside frames or packets from standard input, because the configuration
/// would leave nothing for them.
pub(crate) fn refuse_second_reader(
    command: &mut Command,
    matches: &ArgMatches,
) -> Result<(), Error> {
    let Some((name, given)) = matches.subcommand() else { return Ok(()) };
    let is_standard_input = |id: &str| {
        let mut values = given.try_get_raw(id).ok().flatten().into_iter().flatten();
        values.any(|value| value == "-")
    };
    let any_is = |ids: &[&str]| ids.iter().any(|id| is_standard_input(id));
    if !any_is(&CONFIGS) || !any_is(&STREAMS) {
        return Ok(());
    }
    let command = command.find_subcommand_mut(name).expect("this subcommand was parsed");
    let problem = "standard input can be read only once, so `--config -` and `-` exclude each other; write the \
                   configuration into a file and name that";
    Err(command.error(ErrorKind::ArgumentConflict, problem))
}
