// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules of a folder of Verilog that a simulation reaches.
//!
//! They are read from the text. A module reaches the modules that it instantiates in any branch of
//! a `generate`, even if the design does not take that branch. So a leaf that a generated core
//! contains but does not need counts as reached; a file that nothing instantiates does not.

use foveate_emit::{Prefix, SourceFile, Top};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;

/// The modules of one file that no simulation has reached.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnsimulatedModules {
    /// The path of the file.
    pub file: String,
    /// The modules that were not reached, in their order in the file; never empty.
    pub modules: Vec<String>,
}

impl fmt::Display for UnsimulatedModules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.modules.len() == 1 { "module" } else { "modules" };
        write!(f, "{} ({what} {})", self.file, self.modules.join(", "))
    }
}

/// A module, reduced to what the hierarchy needs.
#[derive(Debug, PartialEq, Eq)]
struct VerilogModule {
    name: String,
    /// The names at places at which an instance names its module. Some of them are not modules.
    instantiated_names: BTreeSet<String>,
}

pub(crate) fn declares(sources: &[SourceFile], module: &str) -> bool {
    sources
        .iter()
        .flat_map(|file| declared_modules(&file.contents))
        .any(|found| found.name == module)
}

/// Returns the prefixes of the cores among the files: those of the modules `rpu` and `rcm` with a
/// prefix. If one core has no prefix, only that core is returned, because other modules whose names
/// end in `_rpu` or `_rcm` may belong to the user.
#[must_use]
pub fn core_prefixes(sources: &[SourceFile]) -> BTreeSet<Prefix> {
    let modules = sources.iter().flat_map(|file| declared_modules(&file.contents));
    let found: BTreeSet<Prefix> = modules
        .flat_map(|module| [Top::Rpu, Top::Rcm].map(|top| Prefix::of_top_module(&module.name, top)))
        .flatten()
        .collect();
    if found.contains(&Prefix::default()) { BTreeSet::from([Prefix::default()]) } else { found }
}

/// Returns the modules, by file, that are neither among `tops` nor below them.
#[must_use]
pub fn unsimulated_modules(sources: &[SourceFile], tops: &[&str]) -> Vec<UnsimulatedModules> {
    let files: Vec<(&str, Vec<VerilogModule>)> =
        sources.iter().map(|file| (file.path.as_str(), declared_modules(&file.contents))).collect();
    let (mut reached, mut open) = (BTreeSet::new(), tops.to_vec());
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            let of_name = files.iter().flat_map(|(_, modules)| modules).filter(|m| m.name == name);
            open.extend(of_name.flat_map(|module| &module.instantiated_names).map(String::as_str));
        }
    }
    let unreached = |(file, modules): &(&str, Vec<VerilogModule>)| {
        let left = modules.iter().filter(|module| !reached.contains(module.name.as_str()));
        let modules: Vec<String> = left.map(|module| module.name.clone()).collect();
        (!modules.is_empty()).then(|| UnsimulatedModules { file: (*file).to_owned(), modules })
    };
    files.iter().filter_map(unreached).collect()
}

fn declared_modules(text: &str) -> Vec<VerilogModule> {
    let tokens = tokens(text);
    let (mut modules, mut under_way) = (Vec::new(), None);
    for (at, token) in tokens.iter().enumerate() {
        match (token.as_str(), under_way.as_mut()) {
            ("module" | "macromodule", None) => {
                let name = tokens.get(at + 1).cloned().unwrap_or_default();
                under_way = Some(VerilogModule { name, instantiated_names: BTreeSet::new() });
            }
            ("endmodule", Some(_)) => modules.extend(under_way.take()),
            (name, Some(module)) if is_instance(&tokens[at..]) => {
                module.instantiated_names.insert(name.to_owned());
            }
            _ => {}
        }
    }
    modules
}

fn is_instance(tokens: &[String]) -> bool {
    let token = |index: usize| tokens.get(index).map_or("", String::as_str);
    let is_name = |text: &str| text.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let named = is_name(token(1)) && matches!(token(2), "(" | "[");
    is_name(token(0)) && (named || (token(1) == "#" && token(2) == "("))
}

