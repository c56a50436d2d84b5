// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads Verilator's makefiles to learn which files it wrote, and which parts of its run time and
//! which libraries they need. This differs between versions, so it is read and not assumed.

use std::path::{Path, PathBuf};

use crate::error::ToolError;

/// The lists that Verilator writes for its own makefile.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct MakefileLists {
    /// The generated files that run often, without `.cpp`.
    pub(super) fast: Vec<String>,
    /// The generated files that run once, without `.cpp`.
    pub(super) slow: Vec<String>,
    /// The parts of the run time.
    pub(super) run_time: Vec<String>,
    /// The flags for the linker.
    pub(super) libraries: Vec<String>,
    /// The folder of Verilator's headers and run time.
    pub(super) include: PathBuf,
}

impl MakefileLists {
    pub(super) fn read(dir: &Path, prefix: &str) -> Result<Self, ToolError> {
        let read = |name: String| {
            let path = dir.join(name);
            std::fs::read_to_string(&path).map_err(ToolError::io("read", &path))
        };
        Ok(Self::parse(&read(format!("{prefix}_classes.mk"))?, &read(format!("{prefix}.mk"))?))
    }

    fn parse(classes: &str, main: &str) -> Self {
        let both = |a, b| [assigned_words(classes, a), assigned_words(classes, b)].concat();
        Self {
            fast: both("VM_CLASSES_FAST", "VM_SUPPORT_FAST"),
            slow: both("VM_CLASSES_SLOW", "VM_SUPPORT_SLOW"),
            run_time: both("VM_GLOBAL_FAST", "VM_GLOBAL_SLOW"),
            libraries: assigned_words(main, "VM_USER_LDLIBS"),
            include: Path::new(assigned_text(main, "VERILATOR_ROOT")).join("include"),
        }
    }
}

/// Returns the words assigned to a variable, over continued lines.
fn assigned_words(makefile: &str, variable: &str) -> Vec<String> {
    let joined = makefile.replace("\\\n", " ");
    let assigned = joined.lines().filter_map(|line| assignment(line, variable));
    assigned.flat_map(str::split_whitespace).map(str::to_owned).collect()
}

/// Returns everything that one line assigns to a variable, such as a path with spaces.
fn assigned_text<'a>(makefile: &'a str, variable: &str) -> &'a str {
    makefile.lines().find_map(|line| assignment(line, variable)).unwrap_or_default().trim()
}

/// Returns the text that a line assigns to a variable; `None` if it assigns nothing to it.
fn assignment<'a>(line: &'a str, variable: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(variable)?.trim_start();
    ["+=", "?=", "="].into_iter().find_map(|sign| rest.strip_prefix(sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_read_over_lines() {
        let classes = "VM_TRACE = 1\nVM_CLASSES_FAST += \\\n\tVtop \\\n\tVtop__0 \\\n\n\
                       VM_CLASSES_SLOW += \\\n\tVtop__Slow \\\n\n\
                       VM_SUPPORT_FAST += \\\n\tVtop__Trace \\\n\n\
                       VM_GLOBAL_FAST += \\\n\tverilated \\\n\tverilated_threads \\\n\n\
                       VM_GLOBAL_SLOW += \\\n\n";
        let main = "VERILATOR_ROOT = /my tools/verilator\nVM_USER_LDLIBS = \\\n\t-lz \\\n\n";
        let makefile = MakefileLists::parse(classes, main);
        assert_eq!(makefile.fast, ["Vtop", "Vtop__0", "Vtop__Trace"]);
        assert_eq!(makefile.slow, ["Vtop__Slow"]);
        assert_eq!(makefile.run_time, ["verilated", "verilated_threads"]);
        assert_eq!(makefile.libraries, ["-lz"]);
        assert_eq!(makefile.include, Path::new("/my tools/verilator/include"));
        let newer = MakefileLists::parse("", "VERILATOR_ROOT ?= /verilator\n");
        assert_eq!(newer.include, Path::new("/verilator/include"));
    }
}
