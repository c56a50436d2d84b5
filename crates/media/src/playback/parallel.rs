// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips in parallel, each on a thread of its own.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Runs `work` on the numbers of all clips, with as many clips in parallel as rayon has threads,
/// and returns the results in the order of the clips. A thread for which `work` returns `None`
/// takes no further clip; clips that no thread took have no result.
///
/// The threads are not those of rayon: while one of these waits within a clip, it could start
/// another clip.
pub fn run_in_parallel<T: Send>(
    clips: usize,
    work: impl Fn(usize) -> Option<T> + Sync,
) -> Vec<Option<T>> {
    let next = AtomicUsize::new(0);
    let results: Vec<Mutex<Option<T>>> = (0..clips).map(|_| Mutex::new(None)).collect();
    let take_clips = || {
        loop {
            let clip = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = results.get(clip) else { return };
            let Some(result) = work(clip) else { return };
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(clips) {
            scope.spawn(take_clips);
        }
    });
    let result = |slot: Mutex<Option<T>>| slot.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.into_iter().map(result).collect()
}
