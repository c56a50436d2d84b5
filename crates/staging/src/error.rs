// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why an output cannot be written.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// An output that cannot be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StagingError {
    /// A path that names no folder that can be made.
    #[error("output `{}` does not name a folder that can be created; choose another", path.display())]
    NoName {
        /// The path as given.
        path: PathBuf,
    },
    /// The folder is there and holds something.
    #[error("output folder `{}` is not empty; choose another folder, or replace it with --force", path.display())]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds something else than what would replace it.
    #[error(
        "output folder `{}` does not hold {what}, so it is not replaced; choose another folder, or empty it",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// What it should hold.
        what: &'static str,
    },
    /// The folder is of the right kind, but nothing says which of its files may go.
    #[error(
        "output folder `{}` has no list of the files that Foveate wrote (.foveate), so it is not replaced; \
         choose another folder, or move what is in it",
        path.display()
    )]
    NoList {
        /// The folder.
        path: PathBuf,
    },
    /// The folder is of the right kind, and holds other files too.
    #[error(
        "output folder `{}` is not replaced, because it holds files that Foveate did not write, or that were changed \
         since: {names}; move them, or choose another folder",
        path.display()
    )]
    Mixed {
        /// The folder.
        path: PathBuf,
        /// The first of them, and how many there are more.
        names: String,
    },
    /// Files came into a folder while it was replaced.
    #[error(
        "output folder `{}` is replaced, but files came into the earlier one meanwhile; they are kept in `{}`",
        path.display(),
        kept.display()
    )]
    Kept {
        /// The folder.
        path: PathBuf,
        /// Where those files are.
        kept: PathBuf,
    },
    /// Something cannot be written.
    #[error("cannot write `{}`: {source}; check free space and permissions, or choose another folder", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl StagingError {
    /// Whether there was no room.
    #[must_use]
    pub fn is_full(&self) -> bool {
        matches!(self, Self::Write { source, .. } if is_full(source))
    }

    /// Names the path in an error of the operating system.
    pub(crate) fn write(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Write { path: path.to_owned(), source }
    }
}

/// Whether an error of the operating system says that there is no room.
#[must_use]
pub fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded)
}
