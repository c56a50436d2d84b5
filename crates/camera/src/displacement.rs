// SPDX-License-Identifier: MIT OR Apache-2.0
//! The displacements that `flow` searches; see `docs/contract.md`, "Flow".

use serde::Serialize;

use crate::bits_for;

/// The movement of the content of a region since its reference, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Displacement {
    /// Columns to the right.
    pub dx: i8,
    /// Rows down.
    pub dy: i8,
}

impl Displacement {
    /// Returns all (2 `radius` + 1)^2 displacements with |dx| and |dy| of at most `radius` pixels,
    /// 0 first. Each of them is preferred to the later ones if their mean errors are equal.
    ///
    /// # Panics
    /// Panics if the radius is above 127. The radius of a camera is 1..=3.
    #[must_use]
    pub fn search_order(radius: u32) -> Vec<Self> {
        let radius = i8::try_from(radius).expect("a radius is at most 3");
        let rows = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)));
        let mut all: Vec<_> = rows.map(|(dx, dy)| Self { dx, dy }).collect();
        all.sort_by_key(|one| one.dx.unsigned_abs() + one.dy.unsigned_abs());
        all
    }

    /// Returns the larger one of |dx| and |dy|, which is at most the radius of the search.
    #[must_use]
    pub fn largest_coordinate(self) -> u32 {
        self.dx.unsigned_abs().max(self.dy.unsigned_abs()).into()
    }

    /// Returns the bits of dx or dy in two's complement, for a search of this radius, 1..=3.
    #[must_use]
    pub fn coordinate_bits(radius: u32) -> u32 {
        bits_for(2 * u64::from(radius))
    }

    /// Returns n(d), the number of pixels whose partner lies in the region too, for regions with
    /// `side` pixels a side. The displacement must not be larger than the region.
    #[must_use]
    pub fn pixel_pairs(self, side: u32) -> u64 {
        let overlap = |shift: i8| u64::from(side - u32::from(shift.unsigned_abs()));
        overlap(self.dx) * overlap(self.dy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_displacements_come_first_and_then_upper_rows() {
        let order = |radius| {
            let all = Displacement::search_order(radius);
            all.into_iter().map(|Displacement { dx, dy }| (dx, dy)).collect::<Vec<_>>()
        };
        let near = [(0, 0), (0, -1), (-1, 0), (1, 0), (0, 1)];
        assert_eq!(order(1), [&near[..], &[(-1, -1), (1, -1), (-1, 1), (1, 1)]].concat());
        let two = order(2);
        assert_eq!((two.len(), order(3).len()), (25, 49));
        assert_eq!(two[..9], [&near[..], &[(0, -2), (-1, -1), (1, -1), (-2, 0)]].concat());
        assert_eq!(two[24], (2, 2));
    }

    #[test]
    fn two_or_three_bits_hold_the_numbers_of_a_search() {
        for radius in 1..=3 {
            let largest = Displacement::search_order(radius)
                .into_iter()
                .map(Displacement::largest_coordinate);
            assert_eq!(largest.max(), Some(radius));
            let bits = Displacement::coordinate_bits(radius);
            assert!(radius < 1 << (bits - 1) && radius >= 1 << (bits - 2), "{radius}: {bits}");
        }
    }

    #[test]
    fn partners_lie_in_the_region() {
        let pairs = |dx, dy, side| Displacement { dx, dy }.pixel_pairs(side);
        assert_eq!([pairs(0, 0, 8), pairs(-1, 3, 8), pairs(1, -1, 2)], [64, 35, 1]);
    }
}
