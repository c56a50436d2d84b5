// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a decision does to a region on the screen.

/// What happens to a region on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Active: its current pixels are forwarded and shown.
    Forward,
    /// Its previous rendered pixels stay.
    Hold,
    /// It becomes black.
    Blank,
    /// Its summary is sent: every block of it shows its mean.
    Summarize,
}

impl Action {
    /// Its name in tables.
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
