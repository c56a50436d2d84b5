// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effect of a decision on a region of the screen.

/// The effect of a decision on a region of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RegionAction {
    /// The region is active: its current pixels are forwarded and shown.
    Forward,
    /// The screen keeps the pixels that it shows of the region.
    Hold,
    /// The region becomes black on the screen.
    Blank,
    /// The summary of the region is sent: the screen shows every block as its mean.
    Summarize,
}

impl RegionAction {
    /// Returns the name that tables use.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Hold => "hold",
            Self::Blank => "blank",
            Self::Summarize => "summarize",
        }
    }
}
