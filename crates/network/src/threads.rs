// SPDX-License-Identifier: MIT OR Apache-2.0
//! Work that threads share. It is compiled for each type of values, and not for each closure, which would take a fourth of this crate's time to compile.

use rayon::prelude::*;

/// Calls `work` with the number and the values of every chunk of that length.
pub(crate) fn each_chunk<T: Send>(
    values: &mut [T],
    length: usize,
    work: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    let chunks = values.par_chunks_mut(length).enumerate();
    chunks.for_each(|(number, chunk)| work(number, chunk));
}

/// The same, with something to work in, which a thread keeps for some chunks.
pub(crate) fn each_chunk_in<T: Send, S: Default>(
    values: &mut [T],
    length: usize,
    work: &(dyn Fn(&mut S, usize, &mut [T]) + Sync),
) {
    let chunks = values.par_chunks_mut(length).enumerate();
    chunks.for_each_init(S::default, |room, (number, chunk)| work(room, number, chunk));
}

/// Calls `work` with every part.
pub(crate) fn each_part<P: Send>(parts: Vec<P>, work: &(dyn Fn(P) + Sync)) {
    parts.into_par_iter().for_each(work);
}
