// SPDX-License-Identifier: MIT OR Apache-2.0
//! The versions of EVT.

use std::fmt;

use crate::events::EventFormat;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EvtVersion {
    Evt2,
    Evt3,
}

impl EvtVersion {
    /// Returns the format of a file with this version.
    pub(crate) fn format(self) -> EventFormat {
        match self {
            Self::Evt2 => EventFormat::Evt2,
            Self::Evt3 => EventFormat::Evt3,
        }
    }

    /// Returns the version in the words of a header: `2.0` or `3.0`.
    pub(crate) fn number(self) -> &'static str {
        match self {
            Self::Evt2 => "2.0",
            Self::Evt3 => "3.0",
        }
    }

    pub(crate) fn word_bytes(self) -> usize {
        match self {
            Self::Evt2 => 4,
            Self::Evt3 => 2,
        }
    }
}

impl fmt::Display for EvtVersion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.format().fmt(formatter)
    }
}
