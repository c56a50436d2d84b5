// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets that a camera sends, in the format of `docs/packets.md`.
//!
//! A [`PacketLayout`] gives the length of every packet of a design. [`packet_encoding`] makes
//! packets, [`PacketSplitter`] finds them in bytes that may be damaged, and [`FrameAssembler`]
//! makes frames from them, with a list of losses. The crate accesses no files and does not depend
//! on the code that computes a frame: `write_packets` of crate `simulator` makes packets of what an
//! engine has computed.

mod error;
mod frame_assembler;
mod frame_clock;
mod frame_info;
mod packet;
pub mod packet_encoding;
mod packet_layout;
mod packet_splitter;
mod received_frame;
mod register_command;
mod stream_loss;

pub use error::PacketError;
pub use frame_assembler::FrameAssembler;
pub use frame_clock::{FrameClock, FrameTime, LONGEST_GAP_SECONDS};
pub use frame_info::FrameInfo;
pub use packet::{
    EndPacket, FlowPacket, Packet, RegionDecision, RegionFlags, RegionPacket, RegisterPacket,
    RowPacket, ScoresPacket,
};
pub use packet_layout::{MAGIC, PacketLayout, VERSION};
pub use packet_splitter::{PacketSplitter, StreamItem};
pub use received_frame::{ReceivedFrame, RegionContent};
pub use register_command::RegisterCommand;
pub use stream_loss::StreamLoss;
