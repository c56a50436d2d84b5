// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads the modules and the counts of their cells from the netlist that Yosys writes as JSON.
//!
//! The counts of `stat -json` would be smaller, but they differ between versions: 0.23 writes text
//! between the modules of a nested design, which is not JSON, and 0.70 adds submodules to some
//! figures. The format of the netlist itself has been stable for years.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;
use serde_json::Value;

use crate::area::Area;
use crate::error::EstimateError;

/// The name of a netlist in messages.
pub(crate) const NETLIST: &str = "netlist.json";

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct AreaNetlist(BTreeMap<String, AreaModule>);

/// A module: its primitive cells and submodules by type, and its name in the source.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct AreaModule {
    pub(crate) cells: BTreeMap<String, u64>,
    pub(crate) submodules: BTreeMap<String, u64>,
    pub(crate) source_name: String,
    pub(crate) parameters: Vec<String>,
}

/// The part of the netlist that is needed; other fields differ between versions.
#[derive(Deserialize)]
struct RawAreaNetlist {
    modules: BTreeMap<String, RawAreaModule>,
}

#[derive(Deserialize)]
struct RawAreaModule {
    cells: BTreeMap<String, RawAreaCell>,
    #[serde(default)]
    attributes: BTreeMap<String, Value>,
    #[serde(default)]
    parameter_default_values: BTreeMap<String, Value>,
}

#[derive(Deserialize)]
struct RawAreaCell {
    #[serde(rename = "type")]
    kind: String,
}

impl AreaNetlist {
    pub(crate) fn parse(file: &'static str, json: &[u8]) -> Result<Self, EstimateError> {
        Self::from_raw(file, serde_json::from_slice(json))
    }

    /// Reads the modules from JSON that is parsed already.
    pub(crate) fn from_value(file: &'static str, json: &Value) -> Result<Self, EstimateError> {
        Self::from_raw(file, RawAreaNetlist::deserialize(json))
    }

    fn from_raw(
        file: &'static str,
        raw: serde_json::Result<RawAreaNetlist>,
    ) -> Result<Self, EstimateError> {
        let raw = raw.map_err(|source| EstimateError::UnreadableFile { file, source })?;
        let module = |(name, module): (&String, &RawAreaModule)| {
            (name.clone(), AreaModule::new(name, module, &raw.modules))
        };
        Ok(Self(raw.modules.iter().map(module).collect()))
    }

    /// Returns the types of the cells of all modules.
    pub(crate) fn cell_types(&self) -> BTreeSet<&str> {
        self.0.values().flat_map(|module| module.cells.keys().map(String::as_str)).collect()
    }

    pub(crate) fn module(&self, name: &str) -> Result<&AreaModule, EstimateError> {
        self.0.get(name).ok_or_else(|| self.missing(name))
    }

    fn missing(&self, name: &str) -> EstimateError {
        EstimateError::MissingModule {
            module: name.to_owned(),
            present: self.0.keys().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
        }
    }

    /// Returns the area of a module's own cells, without submodules.
    pub(crate) fn own_area(&self, name: &str) -> Result<Area, EstimateError> {
        let module = self.module(name)?;
        Area::of_cells(&module.source_name, &module.cells)
    }

    /// Returns the area of a module and all modules inside it, except for the modules `without`.
    pub(crate) fn whole_area(&self, top: &str, without: &[&str]) -> Result<Area, EstimateError> {
        let counts = self.instances(top, without)?;
        let mut inside = counts.iter().filter(|(name, _)| !without.contains(&name.as_str()));
        inside.try_fold(self.own_area(top)?, |sum, (name, &count)| {
            Ok(sum.plus(self.own_area(name)?.multiplied(count)))
        })
    }

    /// Returns the area of the modules with this source name that `top` instantiates directly, with
    /// all modules inside them.
    pub(crate) fn area_in(&self, top: &str, source_name: &str) -> Result<Area, EstimateError> {
        let mut found = None;
        for (name, &count) in &self.module(top)?.submodules {
            if self.module(name)?.source_name == source_name {
                let area = self.whole_area(name, &[])?.multiplied(count);
                found = Some(found.unwrap_or_else(Area::default).plus(area));
            }
        }
        found.ok_or_else(|| self.missing(source_name))
    }

    /// Returns the number of instances of each module below `top`, at any depth; `leaves` are not
    /// entered.
    pub(crate) fn instances(
        &self,
        top: &str,
        leaves: &[&str],
    ) -> Result<BTreeMap<String, u64>, EstimateError> {
        let mut counts = BTreeMap::new();
        self.count_below(top, leaves, 1, &mut Vec::new(), &mut counts)?;
        Ok(counts)
    }

    fn count_below(
        &self,
        name: &str,
        leaves: &[&str],
        times: u64,
        ancestors: &mut Vec<String>,
        counts: &mut BTreeMap<String, u64>,
    ) -> Result<(), EstimateError> {
        if ancestors.iter().any(|module| module == name) {
            return Err(EstimateError::Recursive { module: name.to_owned() });
        }
        ancestors.push(name.to_owned());
        for (submodule, count) in &self.module(name)?.submodules {
            *counts.entry(submodule.clone()).or_default() += times * count;
            if !leaves.contains(&submodule.as_str()) {
                self.count_below(submodule, leaves, times * count, ancestors, counts)?;
            }
        }
        ancestors.pop();
        Ok(())
    }
}

