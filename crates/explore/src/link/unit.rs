// SPDX-License-Identifier: MIT OR Apache-2.0
//! The unit of data that is given to a link at one time.

/// The bits that a camera or an encoder gives to the link at one time: those of a row, a row of
/// regions, or a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkUnit {
    /// The number of the frame that the bits belong to.
    pub frame: u64,
    /// The time at which the sensor has read the oldest pixel that the bits describe, in ns.
    pub read_ns: u64,
    /// The time of the decision on what is sent, in ns.
    pub decided_ns: u64,
    /// The time at which the bits are given to the link, in ns.
    pub sent_ns: u64,
    /// The number of bits.
    pub bits: u64,
}
