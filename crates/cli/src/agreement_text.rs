// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words in which several commands print how much a network keeps.

use foveate_inference::{ConfidenceIntervals, NoiseAgreement};

/// The interval of an agreement over few things, as what follows it.
pub(crate) fn confidence(intervals: &ConfidenceIntervals) -> String {
    intervals.of_few().map_or_else(String::new, |[low, high]| {
        format!(" (95 % interval {:.1} to {:.1} %)", 100.0 * low, 100.0 * high)
    })
}

/// So many levels, with their unit.
pub(crate) fn grey_levels(levels: f64) -> String {
    #[allow(clippy::float_cmp, reason = "exactly one is singular")]
    let unit = if levels == 1.0 { "grey level" } else { "grey levels" };
    format!("{levels} {unit}")
}

/// The lines about the agreement under noise.
pub(crate) fn noisy_shares(noisy: &NoiseAgreement) -> String {
    let detections = noisy.kept_share.zip(noisy.precision).map_or_else(
        || format!("; relative RMS error of the outputs {:.2e}", noisy.relative_rms),
        |(kept, right)| format!("; {:.1} % kept, {:.1} % right", 100.0 * kept, 100.0 * right),
    );
    let (agreement, interval) = (100.0 * noisy.agreement, confidence(&noisy.intervals));
    format!("agreement {agreement:.1} %{interval}{detections}")
}
