// SPDX-License-Identifier: MIT OR Apache-2.0
//! The PSNR and SSIM of a receiver's frames against the original, without a camera.

use super::sample::ComparedFrames;
use crate::FidelityError;
use crate::screens::{ScreenComparison, ScreenTally};

/// A comparison of frames of one size with 8 bits per pixel.
#[derive(Clone, Debug)]
pub struct FrameSimilarity {
    pixels: usize,
    comparison: ScreenComparison<u8>,
    frames: u64,
    tally: ScreenTally,
}

impl FrameSimilarity {
    /// Creates a comparison for frames of `width` x `height` pixels.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        let (width, height) = (width as usize, height as usize);
        let comparison = ScreenComparison::new(width, height, u8::MAX.into());
        Self { pixels: width * height, comparison, frames: 0, tally: ScreenTally::default() }
    }

    /// Adds one frame.
    ///
    /// # Errors
    /// Fails if one of the two frames has another number of pixels; nothing has been added then.
    pub fn add(&mut self, seen: &[u8], original: &[u8]) -> Result<(), FidelityError> {
        for (what, given) in [("frame of the receiver", seen.len()), ("original", original.len())] {
            if given != self.pixels {
                return Err(FidelityError::ResultLength { what, given, expected: self.pixels });
            }
        }
        let compared_frames = ComparedFrames {
            input: original,
            denoised: original,
            rendered: original,
            screen: seen,
            own_denoised: original,
        };
        let [_, to_input] = self.comparison.compare(compared_frames);
        self.tally.add(&to_input);
        self.frames += 1;
        Ok(())
    }

    /// Returns the number of frames that were compared.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Returns the PSNR, defined like [`Figures::psnr_input`](crate::FidelityFigures::psnr_input).
    #[must_use]
    pub fn psnr(&self) -> Option<f64> {
        self.tally.psnr(self.frames * self.pixels as u64, u8::MAX.into())
    }

    /// Returns the SSIM, defined like [`Figures::ssim_input`](crate::FidelityFigures::ssim_input).
    #[must_use]
    pub fn ssim(&self) -> f64 {
        self.tally.ssim(self.frames)
    }
}
