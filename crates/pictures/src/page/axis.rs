// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axis of a plot: the conversion of numbers to positions, and its ticks.

use super::number::tick;

/// The ratio of the largest to the smallest value from which an axis of costs is logarithmic.
const WIDE: f64 = 5.0;
/// The ratio from which an axis of errors, which start at zero, is logarithmic.
const WIDE_FROM_ZERO: f64 = 30.0;
/// The most decades of an axis of errors.
const DECADES: i32 = 4;
/// The length of the linear part at zero, in decades.
const AT_ZERO: f64 = 0.5;

/// An axis of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    low: f64,
    high: f64,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Linear,
    Log,
    /// The axis is linear from zero to this value, then logarithmic.
    Zero(f64),
}

/// A tick with its position from 0 to 1 and its label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) at: f64,
    pub(crate) label: String,
}

impl Axis {
    /// Makes an axis for values that may start anywhere; it is logarithmic if their range is wide.
    #[must_use]
    pub fn free(values: impl Iterator<Item = f64>) -> Self {
        let Some((low, high)) = range(values) else {
            return Self { low: 0.0, high: 1.0, kind: Kind::Linear };
        };
        if low > 0.0 && high / low >= WIDE {
            return Self { low: nice(low, false), high: nice(high, true), kind: Kind::Log };
        }
        Self::linear(low, high)
    }

    /// Makes a linear axis, for values such as numbers of frames and shares of a whole.
    #[must_use]
    pub fn even(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        Self::linear(low, high)
    }

    fn linear(low: f64, high: f64) -> Self {
        if high > low {
            let step = step(high - low);
            let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
            return Self { low, high, kind: Kind::Linear };
        }
        let around = if low == 0.0 { 1.0 } else { low.abs() / 2.0 };
        Self { low: low - around, high: low + around, kind: Kind::Linear }
    }

    /// Makes an axis for errors, which are best at zero; if their range is wide, it is logarithmic
    /// above a small error.
    #[must_use]
    pub fn from_zero(values: impl Iterator<Item = f64>) -> Self {
        let mut zero = false;
        let positive = values.filter(|&value| {
            zero |= value == 0.0;
            value > 0.0
        });
        let Some((low, high)) = range(positive) else {
            return Self { low: 0.0, high: 1.0, kind: Kind::Linear };
        };
        let step = step(high);
        let linear = Self { low: 0.0, high: (high / step).ceil() * step, kind: Kind::Linear };
        if high / low < WIDE_FROM_ZERO {
            return linear;
        }
        let least = 10.0_f64.powi(-DECADES) * high;
        if !zero && low >= least {
            return Self { low: nice(low, false), high: nice(high, true), kind: Kind::Log };
        }
        let small = 10.0_f64.powf(low.max(least).log10().floor());
        Self { low: 0.0, high: nice(high, true), kind: Kind::Zero(small) }
    }

    /// Returns whether distances on the axis are ratios.
    #[must_use]
    pub fn logarithmic(&self) -> bool {
        self.kind != Kind::Linear
    }

    /// Returns the position of a number: 0 at the low end, 1 at the high end; `None` for a number
    /// that the axis cannot show.
    #[must_use]
    pub fn place(&self, value: f64) -> Option<f64> {
        let (low, high) = (self.stretched(self.low), self.stretched(self.high));
        let place = (self.stretched(value) - low) / (high - low);
        place.is_finite().then(|| place.clamp(0.0, 1.0))
    }

    fn stretched(&self, value: f64) -> f64 {
        match self.kind {
            Kind::Linear => value,
            Kind::Log => value.log10(),
            Kind::Zero(small) if value <= small => AT_ZERO * value / small,
            Kind::Zero(small) => AT_ZERO + (value / small).log10(),
        }
    }

