// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arguments of a function over footage from Python: inputs, which are footage by its name or frames
//! as arrays, a camera, and the options by which inputs are read.

use std::ffi::CString;
use std::path::PathBuf;

use foveate_design::{Design, DesignConfig};
use foveate_media::{
    BayerPattern, ClipPlan, ClipPlayer, CropRect, FrameRate, ImageRelation, InputOptions,
    InputWarnings, LumaRange, Orientation, PlayedFrame, RawLayout, RunMonitor, SourceKind,
    TimestampUnit, TimestampsFile, parse_time, plan, skipped_in_words, source_from_memory,
};
use foveate_pixels::ByteFrame;
use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::{PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat};

use crate::array::untyped;
use crate::config;
use crate::error::{raise, value_error};
use crate::frame::Grey;
use crate::work::{CancelFlag, interruptible};

/// The similarity of two names, 0 to 1, from which on one is probably meant by the other.
const ALIKE: f64 = 0.8;

/// The arguments of a function over footage.
pub(crate) struct ClipRequest {
    /// The name of the function, for messages.
    function: &'static str,
    pub(crate) config: DesignConfig,
    pub(crate) options: InputOptions,
    pub(crate) inputs: ClipInputs,
}

/// The inputs of a function that takes footage or arrays.
pub(crate) enum ClipInputs {
    Paths(Vec<PathBuf>),
    Frames(Vec<ByteFrame>),
}

