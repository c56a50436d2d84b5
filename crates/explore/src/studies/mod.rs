// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's studies as commands: activity over clips, redundancy of data sets, and the effect of
//! region size and thresholds, as CSV, SVG and PNG.
//!
//! [`analyze`] runs a [`Study`] over inputs and writes a folder that appears complete or not at
//! all. Every file names the inputs, and the design by its fingerprint. Clips are decoded once,
//! frame by frame, for all points of a study. The same inputs give the same bytes on any number of
//! cores.

mod error;
mod findings;
mod number;
mod rank;
mod report;
mod runner;
mod study;
mod tally;

pub use error::StudyError;
pub use rank::spearman;
pub use report::{STUDY_FOLDER, StudyReport, StudyRequest, analyze};
pub use study::Study;
