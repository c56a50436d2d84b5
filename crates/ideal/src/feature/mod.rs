// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of a frame: one per region and spatial feature, in natural units, and the temporal
//! score.

mod change;
mod corner;
mod edge;
mod flow;
mod mad;
mod range;
mod segment;
mod surface;
mod variance;

use foveate_camera::FeatureKind;

use super::plane::RegionGrid;
use crate::plane::PaddedPlane;
use crate::rules::FeatureRule;
use crate::view::FrameView;

pub(crate) use change::count_changed_pixels;

/// Reused buffers for lines of values and for values per region.
#[derive(Clone, Debug, Default)]
pub(crate) struct ScoreBuffers {
    lines: [Vec<f64>; 3],
    regions: [Vec<f64>; 2],
}

/// Scores every region: a number of pixels for `edge`, `corner` and `segment`, grey levels for
/// `mad`, `range`, `surface` and `flow`, squared grey levels for `variance`.
pub(crate) fn score(
    rule: &FeatureRule,
    view: &FrameView,
    scratch: &mut ScoreBuffers,
    scores: &mut [f64],
) {
    let level = rule.level;
    match rule.kind {
        FeatureKind::Edge => edge::score(level, view, scratch, scores),
        FeatureKind::Corner => corner::score(level, view, scratch, scores),
        FeatureKind::Mad => mad::score(view, scratch, scores),
        FeatureKind::Variance => variance::score(view, scratch, scores),
        FeatureKind::Range => range::score(view, scratch, scores),
        FeatureKind::Surface => surface::score(view, scratch, scores),
        FeatureKind::Segment => segment::score(level, view, scratch, scores),
        FeatureKind::Flow => flow::score(rule.radius, view, scores),
    }
}

/// Adds the values of one row to the sums of the regions that the row crosses.
fn add_row_to_sums(values: &[f64], side: usize, sums: &mut [f64]) {
    for (part, sum) in values.chunks_exact(side).zip(sums) {
        *sum += part.iter().sum::<f64>();
    }
}

fn pixel_sums(plane: &PaddedPlane, grid: &RegionGrid, sums: &mut Vec<f64>) {
    sums.clear();
    sums.resize(grid.regions(), 0.0);
    for y in 0..plane.height() {
        add_row_to_sums(plane.row(y), grid.side, &mut sums[grid.regions_of_row(y)]);
    }
}

fn pixels_per_region(grid: &RegionGrid) -> f64 {
    let side = f64::from(u32::try_from(grid.side).expect("a region is at most 64 pixels wide"));
    side * side
}
