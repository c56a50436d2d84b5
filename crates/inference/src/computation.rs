// SPDX-License-Identifier: MIT OR Apache-2.0
//! The computation of a run: a mode of the executor, or limits that are chosen by tuning.

use crate::TuningGoal;
use foveate_network::ExecutionMode;
use serde::{Serialize, Serializer};
use std::fmt;

/// The computation for each frame after the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Computation {
    /// The computation of a mode.
    Mode(ExecutionMode),
    /// A computation of the changes above a limit for each layer. The limits are chosen on the
    /// first half of the clips, rounded up, or on the first half of the frames of a single clip.
    /// The second half is reported.
    Tuned(TuningGoal),
}

/// Writes `dense`, `exact`, `compare`, `truncate=0.1`, `fixed`, or `tuned to` a goal. A mode is
/// written as on the command line.
impl fmt::Display for Computation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mode(ExecutionMode::Dense) => f.write_str("dense"),
            Self::Mode(ExecutionMode::Exact) => f.write_str("exact"),
            Self::Mode(ExecutionMode::Compare) => f.write_str("compare"),
            Self::Mode(ExecutionMode::Truncate(limit)) => write!(f, "truncate={limit}"),
            Self::Mode(ExecutionMode::Fixed) => f.write_str("fixed"),
            Self::Tuned(goal) => write!(f, "tuned to {goal}"),
        }
    }
}

/// Serializes the text that `Display` writes.
impl Serialize for Computation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_written_as_on_the_command_line() {
        for text in ["dense", "exact", "compare", "truncate=0.25", "fixed"] {
            let computation = Computation::Mode(crate::parse_mode(text).unwrap());
            assert_eq!(serde_json::to_value(computation).unwrap(), text);
        }
        let tuned = Computation::Tuned(TuningGoal::Psnr(40.0));
        assert_eq!(tuned.to_string(), "tuned to psnr=40");
    }
}
