// SPDX-License-Identifier: MIT OR Apache-2.0
//! A space of designs as a file defines it: the start, the ideal camera, and what varies.

use foveate_camera::{CameraConfig, ConfigError};
use foveate_design::{Config, Preset};
use serde::Deserialize;
use toml::{Table, Value};

use crate::ExploreError;
use crate::method::{Axis, MAX_POINTS, Method};

/// Which designs to look at.
#[derive(Clone, Debug)]
pub struct Space {
    /// The configuration from which every point starts.
    pub(crate) start: Start,
    /// The camera with which designs are compared; it computes in floating point over whole frames.
    pub ideal: CameraConfig,
    /// What varies, in the order of the file.
    pub axes: Vec<Axis>,
    /// Which combinations are points.
    pub method: Method,
    /// The clock in MHz that designs run at, if it is known; else it is estimated for each.
    pub clock_mhz: Option<u32>,
}

/// A configuration as TOML, without the keys that it leaves out, so that a point can change it.
#[derive(Clone, Debug)]
pub(crate) struct Start(String);

impl Start {
    /// The configuration with overrides, each `key=TOML_VALUE`. Its thresholds follow an override of the
    /// depth; those that are overridden are in grey levels of the new one.
    pub(crate) fn with(&self, overrides: &[String]) -> Result<Config, ConfigError> {
        Config::from_toml_with(&self.0, overrides)
    }

    /// The same with thresholds in grey levels of the start, those that are overridden too.
    pub(crate) fn with_its_levels(&self, overrides: &[String]) -> Result<Config, ConfigError> {
        let (depth, others): (Vec<String>, Vec<String>) =
            overrides.iter().cloned().partition(|text| text.starts_with("frame.pixel_bits="));
        Self(self.with(&others)?.to_toml()).with(&depth)
    }
}

/// A space that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is for, in one line.
    pub summary: &'static str,
    /// The file.
    pub toml: &'static str,
}

/// Every space that comes with the program.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn {
        name: "approximations",
        summary: "what each approximation of the hardware costs in error, one at a time",
        toml: include_str!("../spaces/approximations.toml"),
    },
    BuiltIn {
        name: "designs",
        summary: "organizations, folds, pixel bits, windows and denoising against each other",
        toml: include_str!("../spaces/designs.toml"),
    },
    BuiltIn {
        name: "periphery",
        summary: "what irrelevant regions send: blocks, level and minimum score against bytes",
        toml: include_str!("../spaces/periphery.toml"),
    },
];

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    preset: Option<String>,
    method: Option<String>,
    points: Option<usize>,
    seed: Option<u64>,
    clock_mhz: Option<u32>,
    #[serde(default)]
    design: Table,
    #[serde(default)]
    ideal: Table,
    #[serde(default)]
    vary: Table,
}

impl Space {
    /// Reads a space.
    ///
    /// # Errors
    /// When the text is not TOML, has an unknown key, a value is of the wrong type or out of range, or
    /// the start or the ideal is not a valid design.
    pub fn from_toml(text: &str) -> Result<Self, ExploreError> {
        let file: File = toml::from_str(text).map_err(|error| {
            let place = error.to_string().lines().next().unwrap_or_default().to_owned();
            wrong(format!("{} ({place})", error.message().replace('\n', "; ")))
        })?;
        let preset = Preset::find(file.preset.as_deref().unwrap_or("paper"))?.toml;
        let section = |name| move |error| ExploreError::Section { section: name, error };
        // Whether it is a design depends on the size of the clips and on what varies.
        let start = Config::from_toml_with(preset, &overrides(&file.design));
        let start = Start(start.map_err(section("design"))?.to_toml());
        // What the ideal sees does not depend on how an array is built.
        let ideal = start.with(&overrides(&file.ideal)).map_err(section("ideal"))?;
        let ideal = ideal.camera;
        ideal.validate().map_err(section("ideal"))?;
        let axes = axes("", &file.vary)?;
        let method =
            Method::parse(file.method.as_deref(), file.points, file.seed).map_err(wrong)?;
        if let Some(clock_mhz) = file.clock_mhz.filter(|mhz| !(1..=10_000).contains(mhz)) {
            return Err(wrong(format!("clock_mhz = {clock_mhz} is not within 1 to 10000")));
        }
        let space = Self { start, ideal, axes, method, clock_mhz: file.clock_mhz };
        match space.method.count(&space.axes) {
            Some(count) if count <= MAX_POINTS => {
                space.axes.iter().try_for_each(|axis| axis.check(&space.start)).map(|()| space)
            }
            _ => Err(wrong(format!(
                "it has more than {MAX_POINTS} points; use method = \"sample\" and points = 1000, or fewer values"
            ))),
        }
    }
}

impl Axis {
    /// Refuses a key that is none: every point with it would be refused for the same reason.
    fn check(&self, start: &Start) -> Result<(), ExploreError> {
        let first = self.values.first().map(|value| format!("{}={value}", self.key));
        match start.with(first.as_slice()) {
            Err(error @ ConfigError::UnknownKey { .. }) => {
                Err(ExploreError::Section { section: "vary", error })
            }
            _ => Ok(()),
        }
    }
}

/// A value as people read it and as tables have it: a string without quotes, anything else as in TOML.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A problem of the file that is not one of a configuration.
fn wrong(problem: String) -> ExploreError {
    ExploreError::Space { problem }
}

/// A table of configuration as overrides: an array is a value.
fn overrides(table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    leaves("", table, &mut |key, value| found.push(format!("{key}={value}")));
    found
}

fn leaves(above: &str, table: &Table, see: &mut impl FnMut(String, &Value)) {
    for (name, value) in table {
        let key = if above.is_empty() { name.clone() } else { format!("{above}.{name}") };
        match value {
            Value::Table(inner) => leaves(&key, inner, see),
            value => see(key, value),
        }
    }
}

/// What varies: every array is a list of values.
fn axes(above: &str, table: &Table) -> Result<Vec<Axis>, ExploreError> {
    let mut found = Vec::new();
    let mut problem = None;
    leaves(above, table, &mut |key, value| match value {
        Value::Array(values) if !values.is_empty() => {
            found.push(Axis { key, values: values.clone() });
        }
        other => {
            problem.get_or_insert(format!(
                "[vary] {key} = {other} is not a list of values, for example {key} = [{other}]"
            ));
        }
    });
    problem.map_or(Ok(found), |problem| Err(wrong(problem)))
}