impl AreaModule {
    /// Counts the cells of a module. A cell whose type is a module of the design is a submodule.
    fn new(name: &str, raw: &RawAreaModule, modules: &BTreeMap<String, RawAreaModule>) -> Self {
        let mut module = Self::default();
        for cell in raw.cells.values() {
            let is_module = modules.contains_key(&cell.kind);
            let counts = if is_module { &mut module.submodules } else { &mut module.cells };
            *counts.entry(cell.kind.clone()).or_default() += 1;
        }
        let hdlname = raw.attributes.get("hdlname").and_then(Value::as_str);
        let source_name = hdlname.unwrap_or(name);
        // Older versions keep the backslash that Yosys puts before public names.
        module.source_name = source_name.strip_prefix('\\').unwrap_or(source_name).to_owned();
        let parameters = raw.parameter_default_values.iter();
        module.parameters =
            parameters.map(|(name, value)| format!("{name}={}", parameter_text(value))).collect();
        module
    }
}

/// Returns a parameter as text. Yosys writes numbers as strings of binary digits, and text as text.
fn parameter_text(value: &Value) -> String {
    let Some(text) = value.as_str() else { return value.to_string() };
    u64::from_str_radix(text, 2).map_or_else(|_| text.trim_end().to_owned(), |n| n.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &[u8] = include_bytes!("../tests/fixtures/array_yosys_0.23.json");
    const NEW: &[u8] = include_bytes!("../tests/fixtures/array_yosys_0.70.json");

    #[test]
    fn netlists_of_old_and_new_yosys_are_read() {
        for json in [OLD, NEW] {
            let netlist = AreaNetlist::parse("netlist", json).unwrap();
            let rcm = netlist.module("rcm").unwrap();
            assert_eq!(rcm.submodules, BTreeMap::from([("rpu".to_owned(), 4)]));
            assert_eq!(rcm.cells, BTreeMap::from([("LUT4".to_owned(), 1)]));
            let rpu = netlist.whole_area("rpu", &[]).unwrap();
            assert_eq!((rpu.lut_logic_low, rpu.lut_logic_high), (10, 16));
            assert_eq!((rpu.lut_memory, rpu.ff, rpu.carry), (8, 7, 6));
        }
    }

    #[test]
    fn unreadable_json_and_missing_modules_are_errors() {
        let error = AreaNetlist::parse("netlist.json", br#"{"modules": {"a": {}}}"#).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("netlist.json") && text.contains("`cells`"), "{text}");
        let netlist = AreaNetlist::parse("netlist", OLD).unwrap();
        let error = netlist.module("lane").unwrap_err().to_string();
        assert!(
            error.contains("no module `lane`; it has only ") && error.contains("`rcm`, `rpu`"),
            "{error}"
        );
    }

    #[test]
    fn the_whole_area_includes_submodules() {
        let json = include_bytes!("../tests/fixtures/leaves_yosys_0.23.json");
        let netlist = AreaNetlist::parse("netlist", json).unwrap();
        let whole = netlist.whole_area("rpu", &[]).unwrap();
        assert_eq!((whole.lut_logic_high, whole.lut_memory, whole.carry), (40, 8, 12));
        let without = netlist.whole_area("rpu", &["pair"]).unwrap();
        assert_eq!((without.lut_logic_high, without.lut_memory, without.carry), (7, 8, 3));
    }

    #[test]
    fn modules_in_another_are_found_by_the_name_in_their_source() {
        let json = include_bytes!("../tests/fixtures/leaves_yosys_0.23.json");
        let netlist = AreaNetlist::parse("netlist", json).unwrap();
        let (pair, adders) = (netlist.area_in("rpu", "pair"), netlist.area_in("pair", "adder"));
        let beside = netlist.whole_area("rpu", &["pair"]).unwrap();
        assert_eq!(pair.unwrap().plus(beside), netlist.whole_area("rpu", &[]).unwrap());
        assert!(adders.unwrap().carry > 0, "a module with parameters has another name");
        // A module that is deeper in the hierarchy is not found.
        let error = netlist.area_in("rpu", "adder").unwrap_err();
        assert!(matches!(error, EstimateError::MissingModule { .. }), "{error}");
    }

    #[test]
    fn a_module_in_itself_is_an_error() {
        let json = br#"{"modules": {"a": {"cells": {"u": {"type": "a"}}}}}"#;
        let error = AreaNetlist::parse("netlist", json).unwrap().instances("a", &[]).unwrap_err();
        assert!(matches!(error, EstimateError::Recursive { .. }));
    }

    #[test]
    fn parameters_are_numbers_or_text() {
        for (value, text) in [("00001000", "8"), ("distributed ", "distributed"), ("x1", "x1")] {
            assert_eq!(parameter_text(&value.into()), text);
        }
    }
}
