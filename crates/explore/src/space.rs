// SPDX-License-Identifier: MIT OR Apache-2.0
//! A space of designs, as a file defines it: the start, the ideal camera, and the axes.

use foveate_camera::{CameraConfig, ConfigError};
use foveate_design::{Config, Preset};
use serde::Deserialize;
use toml::{Table, Value};

use crate::ExploreError;
use crate::method::{Axis, MAX_POINTS, Method};

/// A space of designs.
#[derive(Clone, Debug)]
pub struct Space {
    /// The configuration from which every point starts.
    pub(crate) start: Start,
    /// The ideal camera that designs are compared with; it computes in floating point over whole
    /// frames.
    pub ideal: CameraConfig,
    /// The axes, in the order of the file.
    pub axes: Vec<Axis>,
    /// The method that chooses the combinations.
    pub method: Method,
    /// The clock of all designs in MHz, if it is known; otherwise it is estimated for each design.
    pub clock_mhz: Option<u32>,
}

/// A configuration as TOML without the keys that it leaves out, so that a point can change it.
#[derive(Clone, Debug)]
pub(crate) struct Start(String);

impl Start {
    /// Returns the configuration with overrides, each `key=TOML_VALUE`. Thresholds of the start are
    /// scaled to an overridden depth; overridden thresholds are in grey levels of the new depth.
    pub(crate) fn with(&self, overrides: &[String]) -> Result<Config, ConfigError> {
        Config::from_toml_with(&self.0, overrides)
    }

    /// Returns the configuration with overrides, with all thresholds, also overridden ones, in grey
    /// levels of the start.
    pub(crate) fn with_its_levels(&self, overrides: &[String]) -> Result<Config, ConfigError> {
        let (depth, others): (Vec<String>, Vec<String>) =
            overrides.iter().cloned().partition(|text| text.starts_with("frame.pixel_bits="));
        Self(self.with(&others)?.to_toml()).with(&depth)
    }
}

/// A space that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// The name on the command line.
    pub name: &'static str,
    /// The purpose in one line.
    pub summary: &'static str,
    /// The content of the file.
    pub toml: &'static str,
}

/// The spaces that come with the program.
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

/// The file of a space, as it is written.
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
    /// Fails if the text is not TOML, has an unknown key, or has a value of the wrong type or out
    /// of range, or if the start or the ideal camera is not a valid design.
    pub fn from_toml(text: &str) -> Result<Self, ExploreError> {
        let file: File = toml::from_str(text).map_err(|error| {
            let place = error.to_string().lines().next().unwrap_or_default().to_owned();
            wrong(format!("{} ({place})", error.message().replace('\n', "; ")))
        })?;
        let preset = Preset::find(file.preset.as_deref().unwrap_or("paper"))?.toml;
        let section = |name| move |error| ExploreError::Section { section: name, error };
        // The start alone need not be a valid design: this depends on the size of the clips and on
        // the axes.
        let start = Config::from_toml_with(preset, &overrides(&file.design));
        let start = Start(start.map_err(section("design"))?.to_toml());
        // The ideal camera does not depend on the hardware.
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
    /// Refuses an unknown key: every point with it would be refused for the same reason.
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

/// Formats a value for people and tables: a string without quotes, anything else as in TOML.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Returns an error of the file that is not an error of a configuration.
fn wrong(problem: String) -> ExploreError {
    ExploreError::Space { problem }
}

/// Converts a table of a configuration to overrides; an array is a value.
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

/// Reads the axes: every array is a list of values.
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
