// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a design in terms that every organization has. The timing of each organization is
//! in its own module, as [`crate::PipelinedTiming`] and [`crate::SerialTiming`].

/// The timing of a design in terms that every organization has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DesignTiming {
    pub(crate) clocks_per_frame: u64,
    pub(crate) pixels_per_frame: u64,
    pub(crate) figures: Vec<(&'static str, u64)>,
    pub(crate) phases: Vec<(String, u64)>,
    pub(crate) descriptions: Vec<(&'static str, String)>,
    pub(crate) departure: DepartureTiming,
}

/// The times at which the decisions and pixels of a frame leave the array, if the frame is taken as
/// fast as the array can. Clocks are counted from the edge that takes the last pixel of the frame.
/// Regions that share a unit leave slot by slot. A raster core takes pixels as a sensor reads them
/// out, and gives the decisions and pixels of one row of regions while it takes others; the crate
/// `foveate-timed` computes those times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepartureTiming {
    /// Clocks that the array needs to take a frame whose pixels are all available.
    pub take_clocks: u64,
    /// Number of frames that must be taken after a frame before its decisions are known.
    pub decision_frames: u32,
    /// Clocks until the last decision of slot 0.
    pub decision_clocks: u64,
    /// Number of frames that must be taken after a frame before its pixels leave.
    pub forward_frames: u32,
    /// Clocks until the last pixel of slot 0 leaves, or until its last decision if no pixels leave.
    pub forward_clocks: u64,
    /// Clocks between the same events of one slot and the next.
    pub slot_clocks: u64,
    /// Number of rows of regions whose pixels are buffered for a sink that stalls. A region that
    /// waits longer is lost. `None` if no region is ever lost.
    pub buffered_rows: Option<u32>,
    /// True if each unit can work on its region while other units still wait for their pixels.
    pub has_independent_units: bool,
}

impl DesignTiming {
    /// Returns the clocks from one frame to the next where frames follow each other without a gap.
    #[must_use]
    pub fn clocks_per_frame(&self) -> u64 {
        self.clocks_per_frame
    }

    /// Returns the clocks of a frame in which the pixel port takes pixels, on all of its lanes at
    /// once.
    #[must_use]
    pub fn pixels_per_frame(&self) -> u64 {
        self.pixels_per_frame
    }

    /// Returns the figures of this organization with their names in JSON.
    #[must_use]
    pub fn figures(&self) -> &[(&'static str, u64)] {
        &self.figures
    }

    /// Returns the phases of a frame in order, each with its clocks. The list is empty if
    /// everything happens at once.
    #[must_use]
    pub fn phases(&self) -> &[(String, u64)] {
        &self.phases
    }

    /// Returns the times at which decisions and pixels leave.
    #[must_use]
    pub fn departure(&self) -> DepartureTiming {
        self.departure
    }

    /// Returns a description of the timing for users: headings of at most 17 characters, each with
    /// its text.
    #[must_use]
    pub fn descriptions(&self) -> &[(&'static str, String)] {
        &self.descriptions
    }
}
