// SPDX-License-Identifier: MIT OR Apache-2.0
//! Limits that a design must meet, and how far it is from them.

use foveate_camera::Camera;
use foveate_estimate::Speed;
use foveate_fidelity::Figures;
use serde::Serialize;

use crate::cost::Silicon;
use crate::row::{bytes_per_frame, real};

/// Limits that a design must meet. Shares are 0..=1. A limit that is `None` is not checked.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Constraints {
    /// Share of regions whose action differs from the ideal's.
    pub max_flips: Option<f64>,
    /// Share of the area active in the ideal that is not active in the design.
    pub max_missed: Option<f64>,
    /// PSNR of the screen against that of the ideal, in dB.
    pub min_psnr: Option<f64>,
    /// Frames in a row for which a relevant region may be stale.
    pub max_stale_frames: Option<u64>,
    /// Bytes per frame that leave the array.
    pub max_bytes: Option<f64>,
    /// Share of the objects of which at least half of the regions are active. It needs boxes.
    pub min_recall: Option<f64>,
    /// Frames per second at the clock; of an estimated clock at the low end of its range.
    pub min_fps: Option<f64>,
    /// LUTs of one RPU or lane, those used as memory included.
    pub max_lut: Option<u64>,
    /// Flip-flops of one RPU or lane.
    pub max_ff: Option<u64>,
    /// LUTs of the array.
    pub max_array_lut: Option<u64>,
    /// Block RAM of the array in units of `RAMB36`, of which a `RAMB18` is half.
    pub max_bram: Option<u64>,
}

/// A limit with the figure that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// The option that sets it, without its dashes.
    pub name: &'static str,
    /// The figure; infinite, which JSON has as null, for the PSNR of identical screens.
    pub value: f64,
    /// The limit: the most or the least that the figure may be.
    pub limit: f64,
    /// Whether the limit is a minimum.
    pub at_least: bool,
    /// Whether the limit is met.
    pub holds: bool,
    /// Of frames per second: the clock in MHz that they hold at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clock_mhz: Option<f64>,
    /// Whether the figure is the one to expect of other frames, and not that of these.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_expected: bool,
}

impl Held {
    fn at_most(name: &'static str, value: f64, limit: f64) -> Self {
        Self { at_least: false, holds: value <= limit, ..Self::at_least(name, value, limit) }
    }

    fn at_least(name: &'static str, value: f64, limit: f64) -> Self {
        let holds = value >= limit;
        Self { name, value, limit, at_least: true, holds, clock_mhz: None, is_expected: false }
    }

    /// The agreement of a network, 0 to 1, and the least that is wanted.
    pub(super) fn agreement(share: f64, least: f64) -> Self {
        Self::at_least("min-agreement", share, least)
    }

    /// The agreement that is to be expected of other frames.
    pub(super) fn expected_agreement(share: f64, least: f64) -> Self {
        Self { is_expected: true, ..Self::agreement(share, least) }
    }

    /// How far the figure is from the limit: 0 if the limit is met, 1 if the figure is twice or half of it.
    /// The value is finite and comparable between limits.
    #[must_use]
    pub fn excess(&self) -> f64 {
        const LEAST: f64 = 1e-6;
        if self.holds {
            return 0.0;
        }
        let (more, less) =
            if self.at_least { (self.limit, self.value) } else { (self.value, self.limit) };
        (more.max(LEAST) / less.max(LEAST)).log2().max(LEAST)
    }
}

/// Whether all limits are met.
pub(super) fn all_hold(held: &[Held]) -> bool {
    held.iter().all(|held| held.holds)
}

/// How far all figures together are from their limits.
pub(super) fn excess(held: &[Held]) -> f64 {
    held.iter().map(Held::excess).sum()
}

impl Constraints {
    /// The constraints on what a camera sees and sends; `recall` is known where it is limited.
    #[must_use]
    pub fn on_figures(&self, camera: &Camera, figures: &Figures, recall: Option<f64>) -> Vec<Held> {
        let at_most =
            |name, limit: Option<f64>, value| limit.map(|l| Held::at_most(name, value, l));
        // Screens that are identical are as near as can be.
        let psnr = figures.psnr_ideal.unwrap_or(f64::INFINITY);
        [
            at_most("max-flips", self.max_flips, figures.action_flips),
            at_most("max-missed", self.max_missed, figures.missed),
            self.min_psnr.map(|limit| Held::at_least("min-psnr", psnr, limit)),
            at_most(
                "max-stale-frames",
                self.max_stale_frames.map(real),
                real(figures.staleness.longest),
            ),
            at_most("max-bytes", self.max_bytes, bytes_per_frame(camera, figures)),
            self.min_recall.zip(recall).map(|(limit, r)| Held::at_least("min-recall", r, limit)),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Whether there is one of those on what a camera sees and sends.
    pub(super) fn limits_figures(&self) -> bool {
        let Self {
            max_flips, max_missed, min_psnr, max_stale_frames, max_bytes, min_recall, ..
        } = self;
        let shares = [max_flips, max_missed, min_psnr, max_bytes, min_recall];
        shares.iter().any(|limit| limit.is_some()) || max_stale_frames.is_some()
    }

    /// The constraint on speed, at the low end of the clock. Without a clock it is not met.
    #[must_use]
    pub fn on_speed(&self, speed: Option<&Speed>) -> Vec<Held> {
        let rate = speed.map_or(0.0, |speed| speed.low_frames_per_second);
        let clock_mhz = speed.map(|speed| speed.low_clock_mhz);
        let held = |limit| Held { clock_mhz, ..Held::at_least("min-fps", rate, limit) };
        self.min_fps.map(held).into_iter().collect()
    }

    /// The constraints on area.
    #[must_use]
    pub fn on_silicon(&self, silicon: &Silicon) -> Vec<Held> {
        let Silicon { unit, array, .. } = silicon;
        [
            ("max-lut", real(unit.lut_total_packed), self.max_lut),
            ("max-ff", real(unit.ff), self.max_ff),
            ("max-array-lut", real(array.lut_total_packed), self.max_array_lut),
            ("max-bram", real(array.bram18) / 2.0, self.max_bram),
        ]
        .into_iter()
        .filter_map(|(name, value, limit)| {
            limit.map(|limit| Held::at_most(name, value, real(limit)))
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_is_nothing_when_it_holds_and_grows_with_distance() {
        assert!(Held::at_most("a", 1.0, 1.0).excess() == 0.0);
        assert!((Held::at_most("a", 4.0, 2.0).excess() - 1.0).abs() < 1e-12);
        assert!((Held::at_least("a", 60.0, 120.0).excess() - 1.0).abs() < 1e-12);
        let of_none = Held::at_most("a", 0.5, 0.0).excess();
        assert!(of_none.is_finite() && of_none > Held::at_most("a", 0.5, 0.1).excess());
    }
}
