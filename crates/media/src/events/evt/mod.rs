// SPDX-License-Identifier: MIT OR Apache-2.0
//! EVT 2.0 and EVT 3.0: a header of text lines and a stream of words, which state what changed
//! since the last event. Coordinates have 11 bits. The high part of times counts in a loop, so a
//! reader follows the loops from the start of the file.

mod encoder;
mod evt2;
mod evt3;
mod header;
mod reader;
mod time_base;

pub(crate) use encoder::EvtEncoder;
pub(crate) use header::{EvtVersion, HEADER_START};
pub(crate) use reader::EvtReader;
