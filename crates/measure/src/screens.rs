// SPDX-License-Identifier: MIT OR Apache-2.0
//! The squared errors and the SSIM of the candidate's screen, against the ideal's screen and
//! the input at the same time ([`ScreenComparison`]).
//!
//! The SSIM is that of ffmpeg's filter `ssim` for one plane. It has windows of 8x8 pixels, 4
//! pixels apart, each of which is made of four blocks of 4x4 pixels. Pixels at the right and at
//! the bottom that fill no block belong to no window. For a frame that is less than 8 pixels
//! wide or high, ffmpeg has no window; here the whole frame is one window.
//!
//! The SSIM of a window has the constants of that filter ([`SsimConstants`]). Its definition is
//! that of Z. Wang et al., "Image Quality Assessment: From Error Visibility to Structural
//! Similarity", 2004. Mean, variance and covariance are multiplied by the number of pixels or
//! its square, so that only whole numbers are added.

use super::fixed_point::{FixedPoint, count_to_f64};
use super::sample::ComparedFrames;
use crate::sample::PixelSample;
use serde::{Deserialize, Serialize};

/// The squared errors and the SSIM of two screens, summed over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ScreenTally {
    /// The sum of the squared differences of all pixels.
    pub(crate) squares: FixedPoint,
    /// The sum of the SSIM of all frames.
    pub(crate) ssim: FixedPoint,
}

impl ScreenTally {
    pub(crate) fn add(&mut self, other: &Self) {
        self.squares.add(other.squares);
        self.ssim.add(other.ssim);
    }

    /// Returns the PSNR in dB with the mean squared error of all pixels; `None` if they are
    /// identical.
    pub(crate) fn psnr(&self, pixels: u64, peak: u32) -> Option<f64> {
        let squares = self.squares.to_f64();
        let peak = f64::from(peak);
        (squares > 0.0).then(|| 10.0 * (peak * peak * count_to_f64(pixels) / squares).log10())
    }

    /// Returns the mean SSIM over frames; 1 without frames.
    pub(crate) fn ssim(&self, frames: u64) -> f64 {
        if frames == 0 { 1.0 } else { self.ssim.to_f64() / count_to_f64(frames) }
    }
}

/// The side of a block in pixels.
const BLOCK: usize = 4;
/// The number of columns that are summed at a time.
const TILE: usize = 64;

/// The number of sums. There are sums of the pixels of three frames (the screen, the ideal's screen
/// and the input), of their squares, and of the products of the screen with the other two.
const SUM_COUNT: usize = 8;

/// The sums of 4 rows, column by column.
struct ColumnSums<T: PixelSample> {
    pixels: [[u32; TILE]; 3],
    products: [[T::Product; TILE]; 5],
}

/// A comparison of frames of one size.
#[derive(Clone, Debug)]
pub(crate) struct ScreenComparison<T> {
    width: usize,
    height: usize,
    ssim: SsimConstants,
    /// The sums of the blocks of the last row of blocks and of the current one, with one list per
    /// sum.
    rows: [[Vec<f64>; SUM_COUNT]; 2],
    zero: Vec<T>,
}

impl<T: PixelSample> ScreenComparison<T> {
    /// Creates a comparison of frames of `width` x `height` pixels with values up to `peak`.
    pub(crate) fn new(width: usize, height: usize, peak: u32) -> Self {
        let is_one_window = width < 2 * BLOCK || height < 2 * BLOCK;
        let pixels = if is_one_window { count_to_f64((width * height) as u64) } else { 64.0 };
        let list = || std::array::from_fn(|_| vec![0.0; width / BLOCK]);
        Self {
            width,
            height,
            ssim: SsimConstants::new(pixels, f64::from(peak)),
            rows: [list(), list()],
            zero: vec![T::default(); width.min(TILE)],
        }
    }

    /// Compares one frame with the ideal's screen, and with the input.
    pub(crate) fn compare(&mut self, frames: ComparedFrames<'_, T>) -> [ScreenTally; 2] {
        let mut squares = [0_u64; 2];
        let mut ssim_sums = [0.0; 2];
        let mut frame_sums = [0.0; SUM_COUNT];
        let is_one_window = self.width < 2 * BLOCK || self.height < 2 * BLOCK;
        for top in (0..self.height).step_by(BLOCK) {
            self.sum_rows(frames, top, &mut squares, is_one_window.then_some(&mut frame_sums));
            if top > 0 && top + BLOCK <= self.height && !is_one_window {
                let row = self.ssim_of_windows();
                ssim_sums = [ssim_sums[0] + row[0], ssim_sums[1] + row[1]];
            }
            self.rows.swap(0, 1);
        }
        let windows = if is_one_window {
            ssim_sums = windows_from_sums(frame_sums).map(|window| self.ssim.window_ssim(window));
            1.0
        } else {
            let (across, down) = (self.width / BLOCK - 1, self.height / BLOCK - 1);
            count_to_f64((across * down) as u64)
        };
        std::array::from_fn(|which| ScreenTally {
            squares: FixedPoint::whole(squares[which]),
            ssim: FixedPoint::nearest(ssim_sums[which] / windows),
        })
    }

