// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing diagram of a core: the ports of the cycle-level model during a frame, as WaveDrom
//! source and as a drawing.
//!
//! [`trace`] plays frames to the model, keeps every clock, and leaves out of the diagram the
//! clocks in which nothing begins or ends. [`svg`] writes the others as WaveJSON and as SVG. No
//! number is written by hand, so the diagram agrees with the model.

mod svg;
mod trace;

use crate::error::CosimError;
use foveate_design::Design;
use foveate_emit::SourceFile;
use std::sync::atomic::AtomicBool;
use svg::WaveDiagram;
use trace::PortTrace;

/// Returns `timing.json`, which WaveDrom reads, and `timing.svg`, the drawing of it. Equal designs
/// give equal files.
///
/// # Errors
/// Fails if `cancel` is set; [`CosimError::is_interrupted`] is then true.
pub fn timing_diagram(design: &Design, cancel: &AtomicBool) -> Result<[SourceFile; 2], CosimError> {
    let trace = PortTrace::record(design, cancel)?;
    let columns = trace::columns(&trace);
    let wave = WaveDiagram::from_trace(&trace, &columns);
    let file = |path: &str, contents| SourceFile { path: path.to_owned(), contents };
    Ok([file("timing.json", wave.json()), file("timing.svg", svg::draw_svg(&wave))])
}
