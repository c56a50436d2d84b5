// SPDX-License-Identifier: MIT OR Apache-2.0
//! The content of words that leave.

use foveate_camera::RegionAction;

/// The content of words that leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SentKind {
    /// The pixels of active regions.
    Pixels,
    /// The means of summaries.
    Means,
}

impl SentKind {
    /// Returns the content of the words that leave for an action, or `None` if none leave.
    #[must_use]
    pub fn from_action(action: RegionAction) -> Option<Self> {
        match action {
            RegionAction::Forward => Some(Self::Pixels),
            RegionAction::Summarize => Some(Self::Means),
            RegionAction::Hold | RegionAction::Blank => None,
        }
    }
}
