// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits of everything that grows.

/// The largest number of cameras at a time.
pub const MAX_CAMERAS: usize = 8;

/// The largest number of pixels of a frame: that of 3840x2160.
pub const MAX_PIXELS: u32 = 3840 * 2160;

/// The largest file of a network in bytes.
pub const MAX_NETWORK_FILE: usize = 256 << 20;

/// The largest number of bytes that the tensors of a network take for a frame. A page has 4 GiB in
/// all.
pub const MAX_NETWORK_BYTES: u64 = 1 << 30;

/// The largest recording in bytes.
pub const MAX_RECORDING: usize = 64 << 20;
