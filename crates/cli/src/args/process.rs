// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a process in whose cells designs are measured.

use super::DEFAULT_LIBERTY;
use clap::Args;
use std::path::PathBuf;

/// The cells and memories of a process.
#[derive(Args, Debug)]
#[command(next_help_heading = "Silicon")]
pub(crate) struct ProcessArgs {
    /// Measure designs in the cells of this liberty file, too, plain or gzipped: area, clock and
    /// energy. Without a file, the cells are those of Debian's package `qflow-tech-osu018`, of 0.18
    /// um; then give --liberty behind the inputs
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = DEFAULT_LIBERTY)]
    pub(crate) liberty: Option<PathBuf>,
    /// Liberty files of memory macros of the same voltage, for memories that are too large for
    /// flip-flops
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "liberty")]
    pub(crate) macros: Vec<PathBuf>,
    /// Largest memory in bits that becomes flip-flops
    #[arg(long, value_name = "BITS", default_value_t = 4096, requires = "liberty")]
    pub(crate) memory_limit: u64,
}
