// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far a design is from an ideal one, over the frames of clips.
//!
//! A [`Fidelity`] is given, frame by frame, what went into both, what the ideal camera made of it
//! ([`foveate_ideal::IdealCamera`]) and what the candidate's engine made of it. Its [`Tally`] holds whole
//! numbers only, so that tallies of clips add up to the same bits in any order and can be stored;
//! [`Figures`] are what people read: errors of scores, decisions otherwise, PSNR, SSIM, staleness. No I/O.
#![forbid(unsafe_code)]

mod areas;
mod error;
mod exact;
mod fidelity;
mod figures;
mod overlap;
mod picture;
mod planes;
mod sample;
mod scores;
mod ssim;
mod stale;
mod tally;

pub use error::FidelityError;
pub use fidelity::Fidelity;
pub use figures::{Figures, ScoreError, Staleness};
pub use tally::Tally;
