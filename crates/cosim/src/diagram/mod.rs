// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing diagram of a core: what the cycle-level model shows of a frame, as WaveDrom source and drawn.
//!
//! [`trace`] plays frames to the model and keeps every clock, [`choose`] leaves out those in which nothing
//! begins or ends, [`wave`] writes the rest as WaveJSON, and [`draw`] as a picture. No number is written by
//! hand, so that the diagram is as true as the model.

mod choose;
mod draw;
mod trace;
mod wave;

use crate::error::CosimError;
use foveate_design::Design;
use foveate_emit::SourceFile;
use std::sync::atomic::AtomicBool;
use trace::Trace;
use wave::Wave;

/// `timing.json`, which WaveDrom reads, and `timing.svg`, the same drawn. Equal designs give equal files.
///
/// # Errors
/// When `cancel` is set; [`CosimError::is_interrupted`] tells.
pub fn timing_diagram(design: &Design, cancel: &AtomicBool) -> Result<[SourceFile; 2], CosimError> {
    let trace = Trace::of(design, cancel)?;
    let columns = choose::columns(&trace);
    let wave = Wave::of(&trace, &columns);
    let file = |path: &str, contents| SourceFile { path: path.to_owned(), contents };
    Ok([file("timing.json", wave.json()), file("timing.svg", draw::svg(&wave))])
}
