// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets that a camera sends, in the format of `docs/packets.md`.
//!
//! A [`Layout`] gives the length of every packet of a design. [`write`](mod@write) makes packets,
//! [`Splitter`] finds them in bytes that may be damaged, and [`Assembler`] makes frames from them,
//! with a list of losses. The crate accesses no files and does not depend on the code that computes
//! a frame.

mod frame_assembler;
mod frame_clock;
mod register_command;
mod error;
mod received_frame;
mod frame_info;
mod packet_layout;
mod stream_loss;
mod packet;
mod packet_splitter;
mod word_fields;
pub mod packet_writer;

pub use frame_assembler::FrameAssembler;
pub use frame_clock::{FrameClock, FrameTime, LONGEST_GAP_SECONDS};
pub use register_command::RegisterCommand;
pub use error::PacketError;
pub use received_frame::{RegionContent, ReceivedFrame};
pub use frame_info::FrameInfo;
pub use packet_layout::{PacketLayout, MAGIC, VERSION};
pub use stream_loss::StreamLoss;
pub use packet::{RegionDecision, EndPacket, Packet, RegionPacket, RegionFlags, RegisterPacket, RowPacket, ScoresPacket};
pub use packet_splitter::{StreamItem, PacketSplitter};
