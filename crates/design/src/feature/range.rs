// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `range`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // Two registers: the extremes, the score.
        plain_latency: 2,
        // Three registers: the pixel, the extremes, the score.
        deep_latency: 3,
        rough_luts: 10.0,
    }),
    serial: Some(SerialFeature {
        pass_steps: |design, _| {
            4 * u64::from(design.region_pixels()) + u64::from(design.pixel_bits()) + 2
        },
        computes_operand: true,
        takes_accumulator: true,
        chain_bits: |_| 0,
        // The accumulator holds the difference of a pixel from the largest so far.
        registers: |design, _| FeatureRegisterWidths {
            accumulator: design.pixel_bits() + 1,
            second: design.pixel_bits(),
            scale: design.pixel_bits(),
        },
        rough_luts: 6.0,
    }),
    raster: Some(RasterFeature {
        score_latency: 1,
        memory: Some(("smallest and largest pixels", |design, _| 2 * design.pixel_bits())),
        rough_luts: 6.0,
    }),
};
