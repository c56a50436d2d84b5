// SPDX-License-Identifier: MIT OR Apache-2.0
//! The syntheses of `foveate estimate`: of one design, for a report or for a row of the
//! comparison ([`SynthesisTools`]).

use crate::error::CliError;
use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{AreaReport, EstimateJob, estimate};
use foveate_tools::{Cache, Toolchain};

/// The tools that every synthesis needs.
pub(super) struct SynthesisTools {
    pub(super) toolchain: Toolchain,
    pub(super) cache: Cache,
}

impl SynthesisTools {
    pub(super) fn estimate(&self, design: &Design, leaves: bool) -> Result<AreaReport, CliError> {
        let job = EstimateJob::for_design(design, Top::Rcm);
        let job = if leaves { job.with_leaves(design) } else { job };
        Ok(estimate(&self.toolchain, &self.cache, &job)?)
    }
}
