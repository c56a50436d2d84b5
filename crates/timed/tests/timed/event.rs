// SPDX-License-Identifier: MIT OR Apache-2.0
//! Events at the ports, one per clock and region, in a form that both models can give.

/// An event, with the clock after whose edge it is on the ports.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PortEvent {
    pub(crate) clock: u64,
    pub(crate) event: CoreEvent,
}

/// The kind of an event, and its values.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum CoreEvent {
    SyncError,
    Score {
        region: u32,
        number: u32,
        value: u64,
    },
    Decision {
        region: u32,
        relevance: [bool; 2],
        summary: bool,
        scores: Vec<u64>,
        count: u32,
    },
    /// A decision without its scores.
    SerialDecision {
        region: u32,
        relevance: [bool; 2],
        summary: bool,
    },
    Word {
        region: u32,
        /// The number of the frame on the ports, or 0 if no port has it.
        frame: u64,
        number: u32,
        is_mean: bool,
        values: Vec<u16>,
        is_last: bool,
        is_aborted: bool,
    },
    /// A pixel, or a mean, at its position in the region.
    SerialWord {
        region: u32,
        position: u32,
        value: u16,
    },
    Loss {
        region: u32,
        frame: u64,
    },
}

impl CoreEvent {
    /// Returns the kind of the event, as far as tests must show all kinds.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::SyncError => "error",
            Self::Score { .. } => "score",
            Self::Decision { summary: true, .. } | Self::SerialDecision { summary: true, .. } => {
                "summary"
            }
            Self::Decision { .. } | Self::SerialDecision { .. } => "decision",
            Self::Word { is_aborted: true, is_mean: true, .. } => "aborted means",
            Self::Word { is_aborted: true, .. } => "aborted pixels",
            Self::Word { is_mean: true, .. } => "mean",
            Self::Word { .. } | Self::SerialWord { .. } => "pixels",
            Self::Loss { .. } => "loss",
        }
    }
}
