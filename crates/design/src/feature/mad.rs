// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `mad`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};
use crate::Design;
use foveate_camera::{MeanDivision, SpatialFeature};

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // Two registers: the sum, the mean.
        plain_latency: 2,
        deep_latency: 2,
        rough_luts: 10.0,
    }),
    serial: Some(SerialFeature {
        pass_steps,
        computes_operand: true,
        takes_accumulator: true,
        chain_bits: |_| 0,
        registers,
        rough_luts: 6.0,
    }),
    raster: Some(RasterFeature { score_latency: 0, memory: None, rough_luts: 6.0 }),
};

fn pass_steps(design: &Design, feature: &SpatialFeature) -> u64 {
    let n = u64::from(design.region_pixels());
    let fraction_bits = u64::from(mean(feature).fraction_bits);
    2 * n + u64::from(design.pixel_bits()) + 2 * fraction_bits + 3
}

fn registers(design: &Design, feature: &SpatialFeature) -> FeatureRegisterWidths {
    let second = design.pixel_bits() + mean(feature).fraction_bits;
    FeatureRegisterWidths {
        accumulator: mean(feature).dividend_bits + 1,
        second,
        // The scale holds the shifted divisor.
        scale: design.count_bits() + second - 1,
    }
}

fn mean(feature: &SpatialFeature) -> &MeanDivision {
    feature.mean().expect("mad has a mean")
}
