// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pages that show results: one file with plots, tables and formatted numbers. A page can be read
//! without scripts, and loads nothing. The module does not depend on the meaning of the data.

mod axis;
#[cfg(feature = "browser")]
pub mod browser;
mod colour;
mod document;
mod error;
pub mod number_text;
mod plot;
mod table;

pub use axis::PlotAxis;
pub use colour::{COLOUR_COUNT, group_look, colour_variables};
pub use document::{HeadingFigure, PageNotice, ResultPage, LinkTarget};
pub use error::PageError;
pub use plot::{AxisPosition, PlotAxes, PlotLine, PlotMark, PagePlot, nest_marks, front_path, coordinate_text, line_path};
pub use table::{TableCell, TableColumn, TableRow, SortableTable};