    /// Returns ticks at round numbers along the axis.
    pub(crate) fn ticks(&self) -> Vec<Tick> {
        let values = match self.kind {
            Kind::Linear => {
                let step = step(self.high - self.low);
                (0..=20)
                    .map(|index| (self.low / step).ceil() * step + step * f64::from(index))
                    .collect()
            }
            Kind::Log => between(self.low, self.high),
            Kind::Zero(small) => {
                let mut values = vec![0.0];
                values.extend(between(small, self.high));
                values
            }
        };
        let slack = (self.high - self.low) * 1e-6;
        let values = values.into_iter().filter(|value| *value <= self.high + slack);
        let tick = |value: f64| Some(Tick { at: self.place(value)?, label: tick(value) });
        values.filter_map(tick).collect()
    }
}

/// Returns the smallest and the largest finite number.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// Returns a round step of about a fifth of a length.
fn step(length: f64) -> f64 {
    let ten = 10.0_f64.powf((length / 5.0).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0, 10.0].map(|factor| factor * ten);
    steps.into_iter().find(|step| length / step <= 5.5).unwrap_or(10.0 * ten)
}

/// Returns the nearest number of the form 1, 2 or 5 times a power of ten that is not below `value`,
/// or not above it.
fn nice(value: f64, above: bool) -> f64 {
    let ten = 10.0_f64.powf(value.log10().floor());
    let mut all = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * ten).into_iter();
    let slack = 1e-9 * value;
    let found = if above {
        all.find(|nice| *nice >= value - slack)
    } else {
        all.rfind(|nice| *nice <= value + slack)
    };
    found.unwrap_or(value)
}

/// Returns powers of ten between two numbers, and if there are few decades, also 2 and 5 times
/// each.
fn between(low: f64, high: f64) -> Vec<f64> {
    let few = (high / low).log10() < 2.4;
    let factors: &[f64] = if few { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let first = 10.0_f64.powf((low * (1.0 + 1e-9)).log10().floor());
    let decades = (0..=20).map(|power| first * 10.0_f64.powi(power));
    let all = decades.flat_map(|ten| factors.iter().map(move |factor| factor * ten));
    all.filter(|value| *value >= low * (1.0 - 1e-9) && *value <= high * (1.0 + 1e-9)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn narrow_ranges_are_linear_and_wide_ones_logarithmic() {
        assert_eq!(labels(Axis::free([10.0, 40.0].into_iter())), ["10", "20", "30", "40"]);
        let wide = Axis::free([1500.0, 400_000.0].into_iter());
        assert_eq!(labels(wide), ["1 k", "10 k", "100 k"]);
        assert!(wide.logarithmic());
        assert_eq!(labels(Axis::free([12.0, 90.0].into_iter())), ["10", "20", "50", "100"]);
        assert_eq!(
            labels(Axis::from_zero([0.0, 0.02, 9.0].into_iter())),
            ["0", "0.01", "0.1", "1", "10"]
        );
        assert_eq!(labels(Axis::from_zero([0.02, 9.0].into_iter())), ["0.1", "1", "10"]);
        assert_eq!(
            labels(Axis::from_zero([0.0, 2.0, 9.0].into_iter())),
            ["0", "2", "4", "6", "8", "10"]
        );
    }

    #[test]
    fn whatever_the_numbers_are_places_are_on_the_axis() {
        let kinds: [&[f64]; 7] = [
            &[],
            &[0.0],
            &[3.0],
            &[-2.0],
            &[f64::NAN, f64::INFINITY],
            &[1e-300, 1e300],
            &[0.0, 1e-12],
        ];
        for values in kinds {
            let all = || values.iter().copied();
            for axis in [Axis::free(all()), Axis::from_zero(all()), Axis::even(all())] {
                let ticks = axis.ticks();
                assert!(
                    ticks.iter().all(|tick| (0.0..=1.0).contains(&tick.at)),
                    "{values:?} {ticks:?}"
                );
                let places = values.iter().filter_map(|value| axis.place(*value));
                assert!(places.into_iter().all(|place| (0.0..=1.0).contains(&place)), "{values:?}");
            }
        }
        assert_eq!(
            labels(Axis::even([0.0, 2.0, 100.0].into_iter())),
            ["0", "20", "40", "60", "80", "100"]
        );
        let errors = Axis::from_zero([0.0, 0.001, 50.0].into_iter());
        assert_eq!(errors.place(0.0), Some(0.0));
        assert!(errors.place(0.001) > errors.place(0.0));
    }
}