impl ClipRequest {
    /// Reads the arguments of a function whose other options have the names `own`. Warns of files and
    /// folders that are not read although they might have been meant.
    pub(crate) fn new(
        (function, own): (&'static str, &[&str]),
        inputs: &Bound<'_, PyAny>,
        camera: Option<&Bound<'_, PyAny>>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let py = inputs.py();
        let options = input_options(function, own, options)?;
        let config = config::read(camera, None)?;
        let inputs = ClipInputs::of(function, inputs, config.camera.frame.pixel_bits)?;
        if let ClipInputs::Paths(paths) = &inputs {
            let skipped = py.detach(|| skipped_in_words(paths, &options));
            skipped.into_iter().try_for_each(|sentence| warn(py, sentence, 1))?;
        }
        Ok(Self { function, config, options, inputs })
    }

    /// Opens the inputs as one clip or set, and gives frames from arrays away. Several clips are refused.
    pub(crate) fn open(&mut self) -> PyResult<ClipPlayer> {
        let Self { config, options, inputs, .. } = self;
        let paths = match inputs {
            ClipInputs::Paths(paths) => paths,
            ClipInputs::Frames(frames) => {
                let frames = std::mem::take(frames);
                return Ok(source_from_memory("array", frames, options).map_err(raise)?.into());
            }
        };
        match plan(paths, options).map_err(raise)? {
            ClipPlan::One => ClipPlayer::open(paths, &config.camera, options).map_err(raise),
            ClipPlan::Batch(clips) => Err(value_error(format!(
                "the inputs are {} clips; take them one after the other",
                clips.len()
            ))),
        }
    }

    /// Opens the inputs as a clip. A set of unrelated images is refused.
    pub(crate) fn open_clip(&mut self) -> PyResult<ClipPlayer> {
        let player = self.open()?;
        match player.kind() {
            SourceKind::Clip => Ok(player),
            SourceKind::Set => Err(value_error(format!(
                "images of a set do not follow one another; {function} needs a clip",
                function = self.function
            ))),
        }
    }

    /// Makes something of the design for a clip, and shows it every frame, until Ctrl-C. Warns of the
    /// error that ended the footage before its end.
    pub(crate) fn show_to<T: Send>(
        mut self,
        py: Python<'_>,
        make: impl FnOnce(&Design) -> PyResult<T> + Send,
        mut show: impl FnMut(&mut T, &PlayedFrame) -> PyResult<()> + Send,
    ) -> PyResult<T> {
        let (made, problem) = interruptible(py, |cancel| -> PyResult<_> {
            let mut player = self.open_clip()?;
            let (width, height) = player.size();
            let design = self.config.validate_for_frames(width, height).map_err(raise)?;
            let mut made = make(&design)?;
            let hooks = CancelFlag(cancel);
            let monitor = RunMonitor::of_frames(&hooks, player.frames());
            for frame in monitor.watch(&mut player) {
                show(&mut made, &frame.map_err(raise)?)?;
            }
            Ok((made, problem_text(&player)))
        })??;
        warn_of_problem(py, problem)?;
        Ok(made)
    }
}

impl ClipInputs {
    /// Returns footage by its name, or frames from arrays for a design of some bits per pixel.
    fn of(function: &str, inputs: &Bound<'_, PyAny>, bits: u32) -> PyResult<Self> {
        match paths(inputs) {
            // An empty list has no frames either.
            Ok(paths) if !paths.is_empty() => return Ok(Self::Paths(paths)),
            _ => {}
        }
        let wrong = |what: String| {
            PyTypeError::new_err(format!(
                "{function} takes footage, which is a path, a pattern, scene:NAME or a list of these, or frames, which \
                 are an array of shape (frames, height, width) or a list of arrays (height, width); not {what}"
            ))
        };
        let kind = inputs.get_type().name()?;
        // A sequence that NumPy does not know is converted to an array first.
        let is_clip = !inputs.hasattr("__iter__")? && inputs.hasattr("__dlpack__")?;
        let clip =
            is_clip.then(|| untyped(inputs, "a clip is an array of shape (frames, height, width)"));
        let clip = clip.transpose()?;
        let inputs = clip.as_ref().map_or(inputs, |clip| clip.as_any());
        let frames = inputs.try_iter().map_err(|_| wrong(kind.to_string()))?;
        let mut rasters: Vec<ByteFrame> = Vec::new();
        for frame in frames {
            let frame = frame?;
            let array = untyped(&frame, "a frame is a 2-D array of grey pixels (height, width)");
            let array = match array {
                Err(_) if !frame.hasattr("shape")? => {
                    return Err(wrong(format!("a {kind} of {}", frame.get_type().name()?)));
                }
                array => array?,
            };
            if array.ndim() != 2 {
                let what = format!("a {kind} of arrays of shape {}", array.getattr("shape")?);
                return Err(wrong(what));
            }
            rasters.push(Grey::of(&frame, bits)?.raster(bits)?);
        }
        Ok(Self::Frames(rasters))
    }
}

/// Returns inputs as paths: one, or a list of several.
pub(crate) fn paths(inputs: &Bound<'_, PyAny>) -> PyResult<Vec<PathBuf>> {
    if let Ok(path) = inputs.extract::<PathBuf>() {
        return Ok(vec![path]);
    }
    let kind = inputs.get_type().name()?;
    inputs.extract::<Vec<PathBuf>>().map_err(|_| {
        PyTypeError::new_err(format!(
            "inputs are a path, a pattern or scene:NAME, or a list of these, not {kind}"
        ))
    })
}

/// Returns the error that ended a clip before its end, with the names of its inputs.
pub(crate) fn problem_text(player: &ClipPlayer) -> Option<String> {
    let problem = player.problem()?;
    Some(format!("{}: {problem}", player.inputs().join(", ")))
}

/// Warns of the error that ended a clip before its end, if there is one, and of what was found while
/// inputs were read.
pub(crate) fn warn_of_problem(py: Python<'_>, problem: Option<String>) -> PyResult<()> {
    let found = InputWarnings::of_process().take().into_iter().chain(problem);
    found.into_iter().try_for_each(|sentence| warn(py, sentence, 1))
}

/// Warns the caller that is this many calls above.
pub(crate) fn warn(py: Python<'_>, sentence: String, level: i32) -> PyResult<()> {
    let text = CString::new(sentence).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, level)
}

/// Returns the names of a group of options, which Python's part of the package lists.
pub(crate) fn option_names(py: Python<'_>, group: &str) -> PyResult<Vec<String>> {
    let options = py.import("foveate._options")?.getattr(group)?.getattr("__annotations__")?;
    options.try_iter()?.map(|name| name?.extract()).collect()
}

