// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a camera sends, as packets: the format of `docs/packets.md`.
//!
//! A [`Layout`] says how long every packet of a design is. [`write`](mod@write) makes packets, [`Splitter`] finds them in
//! bytes that may be damaged, and [`Assembler`] makes frames of them, with a list of what is missing.
//! Knows neither files nor what computes a frame.

mod assemble;
mod clock;
mod command;
mod error;
mod frame;
mod info;
mod layout;
mod loss;
mod packet;
mod split;
mod word;
pub mod write;

pub use assemble::Assembler;
pub use clock::{FrameClock, FrameTime, LONGEST_GAP_SECONDS};
pub use command::Command;
pub use error::PacketError;
pub use frame::{Content, ReceivedFrame};
pub use info::FrameInfo;
pub use layout::{Layout, MAGIC, VERSION};
pub use loss::Loss;
pub use packet::{Decision, End, Packet, Region, RegionFlags, Register, Row, Scores};
pub use split::{Found, Splitter};
