// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a feature takes in a pipelined RPU: how long its score does.

use crate::{FeatureKind, Pipelining};

/// Clocks from the step of the last pixel until the score is final; of a feature with a second pass, until what that
/// begins with is.
pub(super) fn score_latency(kind: FeatureKind, pipelining: Pipelining) -> u32 {
    match (kind, pipelining) {
        // The count of hits.
        (FeatureKind::Edge | FeatureKind::Corner, Pipelining::Plain) => 1,
        // Its comparison, the hit, the count.
        (FeatureKind::Edge | FeatureKind::Corner, Pipelining::Deep) => 3,
        // The sum, the mean.
        (FeatureKind::Mad, Pipelining::Plain | Pipelining::Deep) => 2,
        // The sums, the score.
        (FeatureKind::Variance, Pipelining::Plain) => 2,
        // The square, the sums, the score.
        (FeatureKind::Variance, Pipelining::Deep) => 3,
    }
}
