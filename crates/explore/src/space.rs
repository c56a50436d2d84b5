// SPDX-License-Identifier: MIT OR Apache-2.0
//! A space of designs, as a file defines it: the start, the ideal camera, and the axes.

use crate::link::LinkRate;
use foveate_camera::{CameraConfig, ConfigError};
use foveate_design::{DesignConfig, Preset};
use serde::Deserialize;
use toml::{Table, Value};

use crate::ExploreError;
use crate::method::{MAX_POINTS, SamplingMethod, SpaceAxis};

/// A space of designs.
#[derive(Clone, Debug)]
pub struct DesignSpace {
    /// The configuration from which every point starts.
    pub(crate) start: StartConfig,
    /// The ideal camera that designs are compared with; it computes in floating point over whole
    /// frames.
    pub ideal: CameraConfig,
    /// The axes, in the order of the file.
    pub axes: Vec<SpaceAxis>,
    /// The method that chooses the combinations.
    pub method: SamplingMethod,
    /// The clock of all designs in MHz, if it is known; otherwise it is estimated for each design.
    pub clock_mhz: Option<u32>,
    /// The rate of a link behind all designs. With it, the load of each design is measured.
    pub link: Option<LinkRate>,
}

/// A configuration as TOML without the keys that it leaves out, so that a point can change it.
#[derive(Clone, Debug)]
pub(crate) struct StartConfig(String);

impl StartConfig {
    /// Returns the configuration with overrides, each `key=TOML_VALUE`. Thresholds of the start are
    /// scaled to an overridden depth; overridden thresholds are in grey levels of the new depth.
    pub(crate) fn with_overrides(&self, overrides: &[String]) -> Result<DesignConfig, ConfigError> {
        DesignConfig::from_toml_with(&self.0, overrides)
    }

    /// Returns the configuration with overrides, with all thresholds, also overridden ones, in grey
    /// levels of the start.
    pub(crate) fn with_overrides_in_start_levels(
        &self,
        overrides: &[String],
    ) -> Result<DesignConfig, ConfigError> {
        let (depth, others): (Vec<String>, Vec<String>) =
            overrides.iter().cloned().partition(|text| text.starts_with("frame.pixel_bits="));
        Self(self.with_overrides(&others)?.to_toml()).with_overrides(&depth)
    }
}

/// A space that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct BuiltInSpace {
    /// The name on the command line.
    pub name: &'static str,
    /// The purpose in one line.
    pub summary: &'static str,
    /// The content of the file.
    pub toml: &'static str,
}

/// The spaces that come with the program.
pub const BUILT_IN_SPACES: &[BuiltInSpace] = &[
    BuiltInSpace {
        name: "approximations",
        summary: "the error that each approximation of the hardware causes, one at a time",
        toml: include_str!("../spaces/approximations.toml"),
    },
    BuiltInSpace {
        name: "designs",
        summary: "organizations, folds, pixel bits, windows and denoising, each with each",
        toml: include_str!("../spaces/designs.toml"),
    },
    BuiltInSpace {
        name: "periphery",
        summary: "means of irrelevant regions: blocks, level and minimum score against bytes",
        toml: include_str!("../spaces/periphery.toml"),
    },
];

/// The file of a space, as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SpaceFile {
    preset: Option<String>,
    method: Option<String>,
    points: Option<usize>,
    seed: Option<u64>,
    clock_mhz: Option<u32>,
    link: Option<String>,
    #[serde(default)]
    design: Table,
    #[serde(default)]
    ideal: Table,
    #[serde(default)]
    vary: Table,
}

