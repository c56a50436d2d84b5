// SPDX-License-Identifier: MIT OR Apache-2.0
//! The division by a reciprocal, which must equal floor division for every input.

use foveate_camera::FeatureKind;
use rayon::prelude::*;

use crate::stress::designs::{config, design};
use crate::stress::{CaseRow, RunDepth};

/// Tests every N, powers of two included, for several P and f.
///
/// `(x * m) >> s` never falls as x grows, and neither does `floor(x / n)`. So the two are equal for
/// all x if they are equal at both ends of every run of x with the same quotient: at `q * n` and at
/// `q * n + n - 1`, for every q. Trying these values proves all others.
pub(crate) fn reciprocals(depth: RunDepth) -> Vec<CaseRow> {
    let kinds: &[(u32, u32)] = depth.choose(
        &[(8, 0), (10, 2), (16, 0)],
        &[(1, 0), (8, 0), (8, 6), (10, 2), (12, 4), (16, 0), (16, 4)],
    );
    kinds.iter().map(|&kind| reciprocal_row(kind)).collect()
}

fn reciprocal_row((bits, fraction_bits): (u32, u32)) -> CaseRow {
    let sides: Vec<u32> = (2..=64).filter(|side| fraction_limit(*side) >= fraction_bits).collect();
    let (wrong, tried, worst) = sides
        .par_iter()
        .map(|&side| try_every_quotient(side, bits, fraction_bits))
        .reduce(|| (0, 0, 0), |a, b| (a.0 + b.0, a.1 + b.1, a.2.max(b.2)));
    let designs = format!("{} sizes N, P {bits}, f {fraction_bits}", sides.len());
    CaseRow::for_no_errors(
        "mean by reciprocal, every dividend",
        designs,
        "quotients wrong",
        (wrong, tried),
        worst,
    )
}

/// Returns the largest number of fraction bits, ceil(log2 n).
fn fraction_limit(side: u32) -> u32 {
    u32::BITS - (side * side - 1).leading_zeros()
}

fn try_every_quotient(side: u32, bits: u32, fraction_bits: u32) -> (u64, u64, u64) {
    let mut config = config((side, side), side, bits, &[FeatureKind::Mad]);
    config.camera.spatial[0].mean_fraction_bits = Some(fraction_bits);
    let design = design(&config);
    let Some(reciprocal) = design.features()[0].mean().map(|mean| mean.reciprocal) else {
        return (1, 1, 1);
    };
    let (n, last) = (reciprocal.divisor(), reciprocal.x_max());
    let mut result = (0, 0, 0);
    for quotient in 0..=last / n {
        for x in [quotient * n, (quotient * n + n - 1).min(last)] {
            let error = reciprocal.divide(x).abs_diff(quotient);
            result = (result.0 + u64::from(error > 0), result.1 + 1, result.2.max(error));
        }
    }
    result
}
