// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the tests that run whole co-simulations share.

pub(crate) mod serial;
pub(crate) mod vectors;

use foveate_cosim::{CosimError, CosimReport, Job, Level, Simulator, Stimulus};
use foveate_spec::{Config, Design};
use foveate_toolchain::{Cache, Toolchain};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// The design of a configuration for a frame of that many regions.
pub(crate) fn design(config: &Config, regions: (u32, u32)) -> Design {
    let mut config = config.clone();
    let side = config.region.size;
    (config.frame.width, config.frame.height) = (Some(regions.0 * side), Some(regions.1 * side));
    config.validate().unwrap_or_else(|error| panic!("{error}"))
}

/// Vectors without frames of the caller.
pub(crate) fn directed(level: Level, rounds: u32) -> Stimulus {
    Stimulus { level, rounds, ..Stimulus::default() }
}

/// One co-simulation, whose replay folder goes below `output`.
pub(crate) fn cosimulate(
    design: &Design,
    simulator: Simulator,
    stimulus: Stimulus,
    output: &Path,
    edit: impl FnOnce(&mut Job),
) -> Result<CosimReport, CosimError> {
    let mut job = Job::new(design, stimulus, output)?;
    job.simulator = simulator;
    edit(&mut job);
    job.run(&Toolchain::system(), &Cache::from_env()?, &mut |_| {})
}

/// Does `work` for every item on every core; failures come back together.
pub(crate) fn in_parallel<T: Sync>(
    items: &[T],
    work: impl Fn(&T) -> Result<(), String> + Sync,
) -> Vec<String> {
    let (next, failures) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let cores = thread::available_parallelism().map_or(1, |cores| cores.get());
    thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(failure) = work(item) {
                        failures.lock().unwrap_or_else(PoisonError::into_inner).push(failure);
                    }
                }
            });
        }
    });
    failures.into_inner().unwrap_or_else(PoisonError::into_inner)
}
