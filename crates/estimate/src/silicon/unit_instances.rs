// SPDX-License-Identifier: MIT OR Apache-2.0
//! Netlists with one unit of an array or with none, for OpenSTA.
//!
//! A whole array may have millions of cells, and the registers that drive all of its units would
//! have loads that a layout divides by buffers.

/// The name of a unit that is timed by itself. That of Yosys is no plain name.
pub(super) const LONE_UNIT: &str = "foveate_unit";

/// Returns the netlist with only the first instance of the module `kept`, and without all instances
/// of the other `units`. With `None` no instance stays.
pub(super) fn with_units(netlist: &str, units: &[String], kept: Option<&str>) -> String {
    let starts: Vec<(String, &str)> =
        units.iter().map(|unit| (format!("  {} ", verilog_name(unit)), unit.as_str())).collect();
    let (mut text, mut has_kept, mut is_left_out) = (String::new(), false, false);
    for line in netlist.lines() {
        let unit = starts.iter().find(|(start, _)| line.starts_with(start.as_str()));
        if let Some((_, unit)) = unit {
            is_left_out = has_kept || kept != Some(*unit);
            has_kept |= !is_left_out;
        }
        if !is_left_out {
            text.push_str(line);
            text.push('\n');
        }
        is_left_out &= !line.trim_end().ends_with(");");
    }
    text
}

/// Returns the netlist with the module `unit` under the name [`LONE_UNIT`].
pub(super) fn with_lone_unit(netlist: &str, unit: &str) -> String {
    netlist.replace(&format!("module {}", verilog_name(unit)), &format!("module {LONE_UNIT}"))
}

/// Returns a name as Verilog has it: with a backslash and a space, if it is no plain name.
fn verilog_name(name: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    if name.chars().all(is_plain) { name.to_owned() } else { format!("\\{name} ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NETLIST: &str = "module rcm(a);\n  DFF cell_1 (\n    .D(a)\n  );\n  \\$paramod$1\\lane  \\u[0] (\n    .a(a)\n  );\n  \
                           \\$paramod$1\\lane  \\u[1] (\n    .a(a)\n  );\n  \\$paramod$2\\lane  \\u[2] (\n    .a(a)\n  );\nendmodule\n\
                           module \\$paramod$1\\lane (a);\nendmodule\n";

    #[test]
    fn one_unit_stays_or_none() {
        let units = ["$paramod$1\\lane", "$paramod$2\\lane"].map(str::to_owned);
        let one = with_units(NETLIST, &units, Some("$paramod$1\\lane"));
        assert!(one.contains("u[0]") && !one.contains("u[1]") && !one.contains("u[2]"), "{one}");
        let other = with_units(NETLIST, &units, Some("$paramod$2\\lane"));
        assert!(!other.contains("u[0]") && other.contains("u[2]"), "{other}");
        let none = with_units(NETLIST, &units, None);
        assert!(
            !none.contains("u[") && none.contains("cell_1 (\n    .D(a)\n  );\nendmodule"),
            "{none}"
        );
        assert!(with_lone_unit(NETLIST, &units[0]).contains("module foveate_unit(a);"));
    }
}
