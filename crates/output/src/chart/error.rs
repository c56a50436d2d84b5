// SPDX-License-Identifier: MIT OR Apache-2.0
//! The error of a chart.

use thiserror::Error;

/// A chart cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw the chart `{name}`: {problem}")]
pub struct ChartError {
    /// The name of the chart.
    pub name: String,
    /// The problem.
    pub problem: String,
}
