// SPDX-License-Identifier: MIT OR Apache-2.0
//! The variance of data with a large mean and a small spread, for which the sum of squares and the
//! square of the sum agree in their leading digits.

use foveate_camera::{FeatureKind, bits_for};
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

use crate::stress::designs::{config, design};
use crate::stress::test_frames::RandomNumbers;
use crate::stress::{CaseRow, RunDepth};

/// Compares our integers and a single-pass variance in f32 with two passes in f64.
pub(crate) fn large_mean_variance(depth: RunDepth) -> Vec<CaseRow> {
    let regions = depth.choose(200, 5_000);
    [(8, 8), (32, 8), (8, 16), (64, 16)]
        .into_iter()
        .flat_map(|size| integer_and_f32_rows(size, regions))
        .collect()
}

fn integer_and_f32_rows((side, bits): (u32, u32), regions: u32) -> [CaseRow; 2] {
    let mut config = config((side, side), side, bits, &[FeatureKind::Variance]);
    config.camera.denoise.filter = foveate_camera::DenoiseFilter::None;
    let design = design(&config);
    let mut random = RandomNumbers::new(u64::from(side));
    let base = design.pixel_max() - 4;
    let (mut integer_error, mut f32_error) = (0.0_f64, 0.0_f64);
    for _ in 0..regions {
        let region = crate::stress::test_frames::frame_from_fn((side, side), bits, {
            let spread: Vec<u32> = (0..design.region_pixels())
                .map(|_| u32::try_from(random.below(4)).expect("below 4"))
                .collect();
            move |x, y| base + spread[(y * side + x) as usize]
        });
        let exact = two_pass_variance(&region);
        let mut camera = FunctionalCamera::new(&design);
        let score = camera.step(&region).expect("the region is a frame of the design").scores[0][0];
        let n = f64::from(design.region_pixels());
        integer_error = integer_error.max((to_f64(score) / (n * n) - exact).abs() / exact);
        f32_error = f32_error.max((f64::from(single_pass_variance(&region)) - exact).abs() / exact);
    }
    let designs = format!("variance, N {side}, P {bits}, mean {}", base + 2);
    let row = |case, expected: &str, error: f64, holds| CaseRow {
        case,
        designs: designs.clone(),
        expected: expected.to_owned(),
        observed: format!("{:.2e} of it", error),
        worst: format!("{:.2e}", error),
        is_as_expected: holds,
    };
    // If the sum of squares fits into the 24 bits of an f32, it is exact.
    let cancels = bits_for(u64::from(design.region_pixels()) * u64::from(base + 3).pow(2)) > 24;
    [
        row("variance, integers", "error below 1e-9", integer_error, integer_error < 1e-9),
        row(
            "variance, single-pass f32 (not used)",
            if cancels { "error above 10 %" } else { "error below 10 %" },
            f32_error,
            (f32_error > 0.1) == cancels,
        ),
    ]
}

fn two_pass_variance(region: &Frame) -> f64 {
    let pixels = || region.pixels().iter().map(|&pixel| f64::from(pixel));
    let n = pixels().map(|_| 1.0).sum::<f64>();
    let mean = pixels().sum::<f64>() / n;
    pixels().map(|pixel| (pixel - mean) * (pixel - mean)).sum::<f64>() / n
}

fn single_pass_variance(region: &Frame) -> f32 {
    let (mut n, mut sum, mut squares) = (0.0_f32, 0.0_f32, 0.0_f32);
    for &pixel in region.pixels() {
        let pixel = f32::from(pixel);
        n += 1.0;
        sum += pixel;
        squares += pixel * pixel;
    }
    squares / n - (sum / n) * (sum / n)
}

#[allow(clippy::cast_precision_loss, reason = "compared within 1e-9")]
fn to_f64(value: u64) -> f64 {
    value as f64
}
