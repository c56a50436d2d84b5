// SPDX-License-Identifier: MIT OR Apache-2.0
//! The distance of a camera from the ideal camera, over the frames of clips.
//!
//! A [`Fidelity`] gets each input frame with the results of the ideal camera
//! ([`foveate_ideal::IdealCamera`]) and of the candidate's engine. Its [`ErrorTally`] holds only
//! whole numbers, so tallies of clips can be stored, and their sum has the same bits in any order.
//! [`FidelityFigures`] are for people: errors of scores, flips, PSNR, SSIM, staleness.
//! [`stress`] has hard cases with their expected results. This crate does no I/O.
#![forbid(unsafe_code)]

mod areas;
mod error;
mod fidelity;
mod figures;
mod fixed_point;
mod overlap;
mod sample;
mod scores;
mod screens;
mod similarity;
mod staleness;
pub mod stress;
mod tally;
mod threshold_table;

pub use areas::{ActiveAreas, DecisionAreas, DecisionState, FrameOrder};
pub use error::FidelityError;
pub use fidelity::{CandidateFrame, Fidelity};
pub use figures::{FidelityFigures, ScoreError, Staleness};
pub use overlap::GridCells;
pub use similarity::FrameSimilarity;
pub use tally::ErrorTally;
pub use threshold_table::{
    ChosenSteps, DecisionLimits, MinimumChoice, MinimumSteps, ThresholdTable,
};