    /// Sums up to four rows: the squared errors of all columns, and the sums of whole blocks.
    fn sum_rows(
        &mut self,
        frames: ComparedFrames<'_, T>,
        top: usize,
        squares: &mut [u64; 2],
        mut frame_sums: Option<&mut [f64; SUM_COUNT]>,
    ) {
        let mut tile = ColumnSums::<T>::new();
        for left in (0..self.width).step_by(TILE) {
            let len = TILE.min(self.width - left);
            let part = |plane| self.tile_rows(plane, top, left, len);
            tile.fill(part(frames.screen), part(frames.rendered), part(frames.input), len);
            let [rendered, input] = tile.squares(len);
            *squares = [squares[0] + rendered, squares[1] + input];
            if let Some(frame_sums) = frame_sums.as_deref_mut() {
                tile.add_to_frame_sums(frame_sums, len);
            }
            let blocks = left / BLOCK..(left + len) / BLOCK;
            for (at, row) in self.rows[1].iter_mut().enumerate() {
                tile.sum_blocks(at, &mut row[blocks.clone()]);
            }
        }
    }

    /// Returns four rows from column `left` on. Rows below the last one are black, which adds
    /// nothing to a sum.
    fn tile_rows<'p>(
        &'p self,
        plane: &'p [T],
        top: usize,
        left: usize,
        len: usize,
    ) -> [&'p [T]; BLOCK] {
        std::array::from_fn(|row| match top + row < self.height {
            true => &plane[(top + row) * self.width + left..][..len],
            false => &self.zero[..len],
        })
    }

    /// Returns the sums of the SSIM of all windows of two rows of blocks.
    fn ssim_of_windows(&self) -> [f64; 2] {
        let ([above, below], count) = (&self.rows, self.width / BLOCK);
        let (above, below) = (above.each_ref(), below.each_ref());
        let (above, below) = (above.map(|list| &list[..count]), below.map(|list| &list[..count]));
        let mut ssim_sums = [0.0; 2];
        for at in 0..count - 1 {
            let sums = std::array::from_fn(|sum| {
                let (above, below) = (above[sum], below[sum]);
                above[at] + above[at + 1] + below[at] + below[at + 1]
            });
            let [rendered, input] = windows_from_sums(sums);
            ssim_sums[0] += self.ssim.window_ssim(rendered);
            ssim_sums[1] += self.ssim.window_ssim(input);
        }
        ssim_sums
    }
}

/// Returns the window of the screen and the ideal's screen, and that of the screen and the input.
#[inline(always)]
fn windows_from_sums(sums: [f64; SUM_COUNT]) -> [WindowSums; 2] {
    let [screen, ideal, input, screen2, ideal2, input2, with_ideal, with_input] = sums;
    [
        WindowSums { a: screen, b: ideal, squares: screen2 + ideal2, product: with_ideal },
        WindowSums { a: screen, b: input, squares: screen2 + input2, product: with_input },
    ]
}

impl<T: PixelSample> ColumnSums<T> {
    fn new() -> Self {
        Self { pixels: [[0; TILE]; 3], products: [[T::Product::default(); TILE]; 5] }
    }

    #[inline(always)]
    fn fill(&mut self, a: [&[T]; BLOCK], b: [&[T]; BLOCK], c: [&[T]; BLOCK], len: usize) {
        let len = len.min(TILE);
        let (a, b, c) =
            (a.map(|row| &row[..len]), b.map(|row| &row[..len]), c.map(|row| &row[..len]));
        let [screen, ideal, input] = &mut self.pixels;
        let [screen2, ideal2, input2, with_ideal, with_input] = &mut self.products;
        for x in 0..len {
            let mut sums = [0_u32; 3];
            let mut products = [T::Product::default(); 5];
            for row in 0..BLOCK {
                let (a, b, c) = (a[row][x], b[row][x], c[row][x]);
                for (sum, value) in sums.iter_mut().zip([a, b, c]) {
                    *sum += value.into();
                }
                let pairs = [(a, a), (b, b), (c, c), (a, b), (a, c)];
                for (sum, (one, other)) in products.iter_mut().zip(pairs) {
                    *sum += one.product(other);
                }
            }
            [screen[x], ideal[x], input[x]] = sums;
            [screen2[x], ideal2[x], input2[x], with_ideal[x], with_input[x]] = products;
        }
    }

    /// Returns the sums of the squared differences between the screen and each of the other two
    /// frames, by `(a - b)^2 = a^2 + b^2 - 2 a b`.
    fn squares(&self, len: usize) -> [u64; 2] {
        let sum = |which: usize| -> u64 {
            self.products[which][..len].iter().map(|&product| product.into()).sum()
        };
        [sum(0) + sum(1) - 2 * sum(3), sum(0) + sum(2) - 2 * sum(4)]
    }

    fn sum_blocks(&self, which: usize, blocks: &mut [f64]) {
        match which.checked_sub(3) {
            None => {
                let columns = self.pixels[which].chunks_exact(BLOCK);
                for (block, four) in blocks.iter_mut().zip(columns) {
                    *block = f64::from(four.iter().sum::<u32>());
                }
            }
            Some(which) => {
                let columns = self.products[which].chunks_exact(BLOCK);
                for (block, four) in blocks.iter_mut().zip(columns) {
                    let mut sum = T::Product::default();
                    four.iter().for_each(|&product| sum += product);
                    *block = T::sum_to_f64(sum);
                }
            }
        }
    }

    /// Adds every column to the sums of a whole frame.
    fn add_to_frame_sums(&self, all: &mut [f64; SUM_COUNT], len: usize) {
        let (pixels, products) = all.split_at_mut(3);
        for (sum, columns) in pixels.iter_mut().zip(&self.pixels) {
            *sum += columns[..len].iter().map(|&pixel| f64::from(pixel)).sum::<f64>();
        }
        for (sum, columns) in products.iter_mut().zip(&self.products) {
            *sum += columns[..len].iter().map(|&product| T::sum_to_f64(product)).sum::<f64>();
        }
    }
}

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
