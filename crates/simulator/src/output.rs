// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run leaves behind: arrays, a table of frames, pictures and a summary.

mod npy;
mod overlay;
mod png;
mod recorder;
mod summary;
mod table;

pub(crate) use recorder::Recorder;
pub use summary::{Grid, Range, Summary};

use std::io;
use std::path::Path;

use crate::SimulatorError;

/// What a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// The rendered frames, `rendered/000000.png` and on. 8 bits per pixel as they are; fewer are
    /// widened to 8 and more to 16 bits by [`crate::convert_depth`].
    pub rendered: bool,
    /// The original frames, dimmed, with active regions in green, those with SRS only in amber and
    /// those with TRS only in blue, `overlay/000000.png` and on.
    pub overlay: bool,
    /// Replace the output folder of an earlier run.
    pub overwrite: bool,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self { rendered: true, overlay: false, overwrite: false }
    }
}

/// Names the file in an error of the operating system.
fn cannot_write(path: &Path) -> impl Fn(io::Error) -> SimulatorError + '_ {
    |source| SimulatorError::Write { path: path.to_owned(), source }
}
