// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits that a design must meet, and its distance from them.

use std::cmp::Ordering;

use foveate_camera::Camera;
use foveate_estimate::FrameRate;
use foveate_measure::FidelityFigures;
use serde::Serialize;

use super::decision_rates::{DecisionGroups, DecisionRate, DecisionRates, MIN_REGIONS};
use crate::cost::DesignArea;
use crate::row::{bytes_per_frame, count_to_f64};
use crate::target_process::{ProcessEnergy, ProcessFigures};

/// The limits that a design must meet. Shares are 0..=1. A limit that is `None` is not checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Constraints {
    /// The largest share of regions whose action differs from the ideal's.
    pub max_flips: Option<f64>,
    /// The largest share of the ideal's active area that is not active in the design, without the
    /// first frame of every clip.
    pub max_missed: Option<f64>,
    /// The largest share of the design's active area that is not active in the ideal, without the
    /// first frame of every clip.
    pub max_false_alarms: Option<f64>,
    /// The least PSNR of the screen against the ideal's screen, in dB.
    pub min_psnr: Option<f64>,
    /// The most frames in a row for which a relevant region may be stale.
    pub max_stale_frames: Option<u64>,
    /// The most bytes per frame that leave the array.
    pub max_bytes: Option<f64>,
    /// The least share of the objects of which at least half of the regions are active. It needs
    /// ground-truth boxes.
    pub min_recall: Option<f64>,
    /// The least number of frames per second at the clock; at the low end of the range of an
    /// estimated clock. A clock in the cells of a process has no range.
    pub min_fps: Option<f64>,
    /// The most LUTs of one RPU or lane, including those used as memory.
    pub max_lut: Option<u64>,
    /// The most flip-flops of one RPU or lane.
    pub max_ff: Option<u64>,
    /// The most LUTs of the array.
    pub max_array_lut: Option<u64>,
    /// The most block RAM of the array in units of `RAMB36`; a `RAMB18` is half of one.
    pub max_bram: Option<u64>,
    /// The largest area of the array in the cells of a process, in square millimetres.
    pub max_mm2: Option<f64>,
    /// The largest power of the array in the cells of a process in milliwatts, in the busiest
    /// stretch of all clips, if its clock stops when a frame is done.
    pub max_mw: Option<f64>,
}

/// The excess of a figure that is not known, so that it exceeds every limit.
const UNKNOWN_EXCESS: f64 = 64.0;

/// A limit and the figure that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConstraintCheck {
    /// The name of the option that sets the limit, without its dashes.
    pub name: &'static str,
    /// The figure. The PSNR of identical screens is infinite, and so is an area or a power that is
    /// not known; in JSON they are null.
    pub value: f64,
    /// The limit: the largest or the least value of the figure.
    pub limit: f64,
    /// True if the limit is a minimum.
    #[serde(rename = "at_least")]
    pub is_minimum: bool,
    /// True if the limit is met.
    pub holds: bool,
    /// The clock in MHz at which the frames per second hold; only for frames per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clock_mhz: Option<f64>,
    /// True if the figure is the one to expect of other frames, and not the one of these frames.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_expected: bool,
    /// The number of regions that the figure is a share of, if these are too few to decide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub too_few_regions: Option<f64>,
}

/// The figures of a camera in a part of all clips.
#[derive(Clone, Debug)]
pub(super) struct PartFigures {
    pub(super) figures: FidelityFigures,
    pub(super) decisions: DecisionGroups,
    /// The share of the objects that is sent, if it is limited.
    pub(super) recall: Option<f64>,
}

const RATE_NAMES: [&str; 3] = ["max-flips", "max-missed", "max-false-alarms"];

impl ConstraintCheck {
    fn check_at_most(name: &'static str, value: f64, limit: f64) -> Self {
        Self {
            is_minimum: false,
            holds: value <= limit,
            ..Self::check_at_least(name, value, limit)
        }
    }

    fn check_at_least(name: &'static str, value: f64, limit: f64) -> Self {
        let holds = value >= limit;
        Self {
            name,
            value,
            limit,
            is_minimum: true,
            holds,
            clock_mhz: None,
            is_expected: false,
            too_few_regions: None,
        }
    }

