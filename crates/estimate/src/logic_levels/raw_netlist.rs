// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ports, cells, connections and names in the JSON format of Yosys.

use std::collections::BTreeMap;

use serde::Deserialize;

#[derive(Deserialize)]
pub(super) struct PathNetlist {
    pub(super) modules: BTreeMap<String, PathModule>,
}

#[derive(Deserialize)]
pub(super) struct PathModule {
    #[serde(default)]
    pub(super) ports: BTreeMap<String, PathPort>,
    pub(super) cells: BTreeMap<String, PathCell>,
    #[serde(default)]
    netnames: BTreeMap<String, PathNetName>,
}

#[derive(Deserialize)]
pub(super) struct PathPort {
    direction: String,
    pub(super) bits: Vec<PathBit>,
}

#[derive(Deserialize)]
pub(super) struct PathCell {
    #[serde(rename = "type")]
    pub(super) kind: String,
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, serde_json::Value>,
    #[serde(default)]
    pub(super) connections: BTreeMap<String, Vec<PathBit>>,
}

#[derive(Deserialize)]
struct PathNetName {
    hide_name: u8,
    bits: Vec<PathBit>,
}

/// A net of a module by its number, or a constant.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum PathBit {
    Net(u32),
    #[allow(dead_code, reason = "it is read to be skipped")]
    Constant(String),
}

impl PathBit {
    pub(super) fn net(&self) -> Option<u32> {
        match self {
            Self::Net(net) => Some(*net),
            Self::Constant(_) => None,
        }
    }
}

impl PathPort {
    pub(super) fn is_output(&self) -> bool {
        self.direction == "output"
    }
}

impl PathCell {
    /// Returns a parameter that is a number; Yosys writes it as binary digits.
    pub(super) fn number(&self, name: &str) -> Option<u64> {
        let value = self.parameters.get(name)?;
        value.as_u64().or_else(|| u64::from_str_radix(value.as_str()?, 2).ok())
    }

    /// Returns a parameter that is text.
    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.parameters.get(name)?.as_str().map(str::trim_end)
    }
}

impl PathModule {
    /// Returns the name of a net: a name from the source if it has one, else a name that Yosys
    /// made.
    pub(super) fn net_name(&self, net: u32) -> String {
        let place = |bits: &[PathBit]| bits.iter().position(|bit| bit.net() == Some(net));
        let named = self.netnames.iter().filter_map(|(name, net)| {
            Some((net.hide_name, name.len(), name, place(&net.bits)?, net.bits.len()))
        });
        match named.min() {
            None => format!("net {net}"),
            Some((_, _, name, _, 1)) => name.clone(),
            Some((_, _, name, index, _)) => format!("{name}[{index}]"),
        }
    }
}
