// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tools and the library of tests of silicon, and the figures of their reports.

use std::path::Path;

use foveate_toolchain::Tool;
use foveate_toolchain::testing::require_tools;
use serde_json::Value;

/// The library of Debian's package `qflow-tech-osu018`.
pub(crate) const LIBRARY: &str = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

/// Returns true if the tools are there; where tools are required, the library must be there, too.
pub(crate) fn is_ready() -> bool {
    require_tools(&[Tool::Yosys, Tool::OpenSta])
        && (Path::new(LIBRARY).exists()
            || std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_none_or(|_| panic!("no {LIBRARY}")))
        && Path::new(LIBRARY).exists()
}

/// Returns the number at a place of a report.
pub(crate) fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer}: {value}"))
}
