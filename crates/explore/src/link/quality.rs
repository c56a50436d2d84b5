// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quality of a receiver's frames compared with the original.

use foveate_measure::FrameSimilarity;
use serde::Serialize;

/// The PSNR and SSIM over the frames of a clip, rounded to four digits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// The PSNR in dB; `None` if every pixel is equal.
    pub psnr: Option<f64>,
    /// The SSIM, at most 1.
    pub ssim: f64,
}

impl Quality {
    pub(crate) const IDENTICAL: Self = Self { psnr: None, ssim: 1.0 };

    pub(crate) fn from_likeness(likeness: &FrameSimilarity) -> Self {
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        Self { psnr: likeness.psnr().map(rounded), ssim: rounded(likeness.ssim()) }
    }

    /// Returns whether the PSNR is at least that of `other`.
    pub(crate) fn reaches_psnr_of(self, other: Self) -> bool {
        self.psnr.unwrap_or(f64::INFINITY) >= other.psnr.unwrap_or(f64::INFINITY)
    }

    /// Returns whether the SSIM is at least that of `other`.
    pub(crate) fn reaches_ssim_of(self, other: Self) -> bool {
        self.ssim >= other.ssim
    }
}
