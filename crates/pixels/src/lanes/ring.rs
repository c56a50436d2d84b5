// SPDX-License-Identifier: MIT OR Apache-2.0
//! FAST 5/8 as a network of minima and maxima.
//!
//! The score of an arc is the minimum of its five pixels, and the best arc has the largest of the
//! eight minima. Two arcs that share four pixels have the maximum
//! `min(four, max(pixel before, pixel after))`, so four groups of four pixels serve all eight arcs.

use crate::lanes::PixelLane;

/// Returns the score of the best of the eight arcs of five neighbors in a ring. `worse` returns the
/// worse of two pixels, and `better` the better one. The score of an arc is its worst pixel. With
/// minimum and maximum, the best arc is the brightest one; with maximum and minimum, the darkest.
#[inline(always)]
pub fn best_arc<T: PixelLane>(
    x: [T; 8],
    worse: impl Fn(T, T) -> T,
    better: impl Fn(T, T) -> T,
) -> T {
    let pair = [worse(x[0], x[1]), worse(x[2], x[3]), worse(x[4], x[5]), worse(x[6], x[7])];
    // An arc is the four pixels k to k + 3 with a fifth, k - 1 or k + 4.
    let best_of_two = |four: T, before: T, after: T| worse(four, better(before, after));
    let a = best_of_two(worse(pair[0], pair[1]), x[7], x[4]);
    let b = best_of_two(worse(pair[1], pair[2]), x[1], x[6]);
    let c = best_of_two(worse(pair[2], pair[3]), x[3], x[0]);
    let d = best_of_two(worse(pair[3], pair[0]), x[5], x[2]);
    better(better(a, b), better(c, d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ring_of_zeros_and_ones_has_its_best_arc() {
        for bits in 0..256u32 {
            let ring: [u8; 8] = std::array::from_fn(|place| u8::from(bits >> place & 1 == 1));
            let has_arc_of =
                |value| (0..8).any(|start| (0..5).all(|k| ring[(start + k) % 8] == value));
            assert_eq!(best_arc(ring, u8::min, u8::max) == 1, has_arc_of(1), "{ring:?}");
            assert_eq!(best_arc(ring, u8::max, u8::min) == 0, has_arc_of(0), "{ring:?}");
        }
    }
}
