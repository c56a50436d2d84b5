// SPDX-License-Identifier: MIT OR Apache-2.0
//! The external programs that run some of the levels.

use std::time::Duration;

use foveate_tools::{Cache, Toolchain};

pub(super) const RUN_TIME_LIMIT: Duration = Duration::from_secs(3600);

/// The tools of the machine, and the cache of their builds.
#[derive(Clone, Copy, Debug)]
pub struct ExternalTools<'a> {
    /// The toolchain that finds and runs the tools. Its flag stops the benchmark.
    pub toolchain: &'a Toolchain,
    /// The cache of finished builds.
    pub cache: &'a Cache,
}
