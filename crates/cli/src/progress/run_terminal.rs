// SPDX-License-Identifier: MIT OR Apache-2.0
//! The terminal of a run over clips: it shows the progress, and passes on the signals to stop.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_explore::{Synthesizer, TargetProcess};
use foveate_media::{RunHooks, RunProgress};
use foveate_tools::{Cache, Interrupt, Tool, Toolchain};

use super::Progress;
use crate::args::ProcessArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::liberty::read_process;

/// The progress of the command on the terminal, and the flag that Ctrl-C sets.
pub(crate) struct RunTerminal {
    pub(crate) progress: Progress,
    interrupted: Arc<AtomicBool>,
}

impl RunTerminal {
    pub(crate) fn new(quiet: bool) -> Result<Self, CliError> {
        Ok(Self { progress: Progress::new(quiet), interrupted: interrupt::stop_flag()? })
    }

    /// Fails if there is a result that is not complete. The error sets the exit code.
    pub(crate) fn check_complete(
        &self,
        folder: &Path,
        problem: Option<String>,
    ) -> Result<(), CliError> {
        let Some(problem) = problem else { return Ok(()) };
        if self.is_cancelled() {
            return Err(CliError::Interrupted { path: folder.to_owned() });
        }
        let place = folder.display();
        Err(CliError::Failed(format!("`{place}` is not complete: {problem}")))
    }

    /// Returns the tools of this machine. The same Ctrl-C stops them.
    pub(crate) fn synthesizer(&self) -> Result<Synthesizer, CliError> {
        let toolchain = Toolchain::system().with_cancel_flag(Arc::clone(&self.interrupted));
        // A missing Yosys is reported before hours of measurements.
        toolchain.find(Tool::Yosys)?;
        Ok(Synthesizer { toolchain, cache: Cache::from_env()? })
    }

    /// Returns the process of the options, if there is one, whose designs are timed with OpenSTA.
    pub(crate) fn process(&self, args: &ProcessArgs) -> Result<Option<TargetProcess>, CliError> {
        let process = read_process(args)?;
        if process.is_some() {
            Toolchain::system().find(Tool::OpenSta)?;
        }
        Ok(process)
    }
}

impl RunHooks for RunTerminal {
    fn progress(&self, progress: &RunProgress<'_>) {
        self.progress.report(progress);
    }

    fn is_cancelled(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    fn interrupt(&self) -> Interrupt {
        interrupt::stop_request()
    }
}