    /// Returns the constraint on a rate: the one to expect of other frames. A limit of 0 means that
    /// there is no error, and has no margin. With fewer than [`MIN_REGIONS`] regions a share is not
    /// known, and meets only a limit of 1.
    fn check_rate(name: &'static str, rate: &DecisionRate, limit: f64) -> Self {
        let is_expected = limit > 0.0;
        let value = if is_expected { rate.expected } else { rate.share };
        let too_few = (rate.regions < MIN_REGIONS && limit < 1.0).then_some(rate.regions);
        let check = Self::check_at_most(name, value, limit);
        let holds = check.holds && too_few.is_none();
        Self { holds, is_expected, too_few_regions: too_few, ..check }
    }

    /// Returns the constraint of a network's agreement, 0 to 1, with its least value.
    pub(super) fn check_agreement(share: f64, least: f64) -> Self {
        Self::check_at_least("min-agreement", share, least)
    }

    /// Returns the constraint of the agreement that is to be expected of other frames.
    pub(super) fn check_expected_agreement(share: f64, least: f64) -> Self {
        Self { is_expected: true, ..Self::check_agreement(share, least) }
    }

    /// Returns the distance of the figure from the limit: 0 if the limit is met, 1 if the figure is
    /// twice or half of the limit. The value is finite and comparable between limits.
    #[must_use]
    pub fn excess(&self) -> f64 {
        const LEAST: f64 = 1e-6;
        if self.holds {
            return 0.0;
        }
        if self.value.is_infinite() || self.too_few_regions.is_some() {
            return UNKNOWN_EXCESS;
        }
        let (more, less) =
            if self.is_minimum { (self.limit, self.value) } else { (self.value, self.limit) };
        (more.max(LEAST) / less.max(LEAST)).log2().max(LEAST)
    }

    /// Returns the figure and its limit as text.
    #[must_use]
    pub fn text(&self) -> String {
        let side = if self.is_minimum { "at least" } else { "at most" };
        let number = |value: f64| match self.name {
            "max-flips" | "max-missed" | "max-false-alarms" | "min-recall" | "min-agreement" => {
                format!("{:.2} %", value * 100.0)
            }
            "min-psnr" if value.is_infinite() => "identical".to_owned(),
            "min-psnr" => format!("{value:.1} dB"),
            "max-mm2" | "max-mw" if value.is_infinite() => "not known".to_owned(),
            "max-mm2" | "max-mw" => significant(value),
            "min-fps" | "max-bram" => hundredths(value),
            _ => format!("{value:.0}"),
        };
        let what = match self.name {
            "max-flips" => "flips",
            "max-missed" => "missed",
            "max-false-alarms" => "false alarms",
            "min-psnr" => "PSNR",
            "max-stale-frames" => "stale frames",
            "max-bytes" => "bytes per frame",
            "min-recall" => "objects sent by half",
            "min-agreement" => "agreement of the network",
            "min-fps" => "frames/s",
            "max-lut" => "LUTs of a unit",
            "max-ff" => "flip-flops of a unit",
            "max-array-lut" => "LUTs of the array",
            "max-mm2" => "mm2 of the array",
            "max-mw" => "mW in the busiest stretch",
            _ => "RAMB36",
        };
        if let Some(regions) = self.too_few_regions {
            return format!(
                "{what} undecided: they are a share of {regions:.0} regions in a part of the clips, and at least {MIN_REGIONS} are needed"
            );
        }
        let clock = self.clock_mhz.map(|mhz| format!(" at {} MHz", hundredths(mhz)));
        let clock = clock.unwrap_or_default();
        let what = if self.is_expected {
            format!("{what} expected for other frames")
        } else {
            what.to_owned()
        };
        format!("{what} {}{clock} ({side} {})", number(self.value), number(self.limit))
    }
}

