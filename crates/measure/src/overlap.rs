// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas over which errors are counted: the cells into which the lines of two grids of
//! regions divide a frame ([`GridCells`]).

use crate::areas::{DecisionState, StateAreas, state_pair_index};
use foveate_camera::Camera;

/// The pixels along one axis that lie in one region of each grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct GridStrip {
    pixels: u64,
    ideal: usize,
    candidate: usize,
}

/// The cells of a frame, as strips along both axes. Padding belongs to no cell.
#[derive(Clone, Debug)]
pub struct GridCells {
    column_strips: Vec<GridStrip>,
    row_strips: Vec<GridStrip>,
    ideal_columns: usize,
    candidate_columns: usize,
}

impl GridCells {
    /// Creates the cells of two cameras whose frames have the same size.
    #[must_use]
    pub fn new(ideal: &Camera, candidate: &Camera) -> Self {
        let sides = (ideal.region_size(), candidate.region_size());
        Self {
            column_strips: strips(ideal.width(), sides),
            row_strips: strips(ideal.height(), sides),
            ideal_columns: ideal.columns() as usize,
            candidate_columns: candidate.columns() as usize,
        }
    }

    /// Calls `use_cell` with the number of the ideal's region, the number of the candidate's region
    /// and the pixels of every cell.
    #[inline(always)]
    pub fn for_each(&self, mut use_cell: impl FnMut(usize, usize, u64)) {
        for row in &self.row_strips {
            let ideal = row.ideal * self.ideal_columns;
            let candidate = row.candidate * self.candidate_columns;
            for column in &self.column_strips {
                let pixels = row.pixels * column.pixels;
                use_cell(ideal + column.ideal, candidate + column.candidate, pixels);
            }
        }
    }

    /// Adds the area of every combination of states; both lists have one state per region, in
    /// row-major order.
    pub(crate) fn add_areas(
        &self,
        ideal: &[DecisionState],
        candidate: &[DecisionState],
        table: &mut StateAreas,
    ) {
        self.for_each(|ideal_region, region, pixels| {
            table[state_pair_index(ideal[ideal_region], candidate[region])] += pixels;
        });
    }
}

fn strips(size: u32, (ideal, candidate): (u32, u32)) -> Vec<GridStrip> {
    let mut strips = Vec::new();
    let mut at = 0;
    while at < size {
        let line = |side: u32| (at / side + 1) * side;
        let end = line(ideal).min(line(candidate)).min(size);
        strips.push(GridStrip {
            pixels: u64::from(end - at),
            ideal: (at / ideal) as usize,
            candidate: (at / candidate) as usize,
        });
        at = end;
    }
    strips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_both_grids_cut() {
        let strip = |pixels, ideal, candidate| GridStrip { pixels, ideal, candidate };
        assert_eq!(strips(5, (2, 2)), [strip(2, 0, 0), strip(2, 1, 1), strip(1, 2, 2)]);
        let expected =
            [strip(2, 0, 0), strip(1, 1, 0), strip(1, 1, 1), strip(2, 2, 1), strip(1, 3, 2)];
        assert_eq!(strips(7, (2, 3)), expected);
    }
}
