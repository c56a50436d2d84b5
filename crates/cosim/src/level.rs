// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of the hardware that is simulated.

use crate::hierarchy::declares;
use foveate_camera::ConfigError;
use foveate_design::{ArrayStructure, Design};
use foveate_emit::{Prefix, SourceFile, Top};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The largest number of lanes of an array that Verilator builds in a minute or two.
const MAX_UNITS: u32 = 1024;

/// The part of the hardware that is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CosimLevel {
    /// One RPU, through which the regions of the frames go one after the other. Of a serial design
    /// it is one lane, with as many regions as share it.
    #[default]
    Rpu,
    /// An RCM with the given grid of regions.
    Rcm {
        /// The number of columns of regions.
        columns: u32,
        /// The number of rows of regions.
        rows: u32,
    },
    /// The RCM of the design's own frame.
    Full,
}

impl CosimLevel {
    /// Returns the array that stands for the design's own if that would take long. It has 3x2
    /// regions, so that rows and columns cannot be confused, or more if a lane serves more regions,
    /// so that there are two lanes. It never has more regions than the frame.
    #[must_use]
    pub fn small_array(design: &Design) -> Self {
        let (all_columns, all_rows) = (design.columns(), design.rows());
        let wanted = design.slots() + 1;
        let rows_for = |columns: u32| wanted.div_ceil(columns).max(2).min(all_rows);
        let columns = (all_columns.min(3)..=all_columns)
            .find(|&columns| {
                let is_taken = with_grid(design, columns, rows_for(columns)).is_ok();
                columns * rows_for(columns) >= wanted && is_taken
            })
            .unwrap_or(all_columns);
        Self::Rcm { columns, rows: rows_for(columns) }
    }

    /// Returns true if the design's own array is simulated by default: its widths, memories and
    /// counters follow from its size, and it has no more lanes than Verilator builds in a minute or
    /// two.
    #[must_use]
    pub fn is_whole_affordable(design: &Design) -> bool {
        match design.unit().array {
            ArrayStructure::RpuCopies => false,
            ArrayStructure::SharedLogic => design.unit().count <= MAX_UNITS,
        }
    }

    /// Returns the levels that together simulate the Verilog of a user: one for each of the modules
    /// `rpu` and `rcm` that is there under this prefix. The array is simulated as
    /// [`CosimLevel::small_array`] and, if the whole array is larger and
    /// [affordable](Self::is_whole_affordable), also whole. Without either module it is `rpu`,
    /// whose simulation reports what is missing.
    #[must_use]
    pub fn for_sources(design: &Design, sources: &[SourceFile], prefix: &Prefix) -> Vec<Self> {
        let mut levels = vec![Self::Rpu, Self::small_array(design)];
        if Self::is_whole_affordable(design) && !levels[1].is_whole(design) {
            levels.push(Self::Full);
        }
        let is_there =
            |level: &Self| declares(sources, &prefix.prefixed_name(level.top().module()));
        let found: Vec<Self> = levels.into_iter().filter(is_there).collect();
        if found.is_empty() { vec![Self::Rpu] } else { found }
    }

    /// Returns true if the level simulates the design's own array.
    #[must_use]
    pub fn is_whole(self, design: &Design) -> bool {
        match self {
            Self::Full => true,
            Self::Rcm { columns, rows } => (columns, rows) == (design.columns(), design.rows()),
            Self::Rpu => false,
        }
    }

    /// Returns the module that is simulated.
    #[must_use]
    pub fn top(self) -> Top {
        match self {
            Self::Rpu => Top::Rpu,
            Self::Rcm { .. } | Self::Full => Top::Rcm,
        }
    }

    /// Returns the design with the frame that this level simulates.
    ///
    /// # Errors
    /// Fails if the grid makes a frame that no design can have.
    pub fn design(self, design: &Design) -> Result<Design, ConfigError> {
        match self {
            Self::Rpu => Ok(design.lone_unit()),
            // A frame of another size has no areas of zones.
            Self::Rcm { columns, rows } if !self.is_whole(design) => {
                with_grid(design, columns, rows)
            }
            Self::Rcm { .. } | Self::Full => Ok(design.clone()),
        }
    }
}

/// Returns the design for a frame of the given grid of regions. The part of the last regions that
/// lies beyond the frame is that of the design.
fn with_grid(design: &Design, columns: u32, rows: u32) -> Result<Design, ConfigError> {
    let mut config = design.config();
    let side = design.region_size();
    let length =
        |regions: u32, own: u32, all: u32| regions.saturating_mul(side) - (all * side - own);
    config.camera.resize_frame(
        length(columns, design.width(), design.columns()),
        length(rows, design.height(), design.rows()),
    );
    config.validate()
}

impl fmt::Display for CosimLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rpu => f.pad("rpu"),
            Self::Rcm { columns, rows } => f.pad(&format!("rcm {columns}x{rows}")),
            Self::Full => f.pad("full"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    fn sample(toml: &str) -> CosimLevel {
        CosimLevel::small_array(&DesignConfig::from_toml(toml).unwrap().validate().unwrap())
    }

    #[test]
    fn a_sample_has_two_lanes_where_the_frame_has() {
        let grid = |columns, rows| CosimLevel::Rcm { columns, rows };
        assert_eq!(sample(""), grid(3, 2));
        assert_eq!(sample("[frame]\nwidth = 8\nheight = 80\n"), grid(1, 2));
        assert_eq!(sample("[frame]\nwidth = 8\nheight = 8\n"), grid(1, 1));
        let folded = |frame: &str, fold| {
            sample(&format!("{frame}[hardware]\norganization = \"serial\"\nfold = {fold}\n"))
        };
        assert_eq!(folded("", 1), grid(3, 2));
        assert_eq!(folded("", 38), grid(3, 13));
        assert_eq!(folded("", 784), grid(28, 28));
        assert_eq!(folded("[frame]\nwidth = 64\nheight = 16\n", 9), grid(5, 2));
    }

    #[test]
    fn a_sample_of_all_regions_has_the_areas_of_the_zones() {
        let toml = "[frame]\nwidth = 24\nheight = 16\n\
                    [[zones.areas]]\nclass = \"off\"\nrectangle = [0, 0, 8, 8]\n";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let sample = CosimLevel::small_array(&design);
        assert!(sample.is_whole(&design));
        assert_eq!(sample.design(&design).unwrap().fingerprint(), design.fingerprint());
    }
}
