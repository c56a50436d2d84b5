// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cropping, and scaling by area, in integers: the results are identical for every source and on
//! every machine.
//!
//! Each pixel of the result is the mean of the part of the frame that it covers. Pixels at the edge
//! of that part count in proportion. The mean is rounded to the nearest, halves up. Downscaling is
//! box filtering; upscaling is nearest-neighbor with blended borders.

use foveate_pixels::{ByteFrame, FramePixels};

use crate::{CropRect, FootageError};

/// Returns the part of a frame.
pub(crate) fn crop(frame: &ByteFrame, crop: CropRect) -> Result<ByteFrame, FootageError> {
    let (width, height) = crop.size;
    let fits = |at: u32, size: u32, whole: u32| {
        size > 0 && at.checked_add(size).is_some_and(|end| end <= whole)
    };
    if !fits(crop.origin.0, width, frame.width()) || !fits(crop.origin.1, height, frame.height()) {
        return Err(FootageError::Crop { crop, size: (frame.width(), frame.height()) });
    }
    let (bits, whole) = (frame.bits(), frame.width() as usize);
    Ok(match frame.borrowed_pixels() {
        FramePixels::Bytes(pixels) => {
            ByteFrame::from_bytes(width, height, bits, part(pixels, whole, crop))
        }
        FramePixels::Words(pixels) => {
            ByteFrame::from_words(width, height, bits, part(pixels, whole, crop))
        }
    }?)
}

/// Returns the part of pixels in rows of `whole` pixels. The part must lie inside.
fn part<T: Copy>(pixels: &[T], whole: usize, crop: CropRect) -> Vec<T> {
    let (left, right) = (crop.origin.0 as usize, (crop.origin.0 + crop.size.0) as usize);
    let rows = pixels.chunks_exact(whole).skip(crop.origin.1 as usize).take(crop.size.1 as usize);
    rows.flat_map(|row| &row[left..right]).copied().collect()
}

/// Returns the frame scaled to another size.
pub(crate) fn resize(frame: ByteFrame, width: u32, height: u32) -> Result<ByteFrame, FootageError> {
    let from = (frame.width(), frame.height());
    if from == (width, height) {
        return Ok(frame);
    }
    let pixels = match frame.borrowed_pixels() {
        FramePixels::Bytes(pixels) => scaled(pixels, from, (width, height)),
        FramePixels::Words(pixels) => scaled(pixels, from, (width, height)),
    };
    Ok(ByteFrame::from_words(width, height, frame.bits(), pixels)?)
}

fn scaled<T: Copy + Into<u64>>(values: &[T], from: (u32, u32), to: (u32, u32)) -> Vec<u16> {
    let columns = spans(from.0, to.0);
    let rows = spans(from.1, to.1);
    let area = u64::from(from.0) * u64::from(from.1);
    let mut pixels = Vec::with_capacity(to.0 as usize * to.1 as usize);
    let mut sums = vec![0u64; from.0 as usize];
    for span in &rows {
        sums.fill(0);
        for (y, weight) in span.parts() {
            let row = &values[y * sums.len()..];
            for (sum, &value) in sums.iter_mut().zip(row) {
                *sum += weight * value.into();
            }
        }
        pixels.extend(columns.iter().map(|span| {
            let sum: u64 = span.parts().map(|(x, weight)| weight * sums[x]).sum();
            u16::try_from((sum + area / 2) / area).expect("no mean is above the largest pixel")
        }));
    }
    pixels
}

/// The range of source coordinates that one pixel of the result covers, in units of 1 / `scale`
/// source pixels.
struct PixelSpan {
    start: u64,
    end: u64,
    scale: u64,
}

/// Returns the ranges of all pixels. In common units, pixel j of `to` covers j * from .. (j + 1) *
/// from, and source pixel i covers i * to .. (i + 1) * to.
fn spans(from: u32, to: u32) -> Vec<PixelSpan> {
    let (from, scale) = (u64::from(from), u64::from(to));
    (0..scale).map(|j| PixelSpan { start: j * from, end: (j + 1) * from, scale }).collect()
}

impl PixelSpan {
    /// Returns the source pixels with their weights, which add up to the size of the source.
    fn parts(&self) -> impl Iterator<Item = (usize, u64)> + '_ {
        (self.start / self.scale..self.end.div_ceil(self.scale)).map(|i| {
            let (low, high) = (i * self.scale, (i + 1) * self.scale);
            let weight = self.end.min(high) - self.start.max(low);
            (usize::try_from(i).expect("it is a pixel of the source"), weight)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(width: u32, height: u32, pixels: &[u16]) -> ByteFrame {
        ByteFrame::from_words(width, height, 8, pixels.to_vec()).unwrap()
    }

    #[test]
    fn whole_blocks_become_their_mean_with_halves_up() {
        let small = resize(frame(4, 2, &[0, 1, 10, 20, 0, 1, 30, 40]), 2, 1).unwrap();
        assert_eq!(small.borrowed_pixels().to_words(), [1, 25]);
    }

    #[test]
    fn pixels_at_the_edge_count_in_proportion() {
        // Scaling 3 pixels to 2 gives (2 a + b) / 3 and (b + 2 c) / 3.
        assert_eq!(
            resize(frame(3, 1, &[0, 90, 255]), 2, 1).unwrap().borrowed_pixels().to_words(),
            [30, 200]
        );
        assert_eq!(
            resize(frame(1, 3, &[0, 90, 255]), 1, 2).unwrap().borrowed_pixels().to_words(),
            [30, 200]
        );
        // Scaling 2 pixels to 3 puts half of each into the middle pixel.
        assert_eq!(
            resize(frame(2, 1, &[10, 20]), 3, 1).unwrap().borrowed_pixels().to_words(),
            [10, 15, 20]
        );
    }

    #[test]
    fn flat_stays_flat_and_the_mean_stays_near_at_any_size() {
        let full = ByteFrame::from_words(37, 23, 16, vec![65_535; 37 * 23]).unwrap();
        for (width, height) in [(1, 1), (7, 50), (36, 24), (100, 3)] {
            let scaled = resize(full.clone(), width, height).unwrap();
            assert!(scaled.borrowed_pixels().to_words().iter().all(|&value| value == 65_535));
            assert_eq!((scaled.width(), scaled.height()), (width, height));
        }
    }

    #[test]
    fn a_crop_takes_what_it_names_or_says_why_not() {
        let whole =
            frame(5, 4, &(0..4).flat_map(|y| (0..5).map(move |x| 10 * y + x)).collect::<Vec<_>>());
        let part = crop(&whole, CropRect { size: (2, 3), origin: (3, 1) }).unwrap();
        assert_eq!(part.borrowed_pixels().to_words(), [13, 14, 23, 24, 33, 34]);
        for (size, at) in [((6, 1), (0, 0)), ((1, 1), (5, 0)), ((0, 1), (0, 0)), ((1, 2), (0, 3))] {
            let message = crop(&whole, CropRect { size, origin: at }).unwrap_err().to_string();
            assert!(message.contains("5x4"), "{message}");
        }
        assert!(crop(&whole, CropRect { size: (u32::MAX, 1), origin: (2, 0) }).is_err());
    }
}
