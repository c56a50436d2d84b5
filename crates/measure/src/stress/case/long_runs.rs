// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long runs: positions, windows and flags wrap thousands of times, and frame numbers exceed 8 and
//! 16 bits, in case a counter is too narrow.

use crate::stress::designs::{RandomNumbers, design_matrix};
use crate::stress::model_comparison::{AgreementTally, compare_models};
use crate::stress::{CaseRow, RunDepth};

/// Runs more frames than 8 bits can count, and in the full depth more than 16 bits can count.
pub(crate) fn long_runs(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(300, 66_000);
    let designs = design_matrix((4, 2), 2, 8);
    // Random frames alternate with long pauses without changes.
    let frame =
        |t: u64| RandomNumbers::new(if t % 100 < 40 { t } else { t / 100 }).frame((4, 2), 8);
    // One design of each filter, with both neighborhoods, references and payloads.
    let picked = [0, 5, 26, 31].map(|at: usize| &designs[at.min(designs.len() - 1)]);
    let tally = picked
        .iter()
        .map(|design| compare_models(design, (0..frames).map(frame), false))
        .fold(AgreementTally::default(), AgreementTally::add);
    let designs = format!("{} designs, N 2, {frames} frames", picked.len());
    let counts = (tally.differing, tally.compared);
    vec![CaseRow::for_no_errors(
        "long runs",
        designs,
        "values differ",
        counts,
        u8::from(tally.differing > 0),
    )]
}
