// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ends of what grows.

/// The most cameras at a time.
pub const MAX_CAMERAS: usize = 8;
/// The most pixels of a frame: those of 3840x2160.
pub const MAX_PIXELS: u32 = 3840 * 2160;
/// The most bytes of the file of a network.
pub const MAX_NETWORK_FILE: usize = 256 << 20;
/// The most bytes that the tensors of a network take for a frame. A page has 4 GiB for all.
pub const MAX_NETWORK_BYTES: u64 = 1 << 30;
/// The most bytes of a recording.
pub const MAX_RECORDING: usize = 64 << 20;
