// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files of ordinary event cameras, whose pixels send events (x, y, t, p): [EVT 2.0] and [EVT 3.0] of
//! Prophesee, which have the extension `.raw`.
//!
//! A file is a header of text lines and a stream of words, which state what changed since the last event.
//! [`EvtEncoder`] makes such a stream, and [`EvtReader`] reads one. Coordinates have 11 bits. Times are in
//! microseconds; their high part counts in a loop, so a reader follows the loops from the start of the file.
//!
//! [EVT 2.0]: https://docs.prophesee.ai/stable/data/encoding_formats/evt2.html
//! [EVT 3.0]: https://docs.prophesee.ai/stable/data/encoding_formats/evt3.html

mod encoder;
mod error;
mod event;
mod evt2;
mod evt3;
mod header;
mod reader;
mod time_base;

pub use encoder::EvtEncoder;
pub use error::EventFileError;
pub use event::{EvtVersion, PixelEvent};
pub use reader::EvtReader;
