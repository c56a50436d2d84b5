// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the integer scores against the usual formulas in floating point.

use foveate_design::DesignConfig;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

use crate::frames::SeededRandom;

fn scores(side: u32, bits: u32, fraction_bits: u32, pixels: &[u16]) -> (f64, f64) {
    let design = DesignConfig::from_toml(&format!(
        "[frame]\nwidth = {side}\nheight = {side}\npixel_bits = {bits}\n[region]\nsize = {side}\n\
         [denoise]\nfilter = \"none\"\n[temporal]\nlevel = 0\nmin_count = 0\n\
         [[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = {fraction_bits}\nmin_score = 0\n\
         [[spatial]]\nfeature = \"variance\"\nmin_score = 0\n"
    ));
    let mut camera = FunctionalCamera::new(&design.unwrap().validate().unwrap());
    let outcome = camera.step(&Frame::new(side, side, bits, pixels.to_vec()).unwrap()).unwrap();
    let n = f64::from(side * side);
    let mad = outcome.scores[0][0] as f64 / n / f64::from(1 << fraction_bits);
    (mad, outcome.scores[1][0] as f64 / n / n)
}

#[test]
fn mad_and_variance_are_what_their_names_say() {
    let mut random = SeededRandom(7);
    for side in [2u32, 3, 5, 8, 16, 64] {
        for bits in [1, 8, 12, 16] {
            let n = side * side;
            let pixels: Vec<u16> = (0..n).map(|_| random.below(1 << bits) as u16).collect();
            let mean = pixels.iter().map(|&p| f64::from(p)).sum::<f64>() / f64::from(n);
            let average = |term: &dyn Fn(f64) -> f64| {
                pixels.iter().map(|&p| term(f64::from(p) - mean)).sum::<f64>() / f64::from(n)
            };
            let (mad, variance) = (average(&f64::abs), average(&|d| d * d));
            let exact_bits = (0..).find(|bits| 1 << bits >= n).unwrap();
            for fraction_bits in [0, exact_bits / 2, exact_bits] {
                let (got_mad, got_variance) = scores(side, bits, fraction_bits, &pixels);
                assert!((got_variance - variance).abs() <= 1e-9 * variance, "{side} {bits}");
                // No deviation differs from the exact one by more than the mean does.
                let exact = n.is_power_of_two() && fraction_bits == exact_bits;
                let off = if exact { 0.0 } else { 0.5 / f64::from(1 << fraction_bits) };
                assert!((got_mad - mad).abs() <= off + 1e-9 * mad, "{side} {bits} {fraction_bits}");
            }
        }
    }
}
