// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many bits per pixel are shown.

/// Bits per pixel of the PNG that shows pixels of `bits` bits: 8 up to 8, else 16.
#[must_use]
pub fn display_depth(bits: u32) -> u32 {
    if bits <= 8 { 8 } else { 16 }
}
