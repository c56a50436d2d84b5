// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cases, one file for each group, in the order of the table.

mod accumulator_maxima;
mod agreement;
mod division;
mod long_runs;
mod means;
mod references;
mod summaries;
mod thresholds;
mod variance_cancellation;

use crate::stress::{CaseRow, RunDepth};

pub(crate) type CaseFunction = fn(RunDepth) -> Vec<CaseRow>;

pub(crate) const ALL_CASES: &[CaseFunction] = &[
    accumulator_maxima::largest_scores,
    accumulator_maxima::largest_counts,
    division::reciprocals,
    means::halves,
    summaries::halves,
    variance_cancellation::large_mean_variance,
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
