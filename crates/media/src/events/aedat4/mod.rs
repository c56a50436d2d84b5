// SPDX-License-Identifier: MIT OR Apache-2.0
//! AEDAT4: a line that names the format, a header, and packets. A packet is the number of its
//! stream, its length, and a flatbuffer, which is compressed with LZ4 or Zstandard in most files.
//! Other streams than that of the events have frames, movements and triggers, and are skipped. A
//! table of all packets may follow the last one; our files have none, because it grows with the
//! recording, and readers find packets by their lengths.
//!
//! Coordinates have 16 bits with a sign, and times 64, so they do not wrap.

mod encoder;
mod event_packet;
mod flat_table;
mod header;
mod reader;

pub(crate) use encoder::Aedat4Encoder;
pub(crate) use header::HEADER_START;
pub(crate) use reader::Aedat4Reader;
