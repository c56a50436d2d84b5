// SPDX-License-Identifier: MIT OR Apache-2.0
//! Division by a constant as a multiplication and a shift, proven exact over its whole input range.

use crate::bits_for;

/// Division by a constant: `floor(x / divisor) == (x * multiplier) >> shift` for every `x` in
/// `0..=x_max`.
///
/// With `multiplier = ceil(2^shift / divisor)` and `e = multiplier * divisor - 2^shift` the product
/// is `x / divisor + e * x / (divisor * 2^shift)`. The floor stays right as long as the second term
/// is below `1 / divisor` at the worst remainder, which is `divisor - 1`: `e * x < 2^shift` for
/// every `x` (Granlund and Montgomery, "Division by Invariant Integers using Multiplication",
/// 1994). The smallest such shift is used. A power of two has `multiplier = 1`, so only the shift
/// remains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reciprocal {
    divisor: u64,
    x_max: u64,
    multiplier: u64,
    shift: u32,
}

impl Reciprocal {
    /// Makes the reciprocal of `divisor` (1..=4096) for dividends up to `x_max` (below 2^48).
    pub(crate) fn new(divisor: u64, x_max: u64) -> Self {
        let holds = |shift: u32| {
            let power = 1u128 << shift;
            let excess = power.div_ceil(u128::from(divisor)) * u128::from(divisor) - power;
            excess * u128::from(x_max) < power
        };
        // At 2^shift > divisor * x_max the condition always holds, so the search finds a shift.
        let shift = (0..=bits_for(x_max) + bits_for(divisor)).find(|&shift| holds(shift));
        let shift = shift.expect("2^shift is above divisor * x_max at the end");
        let multiplier = (1u128 << shift).div_ceil(u128::from(divisor));
        let multiplier = u64::try_from(multiplier).expect("shift is at most 48 + 13");
        Self { divisor, x_max, multiplier, shift }
    }

    /// Returns the divisor.
    #[must_use]
    pub fn divisor(self) -> u64 {
        self.divisor
    }

    /// Returns the largest dividend for which the division is exact.
    #[must_use]
    pub fn x_max(self) -> u64 {
        self.x_max
    }

    /// Returns the constant factor.
    #[must_use]
    pub fn multiplier(self) -> u64 {
        self.multiplier
    }

    /// Returns the number of bits by which the product is shifted to the right.
    #[must_use]
    pub fn shift(self) -> u32 {
        self.shift
    }

    /// Divides as the hardware does, by multiplication and shift. The quotient is exact for
    /// `x <= x_max`.
    #[must_use]
    pub fn divide(self, x: u64) -> u64 {
        let product = u128::from(x) * u128::from(self.multiplier);
        u64::try_from(product >> self.shift).expect("a quotient is at most its dividend")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quotient can be wrong only at a multiple of the divisor or just below it, and the error
    /// grows with the dividend.
    #[test]
    fn equals_floor_division_for_every_region_size() {
        for side in 2..=64u64 {
            let n = side * side;
            for x_max in [n - 1, n, 255 * n + n / 2, (65535 * n + n / 2) << 12] {
                let reciprocal = Reciprocal::new(n, x_max);
                for quotient in (0..=x_max / n).rev().take(2000).chain(0..2000.min(x_max / n)) {
                    for x in
                        [quotient * n, quotient * n + n - 1].into_iter().filter(|&x| x <= x_max)
                    {
                        assert_eq!(reciprocal.divide(x), x / n, "{x} / {n}");
                    }
                }
            }
        }
    }

    #[test]
    fn exhaustive_for_eight_bit_sums() {
        for side in 2..=12u64 {
            let n = side * side;
            let reciprocal = Reciprocal::new(n, 256 * n);
            for x in 0..=256 * n {
                assert_eq!(reciprocal.divide(x), x / n, "{x} / {n}");
            }
        }
    }

    #[test]
    fn powers_of_two_are_shifts() {
        let reciprocal = Reciprocal::new(64, 16_352);
        assert_eq!((reciprocal.multiplier(), reciprocal.shift()), (1, 6));
    }
}
