// SPDX-License-Identifier: MIT OR Apache-2.0
//! `flow`: the mean difference from the reference as it stands, minus that at the displacement
//! where it is smallest, in grey levels. Only pixels of the region and of its own reference are
//! compared.

use std::ops::Range;

use foveate_camera::Displacement;

use crate::plane::PaddedPlane;
use crate::view::FrameView;

pub(super) fn score(radius: u32, view: &FrameView, scores: &mut [f64]) {
    let displacements = Displacement::search_order(radius);
    for (region, score) in scores.iter_mut().enumerate() {
        *score = 0.0;
        if view.references.valid[region] {
            let costs = displacements.iter().map(|one| MatchingCost::new(view, region, *one));
            let costs: Vec<_> = costs.collect();
            // The first displacement is 0.
            let still = &costs[0];
            *score = costs.iter().map(|cost| cost.gain_over(still)).fold(0.0, f64::max);
        }
    }
}

/// The cost of matching a region with its reference at a displacement.
struct MatchingCost {
    /// E(d), the sum of the absolute differences of the pixels from their partners.
    sum: f64,
    /// n(d), the number of pixels whose partner lies in the region too.
    pairs: f64,
}

impl MatchingCost {
    fn new(view: &FrameView, region: usize, Displacement { dx, dy }: Displacement) -> Self {
        let (columns, rows) = view.grid.area(region);
        let (columns, partner_columns) = paired(&columns, dx);
        let (rows, partner_rows) = paired(&rows, dy);
        let line = |plane: &PaddedPlane, y: usize, columns: &Range<usize>| {
            plane.row(y)[columns.clone()].to_vec()
        };
        let mut differences = Vec::new();
        for (y, partner) in rows.zip(partner_rows) {
            let here = line(view.denoised, y, &columns);
            let there = line(&view.references.plane, partner, &partner_columns);
            differences.extend(here.iter().zip(&there).map(|(x, other)| (x - other).abs()));
        }
        let pairs = u32::try_from(differences.len()).expect("a region has at most 4096 pixels");
        Self { sum: differences.iter().sum(), pairs: pairs.into() }
    }

    /// Returns by how much the mean error E(d) / n(d) of another displacement is larger. It is one
    /// quotient and not the difference of two, so that a score that equals the minimum is not
    /// rounded below it.
    fn gain_over(&self, other: &Self) -> f64 {
        (other.sum * self.pairs - self.sum * other.pairs) / (other.pairs * self.pairs)
    }
}

/// Returns the places whose partner, `shift` places before them, lies in the range too, and the
/// places of the partners.
fn paired(places: &Range<usize>, shift: i8) -> (Range<usize>, Range<usize>) {
    let by = usize::from(shift.unsigned_abs());
    let (later, earlier) = (places.start + by..places.end, places.start..places.end - by);
    if shift < 0 { (earlier, later) } else { (later, earlier) }
}
