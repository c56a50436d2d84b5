// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the names of a core's modules begin with, so that several cores fit into one chip.
//!
//! Leaves and templates have the same names in every core. A prefix is put before them when all of the Verilog is
//! there, so nothing else has to know of it.

use std::collections::BTreeSet;

use crate::{EmitError, LEAVES, SourceFile, Top};
use foveate_design::Design;

/// Most characters of a prefix.
const MOST: usize = 32;
/// The word that asks for the prefix that is made from the fingerprint.
const AUTO: &str = "auto";
/// Digits of the fingerprint in the prefix that is made from it.
const DIGITS: usize = 8;
/// Words of Verilog and SystemVerilog that somebody could take for a prefix.
const KEYWORDS: &[&str] = &[
    "always",
    "and",
    "assign",
    "begin",
    "bit",
    "buf",
    "byte",
    "case",
    "cell",
    "class",
    "config",
    "default",
    "design",
    "do",
    "edge",
    "else",
    "end",
    "enum",
    "event",
    "final",
    "for",
    "force",
    "fork",
    "function",
    "generate",
    "if",
    "import",
    "initial",
    "inout",
    "input",
    "instance",
    "int",
    "integer",
    "interface",
    "join",
    "library",
    "local",
    "logic",
    "macromodule",
    "module",
    "nand",
    "negedge",
    "new",
    "nor",
    "not",
    "null",
    "or",
    "output",
    "package",
    "parameter",
    "posedge",
    "primitive",
    "program",
    "pure",
    "rand",
    "real",
    "ref",
    "reg",
    "release",
    "repeat",
    "return",
    "signed",
    "static",
    "string",
    "struct",
    "super",
    "supply0",
    "supply1",
    "table",
    "task",
    "this",
    "time",
    "tri",
    "type",
    "union",
    "unsigned",
    "use",
    "var",
    "vectored",
    "virtual",
    "void",
    "wait",
    "wand",
    "while",
    "wire",
    "with",
    "wor",
    "xnor",
    "xor",
];

/// What the names of a core's modules begin with; nothing by default.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Prefix(String);

impl Prefix {
    /// The prefix of that text, without the `_` behind it.
    ///
    /// # Errors
    /// When a name cannot begin with it, or could not be told from another core's.
    pub fn new(text: &str) -> Result<Self, EmitError> {
        // As much of it as tells that it is too long, without control characters.
        let shown = || text.chars().take(MOST + 1).flat_map(char::escape_debug).collect();
        let wrong = |wrong: &str| {
            Err(EmitError::Prefix { prefix: shown(), wrong: wrong.to_owned(), most: MOST })
        };
        if !text.starts_with(|first: char| first.is_ascii_alphabetic()) {
            return wrong("does not begin with a letter");
        }
        if let Some(other) = text.chars().find(|c| !c.is_ascii_alphanumeric() && *c != '_') {
            return wrong(&format!("has a `{}`", other.escape_default()));
        }
        if text.ends_with('_') || text.contains("__") {
            return wrong("has a `_` at its end, or two side by side");
        }
        if text.len() > MOST {
            return wrong(&format!("has {} characters", text.len()));
        }
        if KEYWORDS.contains(&text.to_ascii_lowercase().as_str()) {
            return wrong("is a word of Verilog");
        }
        let prefix = Self(text.to_owned());
        let names = || LEAVES.iter().map(|leaf| leaf.name);
        match names().map(|name| prefix.name(name)).find(|made| names().any(|name| name == made)) {
            Some(made) => wrong(&format!("makes the name `{made}`, which cores without it have")),
            None => Ok(prefix),
        }
    }

    /// The prefix that somebody asks for: a text, or `auto` for that of the design; without either none.
    ///
    /// # Errors
    /// As [`Prefix::new`].
    pub fn asked(text: Option<&str>, design: &Design) -> Result<Self, EmitError> {
        match text {
            None => Ok(Self::default()),
            Some(AUTO) => Ok(Self::of(design)),
            Some(text) => Self::new(text),
        }
    }

    /// A prefix made from the fingerprint of a design, so that other designs have others.
    #[must_use]
    pub fn of(design: &Design) -> Self {
        Self(format!("fv{}", &design.fingerprint()[..DIGITS]))
    }

