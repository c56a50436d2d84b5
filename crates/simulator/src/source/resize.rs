// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cropping, and scaling by area, in integers: the same bits for every source and on every machine.
//!
//! Each pixel of the result is the mean of the part of the picture that it covers, edges in
//! proportion, rounded to the nearest (halves up). Going down this is box filtering, going up it is
//! nearest-neighbor with blended seams.

use foveate_model::Frame;

use crate::SimulatorError;

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Width and height.
    pub size: (u32, u32),
    /// Its left and upper pixel.
    pub at: (u32, u32),
}

/// The part of a frame.
pub(crate) fn crop(frame: &Frame, crop: Crop) -> Result<Frame, SimulatorError> {
    let (width, height) = crop.size;
    let fits = |at: u32, size: u32, whole: u32| {
        size > 0 && at.checked_add(size).is_some_and(|end| end <= whole)
    };
    if !fits(crop.at.0, width, frame.width()) || !fits(crop.at.1, height, frame.height()) {
        return Err(SimulatorError::Crop { crop, size: (frame.width(), frame.height()) });
    }
    let (left, right) = (crop.at.0 as usize, (crop.at.0 + width) as usize);
    let rows = (crop.at.1..crop.at.1 + height).map(|y| &frame.row(y)[left..right]);
    let pixels = rows.flatten().copied().collect();
    Ok(Frame::new(width, height, frame.bits(), pixels)?)
}

/// The frame at another size.
pub(crate) fn resize(frame: &Frame, width: u32, height: u32) -> Result<Frame, SimulatorError> {
    if (frame.width(), frame.height()) == (width, height) {
        return Ok(frame.clone());
    }
    let columns = spans(frame.width(), width);
    let rows = spans(frame.height(), height);
    let area = u64::from(frame.width()) * u64::from(frame.height());
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    let mut sums = vec![0u64; frame.width() as usize];
    for span in &rows {
        sums.fill(0);
        for (y, weight) in span.parts() {
            for (sum, &value) in sums.iter_mut().zip(frame.row(y)) {
                *sum += weight * u64::from(value);
            }
        }
        pixels.extend(columns.iter().map(|span| {
            let sum: u64 = span.parts().map(|(x, weight)| weight * sums[x as usize]).sum();
            // A mean of pixels is no larger than the largest of them.
            u16::try_from((sum + area / 2) / area).unwrap_or(u16::MAX)
        }));
    }
    Ok(Frame::new(width, height, frame.bits(), pixels)?)
}

/// What one pixel of the result covers, in parts of 1 / `scale` source pixels.
struct Span {
    start: u64,
    end: u64,
    scale: u64,
}

/// Pixel j of `to` covers j * from .. (j + 1) * from where source pixel i is i * to .. (i + 1) * to.
fn spans(from: u32, to: u32) -> Vec<Span> {
    let (from, scale) = (u64::from(from), u64::from(to));
    (0..scale).map(|j| Span { start: j * from, end: (j + 1) * from, scale }).collect()
}

impl Span {
    /// Source pixels with their weights, which add up to the size of the source.
    fn parts(&self) -> impl Iterator<Item = (u32, u64)> + '_ {
        (self.start / self.scale..self.end.div_ceil(self.scale)).map(|i| {
            let (low, high) = (i * self.scale, (i + 1) * self.scale);
            let weight = self.end.min(high) - self.start.max(low);
            (u32::try_from(i).unwrap_or(u32::MAX), weight)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(width: u32, height: u32, pixels: &[u16]) -> Frame {
        Frame::new(width, height, 8, pixels.to_vec()).unwrap()
    }

    #[test]
    fn whole_blocks_become_their_mean_with_halves_up() {
        let small = resize(&frame(4, 2, &[0, 1, 10, 20, 0, 1, 30, 40]), 2, 1).unwrap();
        assert_eq!(small.pixels(), [1, 25]);
    }

    #[test]
    fn pixels_at_the_edge_count_in_proportion() {
        // 3 to 2: (2 a + b) / 3 and (b + 2 c) / 3.
        assert_eq!(resize(&frame(3, 1, &[0, 90, 255]), 2, 1).unwrap().pixels(), [30, 200]);
        assert_eq!(resize(&frame(1, 3, &[0, 90, 255]), 1, 2).unwrap().pixels(), [30, 200]);
        // 2 to 3: the middle is half of each.
        assert_eq!(resize(&frame(2, 1, &[10, 20]), 3, 1).unwrap().pixels(), [10, 15, 20]);
    }

    #[test]
    fn flat_stays_flat_and_the_mean_stays_near_at_any_size() {
        let full = Frame::filled(37, 23, 16, 65_535).unwrap();
        for (width, height) in [(1, 1), (7, 50), (36, 24), (100, 3)] {
            let scaled = resize(&full, width, height).unwrap();
            assert!(scaled.pixels().iter().all(|&value| value == 65_535));
            assert_eq!((scaled.width(), scaled.height()), (width, height));
        }
    }

    #[test]
    fn a_crop_takes_what_it_names_or_says_why_not() {
        let whole = Frame::from_fn(5, 4, 8, |x, y| u16::try_from(10 * y + x).unwrap()).unwrap();
        let part = crop(&whole, Crop { size: (2, 3), at: (3, 1) }).unwrap();
        assert_eq!(part.pixels(), [13, 14, 23, 24, 33, 34]);
        for (size, at) in [((6, 1), (0, 0)), ((1, 1), (5, 0)), ((0, 1), (0, 0)), ((1, 2), (0, 3))] {
            let message = crop(&whole, Crop { size, at }).unwrap_err().to_string();
            assert!(message.contains("5x4"), "{message}");
        }
        assert!(crop(&whole, Crop { size: (u32::MAX, 1), at: (2, 0) }).is_err());
    }
}
