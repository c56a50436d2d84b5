// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work that threads share. The functions take trait objects, so that they are compiled for each
//! type of values and not for each closure. Compiled for each closure they would take a quarter of
//! the compile time of this crate.

use rayon::prelude::*;

/// Calls `work` with the number and the values of every chunk of `length` values.
pub(crate) fn for_each_chunk<T: Send>(
    values: &mut [T],
    length: usize,
    work: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    let chunks = values.par_chunks_mut(length).enumerate();
    chunks.for_each(|(number, chunk)| work(number, chunk));
}

/// Calls `work` with a scratch buffer and with the number and the values of every chunk of `length`
/// values. A thread reuses its scratch buffer for several chunks.
pub(crate) fn for_each_chunk_with_scratch<T: Send, S: Default>(
    values: &mut [T],
    length: usize,
    work: &(dyn Fn(&mut S, usize, &mut [T]) + Sync),
) {
    let chunks = values.par_chunks_mut(length).enumerate();
    chunks.for_each_init(S::default, |room, (number, chunk)| work(room, number, chunk));
}

/// Calls `work` with every part.
pub(crate) fn for_each_part<P: Send>(parts: Vec<P>, work: &(dyn Fn(P) + Sync)) {
    parts.into_par_iter().for_each(work);
}
