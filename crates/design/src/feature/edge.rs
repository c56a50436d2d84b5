// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `edge`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // One register: the count of hits.
        plain_latency: 1,
        // Three registers: the comparison of the hit, the hit, the count.
        deep_latency: 3,
        rough_luts: 10.0,
    }),
    serial: Some(SerialFeature {
        pass_steps: |design, _| 14 * u64::from(design.region_pixels()),
        computes_operand: false,
        takes_accumulator: false,
        chain_bits: |_| 0,
        // The accumulator holds the sum of three pixels minus that of three others.
        registers: |design, _| FeatureRegisterWidths {
            accumulator: design.pixel_bits() + 3,
            ..FeatureRegisterWidths::default()
        },
        rough_luts: 2.0,
    }),
    raster: Some(RasterFeature { score_latency: 0, memory: None, rough_luts: 11.0 }),
};
