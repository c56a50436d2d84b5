// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report as Markdown, for people. A kB is 1000 bytes.

use std::fmt::Write as _;

use crate::link::{ClipReport, LinkReport, SenderReport, UnbufferedFigures};

const COLUMNS: [&str; 14] = [
    "sender",
    "equal",
    "quantizer",
    "PSNR [dB]",
    "SSIM",
    "kB/s",
    "x region",
    "1 ms: p99, peak",
    "10 ms",
    "100 ms",
    "largest frame [kB]",
    "decision [ms]",
    "last byte: median, longest [ms]",
    "buffer [kB]",
];

impl LinkReport {
    /// Returns a table per clip. The rates of windows are in kB/s.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for (number, clip) in self.clips.iter().enumerate() {
            let _ = write!(
                text,
                "{}{}: {} frames of {} x {} pixels in {} ms, link {} kB/s{}\n\n{}\n\n",
                if number == 0 { "" } else { "\n" },
                clip.name,
                clip.frames,
                clip.width,
                clip.height,
                clip.duration_ns / 1_000_000,
                thousands_text(self.link_bits_per_second / 8),
                if clip.problem.is_some() { ", NOT COMPLETE" } else { "" },
                self.clock(clip),
            );
            let _ = writeln!(text, "| {} |", COLUMNS.join(" | "));
            let _ = writeln!(text, "| --- | --- |{}", " ---: |".repeat(COLUMNS.len() - 2));
            for sender in &clip.senders {
                let _ = writeln!(text, "| {} |", row(clip, sender).join(" | "));
            }
            for figures in clip.senders.iter().filter_map(|sender| sender.unbuffered.as_ref()) {
                let _ = writeln!(text, "\n{}", unbuffered_text(clip, figures));
            }
        }
        text
    }

    /// Describes the clock of the array, or the clocks that are left out without one.
    fn clock(&self, clip: &ClipReport) -> String {
        match self.clock_hz {
            Some(hertz) => format!("The array runs at {} MHz.", millions_text(hertz)),
            None => format!(
                "Without --clock: at {} MHz, the slowest clock that keeps up, the array adds up to {} clocks to the times of the region camera.",
                millions_text(clip.needed_clock_hz),
                clip.array_clocks
            ),
        }
    }
}

/// Describes an array that gives its words to the link without a buffer.
fn unbuffered_text(clip: &ClipReport, figures: &UnbufferedFigures) -> String {
    format!(
        "Without a buffer behind the array, at {} MHz, {}. The link takes the last word of a row of regions at most {} ms after its oldest pixel was read.",
        millions_text(figures.clock_hz),
        figures.losses_text(clip.frames),
        milliseconds_text(figures.last_word_ns)
    )
}

impl UnbufferedFigures {
    /// Describes the regions that are lost in a clip of so many frames, for people.
    #[must_use]
    pub fn losses_text(&self, frames: u64) -> String {
        match self.frames_with_losses[..] {
            [] => "no region is lost".to_owned(),
            [first, ..] => format!(
                "lost regions: {}, in {} of {frames} frames, first in frame {first}",
                self.lost_regions,
                self.frames_with_losses.len(),
            ),
        }
    }
}

/// Formats ns as ms with three decimals; further digits are cut off.
#[must_use]
pub fn milliseconds_text(ns: u64) -> String {
    thousandths_text(ns / 1000, 3)
}

/// Formats millions exactly, as MHz or Mbit.
pub(crate) fn millions_text(value: u64) -> String {
    let digits = format!("{}.{:06}", value / 1_000_000, value % 1_000_000);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn row(clip: &ClipReport, sender: &SenderReport) -> [String; COLUMNS.len()] {
    let figures = &sender.figures;
    let [one, ten, hundred] = figures
        .windows
        .map(|rates| format!("{}, {}", thousands_text(rates.p99), thousands_text(rates.peak)));
    let delivery = figures.delivery_ns;
    let grows = if figures.overloaded { "grows: " } else { "" };
    let ms = milliseconds_text;
    [
        sender.sender.to_owned(),
        sender.equal.map_or("-".to_owned(), str::to_uppercase),
        quantizer(sender),
        psnr(sender),
        sender.quality.map_or("-".to_owned(), |quality| format!("{:.4}", quality.ssim)),
        thousands_text(figures.bytes_per_second),
        ratio(clip, sender),
        one,
        ten,
        hundred,
        thousands_text(figures.largest_frame_bytes),
        ms(figures.decision_ns),
        format!("{}, {}", ms(delivery.median), ms(delivery.longest)),
        format!("{grows}{}", thousands_text(figures.buffer_bytes)),
    ]
}

fn quantizer(sender: &SenderReport) -> String {
    let Some(quantizer) = sender.quantizer else { return "-".to_owned() };
    match sender.search_result {
        Some("finest") => format!("{quantizer}: not reached"),
        Some("coarsest") => format!("{quantizer}: still better"),
        _ => quantizer.to_string(),
    }
}

fn psnr(sender: &SenderReport) -> String {
    sender.quality.map_or("-".to_owned(), |quality| {
        quality.psnr.map_or("equal".to_owned(), |psnr| format!("{psnr:.2}"))
    })
}

/// Formats the bytes as a multiple of those of the region camera.
fn ratio(clip: &ClipReport, sender: &SenderReport) -> String {
    let own = clip.senders.iter().find(|sender| sender.sender.starts_with("region"));
    #[allow(clippy::cast_precision_loss, reason = "shown with three decimals")]
    let ratio = own.map(|own| sender.figures.bytes as f64 / own.figures.bytes.max(1) as f64);
    ratio.map_or(String::new(), |ratio| format!("{ratio:.3}"))
}

/// Formats thousands with one decimal, rounded to the nearest.
fn thousands_text(value: u64) -> String {
    thousandths_text((value + 50) / 100 * 100, 1)
}

/// Formats thousandths with one to three decimals; further digits are cut off.
fn thousandths_text(value: u64, decimals: usize) -> String {
    let thousandths = format!("{:03}", value % 1000);
    format!("{}.{}", value / 1000, &thousandths[..decimals])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_rounded_and_thousandths_are_cut() {
        assert_eq!([0, 49, 50, 12_345].map(thousands_text), ["0.0", "0.0", "0.1", "12.3"]);
        assert_eq!([thousandths_text(1_002, 3), thousandths_text(999, 1)], ["1.002", "0.9"]);
    }
}
