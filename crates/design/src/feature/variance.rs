// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of `variance`.

use super::{
    FeatureHardware, FeatureRegisterWidths, PipelinedFeature, RasterFeature, SerialFeature,
};
use crate::Design;
use foveate_camera::SpatialFeature;

pub(super) const HARDWARE: FeatureHardware = FeatureHardware {
    pipelined: Some(PipelinedFeature {
        // Two registers: the sums, the score.
        plain_latency: 2,
        // Three registers: the square, the sums, the score.
        deep_latency: 3,
        rough_luts: 10.0,
    }),
    serial: Some(SerialFeature {
        pass_steps,
        computes_operand: true,
        takes_accumulator: true,
        chain_bits: |_| 0,
        registers: |design, _| FeatureRegisterWidths {
            accumulator: design.pixel_sum_bits() + 1,
            second: design.pixel_sum_bits(),
            scale: design.pixel_bits() + design.count_bits(),
        },
        rough_luts: 6.0,
    }),
    raster: Some(RasterFeature {
        score_latency: 3,
        memory: Some(("sums of squares", square_sum_bits)),
        rough_luts: 6.0,
    }),
};

fn pass_steps(design: &Design, _: &SpatialFeature) -> u64 {
    let n = u64::from(design.region_pixels());
    let (pixel, ones) = (u64::from(design.pixel_bits()), u64::from(n.count_ones()));
    let (sum, count) = (u64::from(design.pixel_sum_bits()), u64::from(design.count_bits()));
    n + pixel * n * ones + 2 * sum + pixel + count + 2
}

fn square_sum_bits(_: &Design, feature: &SpatialFeature) -> u32 {
    feature.variance().expect("variance has sums of squares").square_sum_bits
}
