// SPDX-License-Identifier: MIT OR Apache-2.0
//! A comparison of what a region camera sends over a link with common senders: pixel events, raw
//! frames, and MJPEG, H.264 and H.265 at the same quality.
//!
//! A sender is a list of [`Unit`]s: bits with the times at which their pixels were read, at which
//! they were decided, and at which they were given to the link. [`Figures`] has the load on a link:
//! rates in windows, latency and the buffer. [`compare`] runs clips through the cameras and the
//! codecs, and writes a folder that appears complete or not at all. Times and rates are integers.

mod clip;
mod codec;
mod compare;
mod encoder;
mod error;
mod fifo;
mod figures;
mod files;
mod picture;
mod quality;
mod report;
mod search;
mod sender;
mod stream;
mod sweep;
mod text;
mod timeline;
mod unit;
mod windows;

pub use codec::{Codec, Effort};
pub use compare::{LINK, Request, compare};
pub use encoder::{Encoded, Encoder, Footage, check_encoders};
pub use error::LinkError;
pub use fifo::{Served, serve};
pub use figures::{Delivery, Figures};
pub use quality::Quality;
pub use report::{ClipReport, LinkReport, Point, SenderReport};
pub use search::coarsest;
pub use sender::{Cameras, Sent};
pub use timeline::Timeline;
pub use unit::Unit;
pub use windows::Rates;
