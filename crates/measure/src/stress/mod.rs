// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hard cases and their expected results.
//!
//! Every case fixes the expected result before it computes the observed one, and reports the worst
//! error. Some cases expect a *failure that the contract keeps on purpose* (the drift of
//! `previous`), or the error of a method that Foveate does not use (single-pass variance in f32).
//! If such a failure did not occur, the inputs of the case would be too easy.
//!
//! The models are not assumed to agree: frames run through the functional model, the engine and the
//! cycle-level model.

mod case;
mod case_row;
mod designs;
mod model_comparison;

use rayon::prelude::*;

pub use case_row::{CaseRow, RunDepth};

/// Runs every case in parallel. `done` is called with the number of finished cases and the number
/// of all. The rows are in the order of the documentation. Cases that have not started when
/// `cancelled` becomes true have no rows.
pub fn run_cases(
    depth: RunDepth,
    done: &(dyn Fn(usize, usize) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Vec<CaseRow> {
    let cases = case::ALL_CASES;
    let finished = std::sync::atomic::AtomicUsize::new(0);
    let rows: Vec<Vec<CaseRow>> = cases
        .par_iter()
        .map(|case| {
            let rows = if cancelled() { Vec::new() } else { case(depth) };
            let finished = finished.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            done(finished, cases.len());
            rows
        })
        .collect();
    rows.into_iter().flatten().collect()
}
