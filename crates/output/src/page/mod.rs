// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pages that show results: one file with plots, tables and formatted numbers. A page can be read
//! without scripts, and loads nothing. The module does not depend on the meaning of the data.

mod axis;
#[cfg(feature = "browser")]
pub mod browser;
mod document;
mod plot;
mod table;

pub use axis::PlotAxis;
pub use document::{
    COLOUR_COUNT, HeadingFigure, LinkTarget, PageError, PageNotice, ResultPage, colour_variables,
    group_look,
};
pub use plot::{
    AxisPosition, PagePlot, PlotAxes, PlotLine, PlotMark, coordinate_text, front_path, nest_marks,
};
pub use table::{SortableTable, TableCell, TableColumn, TableRow};
