// SPDX-License-Identifier: MIT OR Apache-2.0
//! Presents results: colours by meaning, charts as files, and pages. The crate does not depend on
//! the meaning of the data.

pub mod chart;
pub mod lettering;
pub mod page;
pub mod palette;
mod xml_text;