/// Formats a number with four significant digits, or all digits before the point.
fn significant(value: f64) -> String {
    let text = format!("{value:.3e}");
    let exponent = text.split('e').nth(1).and_then(|exponent| exponent.parse::<i32>().ok());
    let decimals = usize::try_from(3 - exponent.unwrap_or(0)).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// Formats a number with at most two digits after the decimal point.
fn hundredths(value: f64) -> String {
    format!("{value:.2}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

pub(super) fn all_met(checks: &[ConstraintCheck]) -> bool {
    checks.iter().all(|check| check.holds)
}

/// Returns of each two checks of the same limit the one that is farther from its limit.
fn worse_checks(one: Vec<ConstraintCheck>, other: Vec<ConstraintCheck>) -> Vec<ConstraintCheck> {
    let is_worse = |check: &ConstraintCheck, than: &ConstraintCheck| {
        let (value, other) = (check.value, than.value);
        match check.excess().total_cmp(&than.excess()) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal if check.is_minimum => value < other,
            Ordering::Equal => value > other,
        }
    };
    let worse = |(one, other)| if is_worse(&other, &one) { other } else { one };
    one.into_iter().zip(other).map(worse).collect()
}

/// Returns the sum of the distances of all figures from their limits.
pub(super) fn total_excess(checks: &[ConstraintCheck]) -> f64 {
    checks.iter().map(ConstraintCheck::excess).sum()
}

impl Constraints {
    /// Returns the constraints on the decisions, the screen and the sent bytes of a camera over the
    /// held out frames.
    pub(super) fn check_figures(
        &self,
        camera: &Camera,
        part: &PartFigures,
    ) -> Vec<ConstraintCheck> {
        let FidelityFigures { action_flips, missed, false_alarms, .. } = part.figures;
        let rates = [action_flips, missed, false_alarms];
        let rates = RATE_NAMES.into_iter().zip(self.rate_limits()).zip(rates);
        let rate = |((name, limit), share): ((_, Option<f64>), f64)| {
            limit.map(|limit| ConstraintCheck::check_at_most(name, share, limit))
        };
        rates.filter_map(rate).chain(self.check_screen(camera, part)).collect()
    }

    /// Returns the constraints on the decisions, the screen and the sent bytes of a camera, each
    /// with the worse of its figures in two parts of the clips. Rates are those to expect of other
    /// frames.
    pub(super) fn check_parts(
        &self,
        camera: &Camera,
        ideal_side: u32,
        parts: &[PartFigures],
    ) -> Vec<ConstraintCheck> {
        let of_part = |part: &PartFigures| {
            let rates = part.decisions.rates((ideal_side, camera.region_size()));
            let mut checks = self.check_rates(&rates);
            checks.extend(self.check_screen(camera, part));
            checks
        };
        parts.iter().map(of_part).reduce(worse_checks).unwrap_or_default()
    }

    /// Returns the constraints on flips, missed regions and false alarms to expect of other frames.
    pub(super) fn check_rates(&self, rates: &DecisionRates) -> Vec<ConstraintCheck> {
        let DecisionRates { flips, missed, false_alarms } = rates;
        let all = RATE_NAMES.into_iter().zip(self.rate_limits()).zip([flips, missed, false_alarms]);
        let check = |((name, limit), rate): ((_, Option<f64>), &DecisionRate)| {
            limit.map(|limit| ConstraintCheck::check_rate(name, rate, limit))
        };
        all.filter_map(check).collect()
    }

    /// Returns the limits on flips, missed regions and false alarms.
    fn rate_limits(&self) -> [Option<f64>; 3] {
        [self.max_flips, self.max_missed, self.max_false_alarms]
    }

    fn check_screen(&self, camera: &Camera, part: &PartFigures) -> Vec<ConstraintCheck> {
        let PartFigures { figures, recall, .. } = part;
        let at_most = |name, limit: Option<f64>, value| {
            limit.map(|l| ConstraintCheck::check_at_most(name, value, l))
        };
        // Identical screens have the best PSNR.
        let psnr = figures.psnr_ideal.unwrap_or(f64::INFINITY);
        [
            self.min_psnr.map(|limit| ConstraintCheck::check_at_least("min-psnr", psnr, limit)),
            at_most(
                "max-stale-frames",
                self.max_stale_frames.map(count_to_f64),
                count_to_f64(figures.staleness.longest),
            ),
            at_most("max-bytes", self.max_bytes, bytes_per_frame(camera, figures)),
            self.min_recall
                .zip(*recall)
                .map(|(limit, r)| ConstraintCheck::check_at_least("min-recall", r, limit)),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Returns whether there is a limit on the screen or the sent bytes of a camera.
    pub(super) fn limits_figures(&self) -> bool {
        let Self { min_psnr, max_stale_frames, max_bytes, min_recall, .. } = self;
        let others = [min_psnr, max_bytes, min_recall];
        self.rate_limits().iter().chain(others).any(Option::is_some) || max_stale_frames.is_some()
    }

    /// Returns the constraint on speed, at the low end of the clock. Without a clock it is not met.
    #[must_use]
    pub fn check_speed(&self, speed: Option<&FrameRate>) -> Vec<ConstraintCheck> {
        let rate = speed.map_or(0.0, |speed| speed.low_frames_per_second);
        let clock_mhz = speed.map(|speed| speed.low_clock_mhz);
        let check = |limit| ConstraintCheck {
            clock_mhz,
            ..ConstraintCheck::check_at_least("min-fps", rate, limit)
        };
        self.min_fps.map(check).into_iter().collect()
    }

    /// Returns the constraints on area.
    #[must_use]
    pub fn check_area(&self, silicon: &DesignArea) -> Vec<ConstraintCheck> {
        let DesignArea { unit, array, .. } = silicon;
        [
            ("max-lut", count_to_f64(unit.lut_total_packed), self.max_lut),
            ("max-ff", count_to_f64(unit.ff), self.max_ff),
            ("max-array-lut", count_to_f64(array.lut_total_packed), self.max_array_lut),
            ("max-bram", count_to_f64(array.bram18) / 2.0, self.max_bram),
        ]
        .into_iter()
        .filter_map(|(name, value, limit)| {
            limit.map(|limit| ConstraintCheck::check_at_most(name, value, count_to_f64(limit)))
        })
        .collect()
    }

    /// Returns the constraint on the area in a process. An area that is not known does not meet it.
    #[must_use]
    pub fn check_process_area(&self, process: Option<&ProcessFigures>) -> Option<ConstraintCheck> {
        let mm2 = process.and_then(|process| process.mm2).unwrap_or(f64::INFINITY);
        self.max_mm2.map(|limit| ConstraintCheck::check_at_most("max-mm2", mm2, limit))
    }

    /// Returns the constraint on power. A power that is not known does not meet it.
    #[must_use]
    pub fn check_power(&self, energy: Option<&ProcessEnergy>) -> Option<ConstraintCheck> {
        let mw = energy.map_or(f64::INFINITY, |energy| energy.busiest_mw);
        self.max_mw.map(|limit| ConstraintCheck::check_at_most("max-mw", mw, limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_and_large_figures_have_four_digits() {
        let texts = [0.000_012_34, 0.076_643, 10.841, 12_345.6, 0.0].map(significant);
        assert_eq!(texts, ["0.00001234", "0.07664", "10.84", "12346", "0.000"]);
    }

    #[test]
    fn excess_is_nothing_when_it_holds_and_grows_with_distance() {
        assert!(ConstraintCheck::check_at_most("a", 1.0, 1.0).excess() == 0.0);
        assert!((ConstraintCheck::check_at_most("a", 4.0, 2.0).excess() - 1.0).abs() < 1e-12);
        assert!((ConstraintCheck::check_at_least("a", 60.0, 120.0).excess() - 1.0).abs() < 1e-12);
        let of_none = ConstraintCheck::check_at_most("a", 0.5, 0.0).excess();
        assert!(
            of_none.is_finite() && of_none > ConstraintCheck::check_at_most("a", 0.5, 0.1).excess()
        );
    }

    /// A camera that never sends has no false alarms, and no limit on them is known to hold.
    #[test]
    fn a_rate_of_too_few_regions_is_undecided() {
        let rate = |regions| DecisionRate { share: 0.0, expected: 0.01, regions };
        let check =
            |regions, limit| ConstraintCheck::check_rate("max-false-alarms", &rate(regions), limit);
        assert!(check(49.0, 0.1).holds && !check(48.0, 0.1).holds && check(0.0, 1.0).holds);
        let text = check(48.0, 0.1).text();
        assert_eq!(
            text,
            "false alarms undecided: they are a share of 48 regions in a part of the clips, and at least 49 are needed"
        );
        assert!(check(48.0, 0.1).excess() > check(49.0, 1e-6).excess());
        // A limit of 0 has no margin.
        let exact = check(49.0, 0.0);
        assert!(exact.holds && !exact.is_expected && !check(49.0, 0.005).holds);
    }

    #[test]
    fn the_worse_of_two_parts_counts() {
        let check = |value| ConstraintCheck::check_at_most("max-flips", value, 0.02);
        let worse = |one, other| worse_checks(vec![check(one)], vec![check(other)])[0].value;
        assert_eq!(
            [worse(0.01, 0.015), worse(0.015, 0.01), worse(0.03, 0.01)],
            [0.015, 0.015, 0.03]
        );
        let psnr = |value| ConstraintCheck::check_at_least("min-psnr", value, 20.0);
        assert_eq!(worse_checks(vec![psnr(30.0)], vec![psnr(25.0)])[0].value, 25.0);
    }
}
