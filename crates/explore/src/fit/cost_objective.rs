// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost that a fit minimizes.

use serde::Serialize;

/// The cost of designs that a fit minimizes among those that meet the limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum CostObjective {
    /// The bytes that leave the camera; the share of the FPGA decides between cameras with equal
    /// bytes. It needs a network.
    Bytes,
    /// The share of the FPGA, a VCU118, that the array takes.
    Area,
    /// The area of the array in the cells of a process, in square millimetres. It needs a process.
    Mm2,
    /// The power of the array in the cells of a process at the wanted frame rate, in the usual
    /// stretches of the clips. It needs a process.
    Energy,
}
