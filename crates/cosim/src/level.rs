// SPDX-License-Identifier: MIT OR Apache-2.0
//! How much of the hardware is simulated.

use foveate_design::{Design, DesignError};
use foveate_emit::Top;
use serde::{Deserialize, Serialize};
use std::fmt;

/// How much of the hardware is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// One RPU, through which the regions of the frames go one after the other; of a serial design one
    /// lane, with as many of them as share it.
    #[default]
    Rpu,
    /// An RCM of that many regions.
    Rcm {
        /// Regions side by side.
        columns: u32,
        /// Regions one below the other.
        rows: u32,
    },
    /// The RCM of the design's own frame.
    Full,
}

impl Level {
    /// The module that is simulated.
    #[must_use]
    pub fn top(self) -> Top {
        match self {
            Self::Rpu => Top::Rpu,
            Self::Rcm { .. } | Self::Full => Top::Rcm,
        }
    }

    /// The design with the frame that this level simulates.
    ///
    /// # Errors
    /// When the grid makes a frame that no design can have.
    pub fn design(self, design: &Design) -> Result<Design, DesignError> {
        match self {
            Self::Full => Ok(design.clone()),
            Self::Rpu => Ok(design.lone_unit()),
            Self::Rcm { columns, rows } => with_grid(design, columns, rows),
        }
    }
}

/// The design for a frame of so many regions.
fn with_grid(design: &Design, columns: u32, rows: u32) -> Result<Design, DesignError> {
    let mut config = design.config().clone();
    let side = design.region_size();
    config.frame.width = Some(columns.saturating_mul(side));
    config.frame.height = Some(rows.saturating_mul(side));
    config.validate()
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rpu => f.pad("rpu"),
            Self::Rcm { columns, rows } => f.pad(&format!("rcm {columns}x{rows}")),
            Self::Full => f.pad("full"),
        }
    }
}
