// SPDX-License-Identifier: MIT OR Apache-2.0
//! Splits a convolution into one part per thread, each of which gathers the inputs that it needs.

use super::chunks::{CHUNK_POSITIONS, PositionChunk};
use super::panels::ConvOutputs;
use std::ops::Range;

/// The positions per thread from which threads share the positions. With fewer, threads share the
/// channels, so that each thread reads only its own weights.
const MIN_POSITIONS_PER_THREAD: usize = 1024;

/// Returns the chunks and outputs of every part. `values` holds the channels of all blocks one
/// after the other, each of `size` rows and columns.
pub(crate) fn thread_parts<'a, T>(
    blocks: &'a [Range<usize>],
    chunks: &'a [PositionChunk],
    values: &'a mut [T],
    size: [usize; 2],
) -> Vec<(&'a [PositionChunk], ConvOutputs<'a, T>)> {
    let threads = rayon::current_num_threads();
    if threads == 1 || chunks.len() * CHUNK_POSITIONS >= MIN_POSITIONS_PER_THREAD * threads {
        split_by_positions(blocks, cut_chunks(chunks, threads, size[1]), values, size)
    } else {
        split_by_channels(blocks, chunks, values, size, threads)
    }
}

/// Cuts chunks into at most `parts` parts of about the same length, at places where neighboring
/// chunks share no position.
fn cut_chunks(chunks: &[PositionChunk], parts: usize, width: usize) -> Vec<&[PositionChunk]> {
    let mut rest = chunks;
    let mut cut = Vec::new();
    for parts_left in (1..=parts).rev() {
        let Some(last) = rest.len().div_ceil(parts_left).checked_sub(1) else { break };
        let done = rest[last].memory_range(width).end;
        let end = rest.partition_point(|chunk| chunk.memory_range(width).start < done);
        let (part, others) = rest.split_at(end);
        cut.push(part);
        rest = others;
    }
    cut
}

fn split_by_positions<'a, T>(
    blocks: &'a [Range<usize>],
    parts: Vec<&'a [PositionChunk]>,
    values: &'a mut [T],
    [height, width]: [usize; 2],
) -> Vec<(&'a [PositionChunk], ConvOutputs<'a, T>)> {
    let output = |chunks: &'a [PositionChunk]| {
        let first = chunks[0].memory_range(width).start;
        (chunks, ConvOutputs { channels: Vec::new(), first_position: first, blocks, width })
    };
    let mut found: Vec<_> = parts.into_iter().map(output).collect();
    for mut rest in values.chunks_mut(height * width) {
        let mut done = 0;
        for (chunks, outputs) in &mut found {
            let end = chunks[chunks.len() - 1].memory_range(width).end;
            let (_, part) = rest.split_at_mut(outputs.first_position - done);
            let (part, others) = part.split_at_mut(end - outputs.first_position);
            outputs.channels.push(part);
            (rest, done) = (others, end);
        }
    }
    found
}

fn split_by_channels<'a, T>(
    blocks: &'a [Range<usize>],
    chunks: &'a [PositionChunk],
    values: &'a mut [T],
    [height, width]: [usize; 2],
    threads: usize,
) -> Vec<(&'a [PositionChunk], ConvOutputs<'a, T>)> {
    let mut planes = values.chunks_mut(height * width);
    let part = |blocks: &'a [Range<usize>]| {
        let channels: usize = blocks.iter().map(Range::len).sum();
        let planes = planes.by_ref().take(channels).collect();
        (chunks, ConvOutputs { channels: planes, first_position: 0, blocks, width })
    };
    blocks.chunks(blocks.len().div_ceil(threads)).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{BlockSizes, chunks::chunks_of_mask};
    use crate::mask::Mask;
    use crate::tensor::TensorForm;
    use foveate_pixels::vectors::InstructionSet;

    /// Each chunk is in exactly one part, whose planes hold its positions. Each part adds 1 at the
    /// first position of its chunks, and no other part may write there.
    #[test]
    fn parts_cover_all_chunks_and_share_no_position() {
        let form = TensorForm::features(vec![1, 13, 40, 70]);
        let blocks = BlockSizes::for_instruction_set(InstructionSet::detect()).blocks(13);
        let masks = [
            Mask::full(40, 70),
            Mask::from_fn(40, 70, |x, y| (x * 7 + y * 11) % 17 == 0),
            Mask::from_fn(40, 70, |x, y| y == 39 && x > 60),
            Mask::from_fn(40, 70, |x, y| y % 13 == 5 && x < 40),
        ];
        for (mask, threads) in
            masks.iter().flat_map(|mask| (1..9).map(move |threads| (mask, threads)))
        {
            let all = chunks_of_mask(mask);
            let mut values = vec![0.0f32; form.element_count()];
            let parts =
                split_by_positions(&blocks, cut_chunks(&all, threads, 70), &mut values, [40, 70]);
            assert!(parts.len() <= threads);
            let mut all_of_parts = Vec::new();
            for (part, outputs) in parts {
                assert_eq!(outputs.channels.len(), 13);
                for plane in outputs.channels {
                    for chunk in part {
                        for value in
                            &mut plane[chunk.y * 70 + chunk.x - outputs.first_position..][..1]
                        {
                            *value += 1.0;
                        }
                    }
                }
                all_of_parts.extend_from_slice(part);
            }
            assert_eq!(all_of_parts, all);
            for (at, &value) in values.iter().enumerate() {
                let (_, y, x) = form.coordinates(at);
                assert_eq!(
                    value,
                    f32::from(u8::from(all.contains(&PositionChunk { x, y }))),
                    "{threads}: {x}, {y}"
                );
            }
            let parts = split_by_channels(&blocks, &all, &mut values, [40, 70], threads);
            let planes: usize = parts.iter().map(|(_, outputs)| outputs.channels.len()).sum();
            assert!(planes == 13 && parts.iter().all(|(part, _)| *part == all));
        }
    }
}
