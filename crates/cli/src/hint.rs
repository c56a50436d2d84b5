// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names that options had: which of the present ones is meant, only the user knows.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

const FPS: &str = "'--fps' has two names now: '--input-fps', the most frames per second that are taken of the \
                   inputs, and '--min-fps', what a design must reach (check, fit)";

/// The same error with what is said about an option that is gone.
pub(crate) fn with_hint(mut error: clap::Error) -> clap::Error {
    let named = matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(name)) if name == "--fps");
    if error.kind() == ErrorKind::UnknownArgument && named {
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(FPS)]));
    }
    error
}
