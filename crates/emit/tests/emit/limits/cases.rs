// SPDX-License-Identifier: MIT OR Apache-2.0
//! Modules with parameters that differ from their defaults, from `limits.txt`.

use foveate_emit::{BOARD_LEAVES, LEAVES, Leaf};
use foveate_tools::Source;
use std::collections::BTreeSet;

/// A module with parameters that differ from their defaults.
pub(super) struct LimitCase {
    pub(super) module: String,
    /// The names and values of the parameters.
    pub(super) parameters: Vec<(String, String)>,
    /// The missing module at which elaboration stops; `None` if the parameters are in range.
    pub(super) refusing_limit: Option<String>,
}

/// Returns the cases of `limits.txt`. The parameters of a line that must elaborate also hold for
/// the lines below it.
pub(super) fn cases() -> Vec<LimitCase> {
    let mut list: Vec<LimitCase> = Vec::new();
    let mut common: Vec<(String, String)> = Vec::new();
    let lines = include_str!("../limits.txt").lines().map(str::trim);
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let mut parts = line.split('|').map(str::trim);
        let module = parts.next().unwrap().to_owned();
        let own = parts.next().unwrap_or_default().split_whitespace().map(|pair| {
            let (name, value) = pair.split_once('=').unwrap_or_else(|| panic!("{line}"));
            (name.to_owned(), value.to_owned())
        });
        let own: Vec<_> = own.collect();
        let refused = parts.next().map(str::to_owned);
        let mut parameters = own.clone();
        match refused {
            None => common.clone_from(&own),
            Some(_) => {
                let first = |name: &String| own.iter().all(|(given, _)| given != name);
                parameters.extend(common.iter().filter(|(name, _)| first(name)).cloned());
            }
        }
        list.push(LimitCase { module, parameters, refusing_limit: refused });
    }
    list
}

/// Returns the text of a module with another default of a parameter.
pub(super) fn with_default(text: &str, name: &str, value: &str) -> String {
    let start = format!(" {name} = ");
    let line = text.lines().find(|line| line.contains("parameter ") && line.contains(&start));
    let line = line.unwrap_or_else(|| panic!("no parameter {name}"));
    let (before, after) = line.split_once(&start).unwrap();
    let end = after.find([',', ' ']).unwrap_or(after.len());
    text.replacen(line, &format!("{before}{start}{value}{}", &after[end..]), 1)
}

/// Returns the leaves of cores and of boards.
pub(super) fn all_leaves() -> impl Iterator<Item = &'static Leaf> {
    LEAVES.iter().chain(BOARD_LEAVES)
}

fn leaf(name: &str) -> &'static Leaf {
    all_leaves().find(|leaf| leaf.name == name).unwrap_or_else(|| panic!("no leaf {name}"))
}

impl LimitCase {
    /// Returns the text of the module with the parameters of the case.
    fn text(&self) -> String {
        let text = leaf(&self.module).contents.to_owned();
        let parameters = self.parameters.iter();
        parameters.fold(text, |text, (name, value)| with_default(&text, name, value))
    }

    /// Returns the module and all modules that it instantiates.
    pub(super) fn sources(&self) -> Vec<Source> {
        let mut names: Vec<&str> = vec![leaf(&self.module).name];
        let mut at = 0;
        while let Some(name) = names.get(at) {
            let uses = leaf(name).uses.iter().filter(|used| !names.contains(used));
            let uses: Vec<&str> = uses.copied().collect();
            names.extend(uses);
            at += 1;
        }
        let text = |name: &str| {
            if name == self.module { self.text() } else { leaf(name).contents.to_owned() }
        };
        names.iter().map(|name| (format!("rtl/{name}.v"), text(name))).collect()
    }

    /// Returns the module under another name, which is also appended to its limits. When many such
    /// modules are elaborated together, each limit then refuses only its own module.
    pub(super) fn renamed_text(&self, name: &str) -> String {
        let text = self.text();
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let limits: BTreeSet<&str> =
            text.split(|c| !is_word(c)).filter(|word| word.contains("_must_")).collect();
        let limited = limits.iter().fold(text.clone(), |text, limit| {
            text.replace(&format!(" {limit} "), &format!(" {limit}_{name} "))
        });
        limited.replacen(&format!("\nmodule {} ", self.module), &format!("\nmodule {name} "), 1)
    }
}
