// SPDX-License-Identifier: MIT OR Apache-2.0
//! The SSIM of two windows from the sums of their pixels, with the constants of ffmpeg's filter
//! `ssim`.
//!
//! The definition is that of Z. Wang et al., "Image Quality Assessment: From Error Visibility to
//! Structural Similarity", 2004. Mean, variance and covariance are multiplied by the number of
//! pixels or its square, so that only whole numbers are added.

/// The sums over the pixels of a window, in two frames `a` and `b`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WindowSums {
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// The sum of the squares in both frames.
    pub(crate) squares: f64,
    pub(crate) product: f64,
}

/// The constants of the SSIM for windows with some number of pixels of some depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SsimConstants {
    pixels: f64,
    c1: f64,
    c2: f64,
}

impl SsimConstants {
    /// Creates the constants for windows of `pixels` pixels with values up to `peak`. For the 64
    /// pixels of an 8x8 window these are ffmpeg's constants, including their rounding. A window of
    /// a single pixel has no variance, but its `c2` must not be 0.
    pub(crate) fn new(pixels: f64, peak: f64) -> Self {
        let rest = (pixels - 1.0).max(1.0);
        Self {
            pixels,
            c1: (0.01 * 0.01 * peak * peak * pixels + 0.5).floor(),
            c2: (0.03 * 0.03 * peak * peak * pixels * rest + 0.5).floor(),
        }
    }

    /// Returns the SSIM of two windows, at most 1.
    #[inline(always)]
    pub(crate) fn window_ssim(self, window: WindowSums) -> f64 {
        let WindowSums { a, b, squares, product } = window;
        let both = a * a + b * b;
        let variances = squares * self.pixels - both;
        let covariance = product * self.pixels - a * b;
        let numerator = (2.0 * a * b + self.c1) * (2.0 * covariance + self.c2);
        let denominator = (both + self.c1) * (variances + self.c2);
        // If both constants are 0, as for pixels of 1 to 3 bits in small windows, two black windows
        // give 0 / 0.
        if numerator == denominator { 1.0 } else { numerator / denominator }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_those_of_ffmpeg() {
        let ssim = SsimConstants::new(64.0, 255.0);
        assert_eq!((ssim.c1, ssim.c2), (416.0, 235_963.0));
    }

    #[test]
    fn equal_windows_are_alike_and_inverse_ones_are_not() {
        let ssim = SsimConstants::new(64.0, 255.0);
        let half = 32.0 * 255.0;
        let window =
            |product| WindowSums { a: half, b: half, squares: 2.0 * half * 255.0, product };
        assert_eq!(ssim.window_ssim(window(half * 255.0)), 1.0);
        assert!(ssim.window_ssim(window(0.0)) < -0.99);
        assert_eq!(SsimConstants::new(1.0, 1.0).window_ssim(WindowSums::default()), 1.0);
    }
}
