// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of writing an output.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// An output cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum StagingError {
    /// The path names no folder that can be created.
    #[error("output `{}` does not name a folder that can be created; choose another", path.display())]
    InvalidPath { path: PathBuf },
    /// The folder exists and is not empty.
    #[error("output folder `{}` is not empty; choose another folder, or replace it with --force", path.display())]
    NotEmpty { path: PathBuf },
    /// The folder does not hold the kind of output that would replace it.
    #[error(
        "output folder `{}` does not hold {what}, so it is not replaced; choose another folder, or empty it",
        path.display()
    )]
    OtherContent { path: PathBuf, what: &'static str },
    /// The folder is of the right kind, but has no list of the files that may be removed.
    #[error(
        "output folder `{}` has no list of the files that Foveate wrote (.foveate), so it is not replaced; \
         choose another folder, or move what is in it",
        path.display()
    )]
    NoList { path: PathBuf },
    /// The folder is of the right kind, but holds other files, too.
    #[error(
        "output folder `{}` is not replaced, because it holds files that Foveate did not write, or that were changed \
         since: {names}; move them, or choose another folder",
        path.display()
    )]
    UnlistedFiles { path: PathBuf, names: String },
    /// Files were added to a folder while it was replaced.
    #[error(
        "output folder `{}` is replaced, but files came into the earlier one meanwhile; they are kept in `{}`",
        path.display(),
        kept.display()
    )]
    FilesKept { path: PathBuf, kept: PathBuf },
    /// A file or folder cannot be written.
    #[error("cannot write `{}`: {source}; check free space and permissions, or choose another folder", path.display())]
    Unwritable { path: PathBuf, source: io::Error },
}

impl StagingError {
    /// Returns whether the disk was full.
    #[must_use]
    pub fn is_full(&self) -> bool {
        matches!(self, Self::Unwritable { source, .. } if is_full(source))
    }

    /// Returns a function that adds the path to an error of the operating system.
    pub(crate) fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Unwritable { path: path.to_owned(), source }
    }
}

/// Returns whether an error of the operating system says that the disk is full.
#[must_use]
pub fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded)
}
