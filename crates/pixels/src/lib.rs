//! Frames of pixels, their vectors, and synthetic scenes.
//!
//! A [`Frame`] has width x height luma pixels of 1 to 16 bits in row-major order, every value
//! checked once. It holds words, and the models compute on it. [`ByteFrame`] holds bytes for up to
//! 8 bits per pixel and words for more, so that video is neither widened nor copied on its way to
//! the engine. Both report the same [`FrameError`]. A [`Rect`] is a rectangle in a frame. A
//! [`Scene`] makes frames, and [`vectors`] computes on many pixels at once. This crate knows no
//! design.

mod byte_frame;
mod depth;
mod error;
mod frame;
mod luma;
mod rect;
mod scenes;
pub mod vectors;

pub use byte_frame::{ByteFrame, FramePixels};
pub use depth::{convert_depth, display_depth};
pub use error::FrameError;
pub use frame::Frame;
pub use luma::{append_luma_of_rgba, luma};
pub use rect::{MAX_COORDINATE, Rect};
pub use scenes::{Scene, SceneError, SceneFrames, SceneParameters};

/// Converts a size or a coordinate to an index. The conversion is lossless: `usize` has 32 bits or
/// more on every platform that can hold a frame.
const fn index(value: u32) -> usize {
    value as usize
}
