// SPDX-License-Identifier: MIT OR Apache-2.0
//! Simulations: a design runs over frames, and arrays, tables, events, rendered frames and packets
//! are written.
//!
//! A [`Simulation`] runs a design over a source of footage and writes a folder of NumPy arrays,
//! PNGs and a summary. The folder appears at the end, and states whether it is complete.
//! [`run_batch`] does so for many clips. [`write_packets`] makes the packets of a frame. The other
//! direction has two types: a [`PacketRecording`] is a stream of packets that becomes such a
//! folder, and a [`PacketStream`] is a stream of packets whose frames are used as they arrive.
//! Memory does not grow with the number of frames. The library never prints: progress and
//! cancellation go through [`foveate_media::RunHooks`].

mod active_groups;
mod batch;
mod error;
mod explanation;
mod losses;
mod output;
mod recording;
mod simulation;
mod stalls;
mod stream;

pub use active_groups::active_groups;
pub use batch::{BatchSummary, ClipSummary, run_batch};
pub use error::SimulatorError;
pub use explanation::explain_region;
pub use foveate_engine::MAX_THREADS;
pub use foveate_model::explanation::{DecidedRegion, DecisionExplanation, RegionExplanation};
pub use foveate_packets::{PacketLayout, RegisterCommand, RegisterPacket, StreamLoss};
pub use output::{
    BandwidthComparison, CameraTraffic, ClockFigures, ClockOptions, DataSetPaths,
    EventTableOptions, FrameStart, GridSize, OverlayFrame, OverlayStyle, PIXEL_EVENT_BYTES,
    PacketContent, PictureFormat, PixelCamera, PixelEvent, PixelEventOptions, RunOptions,
    RunSummary, SentCounts, SentValues, ValueRange, draw_overlay, packet_bytes, packet_layout,
    wrapped_number, write_kept_packets, write_packets,
};
pub use recording::{DecodedRecording, PacketRecording};
pub use simulation::{SIMULATION_FOLDER, Simulation};
pub use stalls::read_stalls;
pub use stream::{MAX_CLAIMED_PIXELS, PacketStream, ShownFrame, StreamItem};
