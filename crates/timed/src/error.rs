// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the timed model.

use foveate_engine::EngineError;
use thiserror::Error;

/// The error that is returned if a model cannot be made, or if a delivery is not possible.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum TimedError {
    /// The pixels are not a frame of the camera, or the threads of the engine cannot be started.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A design that does not find its frames needs whole frames.
    #[error(
        "the source delivers {given} beats, but a frame has {expected}; deliver whole frames, or \
         set hardware.sync = true"
    )]
    Beats { given: u64, expected: u64 },
    /// The source delivers nothing.
    #[error("a delivery has 0 beats; it needs at least one")]
    NoBeats,
    /// The pauses of the source are not in the order of the beats.
    #[error(
        "the pause before beat {beat} is listed after that before beat {before}; list pauses in \
         the order of the beats"
    )]
    OfferOrder { beat: u64, before: u64 },
    /// The reset belongs to an earlier delivery.
    #[error(
        "the reset at edge {reset} comes before edge {earliest}, at which the core could take the \
         delivery; give it to the delivery before"
    )]
    EarlyReset { reset: u64, earliest: u64 },
}
