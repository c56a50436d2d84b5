// SPDX-License-Identifier: MIT OR Apache-2.0
//! Figures in the format of the page, and the figures of its heading.

use crate::InferenceSummary;
use foveate_output::{
    number_text::{MISSING, grouped, percent, real_number},
    page::HeadingFigure,
};

/// Formats a share as a percentage.
pub(super) fn share_text(value: f64) -> String {
    format!("{} %", percent(value))
}

/// Formats an error as zero or with three digits.
pub(super) fn error_text(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if value.is_finite() => format!("{value:.2e}"),
        _ => MISSING.to_owned(),
    }
}

/// Formats a PSNR with its unit; equal outputs have an infinite PSNR.
pub(super) fn decibels_text(psnr: Option<f64>) -> String {
    psnr.map_or("infinite".to_owned(), |psnr| {
        if psnr.is_finite() { format!("{psnr:.1} dB") } else { MISSING.to_owned() }
    })
}

/// Formats a number of bytes with a unit.
#[allow(clippy::cast_precision_loss, reason = "shown with three digits")]
pub(super) fn bytes_text(count: u64) -> String {
    let size = count as f64;
    match count {
        0..1_000 => format!("{count} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", size / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", size / 1e6),
        _ => format!("{:.2} GB", size / 1e9),
    }
}

/// Formats a mean number of bytes with a unit.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mean of bytes is one"
)]
pub(super) fn mean_bytes_text(count: f64) -> String {
    bytes_text(count.round() as u64)
}

/// Formats a large count with a unit.
pub(super) fn large_count_text(count: f64) -> String {
    match count {
        _ if !count.is_finite() => MISSING.to_owned(),
        0.0..1e4 => real_number(count, 0),
        1e4..1e9 => format!("{} M", real_number(count / 1e6, if count < 1e5 { 3 } else { 1 })),
        _ => format!("{} G", real_number(count / 1e9, 2)),
    }
}

/// Formats a time in seconds as milliseconds.
pub(super) fn milliseconds_text(seconds: f64) -> String {
    let value = 1e3 * seconds;
    let digits = match value.abs() {
        0.0..0.01 => 4,
        0.01..0.1 => 3,
        _ => 2,
    };
    format!("{} ms", real_number(value, digits))
}

/// Formats an energy in millijoules.
pub(super) fn millijoules_text(value: f64) -> String {
    format!("{} mJ", real_number(value, if value.abs() < 0.1 { 4 } else { 3 }))
}

/// Returns the figures of the heading. Without a counted frame there are no shares.
pub(super) fn heading_facts(summary: &InferenceSummary) -> Vec<HeadingFigure> {
    // A value is not broken across lines.
    let whole = |value: String| value.replace(' ', "\u{a0}").replace('-', "\u{2011}");
    let fact = |name, value, note: String| HeadingFigure { name, value: whole(value), note };
    let mut facts = Vec::new();
    if summary.counted_frames > 0 {
        let (macs, active) = (&summary.macs, share_text(summary.active_share));
        let (dense, time) =
            (large_count_text(macs.whole_frame), milliseconds_text(summary.seconds_per_frame));
        facts.extend([
            fact("MACs needed", share_text(macs.needed_share()), format!("of {dense} per frame")),
            fact("MACs computed", share_text(macs.scheduled_share()), "whole blocks".to_owned()),
            fact("Regions changed", share_text(summary.changed_share), format!("{active} active")),
            fact("Time per frame", time, "on this computer".to_owned()),
        ]);
        facts.extend(summary.accelerator.as_ref().map(|found| {
            let [masked, all] =
                [found.masked, found.whole].map(|cost| millijoules_text(cost.energy_mj));
            fact("Energy per frame", masked, format!("whole {all}"))
        }));
        facts.extend(summary.error.map(|found| {
            let psnr = decibels_text(found.outputs.psnr);
            fact(
                "Relative RMS error",
                error_text(found.outputs.relative_rms),
                format!("PSNR {psnr}"),
            )
        }));
    }
    let (frames, counted) = (grouped(summary.frames), grouped(summary.counted_frames));
    facts.push(fact("Frames", frames, format!("{counted} counted")));
    facts.push(fact("Frame", format!("{}×{}", summary.width, summary.height), "pixels".to_owned()));
    facts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_the_unit_that_fits() {
        assert_eq!(
            [0, 999, 7_824_000, 4_000_000_000].map(bytes_text).join(", "),
            "0 bytes, 999 bytes, 7.8 MB, 4.00 GB"
        );
        assert_eq!(
            [0.0, 312.0, 14_700.0, 140_894_208.0, 4.1e9].map(large_count_text).join(", "),
            "0, 312, 0.015 M, 140.9 M, 4.10 G"
        );
        assert_eq!([0.0, 0.012_34, f64::NAN].map(error_text).join(", "), "0, 1.23e-2, –");
        assert_eq!(
            [None, Some(41.23), Some(f64::NAN)].map(decibels_text).join(", "),
            "infinite, 41.2 dB, –"
        );
        assert_eq!(
            [0.001_19, 0.000_06, 0.000_002].map(milliseconds_text).join(", "),
            "1.19 ms, 0.060 ms, 0.0020 ms"
        );
    }
}