/// Returns the options of inputs. `own` are the other options of `function`, which have been removed already.
fn input_options(
    function: &str,
    own: &[&str],
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<InputOptions> {
    let mut found =
        InputOptions { warnings: InputWarnings::of_process(), ..InputOptions::default() };
    let Some(options) = options else { return Ok(found) };
    let all = option_names(options.py(), "InputOptions")?;
    for (name, value) in options.iter() {
        let name: String = name.extract()?;
        if !all.contains(&name) {
            return Err(unknown(function, own, &all, &name));
        }
        if !value.is_none() {
            set(&mut found, &name, &value)?;
        }
    }
    if found.timestamps.as_ref().is_some_and(|file| file.path.as_os_str().is_empty()) {
        return Err(PyTypeError::new_err(format!(
            "{function}: timestamp_unit is the unit of timestamps, which are not given"
        )));
    }
    Ok(found)
}

/// Returns the error for an unknown option, with the known ones.
fn unknown(function: &str, own: &[&str], input: &[String], name: &str) -> PyErr {
    let names: Vec<&str> = own.iter().copied().chain(input.iter().map(String::as_str)).collect();
    let alike = names.iter().map(|other| (strsim::jaro_winkler(other, name), other));
    let meant =
        alike.filter(|(alike, _)| *alike > ALIKE).max_by(|one, two| one.0.total_cmp(&two.0));
    let meant = meant.map(|(_, other)| format!(", but {other}")).unwrap_or_default();
    PyTypeError::new_err(format!(
        "{function} has no option {name}{meant}; its options are {}",
        names.join(", ")
    ))
}

/// Writes a number without an exponent, with at most six decimal places.
fn decimal_text(number: f64) -> String {
    let text = format!("{number:.6}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

fn set(found: &mut InputOptions, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    // Six decimal places are all that times and rates have.
    let text = || -> PyResult<String> {
        match value.cast::<PyFloat>() {
            Ok(number) => Ok(decimal_text(number.value())),
            Err(_) => Ok(value.str()?.to_string()),
        }
    };
    let wrong = |problem: String| PyValueError::new_err(format!("{name} = {value}: {problem}"));
    let times = || TimestampsFile { path: PathBuf::new(), unit: TimestampUnit::default() };
    match name {
        "max_frames" => {
            let frames = value.extract().ok().filter(|&frames: &u32| frames > 0);
            found.frames = Some(frames.ok_or_else(|| wrong("expected a number from 1 on".into()))?);
        }
        "rate" => found.frame_rate = FrameRate::parse(&text()?).map_err(wrong)?,
        "input_fps" => {
            found.selection.rate = Some(FrameRate::parse(&text()?).map_err(wrong)?);
        }
        "start" => found.selection.start_us = Some(parse_time(&text()?).map_err(wrong)?),
        "end" => found.selection.end_us = Some(parse_time(&text()?).map_err(wrong)?),
        "crop" => {
            let (width, height, x, y) = value
                .extract()
                .map_err(|_| wrong("expected (width, height, x, y) in pixels".into()))?;
            found.crop = Some(CropRect { size: (width, height), origin: (x, y) });
        }
        "resize" => {
            let size = value.extract().ok().filter(|&(width, height): &(u32, u32)| {
                let sides = 1..=foveate_media::MAX_SIDE;
                sides.contains(&width) && sides.contains(&height)
            });
            found.resize = Some(size.ok_or_else(|| {
                wrong(format!("expected (width, height), each 1 to {}", foveate_media::MAX_SIDE))
            })?);
        }
        "luma" => {
            found.luma = match text()?.as_str() {
                "coded" => LumaRange::Coded,
                "full" => LumaRange::Full,
                _ => return Err(wrong("expected \"coded\" or \"full\"".into())),
            };
        }
        "orientation" => {
            found.orientation = match text()?.as_str() {
                "stored" => Orientation::Stored,
                "upright" => Orientation::Upright,
                _ => return Err(wrong("expected \"stored\" or \"upright\"".into())),
            };
        }
        "video_stream" => {
            let number =
                value.extract().map_err(|_| wrong("expected a number from 0 on".into()))?;
            found.video_stream = Some(number);
        }
        "raw" => found.raw = Some(RawLayout::parse(&text()?).map_err(wrong)?),
        "bayer" => {
            let name = text()?;
            let pattern = BayerPattern::ALL.into_iter().find(|pattern| pattern.name() == name);
            let names = "expected \"rggb\", \"bggr\", \"grbg\" or \"gbrg\"";
            found.bayer = Some(pattern.ok_or_else(|| wrong(names.into()))?);
        }
        "timestamps" => found.timestamps.get_or_insert_with(times).path = value.extract()?,
        "timestamp_unit" => {
            let symbol = text()?;
            let unit = TimestampUnit::ALL.into_iter().find(|unit| unit.symbol() == symbol);
            let unit = unit.ok_or_else(|| wrong("expected \"s\", \"ms\", \"us\" or \"ns\"".into()));
            found.timestamps.get_or_insert_with(times).unit = unit?;
        }
        "images" => {
            found.images = match text()?.as_str() {
                "clip" => ImageRelation::Clip,
                "set" => ImageRelation::Set,
                "cifar-sheet" => ImageRelation::CifarSheet,
                _ => return Err(wrong("expected \"clip\", \"set\" or \"cifar-sheet\"".into())),
            };
        }
        "labels" => found.labels = Some(value.extract()?),
        _ => unreachable!("every option of inputs is above"),
    }
    Ok(())
}
