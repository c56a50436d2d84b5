// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ground-truth boxes of objects, and the regions of a camera that belong to them.
//!
//! [`Boxes`] reads a file of MOT, COCO or CSV, or a folder of YOLO files, and gives the boxes of a frame by
//! its number or its name. [`assign`] finds the boxes of several clips. A [`View`] moves boxes into a frame
//! that is cropped and scaled, and a [`Grid`] says which regions a box owns. Nothing here reads
//! pixels.

mod assign;
mod error;
mod file;
mod format;
mod grid;
mod labelled;
mod limits;
mod name;
mod view;

pub use assign::{Clip, assign};
pub use error::BoxError;
pub use file::{Boxes, Found, Place};
pub use format::Format;
pub use grid::Grid;
pub use labelled::Labelled;
pub use limits::MAX_BOXES;
pub use view::View;
