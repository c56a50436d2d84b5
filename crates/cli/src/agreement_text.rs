// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text with which several commands print the agreement of a network's outputs.

use foveate_inference::{ConfidenceIntervals, NoiseAgreement};

/// Returns the confidence interval of an agreement over few samples, to be put behind it. The text
/// is empty if there is no such interval.
pub(crate) fn interval_text(intervals: &ConfidenceIntervals) -> String {
    intervals.wide_agreement().map_or_else(String::new, |[low, high]| {
        format!(" (95 % interval {:.1} to {:.1} %)", 100.0 * low, 100.0 * high)
    })
}

pub(crate) fn grey_levels(levels: f64) -> String {
    #[allow(clippy::float_cmp, reason = "exactly one is singular")]
    let unit = if levels == 1.0 { "grey level" } else { "grey levels" };
    format!("{levels} {unit}")
}

/// Returns the text about the agreement under noise.
pub(crate) fn noise_text(noisy: &NoiseAgreement) -> String {
    let detections = noisy.kept_share.zip(noisy.precision).map_or_else(
        || format!("; relative RMS error of the outputs {:.2e}", noisy.relative_rms),
        |(kept, right)| format!("; {:.1} % kept, {:.1} % right", 100.0 * kept, 100.0 * right),
    );
    let (agreement, interval) = (100.0 * noisy.agreement, interval_text(&noisy.intervals));
    format!("agreement {agreement:.1} %{interval}{detections}")
}
