// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong with a chart.

use thiserror::Error;

/// A chart that cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw the chart `{name}`: {problem}")]
pub struct ChartError {
    /// The chart.
    pub name: String,
    /// What is wrong.
    pub problem: String,
}
