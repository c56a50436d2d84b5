// SPDX-License-Identifier: MIT OR Apache-2.0
//! What gets on a link at one time.

/// Bits that a camera or encoder gives to the link at one time: a row, a row of regions, a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// The frame that it belongs to.
    pub frame: u64,
    /// When the sensor has read the oldest pixel that it is about, in ns.
    pub read: u64,
    /// When it was decided what is sent, in ns.
    pub decided: u64,
    /// When the bits are given to the link, in ns.
    pub sent: u64,
    /// How many they are.
    pub bits: u64,
}
