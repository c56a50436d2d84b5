// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts as SVG and PNG, from the same drawing. The font is part of the program, so charts look the
//! same on a machine without fonts. Colours are those of the palette; from the eighth series on, lines
//! are dashed. Knows nothing of what is drawn.

mod axes;
mod bars;
mod draw;
mod error;
mod figure;
mod files;
mod label;
mod legend;
mod paint;
mod sheet;

pub use error::ChartError;
pub use figure::{Bars, Chart, Line, Look, Shape};
