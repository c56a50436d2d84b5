// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axis of a plot: the conversion of numbers to positions, and its ticks.

use crate::number_text::tick_label;

/// The ratio of the largest to the smallest value from which an axis of costs is logarithmic.
const LOG_RATIO: f64 = 5.0;
/// The ratio from which an axis of errors, which start at zero, is logarithmic.
const LOG_RATIO_FROM_ZERO: f64 = 30.0;
/// The most decades of an axis of errors.
const MAX_DECADES: i32 = 4;
/// The length of the linear part at zero, in decades.
const LINEAR_DECADES: f64 = 0.5;

/// An axis of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlotAxis {
    low: f64,
    high: f64,
    kind: AxisScale,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum AxisScale {
    Linear,
    Log,
    /// The axis is linear from zero to this value, then logarithmic.
    LinearAtZero(f64),
}

/// A tick with its position from 0 to 1 and its label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AxisTick {
    pub(crate) position: f64,
    pub(crate) label: String,
}

impl PlotAxis {
    /// Makes an axis for values that may start anywhere; it is logarithmic if their range is wide.
    #[must_use]
    pub fn with_free_start(values: impl Iterator<Item = f64>) -> Self {
        let Some((low, high)) = finite_range(values) else {
            return Self { low: 0.0, high: 1.0, kind: AxisScale::Linear };
        };
        if low > 0.0 && high / low >= LOG_RATIO {
            return Self {
                low: round_value(low, false),
                high: round_value(high, true),
                kind: AxisScale::Log,
            };
        }
        Self::linear(low, high)
    }

    /// Makes a linear axis, for values such as numbers of frames and shares of a whole.
    #[must_use]
    pub fn always_linear(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = finite_range(values).unwrap_or((0.0, 1.0));
        Self::linear(low, high)
    }

    fn linear(low: f64, high: f64) -> Self {
        if high > low {
            let step = round_step(high - low);
            let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
            return Self { low, high, kind: AxisScale::Linear };
        }
        let margin = if low == 0.0 { 1.0 } else { low.abs() / 2.0 };
        Self { low: low - margin, high: low + margin, kind: AxisScale::Linear }
    }

    /// Makes an axis for errors, which are best at zero; if their range is wide, it is logarithmic
    /// above a small error.
    #[must_use]
    pub fn starting_at_zero(values: impl Iterator<Item = f64>) -> Self {
        // The values can be read only once, so the filter also notes whether one of them is zero.
        let mut has_zero = false;
        let positive = values.filter(|&value| {
            has_zero |= value == 0.0;
            value > 0.0
        });
        let Some((low, high)) = finite_range(positive) else {
            return Self { low: 0.0, high: 1.0, kind: AxisScale::Linear };
        };
        let step = round_step(high);
        let linear = Self { low: 0.0, high: (high / step).ceil() * step, kind: AxisScale::Linear };
        if high / low < LOG_RATIO_FROM_ZERO {
            return linear;
        }
        let smallest_shown = 10.0_f64.powi(-MAX_DECADES) * high;
        if !has_zero && low >= smallest_shown {
            return Self {
                low: round_value(low, false),
                high: round_value(high, true),
                kind: AxisScale::Log,
            };
        }
        let small = 10.0_f64.powf(low.max(smallest_shown).log10().floor());
        Self { low: 0.0, high: round_value(high, true), kind: AxisScale::LinearAtZero(small) }
    }

    /// Returns whether distances on the axis are ratios.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        self.kind != AxisScale::Linear
    }

    /// Returns the position of a number: 0 at the low end, 1 at the high end; `None` for a number
    /// that the axis cannot show.
    #[must_use]
    pub fn position(&self, value: f64) -> Option<f64> {
        let (low, high) = (self.scaled(self.low), self.scaled(self.high));
        let place = (self.scaled(value) - low) / (high - low);
        place.is_finite().then(|| place.clamp(0.0, 1.0))
    }

    fn scaled(&self, value: f64) -> f64 {
        match self.kind {
            AxisScale::Linear => value,
            AxisScale::Log => value.log10(),
            AxisScale::LinearAtZero(small) if value <= small => LINEAR_DECADES * value / small,
            AxisScale::LinearAtZero(small) => LINEAR_DECADES + (value / small).log10(),
        }
    }

    /// Returns ticks at round numbers along the axis.
    pub(crate) fn ticks(&self) -> Vec<AxisTick> {
        let values = match self.kind {
            AxisScale::Linear => {
                let step = round_step(self.high - self.low);
                (0..=20)
                    .map(|index| (self.low / step).ceil() * step + step * f64::from(index))
                    .collect()
            }
            AxisScale::Log => round_values_between(self.low, self.high),
            AxisScale::LinearAtZero(small) => {
                let mut values = vec![0.0];
                values.extend(round_values_between(small, self.high));
                values
            }
        };
        let slack = (self.high - self.low) * 1e-6;
        let values = values.into_iter().filter(|value| *value <= self.high + slack);
        let tick = |value: f64| {
            Some(AxisTick { position: self.position(value)?, label: tick_label(value) })
        };
        values.filter_map(tick).collect()
    }
}

