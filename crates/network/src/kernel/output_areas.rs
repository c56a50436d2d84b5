// SPDX-License-Identifier: MIT OR Apache-2.0
//! Combines chunks into areas: runs of the same columns in consecutive rows, which share the inputs
//! of their windows.

use super::chunks::{CHUNK_POSITIONS, PositionChunk};
use std::collections::HashMap;
use std::ops::Range;

/// The largest number of positions of an area, unless a single row has more. With so many, inputs
/// and outputs stay in the nearest cache.
const MAX_AREA_POSITIONS: usize = 3072;

/// The same columns of consecutive rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct OutputArea {
    pub(crate) rows: Range<usize>,
    pub(crate) columns: Range<usize>,
}

/// Returns the positions of chunks as areas, each position once. Rows have `width` positions.
pub(crate) fn areas_of_chunks(chunks: &[PositionChunk], width: usize) -> Vec<OutputArea> {
    let mut found: Vec<OutputArea> = Vec::new();
    // The last area of each range of columns.
    let mut latest = HashMap::<Range<usize>, usize>::new();
    for (y, columns) in runs_of_chunks(chunks, width) {
        let last = latest.get(&columns).map(|&last| &mut found[last].rows);
        match last
            .filter(|rows| rows.end == y && (rows.len() + 1) * columns.len() <= MAX_AREA_POSITIONS)
        {
            Some(rows) => rows.end += 1,
            None => {
                latest.insert(columns.clone(), found.len());
                found.push(OutputArea { rows: y..y + 1, columns });
            }
        }
    }
    found
}

/// Returns the runs of positions that chunks cover, each with its row.
fn runs_of_chunks(
    chunks: &[PositionChunk],
    width: usize,
) -> impl Iterator<Item = (usize, Range<usize>)> {
    let mut rest = chunks.iter().peekable();
    std::iter::from_fn(move || {
        let &PositionChunk { x, y } = rest.next()?;
        let mut end = x + CHUNK_POSITIONS;
        while let Some(next) = rest.next_if(|next| next.y == y && next.x <= end) {
            end = next.x + CHUNK_POSITIONS;
        }
        Some((y, x..end.min(width)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::chunks::chunks_of_mask;
    use crate::mask::Mask;

    #[test]
    fn areas_cover_each_position_of_the_chunks_once() {
        for width in [3, 9, 70, 4000] {
            for is_taken in [|_, _| true, |x, y| (x * 7 + y / 5 * 11) % 29 < 2] {
                let chunks = chunks_of_mask(&Mask::from_fn(40, width, is_taken));
                let mut covered = vec![0; 40 * width];
                for OutputArea { rows, columns } in areas_of_chunks(&chunks, width) {
                    assert!(rows.len() == 1 || rows.len() * columns.len() <= MAX_AREA_POSITIONS);
                    for y in rows {
                        covered[y * width..][columns.clone()]
                            .iter_mut()
                            .for_each(|covered| *covered += 1);
                    }
                }
                let mut wanted = vec![0; 40 * width];
                for chunk in chunks {
                    wanted[chunk.memory_range(width)].fill(1);
                }
                assert_eq!(covered, wanted);
            }
        }
    }
}
