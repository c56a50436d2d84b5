// SPDX-License-Identifier: MIT OR Apache-2.0
//! Folds before and after a design's clock is known. A clock is estimated from a netlist, and what is to be
//! synthesized has none: so a planned clock says which folds are tried, and no rate is told at it.

use foveate_design::Design;
use foveate_estimate::Speed;

use super::FitRequest;
use crate::row::real;

/// The planned clock in Hz. It is below the low ends of the serial arrays in `docs/area.md`, of which the slowest
/// is at 56 MHz. A design that is faster is folded again, by its own clock.
const PLANNED_HZ: u64 = 50_000_000;

/// The most clocks that a frame may take, at the clock that was given or at the planned one.
pub(super) fn max_clocks(request: &FitRequest<'_>) -> Option<u64> {
    let hertz = real(request.clock_hz.unwrap_or(PLANNED_HZ));
    request.constraints.min_fps.map(|fps| clocks(hertz, fps))
}

/// The design with the deepest fold that is fast enough at the low end of its own clock, if that is deeper than
/// its fold; of an organization without folds that with half the pixels per clock, if that is fast enough.
pub(super) fn slower(design: &Design, speed: &Speed, min_fps: f64) -> Option<Design> {
    let most = clocks(speed.low_clock_mhz * 1e6, min_fps);
    if !design.organization().folds() {
        let mut config = design.config().clone();
        config.hardware.pixels_per_clock = Some(design.pixels_per_clock() / 2);
        let half = config.validate().ok();
        return half.filter(|half| half.timing().clocks_per_frame() <= most);
    }
    let fold = design.largest_fold(most)?;
    if fold > design.fold() { design.with_fold(fold).ok() } else { None }
}

/// The most clocks per frame that reach this many frames per second.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive and below 2^53"
)]
fn clocks(hertz: f64, fps: f64) -> u64 {
    (hertz / fps.max(1e-9)).floor() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::Config;

    #[test]
    fn a_design_is_folded_as_deep_as_the_low_end_of_its_clock_allows() {
        let text = "[frame]\nwidth = 64\nheight = 64\n[hardware]\norganization = \"serial\"\n";
        let single = Config::from_toml(text).unwrap().validate().unwrap();
        let speed = |mhz| Speed { low_clock_mhz: mhz, ..Speed::given(1000.0, 1) };
        let (low, fps) = (60.0, 500.0);
        let fast = |design: &Design| low * 1e6 / real(design.timing().clocks_per_frame()) >= fps;
        let found = slower(&single, &speed(low), fps).unwrap();
        assert!(found.fold() > 1 && fast(&found), "{}", found.fold());
        assert!(!fast(&single.with_fold(found.fold() + 1).unwrap()), "{}", found.fold());
        assert!(slower(&found, &speed(low), fps).is_none(), "it is as deep already");
        assert!(slower(&found, &speed(low / 2.0), fps).is_none(), "it is too deep already");
    }

    /// 1,574 clocks or a little more take two pixels at a clock, 3,110 take one.
    #[test]
    fn a_raster_core_takes_fewer_pixels_per_clock_where_its_clock_allows() {
        let text = "[frame]\nwidth = 64\nheight = 48\n[hardware]\norganization = \"raster\"\n\
                    pixels_per_clock = 2\n";
        let double = Config::from_toml(text).unwrap().validate().unwrap();
        let speed = Speed { low_clock_mhz: 60.0, ..Speed::given(1000.0, 1) };
        let single = slower(&double, &speed, 15_000.0).unwrap();
        assert_eq!(single.pixels_per_clock(), 1);
        assert!(slower(&double, &speed, 30_000.0).is_none(), "one pixel at a clock is too slow");
        assert!(slower(&single, &speed, 1.0).is_none(), "there are no fewer");
    }
}
