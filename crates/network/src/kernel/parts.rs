// SPDX-License-Identifier: MIT OR Apache-2.0
//! Splits a convolution into one part per thread, each of which gathers the inputs that it needs.

use super::chunks::{CHUNK, Chunk};
use super::panels::Outputs;
use std::ops::Range;

/// The positions per thread from which threads share the positions. With fewer, threads share the
/// channels, so that each thread reads only its own weights.
const MANY: usize = 1024;

/// Returns the chunks and outputs of every part. `values` holds the channels of all blocks one
/// after the other, each of `size` rows and columns.
pub(crate) fn parts<'a, T>(
    blocks: &'a [Range<usize>],
    chunks: &'a [Chunk],
    values: &'a mut [T],
    size: [usize; 2],
) -> Vec<(&'a [Chunk], Outputs<'a, T>)> {
    let threads = rayon::current_num_threads();
    if threads == 1 || chunks.len() * CHUNK >= MANY * threads {
        by_places(blocks, cut(chunks, threads, size[1]), values, size)
    } else {
        by_channels(blocks, chunks, values, size, threads)
    }
}

/// Cuts chunks into at most `parts` parts of about the same length, at places where neighboring
/// chunks share no position.
fn cut(chunks: &[Chunk], parts: usize, width: usize) -> Vec<&[Chunk]> {
    let mut rest = chunks;
    let mut found = Vec::new();
    for left in (1..=parts).rev() {
        let Some(last) = rest.len().div_ceil(left).checked_sub(1) else { break };
        let done = rest[last].places(width).end;
        let end = rest.partition_point(|chunk| chunk.places(width).start < done);
        let (own, others) = rest.split_at(end);
        found.push(own);
        rest = others;
    }
    found
}

fn by_places<'a, T>(
    blocks: &'a [Range<usize>],
    parts: Vec<&'a [Chunk]>,
    values: &'a mut [T],
    [height, width]: [usize; 2],
) -> Vec<(&'a [Chunk], Outputs<'a, T>)> {
    let output = |chunks: &'a [Chunk]| {
        let first = chunks[0].places(width).start;
        (chunks, Outputs { planes: Vec::new(), first, blocks, width })
    };
    let mut found: Vec<_> = parts.into_iter().map(output).collect();
    for mut rest in values.chunks_mut(height * width) {
        let mut done = 0;
        for (chunks, outputs) in &mut found {
            let end = chunks[chunks.len() - 1].places(width).end;
            let (_, own) = rest.split_at_mut(outputs.first - done);
            let (own, others) = own.split_at_mut(end - outputs.first);
            outputs.planes.push(own);
            (rest, done) = (others, end);
        }
    }
    found
}

fn by_channels<'a, T>(
    blocks: &'a [Range<usize>],
    chunks: &'a [Chunk],
    values: &'a mut [T],
    [height, width]: [usize; 2],
    threads: usize,
) -> Vec<(&'a [Chunk], Outputs<'a, T>)> {
    let mut planes = values.chunks_mut(height * width);
    let part = |blocks: &'a [Range<usize>]| {
        let channels: usize = blocks.iter().map(Range::len).sum();
        let planes = planes.by_ref().take(channels).collect();
        (chunks, Outputs { planes, first: 0, blocks, width })
    };
    blocks.chunks(blocks.len().div_ceil(threads)).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form::Form;
    use crate::kernel::{Blocking, chunks};
    use crate::mask::Mask;
    use foveate_lanes::Level;

    /// Each chunk is in exactly one part, whose planes hold its positions. Each part adds 1 at the
    /// first position of its chunks, and no other part may write there.
    #[test]
    fn parts_are_all_chunks_and_share_no_position() {
        let form = Form::features(vec![1, 13, 40, 70]);
        let blocks = Blocking::of(Level::detect()).blocks(13);
        let masks = [
            Mask::full(40, 70),
            Mask::from_fn(40, 70, |x, y| (x * 7 + y * 11) % 17 == 0),
            Mask::from_fn(40, 70, |x, y| y == 39 && x > 60),
            Mask::from_fn(40, 70, |x, y| y % 13 == 5 && x < 40),
        ];
        for (mask, threads) in
            masks.iter().flat_map(|mask| (1..9).map(move |threads| (mask, threads)))
        {
            let all = chunks(mask);
            let mut values = vec![0.0f32; form.elements()];
            let parts = by_places(&blocks, cut(&all, threads, 70), &mut values, [40, 70]);
            assert!(parts.len() <= threads);
            let mut seen = Vec::new();
            for (own, outputs) in parts {
                assert_eq!(outputs.planes.len(), 13);
                for plane in outputs.planes {
                    for chunk in own {
                        for value in &mut plane[chunk.y * 70 + chunk.x - outputs.first..][..1] {
                            *value += 1.0;
                        }
                    }
                }
                seen.extend_from_slice(own);
            }
            assert_eq!(seen, all);
            for (at, &value) in values.iter().enumerate() {
                let (_, y, x) = form.coordinates(at);
                assert_eq!(
                    value,
                    f32::from(u8::from(all.contains(&Chunk { x, y }))),
                    "{threads}: {x}, {y}"
                );
            }
            let parts = by_channels(&blocks, &all, &mut values, [40, 70], threads);
            let planes: usize = parts.iter().map(|(_, outputs)| outputs.planes.len()).sum();
            assert!(planes == 13 && parts.iter().all(|(own, _)| *own == all));
        }
    }
}