    /// Its text; empty where there is none.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.0
    }

    /// The name of a module or file of the core.
    #[must_use]
    pub fn name(&self, plain: &str) -> String {
        if self.0.is_empty() { plain.to_owned() } else { format!("{}_{plain}", self.0) }
    }

    /// The prefix of a module that is `top` in some core; nothing for other modules.
    #[must_use]
    pub fn of_top(module: &str, top: Top) -> Option<Self> {
        match module.strip_suffix(top.module())? {
            "" => Some(Self::default()),
            before => Self::new(before.strip_suffix('_')?).ok(),
        }
    }

    /// These modules under their names in the core: each in its file, where it is declared, and where one
    /// instantiates it.
    #[must_use]
    pub fn apply(&self, files: Vec<SourceFile>) -> Vec<SourceFile> {
        if self.0.is_empty() {
            return files;
        }
        let names: BTreeSet<String> =
            files.iter().filter_map(|file| Some(module_of(&file.path)?.to_owned())).collect();
        let renamed = |file: SourceFile| match module_of(&file.path) {
            None => file,
            Some(module) => SourceFile {
                path: path_of(&self.name(module)),
                contents: self.rename(&file.contents, &names),
            },
        };
        files.into_iter().map(renamed).collect()
    }

    /// The text with these modules renamed. A module is named at the beginning of a line: by `module name`, or by
    /// `name #(` or `name u_...`, as all of ours are written.
    fn rename(&self, text: &str, names: &BTreeSet<String>) -> String {
        let renamed = |line: &str| {
            let code = line.trim_start();
            let indent = &line[..line.len() - code.len()];
            let (start, rest) = match code.strip_prefix("module ") {
                Some(rest) => ("module ", rest),
                None => ("", code),
            };
            let end = rest.find([' ', ';']).unwrap_or(rest.len());
            let (name, after) = rest.split_at(end);
            let is_instance = [" #(", " u_"].iter().any(|word| after.starts_with(word));
            if names.contains(name) && (is_instance || !start.is_empty()) {
                format!("{indent}{start}{}{after}", self.name(name))
            } else {
                line.to_owned()
            }
        };
        text.split_inclusive('\n').map(renamed).collect()
    }
}

/// The file of a module.
pub(crate) fn path_of(module: &str) -> String {
    format!("rtl/{module}.v")
}

/// The module of a file of Verilog.
fn module_of(path: &str) -> Option<&str> {
    path.strip_prefix("rtl/")?.strip_suffix(".v")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prefix_begins_names_that_no_other_core_has() {
        for good in ["cam0", "a", "Left_eye", "fv00c0ffee", "x2_y3"] {
            assert_eq!(Prefix::new(good).unwrap().name("rcm"), format!("{good}_rcm"));
        }
        for (bad, why) in [
            ("", "does not begin with a letter"),
            ("0cam", "does not begin with a letter"),
            ("_cam", "does not begin with a letter"),
            ("cäm", "has a `\\u{e4}`"),
            ("cam-0", "has a `-`"),
            ("cam 0", "has a ` `"),
            ("cam_", "at its end"),
            ("cam__0", "two side by side"),
            ("module", "a word of Verilog"),
            ("Wire", "a word of Verilog"),
            // The decision of a serial core, and the adder of its lanes.
            ("serial", "`serial_decision`"),
            ("carry", "`carry_adder`"),
            (&"x".repeat(33), "has 33 characters"),
        ] {
            let error = Prefix::new(bad).unwrap_err().to_string();
            assert!(error.contains(why) && error.contains("such as `cam0`"), "{bad}: {error}");
        }
    }

    #[test]
    fn names_are_changed_where_they_name_modules_and_nowhere_else() {
        let file = |name: &str, contents: &str| SourceFile {
            path: path_of(name),
            contents: contents.to_owned(),
        };
        let vote = "// A vote.\nmodule vote #(\n    parameter A = 1\n) (\n    input wire vote\n);\nendmodule\n";
        let top = "(* keep *)\nmodule rcm;\n    vote #(.A(2)) u_vote (.vote(vote));\n    vote u_plain (.vote());\n    \
                   assign vote = 1;\nendmodule\n";
        let files = vec![file("vote", vote), file("rcm", top)];
        assert_eq!(Prefix::default().apply(files.clone()), files);
        let files = Prefix::new("cam0").unwrap().apply(files);
        assert_eq!(files[0].path, "rtl/cam0_vote.v");
        assert_eq!(files[0].contents, vote.replace("module vote", "module cam0_vote"));
        let expected = top
            .replace("    vote #", "    cam0_vote #")
            .replace("vote u_plain", "cam0_vote u_plain")
            .replace("module rcm", "module cam0_rcm");
        assert_eq!(files[1].contents, expected);
    }

    #[test]
    fn the_prefix_of_a_top_is_what_stands_before_it() {
        let of = |module| Prefix::of_top(module, Top::Rcm).map(|prefix| prefix.text().to_owned());
        assert_eq!(of("rcm").as_deref(), Some(""));
        assert_eq!(of("left_eye_rcm").as_deref(), Some("left_eye"));
        for other in ["rpu", "xrcm", "_rcm", "cam0_rcm_replay", "1_rcm"] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}
