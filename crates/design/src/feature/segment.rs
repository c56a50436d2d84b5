// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `segment`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};
use crate::Design;
use foveate_camera::{SpatialFeature, bits_for};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // Two registers: the sum, the mean.
        plain_latency: 2,
        deep_latency: 2,
        rough_luts: 10.0,
    }),
    serial: Some(SerialFeature {
        pass_steps: |design, _| {
            4 * u64::from(design.region_pixels()) + 4 * u64::from(design.pixel_bits()) + 9
        },
        computes_operand: false,
        takes_accumulator: true,
        // The word holds the number of pixels above plus the number of those that are not below. It
        // is at most 2n - 1, because no mean has all pixels of its region above it.
        chain_bits: |design| bits_for(u64::from(2 * design.region_pixels() - 1)),
        registers,
        rough_luts: 3.5,
    }),
    raster: Some(RasterFeature { score_latency: 0, memory: None, rough_luts: 6.0 }),
};

/// The accumulator holds the sum of the region and half of n. The second word holds the mean
/// without its fraction.
fn registers(design: &Design, _: &SpatialFeature) -> FeatureRegisterWidths {
    let (n, pixel) = (u64::from(design.region_pixels()), design.pixel_bits());
    let dividend = n * ((1 << pixel) - 1) + n / 2;
    FeatureRegisterWidths {
        accumulator: bits_for(dividend) + 1,
        second: pixel,
        // The scale holds the shifted divisor.
        scale: design.count_bits() + pixel - 1,
    }
}
