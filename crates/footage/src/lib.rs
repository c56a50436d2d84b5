// SPDX-License-Identifier: MIT OR Apache-2.0
//! Footage: video, images, data sets and synthetic scenes, as frames one at a time.
//!
//! [`open`] turns an input (video, files, folders, globs, `scene:NAME`) into a [`Source`] of frames
//! of the design's depth; [`plan`] decides whether inputs are one clip or many; [`read_ahead`]
//! reads on a separate thread. [`boxes`] reads the positions of objects in the frames. Memory does
//! not grow with the number of frames. This crate does not know what happens to the frames.

mod address;
mod advice;
pub mod boxes;
mod error;
mod extension;
mod hooks;
mod input;
mod limits;
mod natural;
mod options;
mod picture;
mod plan;
mod rate;
mod samples;
mod sets;
mod source;
mod subject;
mod video;
mod y4m;

pub use address::{redacted, shown_input};
pub use advice::{advice, skipped, skipped_in_words};
pub use error::FootageError;
pub use hooks::{Hooks, Progress, Silent};
pub use input::{SkipReason, SkippedInput, is_camera, is_read_once, open};
pub use limits::{Crop, MAX_SIDE};
pub use natural::natural_order;
pub use options::{ImagesAs, InputOptions};
pub use picture::{decode, read};
pub use plan::{Clip, ClipPlan, plan};
pub use rate::FrameRate;
pub use source::ahead::{Frames, read_ahead};
pub use source::form::{IdxFile, Labels, SetFiles, SetForm};
pub use source::memory::in_memory;
pub use source::select::{Selection, parse_time};
pub use source::{Kind, Origin, Source, SourceFrame};
pub use subject::{Subject, subjects};