/// Splits a text into words and single characters, without comments, strings and attributes.
fn tokens(text: &str) -> Vec<String> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    let (mut tokens, mut rest) = (Vec::new(), text);
    let after = |rest: &'_ str, end: &str| rest.find(end).map_or(rest.len(), |at| at + end.len());
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            after(rest, "\n")
        } else if let Some(comment) = rest.strip_prefix("/*") {
            2 + after(comment, "*/")
        } else if let Some(attribute) = attribute_text(rest) {
            2 + after(attribute, "*)")
        } else if first == '"' {
            string_length(rest)
        } else if first == '\\' {
            // An escaped name ends at a blank; the token is the name without the backslash.
            let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
            tokens.push(rest[1..length].to_owned());
            length
        } else if is_word(first) {
            let length = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            tokens.push(rest[..length].to_owned());
            length
        } else {
            if !first.is_whitespace() {
                tokens.push(first.to_string());
            }
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    tokens
}

/// Returns the text after the beginning of an attribute; `(*)` in a sensitivity list is not an
/// attribute.
fn attribute_text(text: &str) -> Option<&str> {
    text.strip_prefix("(*").filter(|rest| !rest.trim_start().starts_with(')'))
}

/// Returns the number of bytes of the string that begins here, with its quotation marks.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    for (at, sign) in text.char_indices().skip(1) {
        match sign {
            '"' if !escaped => return at + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str, contents: &str) -> SourceFile {
        SourceFile { path: path.to_owned(), contents: contents.to_owned() }
    }

    #[test]
    fn instances_are_found_in_every_form() {
        let text = r#"
            `timescale 1ns / 1ps
            (* keep = "module ghost (" *) module top #(parameter N = 2) (input wire a);
                // commented c0 ();
                /* commented c1 (); */
                initial $display("quoted \" c2 ();");
                always @(*) x = f(a);
                plain u_plain (.a(a));
                with_parameters #(.N(N)) u_with (.a(a));
                array u_array [3:0] (.a(a));
                (* keep *) attributed u_attributed (.a(a));
                \escaped u_escaped (.a(a));
                generate if (N > 1) begin : g_more
                    branch u_branch (.a(a));
                end endgenerate
            endmodule
            module second; endmodule"#;
        let found = declared_modules(text);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].name.as_str(), found[1].name.as_str()), ("top", "second"));
        for name in ["plain", "with_parameters", "array", "attributed", "escaped", "branch"] {
            assert!(found[0].instantiated_names.contains(name), "{name}: {found:?}");
        }
        for name in ["c0", "c1", "c2", "ghost"] {
            assert!(!found[0].instantiated_names.contains(name), "{name}: {found:?}");
        }
    }

    #[test]
    fn what_no_top_reaches_is_named_with_its_file() {
        let sources = [
            file("a.v", "module a; b u_b (); endmodule module spare; c u_c (); endmodule"),
            file("b.v", "module b; endmodule"),
            file("c.v", "module c; wire b; endmodule"),
            file("defines.v", "`define WIDTH 8\n"),
        ];
        let named: Vec<String> =
            unsimulated_modules(&sources, &["a"]).iter().map(ToString::to_string).collect();
        assert_eq!(named, ["a.v (module spare)", "c.v (module c)"]);
        assert_eq!(unsimulated_modules(&sources, &["a", "spare"]), []);
    }

    #[test]
    fn cores_are_found_by_their_tops() {
        let of = |modules: &[&str]| {
            let sources: Vec<SourceFile> = modules
                .iter()
                .map(|name| file("a.v", &format!("module {name}; endmodule")))
                .collect();
            let found = core_prefixes(&sources);
            found.iter().map(|prefix| prefix.text().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(of(&["rpu", "rcm", "my_rcm"]), [""]);
        assert_eq!(of(&["cam0_rpu", "cam0_rcm", "cam0_vote"]), ["cam0"]);
        assert_eq!(of(&["b_rcm", "a_rpu"]), ["a", "b"]);
        assert!(of(&["vote", "rcm_replay"]).is_empty());
    }

    #[test]
    fn every_generated_file_is_reached_from_the_tops() {
        use foveate_design::PRESETS;
        use foveate_emit::{Top, verilog};
        for preset in PRESETS {
            let design = preset.config().and_then(|config| config.validate()).unwrap();
            let mut sources = verilog(&design, Top::Rcm);
            let known = |sources: &[SourceFile], path: &str| sources.iter().any(|f| f.path == path);
            for file in verilog(&design, Top::Rpu) {
                if !known(&sources, &file.path) {
                    sources.push(file);
                }
            }
            assert_eq!(unsimulated_modules(&sources, &["rpu", "rcm"]), [], "{}", preset.name);
        }
    }
}
