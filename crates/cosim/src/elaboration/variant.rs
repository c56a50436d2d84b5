// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules of an elaborated design with the values of their parameters ([`ModuleVariant`]).

use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// A module with the values of its parameters, in hexadecimal.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ModuleVariant {
    pub(crate) module: String,
    pub(crate) parameters: BTreeMap<String, String>,
}

impl ModuleVariant {
    /// Converts the variant to one that was not elaborated, with its differences to the nearest
    /// elaborated variant of the same module.
    pub(super) fn into_unelaborated(self, seen: &BTreeSet<Self>) -> UnelaboratedVariant {
        let of_module = seen.iter().filter(|other| other.module == self.module);
        let nearest = of_module.min_by_key(|other| self.differing(other).count());
        let shown = |(name, value): (&String, &String)| format!("{name} = {value}");
        let parameters = match nearest {
            Some(other) => self.differing(other).map(shown).collect(),
            None => self.parameters.iter().map(shown).collect(),
        };
        UnelaboratedVariant { is_module_known: nearest.is_some(), module: self.module, parameters }
    }

    fn differing<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = (&'a String, &'a String)> {
        self.parameters.iter().filter(|(name, value)| other.parameters.get(*name) != Some(*value))
    }
}

/// A module with parameter values that no run has elaborated.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnelaboratedVariant {
    /// The name of the module.
    pub module: String,
    /// True if a run has elaborated the module with other values.
    pub is_module_known: bool,
    /// The values, each as `NAME = value`. If a run has elaborated the module, only the values that
    /// differ from the nearest elaborated variant.
    pub parameters: Vec<String>,
}

impl fmt::Display for UnelaboratedVariant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.is_module_known, self.parameters.is_empty()) {
            (false, _) | (true, true) => write!(f, "module {}", self.module),
            (true, false) => write!(f, "{} with {}", self.module, self.parameters.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variant(module: &str, parameters: &[(&str, &str)]) -> ModuleVariant {
        let pair = |&(name, value): &(&str, &str)| (name.to_owned(), value.to_owned());
        ModuleVariant {
            module: module.to_owned(),
            parameters: parameters.iter().map(pair).collect(),
        }
    }

    #[test]
    fn what_differs_from_the_nearest_is_named() {
        let seen = BTreeSet::from([
            variant("store", &[("WORDS", "4"), ("BITS", "2"), ("DEEP", "0")]),
            variant("store", &[("WORDS", "9"), ("BITS", "4"), ("DEEP", "1")]),
        ]);
        let said = |variant: ModuleVariant| variant.into_unelaborated(&seen).to_string();
        let left = variant("store", &[("WORDS", "c"), ("BITS", "4"), ("DEEP", "1")]);
        assert_eq!(said(left), "store with WORDS = c");
        assert_eq!(said(variant("banks", &[("WORDS", "c")])), "module banks");
    }
}
