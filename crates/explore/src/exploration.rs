// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of an exploration as data: for the JSON file next to the tables, and for the page.

use serde::Serialize;

use crate::objective::{FrontObjectives, Objective};
use crate::point::settings_text;
use crate::{DesignRow, RefusedCombination};

/// The results of an exploration.
#[derive(Clone, Debug, Serialize)]
pub struct Exploration {
    /// The version of the JSON format; it changes if a field changes its meaning or is removed.
    pub format_version: u32,
    /// The name and version of the program.
    pub program: String,
    /// The clips, with their numbers of frames.
    pub clips: Vec<ClipRow>,
    /// The width and height of a frame in pixels.
    pub size: (u32, u32),
    /// The disturbance of the frames that the designs saw, as `name=value`, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<String>,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
    /// The ideal camera that designs are compared with, as TOML.
    pub ideal: String,
    /// The clock of the frame rates in MHz, if the space gives one; otherwise each design has its own
    /// clock. In a process no design has a clock above the highest one of its cells.
    pub clock_mhz: Option<u32>,
    /// The name of the library of cells in which designs were measured, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// The frames per second of powers, if energies were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_rate: Option<f64>,
    /// The rate in bits per second of the link behind all designs, if the space gives one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub link_bits_per_second: Option<u64>,
    /// The keys of the configuration that vary.
    pub axes: Vec<String>,
    /// The points, each with its figures.
    pub rows: Vec<DesignRow>,
    /// The combinations that are not valid designs.
    pub refused: Vec<RefusedCombination>,
    /// The problems: clips that ended early, and designs that could not be synthesized, mapped to cells or
    /// simulated as gates, with the reasons.
    pub problems: Vec<String>,
}

impl Exploration {
    /// Returns the objectives of the fronts of area and of all.
    pub(crate) fn front_objectives(&self) -> FrontObjectives {
        FrontObjectives::of_rows(&self.rows, self.library.is_some())
    }

    /// Returns the figures of the front of all, for a sentence: `error, speed and area`.
    #[must_use]
    pub fn front_figures(&self) -> &'static str {
        let FrontObjectives { area, has_areas, .. } = self.front_objectives();
        match (has_areas, area) {
            (false, _) => "error and speed",
            (true, Objective::Mm2) => "error, speed and area in mm²",
            (true, _) => "error, speed and area in LUTs",
        }
    }

    /// Returns the settings of a point as `key = value`.
    #[must_use]
    pub fn settings_text(&self, row: &DesignRow) -> String {
        settings_text(self.axes.iter().map(String::as_str), &row.settings)
    }
}

/// A clip of an exploration.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ClipRow {
    /// The name of the clip.
    pub name: String,
    /// The number of frames of the clip.
    pub frames: u64,
}
