// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positions of an output that are computed, and the inputs that they depend on.

use crate::accelerator::layer::{KernelWindow, Layer};
use std::ops::Range;

/// The positions of one image's output that are computed.
#[derive(Clone, Debug)]
pub(crate) struct ComputedPositions<'a> {
    layer: &'a Layer,
    /// True if each position is computed, in row-major order.
    is_computed: Vec<bool>,
}

impl<'a> ComputedPositions<'a> {
    /// Selects all positions.
    pub(crate) fn all(layer: &'a Layer) -> Self {
        Self { layer, is_computed: vec![true; index(layer.outputs.positions())] }
    }

    /// Selects the positions of all tiles in which at least one position is needed. `tile` has rows
    /// and columns; `is_needed` takes column and row.
    pub(crate) fn in_tiles(
        layer: &'a Layer,
        tile: [u32; 2],
        is_needed: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let (height, width) = (index(layer.outputs.height), index(layer.outputs.width));
        let [rows, columns] = tile.map(|side| index(side.into()));
        let mut is_computed = vec![false; height * width];
        for top in (0..height).step_by(rows) {
            let rows = top..(top + rows).min(height);
            for left in (0..width).step_by(columns) {
                let columns = left..(left + columns).min(width);
                if rows.clone().any(|y| columns.clone().any(|x| is_needed(x, y))) {
                    for y in rows.clone() {
                        is_computed[y * width..][columns.clone()].fill(true);
                    }
                }
            }
        }
        Self { layer, is_computed }
    }

    pub(crate) fn position_count(&self, rows: Range<u64>) -> u64 {
        rows.map(|row| self.count_in_row(row)).sum()
    }

    /// Returns the largest number of computed positions in one of these rows.
    pub(crate) fn longest_row(&self, rows: Range<u64>) -> u64 {
        rows.map(|row| self.count_in_row(row)).max().unwrap_or_default()
    }

    /// Returns the number of input positions that the computed outputs of these rows depend on,
    /// each counted once.
    pub(crate) fn input_count(&self, rows: Range<u64>) -> u64 {
        let [down, across] = self.layer.windows;
        let (height, width) = (self.layer.inputs.height, self.layer.inputs.width);
        // A row of the input is empty until a computed output depends on it.
        let mut needed_rows = vec![Vec::new(); index(height)];
        for row in rows {
            let Some(needed) = self.input_columns(row, across, width) else { continue };
            for input in down.taps(row, height) {
                let needed_row: &mut Vec<bool> = &mut needed_rows[index(input)];
                needed_row.resize(needed.len(), false);
                needed_row.iter_mut().zip(&needed).for_each(|(bit, &needed)| *bit |= needed);
            }
        }
        needed_rows.iter().flatten().map(|&needed| u64::from(needed)).sum()
    }

    /// Returns true for each column of the input that a computed output of a row depends on; `None`
    /// if the row has no computed output.
    fn input_columns(&self, row: u64, across: KernelWindow, width: u64) -> Option<Vec<bool>> {
        let outputs = self.row(row);
        outputs.contains(&true).then(|| {
            let mut is_needed = vec![false; index(width)];
            for (column, _) in (0..).zip(outputs).filter(|&(_, &is_computed)| is_computed) {
                across.taps(column, width).for_each(|input| is_needed[index(input)] = true);
            }
            is_needed
        })
    }

    fn count_in_row(&self, row: u64) -> u64 {
        self.row(row).iter().map(|&is_computed| u64::from(is_computed)).sum()
    }

    fn row(&self, row: u64) -> &[bool] {
        let width = index(self.layer.outputs.width);
        &self.is_computed[index(row) * width..][..width]
    }
}

/// Converts a position to an index. Layers are checked to have fewer positions than a `usize` can
/// count.
fn index(value: u64) -> usize {
    usize::try_from(value).expect("a layer has fewer positions than memory has bytes")
}
