// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an exploration found, as data: the JSON beside the tables, and what the page shows.

use serde::Serialize;

use crate::point::described;
use crate::{DesignRow, Refused};

/// What an exploration found.
#[derive(Clone, Debug, Serialize)]
pub struct Exploration {
    /// Version of this as JSON; changes when a field changes its meaning or goes.
    pub format_version: u32,
    /// The program.
    pub program: String,
    /// Clips with their frames.
    pub clips: Vec<ClipRow>,
    /// Width and height of a frame.
    pub size: (u32, u32),
    /// The camera that designs are compared with, as TOML.
    pub ideal: String,
    /// Clock of the frame rates in MHz, if the space gives one; else each design has its estimated one.
    pub clock_mhz: Option<u32>,
    /// Keys of the configuration that vary.
    pub axes: Vec<String>,
    /// The points.
    pub rows: Vec<DesignRow>,
    /// Combinations that are no design.
    pub refused: Vec<Refused>,
    /// Clips that ended before their end and designs that Yosys did not synthesize, and why.
    pub problems: Vec<String>,
}

impl Exploration {
    /// What a point sets, as `key = value`.
    #[must_use]
    pub fn described(&self, row: &DesignRow) -> String {
        described(self.axes.iter().map(String::as_str), &row.settings)
    }
}

/// A clip of an exploration.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ClipRow {
    /// Its name.
    pub name: String,
    /// Its frames.
    pub frames: u64,
}
