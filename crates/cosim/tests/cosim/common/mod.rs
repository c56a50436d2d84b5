// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions that several tests of whole co-simulations share.

pub(crate) mod serial;
pub(crate) mod vectors;

use foveate_camera::{FeatureKind, SpatialConfig};
use foveate_cosim::{CosimError, CosimJob, CosimLevel, CosimReport, Simulator, Stimulus};
use foveate_design::{Design, DesignConfig, Organization};
use foveate_tools::{Cache, Toolchain, testing::require_tools};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

pub(crate) fn feature(kind: FeatureKind, mean_fraction_bits: u32) -> SpatialConfig {
    let mut feature = SpatialConfig::new(kind);
    feature.mean_fraction_bits = kind.has_second_pass().then_some(mean_fraction_bits);
    feature
}

/// Returns sets of the features of an organization: each with its companions, and all.
pub(crate) fn feature_sets(organization: Organization) -> Vec<Vec<FeatureKind>> {
    let all = organization.feature_kinds();
    let own = |kind: &FeatureKind| {
        kind.spec().companions.iter().copied().filter(|kind| all.contains(kind)).collect()
    };
    all.iter().map(own).chain([all.clone()]).collect()
}

/// Returns the name of a configuration, from the keys that all organizations have.
pub(crate) fn config_name(config: &DesignConfig) -> String {
    let kinds: Vec<_> = config.camera.spatial.iter().map(|s| s.feature.name()).collect();
    let blocks = config.camera.periphery.blocks.map_or(String::new(), |q| format!(" q={q}"));
    format!(
        "{} N={} P={} {} {} {} {}{blocks} {} {} {}",
        kinds.join("+"),
        config.camera.region.size,
        config.camera.frame.pixel_bits,
        config.camera.denoise.filter,
        config.camera.region.neighborhood,
        config.camera.temporal.reference,
        config.camera.render.irrelevant,
        config.camera.render.payload,
        config.camera.decision.combine,
        config.hardware.thresholds,
    )
}

/// Returns one of all values of a key, in turn.
pub(crate) fn in_turn<T: Copy>(all: &[T], turn: usize) -> T {
    all[turn % all.len()]
}

/// Returns the design of a configuration for a frame of the given grid of regions.
pub(crate) fn design(config: &DesignConfig, regions: (u32, u32)) -> Design {
    let mut config = config.clone();
    let side = config.camera.region.size;
    (config.camera.frame.width, config.camera.frame.height) =
        (Some(regions.0 * side), Some(regions.1 * side));
    config.validate().unwrap_or_else(|error| panic!("{error}"))
}

/// Returns true if every simulator is installed.
pub(crate) fn has_simulators() -> bool {
    Simulator::ALL.iter().all(|simulator| require_tools(simulator.tools()))
}

/// Returns a stimulus without frames of the caller.
pub(crate) fn directed_stimulus(level: CosimLevel, rounds: u32) -> Stimulus {
    Stimulus { level, rounds, ..Stimulus::default() }
}

/// Runs one co-simulation; its replay folder is `output`.
pub(crate) fn cosimulate(
    design: &Design,
    simulator: Simulator,
    stimulus: Stimulus,
    output: &Path,
    edit: impl FnOnce(&mut CosimJob),
) -> Result<CosimReport, CosimError> {
    let mut job = CosimJob::new(design, stimulus, output)?;
    job.simulator = simulator;
    edit(&mut job);
    job.run(&Toolchain::system(), &Cache::from_env()?, &mut |_| {})
}

/// Checks that a co-simulation finds no mismatch. Fails with the report otherwise.
pub(crate) fn check_agreement(
    what: &str,
    design: &Design,
    simulator: Simulator,
    stimulus: Stimulus,
    output: &Path,
) -> Result<(), String> {
    match cosimulate(design, simulator, stimulus, output, |_| {}) {
        Ok(report) if report.passed() => Ok(()),
        Ok(report) => Err(format!("{what}: {report}")),
        Err(error) => Err(format!("{what}: {error}")),
    }
}

/// Does `work` for every item on all cores, and returns the failures of all items.
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
