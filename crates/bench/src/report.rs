// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a bench.

use foveate_cosim::Agreement;
use serde::Serialize;

/// Version of [`BenchReport`] as JSON; changes when a field changes its meaning or goes.
pub const FORMAT_VERSION: u32 = 2;

/// A level of the design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Whole frames, written to be read.
    FunctionalClear,
    /// Whole frames, written to be fast.
    FunctionalFast,
    /// Every port at every clock.
    Cycle,
    /// The Verilog.
    Rtl,
    /// What synthesis makes of it.
    Netlist,
}

/// All levels of one design, top down.
#[derive(Clone, Debug, Serialize)]
pub struct BenchReport {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// Fingerprint of the design.
    pub design: String,
    /// Its organization.
    pub organization: &'static str,
    /// Its regions.
    pub regions: u32,
    /// Pixels of a frame, side by side and one below the other.
    pub size: (u32, u32),
    /// Frames that the functional levels see.
    pub frames: u64,
    /// Frames that the levels with clocks see: those, and the last one again until everything has left.
    pub streamed: u64,
    /// Clocks that these take.
    pub clocks: u64,
    /// The processor's vector instructions that the fast levels use.
    pub instructions: String,
    /// One per level.
    pub rows: Vec<LevelRow>,
}

/// One level.
#[derive(Clone, Debug, Serialize)]
pub struct LevelRow {
    /// Which.
    pub level: Level,
    /// What runs there.
    pub name: String,
    /// What it came to, unless it could not run.
    pub measured: Option<Measured>,
    /// Why it could not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
}

/// What a level costs, and how far it agrees.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Measured {
    /// Frames per second.
    pub frames_per_second: f64,
    /// Clocks per second, where there are clocks.
    pub clocks_per_second: Option<f64>,
    /// Pixels of frames per second.
    pub pixels_per_second: f64,
    /// Clocks per second over those of the RTL.
    pub times_rtl: Option<f64>,
    /// Bytes that the level takes at most, where the system tells.
    pub peak_bytes: Option<u64>,
    /// Seconds to build it; nothing for what is part of this program.
    pub build_seconds: Option<f64>,
    /// Whether the build was found in the cache, so that its seconds mean nothing.
    pub is_cached: bool,
    /// The level with which it was compared.
    pub same_as: Option<Level>,
    /// Values that were compared, and those that differ.
    pub compared: u64,
    /// Values that differ.
    pub differing: u64,
    /// How often the frames went through while the time was taken.
    pub passes: u64,
    /// Seconds of these passes.
    pub seconds: f64,
    /// Clocks per second from file to file; the figure above is from memory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub files_clocks_per_second: Option<f64>,
    /// The part of the time that went into unpacking the inputs, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unpacking: Option<f64>,
}

impl Measured {
    pub(crate) fn agrees(self, level: Level, agreement: Agreement) -> Self {
        let Agreement { compared, differing } = agreement;
        Self { same_as: Some(level), compared, differing, ..self }
    }
}

impl LevelRow {
    pub(crate) fn of(level: Level, name: &str, measured: Measured) -> Self {
        Self { level, name: name.to_owned(), measured: Some(measured), missing: None }
    }

    pub(crate) fn missing(level: Level, name: &str, why: String) -> Self {
        Self { level, name: name.to_owned(), measured: None, missing: Some(why) }
    }
}

impl BenchReport {
    /// Values that differ between levels that claim the same.
    #[must_use]
    pub fn differing(&self) -> u64 {
        self.rows.iter().filter_map(|row| row.measured.as_ref()).map(|row| row.differing).sum()
    }

    /// Fills in how many times faster than the RTL the others are; one RPU of a netlist is no array.
    pub(crate) fn relate(&mut self) {
        let rtl = self.rows.iter().find(|row| row.level == Level::Rtl);
        let Some(rtl) = rtl.and_then(|row| row.measured.as_ref()?.clocks_per_second) else {
            return;
        };
        for row in self.rows.iter_mut().filter(|row| row.level != Level::Netlist) {
            if let Some(measured) = &mut row.measured {
                measured.times_rtl = measured.clocks_per_second.map(|clocks| clocks / rtl);
            }
        }
    }
}
