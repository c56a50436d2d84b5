// SPDX-License-Identifier: MIT OR Apache-2.0
//! The prefix of the names of a core's modules, with which several cores fit into one chip.
//!
//! Leaves and templates have the same names in every core. The prefix is put before the names once
//! all of the Verilog is generated, so no other code has to handle it.

use std::collections::BTreeSet;

use crate::{EmitError, LEAVES, SourceFile, Top};
use foveate_design::Design;

const MAX_CHARACTERS: usize = 32;
/// The word that requests the prefix made from the fingerprint.
const AUTO_WORD: &str = "auto";
const FINGERPRINT_DIGITS: usize = 8;
/// The keywords of Verilog and SystemVerilog that are likely to be tried as a prefix.
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

/// The prefix of the names of a core's modules; empty by default.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Prefix(String);

impl Prefix {
    /// Makes a prefix from a text that does not include the `_` after the prefix.
    ///
    /// # Errors
    /// Fails if no module name can begin with the text, or if a name with this prefix could be that
    /// of a module in a core without a prefix.
    pub fn new(text: &str) -> Result<Self, EmitError> {
        // The message shows only the characters needed to see that the text is too long, and no
        // control characters.
        let shown = || text.chars().take(MAX_CHARACTERS + 1).flat_map(char::escape_debug).collect();
        let wrong = |wrong: &str| {
            Err(EmitError::InvalidPrefix {
                prefix: shown(),
                wrong: wrong.to_owned(),
                most: MAX_CHARACTERS,
            })
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
        if text.len() > MAX_CHARACTERS {
            return wrong(&format!("has {} characters", text.len()));
        }
        if KEYWORDS.contains(&text.to_ascii_lowercase().as_str()) {
            return wrong("is a word of Verilog");
        }
        let prefix = Self(text.to_owned());
        let names = || LEAVES.iter().map(|leaf| leaf.name);
        match names()
            .map(|name| prefix.prefixed_name(name))
            .find(|made| names().any(|name| name == made))
        {
            Some(made) => wrong(&format!("makes the name `{made}`, which cores without it have")),
            None => Ok(prefix),
        }
    }

    /// Makes the prefix that a user requests: a text, `auto` for the prefix made from the
    /// fingerprint of the design, or no prefix without a text.
    ///
    /// # Errors
    /// Fails like [`Prefix::new`].
    pub fn from_request(text: Option<&str>, design: &Design) -> Result<Self, EmitError> {
        match text {
            None => Ok(Self::default()),
            Some(AUTO_WORD) => Ok(Self::from_fingerprint(design)),
            Some(text) => Self::new(text),
        }
    }

    /// Makes a prefix from the fingerprint of a design, so that different designs have different
    /// prefixes.
    #[must_use]
    pub fn from_fingerprint(design: &Design) -> Self {
        Self(format!("fv{}", &design.fingerprint()[..FINGERPRINT_DIGITS]))
    }

    /// Returns the text of the prefix; empty without a prefix.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Returns the name of a module or file of the core, with the prefix.
    #[must_use]
    pub fn prefixed_name(&self, plain: &str) -> String {
        if self.0.is_empty() { plain.to_owned() } else { format!("{}_{plain}", self.0) }
    }

    /// Returns the prefix of a module that is `top` in some core; `None` for other modules.
    #[must_use]
    pub fn of_top_module(module: &str, top: Top) -> Option<Self> {
        match module.strip_suffix(top.module())? {
            "" => Some(Self::default()),
            before => Self::new(before.strip_suffix('_')?).ok(),
        }
    }

    /// Renames the modules with the prefix: their files, their declarations and their instances.
    #[must_use]
    pub fn apply(&self, files: Vec<SourceFile>) -> Vec<SourceFile> {
        if self.0.is_empty() {
            return files;
        }
        let names: BTreeSet<String> =
            files.iter().filter_map(|file| Some(file_module(&file.path)?.to_owned())).collect();
        let renamed = |file: SourceFile| match file_module(&file.path) {
            None => file,
            Some(module) => SourceFile {
                path: module_path(&self.prefixed_name(module)),
                contents: self.rename(&file.contents, &names),
            },
        };
        files.into_iter().map(renamed).collect()
    }

    /// Renames these modules in a text. A name of a module stands at the beginning of a line, as
    /// `module name`, `name #(` or `name u_...`; all Verilog of this crate is written so.
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
                format!("{indent}{start}{}{after}", self.prefixed_name(name))
            } else {
                line.to_owned()
            }
        };
        text.split_inclusive('\n').map(renamed).collect()
    }
}

pub(crate) fn module_path(module: &str) -> String {
    format!("rtl/{module}.v")
}

/// Returns the module of a Verilog file; `None` for other files.
fn file_module(path: &str) -> Option<&str> {
    path.strip_prefix("rtl/")?.strip_suffix(".v")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prefix_begins_names_that_no_other_core_has() {
        for good in ["cam0", "a", "Left_eye", "fv00c0ffee", "x2_y3"] {
            assert_eq!(Prefix::new(good).unwrap().prefixed_name("rcm"), format!("{good}_rcm"));
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
            // Cores have the modules `serial_decision` and `carry_adder`, which these prefixes
            // would produce.
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
            path: module_path(name),
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
        let of =
            |module| Prefix::of_top_module(module, Top::Rcm).map(|prefix| prefix.text().to_owned());
        assert_eq!(of("rcm").as_deref(), Some(""));
        assert_eq!(of("left_eye_rcm").as_deref(), Some("left_eye"));
        for other in ["rpu", "xrcm", "_rcm", "cam0_rcm_replay", "1_rcm"] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}
