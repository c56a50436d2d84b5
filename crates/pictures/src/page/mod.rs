// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pages that show results: one file with plots, tables and formatted numbers. A page can be read
//! without scripts, and loads nothing. The module does not depend on the meaning of the data.

mod axis;
#[cfg(feature = "browser")]
pub mod browser;
mod colour;
mod document;
mod error;
pub mod number;
mod plot;
mod table;

pub use axis::Axis;
pub use colour::{COLOURS, look, variables};
pub use document::{Fact, Notice, Page, Target};
pub use error::PageError;
pub use plot::{At, Field, Line, Mark, Plot, rings, staircase, text, through};
pub use table::{Cell, Column, Row, Table};
