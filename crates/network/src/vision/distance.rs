// SPDX-License-Identifier: MIT OR Apache-2.0
//! The distance between the outputs of a network and the right values ([`OutputDistance`]).

/// Sums over values and over the right values, which are those of a reference computation.
#[derive(Clone, Copy, Debug)]
pub struct OutputDistance {
    /// The largest difference.
    pub largest: f64,
    /// The sum of the squared differences.
    squared_difference: f64,
    /// The sum of the squares of the right values.
    right_squares: f64,
    /// The sum of the squares of the found values.
    found_squares: f64,
    /// The sum of the products of the right and the found values.
    products: f64,
    /// The lowest of the right values.
    lowest: f64,
    /// The highest of the right values.
    highest: f64,
    values: u64,
}

impl Default for OutputDistance {
    fn default() -> Self {
        let [largest, difference, right, found, product] = [0.0; 5];
        let (lowest, highest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self {
            largest,
            squared_difference: difference,
            right_squares: right,
            found_squares: found,
            products: product,
            lowest,
            highest,
            values: 0,
        }
    }
}

impl OutputDistance {
    /// Returns the distance of two lists of values, with true if any value differs in a bit.
    #[must_use]
    pub fn between(right: &[f32], found: &[f32]) -> (Self, bool) {
        let (mut sum, mut differs) = (Self::default(), false);
        sum.values = right.len() as u64;
        for (right, found) in right.iter().zip(found) {
            differs |= right.to_bits() != found.to_bits();
            let (right, found) = (f64::from(*right), f64::from(*found));
            let difference = (right - found).abs();
            sum.largest = sum.largest.max(difference);
            sum.squared_difference += difference * difference;
            sum.right_squares += right * right;
            sum.found_squares += found * found;
            sum.products += right * found;
            sum.lowest = sum.lowest.min(right);
            sum.highest = sum.highest.max(right);
        }
        (sum, differs)
    }

    /// Adds the distance of other values.
    pub fn add(&mut self, other: Self) {
        self.largest = self.largest.max(other.largest);
        self.squared_difference += other.squared_difference;
        self.right_squares += other.right_squares;
        self.found_squares += other.found_squares;
        self.products += other.products;
        self.lowest = self.lowest.min(other.lowest);
        self.highest = self.highest.max(other.highest);
        self.values += other.values;
    }

    /// The sum of the squared differences.
    #[must_use]
    pub fn squared_difference(&self) -> f64 {
        self.squared_difference
    }

    /// The sum of the squares of the right values.
    #[must_use]
    pub fn right_squares(&self) -> f64 {
        self.right_squares
    }

    /// The RMS of the differences as a share of the RMS of the right values; 0 if there is no
    /// difference.
    #[must_use]
    pub fn relative_rms(&self) -> f64 {
        if self.squared_difference == 0.0 {
            0.0
        } else {
            (self.squared_difference / self.right_squares).sqrt()
        }
    }

    /// The cosine of the angle between the right and the found values as vectors; 1 if there is no
    /// difference.
    #[must_use]
    pub fn cosine(&self) -> f64 {
        if self.squared_difference == 0.0 {
            1.0
        } else {
            self.products / (self.right_squares * self.found_squares).sqrt()
        }
    }

    /// The peak signal-to-noise ratio in decibels, with the range of the right values as the peak;
    /// `None` if there is no difference.
    #[must_use]
    pub fn psnr(&self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let mean = self.squared_difference / self.values.max(1) as f64;
        psnr((self.highest - self.lowest).powi(2), mean)
    }
}

/// Returns the peak signal-to-noise ratio in decibels, from the squares of the peak and of the
/// error. Both must be means, or both sums over the same values. Returns `None` if there is no
/// error.
#[must_use]
pub fn psnr(peak: f64, error: f64) -> Option<f64> {
    (error != 0.0).then(|| 10.0 * (peak / error).log10())
}

/// Returns the index of the largest value, or of the first of several equal ones.
#[must_use]
pub fn index_of_largest(values: &[f32]) -> usize {
    let mut best = 0;
    for (at, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = at;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_are_those_of_the_books() {
        let (mut sum, differs) = OutputDistance::between(&[3.0, 0.0], &[3.0, 4.0]);
        assert!(differs);
        assert_eq!((sum.largest, sum.relative_rms()), (4.0, 4.0 / 3.0));
        assert_eq!(sum.cosine(), 9.0 / 15.0);
        assert!((sum.psnr().unwrap() - 10.0 * (9.0f64 / 8.0).log10()).abs() < 1e-12);
        // The added values lengthen the vectors and widen the range.
        sum.add(OutputDistance::between(&[-1.0], &[-1.0]).0);
        assert_eq!(sum.cosine(), 10.0 / (10.0f64 * 26.0).sqrt());
        assert!((sum.psnr().unwrap() - 10.0 * (16.0f64 * 3.0 / 16.0).log10()).abs() < 1e-12);
    }

    #[test]
    fn equal_values_are_as_close_as_can_be() {
        for values in [&[0.0, 0.0][..], &[1.0, -2.0]] {
            let (same, differs) = OutputDistance::between(values, values);
            assert!(!differs);
            assert_eq!((same.relative_rms(), same.cosine(), same.psnr()), (0.0, 1.0, None));
        }
    }
}
