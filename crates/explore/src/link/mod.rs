// SPDX-License-Identifier: MIT OR Apache-2.0
//! A comparison of what a region camera sends over a link with common senders: pixel events, raw
//! frames, and MJPEG, H.264 and H.265 at the same quality.
//!
//! A sender is a list of [`LinkUnit`]s: bits with the times at which their pixels were read, at
//! which they were decided, and at which they were given to the link. [`LinkFigures`] has the load
//! on a link: rates in windows, latency and the buffer. [`compare`](fn@compare) runs clips through
//! the cameras and the codecs, and writes a folder that appears complete or not at all.
//! [`ClipLoad::measure`] measures one design over one clip, without codecs and without files. Times
//! and rates are integers.

mod array_results;
mod clip;
mod clip_load;
mod compare;
mod encoder;
mod error;
mod figures;
mod files;
mod frame_ranges;
mod grey_footage;
mod link_rate;
mod queue;
mod raster_array;
mod report;
mod sender;
mod sweep;
mod timeline;
mod unit;
mod windows;

pub use array_results::{ArrayResults, UnbufferedFigures};
pub use clip_load::{ArrayLink, ArrayLoad, ClipLoad};
pub use compare::{LINK_FOLDER, LinkRequest, coarsest_quantizer, compare};
pub use encoder::{ClipEncoder, Codec, EncodedClip, EncoderPreset, Quality, check_encoders};
pub use error::LinkError;
pub use figures::{DeliveryTimes, LinkFigures};
pub use grey_footage::GreyFootage;
pub use link_rate::LinkRate;
pub use queue::{QueueResult, send_over_link};
pub use raster_array::RasterArray;
pub use report::{ClipReport, CurvePoint, LinkReport, SenderReport, milliseconds_text};
pub use sender::{FrameTaker, SenderCameras, SentCounts};
pub use timeline::Timeline;
pub use unit::LinkUnit;
pub use windows::WindowRates;
