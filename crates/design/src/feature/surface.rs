// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `surface`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // Two registers: the sums, the score.
        plain_latency: 2,
        // Three registers: the differences, the sums, the score.
        deep_latency: 3,
        rough_luts: 20.0,
    }),
    serial: Some(SerialFeature {
        pass_steps: |design, _| {
            8 * u64::from(design.region_pixels()) + 11 * u64::from(design.pixel_sum_bits()) + 5
        },
        computes_operand: true,
        takes_accumulator: true,
        chain_bits: |_| 0,
        // The accumulator holds the difference of two sums. The second word holds the smallest.
        registers: |design, _| FeatureRegisterWidths {
            accumulator: design.pixel_sum_bits() + 1,
            second: design.pixel_sum_bits(),
            scale: design.pixel_sum_bits(),
        },
        rough_luts: 6.0,
    }),
    raster: Some(RasterFeature {
        score_latency: 2,
        memory: Some(("four sums of differences", |design, _| 4 * design.pixel_sum_bits())),
        rough_luts: 10.0,
    }),
};