/// Returns the smallest and the largest finite number.
fn finite_range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// Returns a round step of about a fifth of a length.
fn round_step(length: f64) -> f64 {
    let power_of_ten = 10.0_f64.powf((length / 5.0).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0].map(|factor| factor * power_of_ten);
    steps.into_iter().find(|step| length / step <= 5.5).unwrap_or(10.0 * power_of_ten)
}

/// Returns the nearest number of the form 1, 2 or 5 times a power of ten that is not below `value`,
/// or not above it.
fn round_value(value: f64, above: bool) -> f64 {
    let power_of_ten = 10.0_f64.powf(value.log10().floor());
    let mut candidates = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power_of_ten).into_iter();
    let slack = 1e-9 * value;
    let found = if above {
        candidates.find(|candidate| *candidate >= value - slack)
    } else {
        candidates.rfind(|candidate| *candidate <= value + slack)
    };
    found.unwrap_or(value)
}

/// Returns the powers of ten between two numbers. If there are few decades, twice and five times
/// each power are included, too. Rounding must not exclude an end, so the ends have a tolerance.
fn round_values_between(low: f64, high: f64) -> Vec<f64> {
    let has_few_decades = (high / low).log10() < 2.4;
    let factors: &[f64] = if has_few_decades { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let first = 10.0_f64.powf((low * (1.0 + 1e-9)).log10().floor());
    let decades = (0..=20).map(|power| first * 10.0_f64.powi(power));
    let candidates =
        decades.flat_map(|power_of_ten| factors.iter().map(move |factor| factor * power_of_ten));
    candidates
        .filter(|value| *value >= low * (1.0 - 1e-9) && *value <= high * (1.0 + 1e-9))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: PlotAxis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn narrow_ranges_are_linear_and_wide_ones_logarithmic() {
        assert_eq!(
            labels(PlotAxis::with_free_start([10.0, 40.0].into_iter())),
            ["10", "20", "30", "40"]
        );
        let wide = PlotAxis::with_free_start([1500.0, 400_000.0].into_iter());
        assert_eq!(labels(wide), ["1 k", "10 k", "100 k"]);
        assert!(wide.is_logarithmic());
        assert_eq!(
            labels(PlotAxis::with_free_start([12.0, 90.0].into_iter())),
            ["10", "20", "50", "100"]
        );
        assert_eq!(
            labels(PlotAxis::starting_at_zero([0.0, 0.02, 9.0].into_iter())),
            ["0", "0.01", "0.1", "1", "10"]
        );
        assert_eq!(labels(PlotAxis::starting_at_zero([0.02, 9.0].into_iter())), ["0.1", "1", "10"]);
        assert_eq!(
            labels(PlotAxis::starting_at_zero([0.0, 2.0, 9.0].into_iter())),
            ["0", "2", "4", "6", "8", "10"]
        );
    }

    #[test]
    fn positions_and_ticks_are_on_the_axis_for_any_numbers() {
        let cases: [&[f64]; 7] = [
            &[],
            &[0.0],
            &[3.0],
            &[-2.0],
            &[f64::NAN, f64::INFINITY],
            &[1e-300, 1e300],
            &[0.0, 1e-12],
        ];
        for values in cases {
            let all = || values.iter().copied();
            for axis in [
                PlotAxis::with_free_start(all()),
                PlotAxis::starting_at_zero(all()),
                PlotAxis::always_linear(all()),
            ] {
                let ticks = axis.ticks();
                assert!(
                    ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.position)),
                    "{values:?} {ticks:?}"
                );
                let positions = values.iter().filter_map(|value| axis.position(*value));
                assert!(
                    positions.into_iter().all(|position| (0.0..=1.0).contains(&position)),
                    "{values:?}"
                );
            }
        }
        assert_eq!(
            labels(PlotAxis::always_linear([0.0, 2.0, 100.0].into_iter())),
            ["0", "20", "40", "60", "80", "100"]
        );
        let errors = PlotAxis::starting_at_zero([0.0, 0.001, 50.0].into_iter());
        assert_eq!(errors.position(0.0), Some(0.0));
        assert!(errors.position(0.001) > errors.position(0.0));
    }
}
