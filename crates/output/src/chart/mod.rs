// SPDX-License-Identifier: MIT OR Apache-2.0
//! Charts as SVG and PNG, from the same drawing. The font is part of the program, so charts look
//! the same on a machine without fonts. The colours are those of the palette; from the eighth
//! series on, lines are dashed. The module does not depend on the meaning of the data.

mod canvas;
mod chart_data;
mod chart_files;
mod drawing;

pub use chart_data::{BarSeries, Chart, ChartData, ChartError, ChartSeries, LineLook};
