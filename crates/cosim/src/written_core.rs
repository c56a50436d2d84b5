// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core of a design as a folder: its Verilog with the files around it, its benches with their
//! vectors, and its timing diagram.

use crate::error::CosimError;
use crate::{ShippedBench, timing_diagram};
use foveate_design::Design;
use foveate_emit::{Prefix, Top};
use foveate_tools::{FolderKind, StagedFolder};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The kind of folder that is written, and the only kind that may be replaced.
pub const CORE: FolderKind = FolderKind {
    description: "a generated core (its foveate_rcm.core)",
    matches: |folder| folder.join("foveate_rcm.core").is_file(),
};

/// A core that has been written.
#[derive(Debug)]
pub struct WrittenCore {
    /// The paths of its files, relative to the folder.
    pub files: Vec<String>,
    /// The bench of each top module: of one RPU or lane, and of the array. A raster core has only
    /// the bench of the array.
    pub benches: Vec<ShippedBench>,
    /// The prefix of the module names.
    pub prefix: Prefix,
}

impl WrittenCore {
    /// Returns a warning for each bench that will not pass, with the reason.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.benches.iter().filter_map(|bench| {
            let shortcoming = bench.shortcoming.as_ref()?;
            let top = self.prefix.prefixed_name(bench.top.module());
            Some(format!(
                "tb/{top}_replay.v does not test all of `{top}`, so it never says PASS: {shortcoming}"
            ))
        })
    }
}

/// Writes the core of a design to a folder, which appears when it is complete. Module names begin
/// with `prefix`; `overwrite` replaces an earlier core.
///
/// # Errors
/// Fails if the folder cannot be written or holds something else, and if `cancel` is set.
pub fn write_core(
    design: &Design,
    prefix: &Prefix,
    folder: &Path,
    overwrite: bool,
    cancel: &AtomicBool,
) -> Result<WrittenCore, CosimError> {
    let staged = StagedFolder::new(folder, CORE, overwrite)?;
    let mut files = foveate_emit::core_files(design, prefix);
    let bench = |top| ShippedBench::new(design, top, prefix, cancel);
    let benches =
        Top::all_of(design).iter().map(|&top| bench(top)).collect::<Result<Vec<_>, _>>()?;
    files.extend(benches.iter().flat_map(|bench| bench.files.iter().cloned()));
    files.extend(timing_diagram(design, cancel)?);
    for file in &files {
        staged.write(&file.path, file.contents.as_bytes())?;
    }
    staged.commit()?;
    let files = files.into_iter().map(|file| file.path).collect();
    Ok(WrittenCore { files, benches, prefix: prefix.clone() })
}
