// SPDX-License-Identifier: MIT OR Apache-2.0
//! Options by name: which of them a function has, and which one was probably meant by an unknown name.

use foveate_media::{
    BayerPattern, CropRect, FrameRate, ImageRelation, InputOptions, InputWarnings, LumaRange,
    Orientation, RawLayout, TimestampUnit, TimestampsFile, parse_time,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat};

/// The options of all functions that read footage, by their names on the command line.
const INPUT: [&str; 16] = [
    "max_frames",
    "input_fps",
    "rate",
    "start",
    "end",
    "crop",
    "resize",
    "luma",
    "orientation",
    "video_stream",
    "raw",
    "bayer",
    "timestamps",
    "timestamp_unit",
    "images",
    "labels",
];
/// The similarity of two names, 0 to 1, from which on one is probably meant by the other.
const ALIKE: f64 = 0.8;

/// Returns the options of inputs. `own` are the other options of `function`, which have been removed already.
pub(crate) fn input_options(
    function: &str,
    own: &[&str],
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<InputOptions> {
    let mut found =
        InputOptions { warnings: InputWarnings::of_process(), ..InputOptions::default() };
    let Some(options) = options else { return Ok(found) };
    for (name, value) in options.iter() {
        let name: String = name.extract()?;
        if !INPUT.contains(&name.as_str()) {
            return Err(unknown(function, own, &name));
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

/// Refuses an option that a function of the Python files does not have.
#[pyfunction]
pub(crate) fn refuse_option(function: &str, name: &str) -> PyResult<()> {
    let own: &[&str] = match function {
        "infer" => &crate::inference::OWN,
        "fidelity" => &["ideal"],
        "pixel_events" => &crate::pixel_events::OWN,
        _ => &["frame", "region"],
    };
    Err(unknown(function, own, name))
}

/// Returns the error for an unknown option, with the known ones.
fn unknown(function: &str, own: &[&str], name: &str) -> PyErr {
    let all = || own.iter().chain(&INPUT);
    let alike = all().map(|other| (strsim::jaro_winkler(other, name), other));
    let meant =
        alike.filter(|(alike, _)| *alike > ALIKE).max_by(|one, two| one.0.total_cmp(&two.0));
    let meant = meant.map(|(_, other)| format!(", but {other}")).unwrap_or_default();
    let names: Vec<&str> = all().copied().collect();
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
        "timestamps" => {
            let unit = found.timestamps.take().map(|file| file.unit).unwrap_or_default();
            found.timestamps = Some(TimestampsFile { path: value.extract()?, unit });
        }
        "timestamp_unit" => {
            let symbol = text()?;
            let unit = TimestampUnit::ALL.into_iter().find(|unit| unit.symbol() == symbol);
            let unit =
                unit.ok_or_else(|| wrong("expected \"s\", \"ms\", \"us\" or \"ns\"".into()))?;
            let path = found.timestamps.take().map(|file| file.path).unwrap_or_default();
            found.timestamps = Some(TimestampsFile { path, unit });
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
        _ => unreachable!("every name of INPUT is above"),
    }
    Ok(())
}
