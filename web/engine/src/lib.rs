// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine for a page in the browser.
//!
//! [`exports`] has plain functions over linear memory, without imports. Bytes go into one buffer,
//! and every answer lies at a pointer with a length. The functions only call a [`PageCameras`],
//! which holds the cameras of a page, or a [`PageNetwork`], which holds a network for frames;
//! `web/engine.js` is their only caller. `scripts/web.sh` compiles this crate to
//! `web/foveate.wasm`, on one thread, with vectors of 128 bits. The results are those of `foveate
//! simulate` for the same frames, bit for bit.
//!
//! Wrong input gives a message. Everything that grows has a limit: cameras, pixels of a frame,
//! bytes of a recording, a network.

mod error;
pub mod exports;
mod facts;
mod limits;
mod live_camera;
mod network;
mod page_cameras;
mod pixels;
mod recording;

pub use error::WebError;
pub use limits::{MAX_CAMERAS, MAX_NETWORK_BYTES, MAX_NETWORK_FILE, MAX_PIXELS, MAX_RECORDING};
pub use live_camera::{ActionCounts, FrameSummary, LiveCamera};
pub use network::{FrameDetection, NetworkComparison, NetworkSettings, PageNetwork};
pub use page_cameras::PageCameras;
pub use recording::RecordingState;
