// SPDX-License-Identifier: MIT OR Apache-2.0
//! Footage: video, images, data sets and synthetic scenes, as frames one at a time.
//!
//! [`open`] turns an input (video, files, folders, globs, `scene:NAME`) into a [`FrameSource`] of
//! frames of the design's depth; [`plan`](fn@plan) decides whether inputs are one clip or many.
//! [`boxes`] reads the positions of objects in the frames. A [`ClipPlayer`] shows frames to
//! cameras. An [`EventReader`] reads the files of ordinary event cameras, and an [`EventEncoder`]
//! makes them. Memory does not grow with the number of frames. This crate does not know what
//! happens to the frames.

mod address;
mod advice;
mod bayer;
pub mod boxes;
mod class_map;
mod compared_input;
mod error;
mod events;
mod extension;
mod input;
mod limits;
mod luma_range;
mod natural_order;
mod options;
mod orientation;
mod picture;
mod plan;
mod playback;
mod rate;
mod raw;
mod raw_layout;
mod samples;
mod sets;
mod source;
mod stream;
mod timestamps;
mod video;
mod warnings;
mod y4m;

pub use address::{input_without_secrets, text_without_secrets};
pub use advice::{input_warnings, skipped_in_words, skipped_inputs, turned_images_warning};
pub use bayer::BayerPattern;
pub use class_map::read_class_map;
pub use compared_input::{ComparedInput, subjects};
pub use error::FootageError;
pub use events::{
    EventEncoder, EventFileError, EventFormat, EventReader, PixelEvent, is_event_file,
};
pub use input::{SkipReason, SkippedInput, is_camera, is_read_once, matched_images, open};
pub use limits::{CropRect, MAX_SIDE};
pub use luma_range::LumaRange;
pub use natural_order::natural_order;
pub use options::{ImageRelation, InputOptions};
pub use orientation::Orientation;
pub use picture::{decode, read};
pub use plan::{BatchClip, ClipPlan, plan};
pub use playback::{
    ClipHalves, ClipPlayer, ClipReading, CommonFormat, FrameDepths, InputError, MonitoredFrames,
    PlaybackError, PlayedFrame, ProgressStage, ProgressUnit, RemainingTime, RunClips, RunHooks,
    RunMonitor, RunProgress, SilentHooks, StageAmount, run_in_parallel, testing,
};
pub use rate::FrameRate;
pub use raw_layout::RawLayout;
pub use source::memory_source::source_from_memory;
pub use source::selection::{FrameSelection, parse_time};
pub use source::set_form::{IdxFile, SetFiles, SetForm, SetLabels};
pub use source::{FrameOrigin, FrameSource, SourceFrame, SourceKind};
pub use timestamps::{TimestampUnit, TimestampsFile};
pub use warnings::InputWarnings;
