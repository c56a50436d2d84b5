// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ctrl-C: every command looks at one flag, so that nothing half-done is left behind.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_toolchain::Toolchain;

use crate::error::CliError;

/// The exit code of what a signal ended, as shells have it.
pub(crate) const EXIT_CODE: u8 = 130;

/// A flag that the first Ctrl-C sets; a second one ends the process at once.
pub(crate) fn flag() -> Result<Arc<AtomicBool>, CliError> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(EXIT_CODE.into());
        }
    })
    .map_err(|e| CliError::Usage(format!("cannot listen for Ctrl-C: {e}")))?;
    Ok(flag)
}

/// The tools of this machine, stopped by Ctrl-C.
pub(crate) fn toolchain() -> Result<Toolchain, CliError> {
    Ok(Toolchain::system().cancelled_by(flag()?))
}
