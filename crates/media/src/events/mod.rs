// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files of ordinary event cameras, whose pixels send events (x, y, t, p): [EVT 2.0] and [EVT 3.0]
//! of Prophesee, which have the extension `.raw`, and [AEDAT4] of iniVation, `.aedat4`.
//!
//! [`EventEncoder`] makes the bytes of a file, and [`EventReader`] reads one, whose format it finds
//! in the first bytes. Times are in microseconds. Neither holds more than a packet of a file in
//! memory.
//!
//! [EVT 2.0]: https://docs.prophesee.ai/stable/data/encoding_formats/evt2.html
//! [EVT 3.0]: https://docs.prophesee.ai/stable/data/encoding_formats/evt3.html
//! [AEDAT4]: https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-4.0.html

mod aedat4;
mod encoder;
mod error;
mod event;
mod evt;
mod frame_size;
mod reader;

pub use encoder::EventEncoder;
pub use error::EventFileError;
pub use event::{EventFormat, PixelEvent};
pub use reader::{EventReader, is_event_file};
