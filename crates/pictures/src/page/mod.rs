// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pages that show results: one file with plots, tables and numbers as people read them. No script is needed to read a page, and nothing is
//! loaded. Knows nothing of what is shown.

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
