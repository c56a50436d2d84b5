// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cases, one file for each group, in the order of the table.

mod agreement;
mod cancellation;
mod division;
mod maxima;
mod means;
mod references;
mod summaries;
mod thresholds;
mod wraps;

use crate::{CaseRow, Depth};

/// A function that runs one case.
pub(crate) type Case = fn(Depth) -> Vec<CaseRow>;

/// Every case.
pub(crate) const ALL: &[Case] = &[
    maxima::largest_scores,
    maxima::counts,
    division::reciprocals,
    means::halves,
    summaries::halves,
    cancellation::variance,
    thresholds::on_below_above,
    references::slow_fade,
    references::flicker,
    references::blanked,
    references::invariant_on_scenes,
    summaries::fade,
    agreement::scenes,
    agreement::sizes,
    agreement::depths,
    agreement::unrest,
    agreement::means,
    wraps::long_runs,
];
