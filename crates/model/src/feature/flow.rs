// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `flow`: the displacement at which the reference of a region matches the region best,
//! and by how much it matches better than the reference as it stands.

use foveate_camera::Displacement;

use crate::conversions::index;
use crate::region::RegionView;

/// The sum of the differences between a region and its displaced reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisplacedError {
    /// The displacement d.
    pub displacement: Displacement,
    /// The sum E(d) over the pixels whose partner lies in the region.
    pub error: u64,
    /// The number n(d) of these pixels.
    pub pairs: u64,
}

/// The result of the search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlowMatch {
    /// The displacement with the smallest mean error.
    pub displacement: Displacement,
    /// The gain of the displacement, in grey levels times the pixels of a region.
    pub score: u64,
}

impl DisplacedError {
    /// Returns true if the mean error is smaller than that of another displacement.
    fn is_better_than(self, other: Self) -> bool {
        self.error * other.pairs < other.error * self.pairs
    }
}

/// Returns the errors at all displacements of at most `radius` pixels, in the order of the search.
/// Returns nothing for a region without a valid reference.
#[must_use]
pub fn displaced_errors(region: &impl RegionView, radius: u32) -> Vec<DisplacedError> {
    let Some(reference) = region.reference() else { return Vec::new() };
    let side = u32::try_from(region.pixel_count().isqrt()).expect("a side is at most 64");
    let (pixels, reference) = (region.pixels().collect::<Vec<_>>(), reference.collect::<Vec<_>>());
    let (pixels, reference) = (pixels.chunks(index(side)), reference.chunks(index(side)));
    let (pixels, reference): (Vec<_>, Vec<_>) = (pixels.collect(), reference.collect());
    let error_at = |displacement: Displacement| {
        let (dx, dy) = (displacement.dx.into(), displacement.dy.into());
        let (rows, partner_rows) = (overlap(&pixels, dy), overlap(&reference, -dy));
        let rows = rows.iter().zip(partner_rows);
        let pairs =
            rows.flat_map(|(row, partners)| overlap(row, dx).iter().zip(overlap(partners, -dx)));
        let error = pairs.map(|(pixel, partner)| u64::from(pixel.abs_diff(*partner))).sum();
        DisplacedError { displacement, error, pairs: displacement.pixel_pairs(side) }
    };
    Displacement::search_order(radius).into_iter().map(error_at).collect()
}

/// Returns the best displacement and its score. Without a valid reference both are 0.
#[must_use]
pub fn flow_match(region: &impl RegionView, radius: u32) -> FlowMatch {
    let errors = displaced_errors(region, radius);
    let Some((&still, displaced)) = errors.split_first() else { return FlowMatch::default() };
    let nearer = |best: DisplacedError, &next: &DisplacedError| {
        if next.is_better_than(best) { next } else { best }
    };
    let best = displaced.iter().fold(still, nearer);
    let gain = still.error * best.pairs - best.error * still.pairs;
    FlowMatch { displacement: best.displacement, score: gain / best.pairs }
}

/// Returns the elements whose partner, `shift` elements before them, exists too.
fn overlap<T>(elements: &[T], shift: isize) -> &[T] {
    let missing = shift.unsigned_abs();
    if shift < 0 { &elements[..elements.len() - missing] } else { &elements[missing..] }
}
