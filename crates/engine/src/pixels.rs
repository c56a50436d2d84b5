// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels of one frame in the caller's buffer: rows that start `stride` values apart, without a
//! copy.

use foveate_camera::Camera;

use crate::EngineError;
use crate::plan::index;
use foveate_pixels::vectors::VectorPixel;

/// A borrowed frame of `width` x `height` pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BorrowedFrame<'a, T> {
    pub(crate) values: &'a [T],
    pub(crate) stride: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl<'a, T> BorrowedFrame<'a, T> {
    /// Returns row `y` of the padded frame, without the padding at its right side.
    #[inline(always)]
    pub(crate) fn row(&self, y: usize) -> &'a [T] {
        &self.values[y.min(self.height - 1) * self.stride..][..self.width]
    }
}

impl<'a, T: VectorPixel> BorrowedFrame<'a, T> {
    pub(crate) fn new_checked(
        camera: &Camera,
        values: &'a [T],
        stride: usize,
    ) -> Result<Self, EngineError> {
        let (width, height) = (index(camera.width()), index(camera.height()));
        let needed = (height - 1).saturating_mul(stride.max(width)).saturating_add(width);
        if stride < width || values.len() < needed {
            let given = values.len();
            return Err(EngineError::FrameLength { given, stride, width, height, needed });
        }
        let raw = Self { values, stride, width, height };
        let max = u64::from(camera.pixel_max());
        // A type whose largest value is the largest pixel needs no check.
        let rows = if max < T::MAX.into() { 0..height } else { 0..0 };
        for y in rows {
            let largest = raw.row(y).iter().copied().fold(T::default(), T::max);
            if largest.into() > max {
                let x = raw.row(y).iter().position(|&pixel| pixel == largest);
                let x = x.expect("the largest pixel of a row is in it");
                let (bits, max) = (camera.pixel_bits(), camera.pixel_max());
                return Err(EngineError::PixelRange { x, y, value: largest.into(), bits, max });
            }
        }
        Ok(raw)
    }
}
