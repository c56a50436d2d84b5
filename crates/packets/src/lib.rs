// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets that a camera sends, in the format of `docs/packets.md`.
//!
//! A [`Layout`] gives the length of every packet of a design. [`write`](mod@write) makes packets,
//! [`Splitter`] finds them in bytes that may be damaged, and [`Assembler`] makes frames from them,
//! with a list of losses. The crate accesses no files and does not depend on the code that computes
//! a frame.

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
