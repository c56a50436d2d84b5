// SPDX-License-Identifier: MIT OR Apache-2.0
//! How results are shown: colours by meaning, charts as files, and pages. Knows nothing of what is shown.

pub mod chart;
pub mod page;
pub mod palette;
mod xml;
