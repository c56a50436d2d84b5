// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `corner`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // One register: the count of hits.
        plain_latency: 1,
        // Three registers: the comparison of the hit, the hit, the count.
        deep_latency: 3,
        rough_luts: 30.0,
    }),
    serial: Some(SerialFeature {
        pass_steps: |design, _| 36 * u64::from(design.region_pixels()),
        computes_operand: false,
        takes_accumulator: false,
        chain_bits: |_| 0,
        registers: |_, _| FeatureRegisterWidths::default(),
        rough_luts: 3.5,
    }),
    raster: Some(RasterFeature { score_latency: 0, memory: None, rough_luts: 14.0 }),
};
