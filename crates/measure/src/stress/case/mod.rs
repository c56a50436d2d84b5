// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cases, one file for each group, in the order of the table.

mod agreement;
mod arithmetic;
mod long_runs;
mod references;
mod summaries;
mod thresholds;

use crate::stress::{CaseRow, RunDepth};

pub(crate) type CaseFunction = fn(RunDepth) -> Vec<CaseRow>;

pub(crate) const ALL_CASES: &[CaseFunction] = &[
    arithmetic::largest_scores,
    arithmetic::largest_counts,
    arithmetic::reciprocals,
    summaries::halves_of_means,
    summaries::halves,
    arithmetic::large_mean_variance,
    thresholds::on_below_above,
    references::slow_fade,
    references::flicker,
    references::relevance_returns,
    references::invariant_on_scenes,
    summaries::fade,
    agreement::scenes,
    agreement::sizes,
    agreement::depths,
    agreement::gaps_and_resets,
    agreement::means,
    long_runs::long_runs,
];
