// SPDX-License-Identifier: MIT OR Apache-2.0
//! External programs that run some of the levels.

use std::time::Duration;

use foveate_toolchain::{Cache, Toolchain};

/// The longest that a run may take.
pub(crate) const LIMIT: Duration = Duration::from_secs(3600);

/// The tools of the machine, and what they have built.
#[derive(Clone, Copy, Debug)]
pub struct Tools<'a> {
    /// Found and run by it; its flag stops the bench.
    pub toolchain: &'a Toolchain,
    /// Finished builds.
    pub cache: &'a Cache,
}
