// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine for a page in the browser.
//!
//! [`exports`] are plain functions over linear memory, without imports: bytes go into one buffer, every answer lies where a
//! pointer and a length say. They do nothing but call a [`Desk`], which holds the cameras of a page, or a [`NetworkDesk`], which has a
//! network that looks at frames; `web/engine.js` is the only caller that knows them. `scripts/web.sh` compiles this crate to `web/foveate.wasm`, on one thread, with
//! vectors of 128 bits. What is computed is what `foveate simulate` computes on the same frames, bit for bit.
//!
//! Wrong input gives a message. What grows has a limit: cameras, pixels of a frame, bytes of a recording, a network.

mod describe;
mod desk;
mod error;
pub mod exports;
mod facts;
mod limits;
mod live;
mod network;
mod pixels;
mod recording;

pub use desk::Desk;
pub use error::WebError;
pub use limits::{MAX_CAMERAS, MAX_NETWORK_BYTES, MAX_NETWORK_FILE, MAX_PIXELS, MAX_RECORDING};
pub use live::{Actions, LiveCamera, Sent};
pub use network::{Looked, NetworkDesk, Seen, Wishes};
pub use recording::Recorded;
