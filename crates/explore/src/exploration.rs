// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of an exploration as data: for the JSON file next to the tables, and for the page.

use foveate_output::number_text::{counted, grouped};
use serde::Serialize;

use crate::objective::{FrontObjectives, Objective};
use crate::point::settings_text;
use crate::{DesignRow, FrontMembership, RefusedCombination};

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
    /// The clock of the frame rates in MHz, if the space gives one; otherwise each design has its
    /// own clock. In a process no design has a clock above the highest one of its cells.
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
    /// The problems: clips that ended early, and designs that could not be synthesized, mapped to
    /// cells or simulated as gates, with the reasons.
    pub problems: Vec<String>,
    /// The number of areas that are not known yet, while the exploration runs.
    #[serde(skip)]
    pub(crate) awaited_areas: usize,
}

impl Exploration {
    pub(crate) fn front_objectives(&self) -> FrontObjectives {
        FrontObjectives::of_rows(&self.rows, self.library.is_some())
    }

    /// Returns the fronts that have a point, each by rising error.
    #[must_use]
    pub fn fronts(&self) -> Vec<DesignFront<'_>> {
        let FrontObjectives { speed, area, .. } = self.front_objectives();
        let speed = match speed {
            Objective::PerClock => "Error against frames per clock",
            _ => "Error against frames per second",
        };
        let area = match area {
            Objective::Mm2 => "Error against mm²",
            _ => "Error against share of the device",
        };
        let front = |names, is_on: fn(&FrontMembership) -> bool| {
            DesignFront::new(names, self.rows.iter().filter(|row| is_on(&row.front)))
        };
        let mut fronts = vec![
            front(("area", area), |front| front.area),
            front(("speed", speed), |front| front.speed),
            front(("energy", "Error against energy"), |front| front.energy),
        ];
        fronts.retain(|front| !front.rows.is_empty());
        fronts
    }

    /// Returns a sentence about the designs that are on no front whatever their figures, and one
    /// about the combinations that cannot be built, if there are any.
    #[must_use]
    pub fn findings(&self) -> Vec<String> {
        let useless = self.rows.iter().filter(|row| !row.qualifies()).count();
        let useless = (useless > 0).then(|| {
            format!(
                "On no front, and hollow in the plots: {} of {} with more than 10 % of the active regions missed or \
                 more than 10 % false alarms.",
                grouped(useless as u64),
                counted(self.rows.len(), "design")
            )
        });
        let refused = self.refused.first().map(|first| {
            format!(
                "{} cannot be built, for example {}: {}. All reasons are in exploration.json.",
                counted(self.refused.len(), "combination"),
                first.settings,
                first.reason
            )
        });
        useless.into_iter().chain(refused).collect()
    }

    /// Returns the settings of a point as `key = value`.
    #[must_use]
    pub fn settings_text(&self, row: &DesignRow) -> String {
        settings_text(self.axes.iter().map(String::as_str), &row.settings)
    }
}

/// The front of the error and one other figure.
#[derive(Clone, Debug)]
pub struct DesignFront<'a> {
    /// The figure besides the error: `area`, `speed` or `energy`.
    pub name: &'static str,
    /// The two figures in words.
    pub title: &'static str,
    /// The points, by rising error.
    pub rows: Vec<&'a DesignRow>,
}

impl<'a> DesignFront<'a> {
    pub(crate) fn new(
        (name, title): (&'static str, &'static str),
        rows: impl Iterator<Item = &'a DesignRow>,
    ) -> Self {
        let mut rows: Vec<_> = rows.collect();
        rows.sort_by(|one, other| one.figures.action_flips.total_cmp(&other.figures.action_flips));
        Self { name, title, rows }
    }

    /// Returns the points that are named where not all of them can be: at most eight, with both
    /// ends and evenly spread between them.
    pub fn named_rows(&self) -> impl Iterator<Item = &'a DesignRow> {
        const NAMED: usize = 8;
        let (count, last) = (self.rows.len().min(NAMED), self.rows.len().saturating_sub(1));
        (0..count).map(move |index| self.rows[index * last / (count - 1).max(1)])
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
