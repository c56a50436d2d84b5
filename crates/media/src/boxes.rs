// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ground-truth boxes of objects, and the regions of a camera that belong to them.
//!
//! [`BoxFile`] reads a file of MOT, COCO or CSV, or a folder of YOLO files, and returns the boxes
//! of a frame by its number or its name. [`assign_boxes`] finds the boxes of several clips. A
//! [`BoxView`] transforms boxes into a frame that is cropped and scaled, and a [`RegionGrid`] finds
//! the regions that belong to a box. This module reads no pixels.

mod assignment;
mod error;
mod exclusions;
mod file;
mod format;
mod image_name;
mod limits;
mod view;

pub use assignment::{ClipToLabel, assign_boxes};
pub use error::BoxError;
pub use file::{BoxFile, FrameBoxes, FrameKey};
pub use format::BoxFormat;
pub use limits::MAX_BOXES;
pub use view::{BoxView, LabelledBox, RegionGrid};