impl DesignSpace {
    /// Reads a space.
    ///
    /// # Errors
    /// Fails if the text is not TOML, has an unknown key, or has a value of the wrong type or out
    /// of range, or if the start or the ideal camera is not a valid design.
    pub fn from_toml(text: &str) -> Result<Self, ExploreError> {
        let file: SpaceFile = toml::from_str(text).map_err(|error| {
            let place = error.to_string().lines().next().unwrap_or_default().to_owned();
            space_error(format!("{} ({place})", error.message().replace('\n', "; ")))
        })?;
        let preset = Preset::find(file.preset.as_deref().unwrap_or("paper"))?.toml;
        let section = |name| move |error| ExploreError::InvalidSection { section: name, error };
        // The start alone need not be a valid design: this depends on the size of the clips and on
        // the axes.
        let start = DesignConfig::from_toml_with(preset, &table_overrides(&file.design));
        let start = StartConfig(start.map_err(section("design"))?.to_toml());
        // The ideal camera does not depend on the hardware.
        let ideal =
            start.with_overrides(&table_overrides(&file.ideal)).map_err(section("ideal"))?;
        let ideal = ideal.camera;
        ideal.validate().map_err(section("ideal"))?;
        let axes = read_axes("", &file.vary)?;
        let method = SamplingMethod::parse(file.method.as_deref(), file.points, file.seed)
            .map_err(space_error)?;
        if let Some(clock_mhz) = file.clock_mhz.filter(|mhz| !(1..=10_000).contains(mhz)) {
            return Err(space_error(format!("clock_mhz = {clock_mhz} is not within 1 to 10000")));
        }
        let link = file.link.as_deref().map(|text| {
            let rate = LinkRate::parse(text);
            rate.map_err(|problem| space_error(format!("link = \"{text}\": {problem}")))
        });
        let link = link.transpose()?;
        let space = Self { start, ideal, axes, method, clock_mhz: file.clock_mhz, link };
        match space.method.count(&space.axes) {
            Some(count) if count <= MAX_POINTS => {
                space.axes.iter().try_for_each(|axis| axis.check_key(&space.start)).map(|()| space)
            }
            _ => Err(space_error(format!(
                "it has more than {MAX_POINTS} points; use method = \"sample\" and points = 1000, or fewer values"
            ))),
        }
    }
}

impl SpaceAxis {
    /// Refuses an unknown key: every point with it would be refused for the same reason.
    fn check_key(&self, start: &StartConfig) -> Result<(), ExploreError> {
        let first = self.values.first().map(|value| format!("{}={value}", self.key));
        match start.with_overrides(first.as_slice()) {
            Err(error @ ConfigError::UnknownKey { .. }) => {
                Err(ExploreError::InvalidSection { section: "vary", error })
            }
            _ => Ok(()),
        }
    }
}

/// Formats a value for people and tables: a string without quotes, anything else as in TOML.
pub(crate) fn plain_text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Returns an error of the file that is not an error of a configuration.
fn space_error(problem: String) -> ExploreError {
    ExploreError::Space { problem }
}

/// Converts a table of a configuration to overrides; an array is a value.
fn table_overrides(table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    visit_values("", table, &mut |key, value| found.push(format!("{key}={value}")));
    found
}

fn visit_values(above: &str, table: &Table, see: &mut impl FnMut(String, &Value)) {
    for (name, value) in table {
        let key = if above.is_empty() { name.clone() } else { format!("{above}.{name}") };
        match value {
            // Zones without keys are zones, too.
            Value::Table(inner) if !(inner.is_empty() && key == "zones") => {
                visit_values(&key, inner, see);
            }
            value => see(key, value),
        }
    }
}

fn read_axes(above: &str, table: &Table) -> Result<Vec<SpaceAxis>, ExploreError> {
    let mut found = Vec::new();
    let mut problem = None;
    visit_values(above, table, &mut |key, value| match value {
        Value::Array(values) if !values.is_empty() => {
            found.push(SpaceAxis { key, values: values.clone() });
        }
        other => {
            problem.get_or_insert(format!(
                "[vary] {key} = {other} is not a list of values, for example {key} = [{other}]"
            ));
        }
    });
    problem.map_or(Ok(found), |problem| Err(space_error(problem)))
}
