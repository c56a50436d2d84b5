// SPDX-License-Identifier: MIT OR Apache-2.0
//! The threads that do the work: the calling thread, and others that take strips from the same
//! queue.
//!
//! The caller never waits for a thread to wake up. It waits only for strips that other threads have
//! begun.

use std::sync::{Mutex, PoisonError};

use foveate_pixels::vectors::{InstructionSet, VectorTask};

/// The largest number of threads that an engine takes. More threads than processors gain nothing,
/// and thousands of threads would keep the system busy.
pub const MAX_THREADS: usize = 256;
/// The number of strips per thread. A thread that is interrupted delays the others by at most half
/// of its work.
const STRIPS_PER_THREAD: usize = 2;
/// The number of pixels of the smallest strip that is worth handing to another thread.
const SMALLEST_STRIP: usize = 1 << 15;

/// The threads and the instruction set of an engine.
#[derive(Debug)]
pub(crate) struct Workers {
    pub(crate) level: InstructionSet,
    /// The threads other than the calling one.
    pub(crate) other_threads: Option<rayon::ThreadPool>,
}

impl Workers {
    /// Makes the workers of an engine that uses only the calling thread.
    pub(crate) fn calling_thread(level: InstructionSet) -> Self {
        Self { level, other_threads: None }
    }

    /// Makes `threads` workers, the calling thread included.
    pub(crate) fn new(
        level: InstructionSet,
        threads: usize,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        if threads <= 1 {
            return Ok(Self::calling_thread(level));
        }
        let others = rayon::ThreadPoolBuilder::new().num_threads(threads - 1).build()?;
        Ok(Self { level, other_threads: Some(others) })
    }

    fn other_thread_count(&self) -> usize {
        self.other_threads.as_ref().map_or(0, rayon::ThreadPool::current_num_threads)
    }

    /// Returns the number of strips, at most `most`, into which this number of pixels is divided.
    /// The pixels may be those of several frames.
    pub(crate) fn strips(&self, most: usize, pixels: usize) -> usize {
        match self.other_thread_count() {
            0 => 1,
            others => {
                let most = ((others + 1) * STRIPS_PER_THREAD).min(most);
                (pixels / SMALLEST_STRIP).clamp(1, most)
            }
        }
    }

    /// Runs tasks that share nothing, in any order.
    pub(crate) fn run<W: VectorTask + Send>(&self, tasks: impl ExactSizeIterator<Item = W>) {
        match &self.other_threads {
            Some(pool) if tasks.len() > 1 => {
                let helpers = self.other_thread_count().min(tasks.len() - 1);
                let tasks: Vec<W> = tasks.collect();
                let queue = Mutex::new(tasks.into_iter());
                let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                let work = || {
                    while let Some(task) = next() {
                        self.run_task(task);
                    }
                };
                pool.in_place_scope(|scope| {
                    for _ in 0..helpers {
                        scope.spawn(|_| work());
                    }
                    work();
                });
            }
            _ => tasks.for_each(|task| self.run_task(task)),
        }
    }

    /// Runs a task. It is not inlined: a task is large, and is compiled once instead of once per
    /// call.
    #[inline(never)]
    fn run_task<W: VectorTask>(&self, task: W) {
        self.level.run(task);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    struct CountTask<'a>(&'a AtomicUsize, usize);

    impl VectorTask for CountTask<'_> {
        #[inline(always)]
        fn run(self) {
            self.0.fetch_add(self.1, Ordering::Relaxed);
        }
    }

    #[test]
    fn every_task_runs_once() {
        for threads in 1..=3 {
            let workers = Workers::new(InstructionSet::PORTABLE, threads).unwrap();
            for tasks in [0, 1, 2, 50] {
                let sum = AtomicUsize::new(0);
                let tasks: Vec<_> = (0..tasks).map(|number| CountTask(&sum, number + 1)).collect();
                let expected = tasks.len() * (tasks.len() + 1) / 2;
                workers.run(tasks.into_iter());
                assert_eq!(sum.into_inner(), expected);
            }
        }
    }

    #[test]
    fn small_frames_are_not_divided() {
        let workers = Workers::new(InstructionSet::PORTABLE, 2).unwrap();
        assert_eq!(workers.strips(28, 224 * 224), 1);
        assert_eq!(workers.strips(34, 1920 * 1088), 4);
        assert_eq!(workers.strips(3, 1920 * 1088), 3);
        assert_eq!(Workers::calling_thread(InstructionSet::PORTABLE).strips(34, 1920 * 1088), 1);
    }
}
