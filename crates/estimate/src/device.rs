// SPDX-License-Identifier: MIT OR Apache-2.0
//! The device of the paper, and the share of it that an array takes.

use serde::{Deserialize, Serialize};

use crate::area::{Area, rounded_quotient};
use crate::speed::count_to_f64;

/// The resources of a device.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FpgaDevice {
    /// The name of the part.
    pub name: String,
    /// The number of LUTs.
    pub lut: u64,
    /// The number of LUTs that can be memory.
    pub lut_memory: u64,
    /// The number of flip-flops.
    pub ff: u64,
    /// The number of DSP blocks.
    pub dsp: u64,
    /// The block RAM in units of `RAMB18`.
    pub bram18: u64,
}

/// The XCVU9P of the VCU118 board: name, and the numbers of LUTs, memory LUTs, flip-flops, DSP
/// blocks and RAMB18.
pub const XCVU9P: (&str, [u64; 5]) = ("XCVU9P", [1_182_240, 591_840, 2_364_480, 6_840, 2 * 2_160]);

impl FpgaDevice {
    /// Returns the paper's device.
    #[must_use]
    pub fn xcvu9p() -> Self {
        let (name, [lut, lut_memory, ff, dsp, bram18]) = XCVU9P;
        Self { name: name.to_owned(), lut, lut_memory, ff, dsp, bram18 }
    }

    /// Returns the cost of an area: the sum of its shares of the device in LUTs, block RAM and DSP
    /// blocks, and a hundredth of its share of flip-flops, of which there are two for every LUT.
    #[must_use]
    pub fn cost(&self, area: &Area) -> f64 {
        let share = |used: u64, of: u64| count_to_f64(used) / count_to_f64(of);
        share(area.lut_total_packed, self.lut)
            + share(area.bram18, self.bram18)
            + share(area.dsp, self.dsp)
            + share(area.ff, self.ff) / 100.0
    }
}

/// The share of the device that the RCM takes, in percent of each resource.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DeviceShare {
    /// The share of the LUTs, by `lut_total`.
    pub lut: f64,
    /// The share of the LUTs that can be memory, by `lut_memory`.
    pub lut_memory: f64,
    /// The share of the flip-flops.
    pub ff: f64,
    /// The share of the DSP blocks.
    pub dsp: f64,
    /// The share of the block RAM.
    pub bram: f64,
}

impl DeviceShare {
    pub(crate) fn new(area: &Area, device: &FpgaDevice) -> Self {
        Self {
            lut: rounded_quotient(area.lut_total * 100, device.lut),
            lut_memory: rounded_quotient(area.lut_memory * 100, device.lut_memory),
            ff: rounded_quotient(area.ff * 100, device.ff),
            dsp: rounded_quotient(area.dsp * 100, device.dsp),
            bram: rounded_quotient(area.bram18 * 100, device.bram18),
        }
    }
}
