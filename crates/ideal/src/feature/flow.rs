// SPDX-License-Identifier: MIT OR Apache-2.0
//! `flow`: the mean difference from the reference as it stands, minus that at the displacement where
//! it is smallest, in grey levels. Only pixels of the region and of its own reference are compared.

use std::ops::Range;

use foveate_camera::Displacement;

use crate::plane::PaddedPlane;
use crate::view::FrameView;

pub(super) fn score(radius: u32, view: &FrameView, scores: &mut [f64]) {
    let displacements = Displacement::search_order(radius);
    for (region, score) in scores.iter_mut().enumerate() {
        *score = 0.0;
        if view.references.valid[region] {
            let still = DisplacedDifference::new(view, region, Displacement::default());
            let moved =
                displacements.iter().map(|one| DisplacedDifference::new(view, region, *one));
            *score = moved.map(|one| one.gain_over(&still)).fold(0.0, f64::max);
        }
    }
}

/// The differences of the pixels of a region from their partners at a displacement.
struct DisplacedDifference {
    /// The sum of the absolute differences.
    sum: f64,
    /// The number of pixels whose partner lies in the region too.
    pairs: f64,
}

impl DisplacedDifference {
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

    /// Returns how much larger the mean of another difference is. It is one quotient and not the
    /// difference of two, so that a score that equals the minimum is not rounded below it.
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
