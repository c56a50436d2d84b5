// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a design says what: what every organization answers. The numbers behind the answers are in the
//! module of each, as [`crate::PipelinedTiming`] and [`crate::SerialTiming`].

/// When a design says what, in terms that every organization has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timing {
    pub(crate) clocks_per_frame: u64,
    pub(crate) pixels_per_frame: u64,
    pub(crate) figures: Vec<(&'static str, u64)>,
    pub(crate) phases: Vec<(String, u64)>,
    pub(crate) text: Vec<(&'static str, String)>,
    pub(crate) departure: Departure,
}

/// When what a frame leads to leaves the array, if the frame is taken as fast as the array can. Clocks are counted
/// from the edge that takes the last pixel of a frame. Regions that share a unit leave slot by slot. A raster core takes
/// pixels as a sensor reads them, and gives decisions and pixels of a row of regions while it takes others:
/// [`crate::RasterStream`] says when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Departure {
    /// Clocks that the array needs to take a frame whose pixels are all there.
    pub take_clocks: u64,
    /// Frames that must be taken after a frame before its decisions are known.
    pub decision_frames: u32,
    /// Clocks to the last decision of slot 0.
    pub decision_clocks: u64,
    /// Frames that must be taken after a frame before its pixels leave.
    pub forward_frames: u32,
    /// Clocks to the last pixel of slot 0; to its last decision where no pixels leave.
    pub forward_clocks: u64,
    /// Clocks from one slot to the next.
    pub slot_clocks: u64,
    /// Rows of regions whose pixels wait for a sink that stalls; a region further behind is lost. None where
    /// no region is ever lost.
    pub kept_rows: Option<u32>,
    /// Whether a unit alone can work on its region while the others wait for theirs.
    pub alone: bool,
}

impl Timing {
    /// Clocks from one frame to the next, where frames follow each other at once.
    #[must_use]
    pub fn clocks_per_frame(&self) -> u64 {
        self.clocks_per_frame
    }

    /// Clocks of a frame in which the pixel port takes something, on as many lanes as it has.
    #[must_use]
    pub fn pixels_per_frame(&self) -> u64 {
        self.pixels_per_frame
    }

    /// Numbers of this organization with their names, as JSON has them.
    #[must_use]
    pub fn figures(&self) -> &[(&'static str, u64)] {
        &self.figures
    }

    /// What is done with a frame in turn, and for how many clocks; empty where all is done at once.
    #[must_use]
    pub fn phases(&self) -> &[(String, u64)] {
        &self.phases
    }

    /// When decisions and pixels leave.
    #[must_use]
    pub fn departure(&self) -> Departure {
        self.departure
    }

    /// The same for people: headings of at most 17 characters, and what stands there.
    #[must_use]
    pub fn text(&self) -> &[(&'static str, String)] {
        &self.text
    }
}
