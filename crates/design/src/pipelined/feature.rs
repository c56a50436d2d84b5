// SPDX-License-Identifier: MIT OR Apache-2.0
//! The latencies of features in a pipelined RPU.

use crate::Pipelining;
use foveate_camera::FeatureKind;

/// Returns the clocks from the step of the last pixel of a frame until the score is final. For a
/// feature with a second pass, the clocks end when the value that the second pass starts with is
/// final.
pub(super) fn score_latency(kind: FeatureKind, pipelining: Pipelining) -> u32 {
    match (kind, pipelining) {
        // One register: the count of hits.
        (FeatureKind::Edge | FeatureKind::Corner, Pipelining::Plain) => 1,
        // Three registers: the comparison of the hit, the hit, the count.
        (FeatureKind::Edge | FeatureKind::Corner, Pipelining::Deep) => 3,
        // Two registers: the sum, the mean.
        (FeatureKind::Mad | FeatureKind::Segment, Pipelining::Plain | Pipelining::Deep) => 2,
        // Two registers: the sums, the score.
        (FeatureKind::Variance, Pipelining::Plain) => 2,
        // Three registers: the square, the sums, the score.
        (FeatureKind::Variance, Pipelining::Deep) => 3,
        // Two registers: the extremes, the score.
        (FeatureKind::Range, Pipelining::Plain) => 2,
        // Three registers: the pixel, the extremes, the score.
        (FeatureKind::Range, Pipelining::Deep) => 3,
        // Two registers: the sums, the score.
        (FeatureKind::Surface, Pipelining::Plain) => 2,
        // Three registers: the differences, the sums, the score.
        (FeatureKind::Surface, Pipelining::Deep) => 3,
        (FeatureKind::Flow, _) => unreachable!("pipelined refuses flow"),
    }
}
