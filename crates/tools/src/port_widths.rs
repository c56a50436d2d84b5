// SPDX-License-Identifier: MIT OR Apache-2.0
//! The actual widths of the ports of a module, with parameters evaluated, as the tools report them.
//! Both simulators drop or pad bits where widths differ, so the widths must be checked.

use crate::error::ToolError;

/// The name of a port and its width in bits.
pub type PortBits = (String, u32);

/// Compares the required ports with those that Verilator declares in the C++ header of a model.
pub(crate) fn check_header(top: &str, header: &str, wanted: &[PortBits]) -> Result<(), ToolError> {
    let declared: Vec<(&str, u32)> = header.lines().filter_map(parse_declaration).collect();
    for (port, bits) in wanted {
        match declared.iter().find(|(name, _)| name == port) {
            Some((_, found)) if found == bits => {}
            Some(&(_, found)) => return Err(width_error(top, port, found, *bits)),
            None => {
                return Err(ToolError::MissingPort { top: top.to_owned(), port: port.clone() });
            }
        }
    }
    Ok(())
}

/// Parses a declaration such as `VL_IN8(&name,msb,lsb);` or `VL_INW(&name,msb,lsb,words);`.
fn parse_declaration(line: &str) -> Option<(&str, u32)> {
    let line = line.trim();
    let rest = ["VL_IN", "VL_OUT"].iter().find_map(|start| line.strip_prefix(start))?;
    let mut words = rest.split_once('(')?.1.trim_end_matches([')', ';']).split(',');
    let name = words.next()?.trim_start_matches('&');
    let mut bound = || words.next()?.trim().parse::<i64>().ok();
    let (msb, lsb) = (bound()?, bound()?);
    Some((name, u32::try_from(msb.abs_diff(lsb) + 1).ok()?))
}

/// Fails if a warning of Icarus says that a port of `top` and its signal in the bench, `file`,
/// differ in width: `file:3: warning: Port 3 (a_i) of tiny expects 16 bits, got 11.`
pub(crate) fn check_warnings(top: &str, file: &str, log: &str) -> Result<(), ToolError> {
    let mismatch = |line: &str| {
        let line = line.strip_prefix(file)?.strip_prefix(':')?;
        let (_, port) = line.split_once("warning: Port ")?;
        let (_, port) = port.split_once('(')?;
        let (port, rest) = port.split_once(") of ")?;
        let rest = rest.strip_prefix(top)?.strip_prefix(" expects ")?;
        let (found, wanted) = rest.split_once(" bits, got ")?;
        let wanted = wanted.trim_end_matches('.').parse().ok()?;
        Some(width_error(top, port, found.parse().ok()?, wanted))
    };
    log.lines().find_map(mismatch).map_or(Ok(()), Err)
}

fn width_error(top: &str, port: &str, found: u32, wanted: u32) -> ToolError {
    ToolError::PortWidth { top: top.to_owned(), port: port.to_owned(), found, wanted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn port_widths_are_read_from_the_header() {
        let header = "class Vt {\n    VL_IN8(&a_i,7,0);\n    VL_OUT16(&b_o,1,12);\n    \
                      VL_INW(&c_i,199,0,7);\n}\n";
        let check = |name: &str, bits| check_header("t", header, &[(name.to_owned(), bits)]);
        assert!(check("a_i", 8).is_ok() && check("b_o", 12).is_ok() && check("c_i", 200).is_ok());
        let error = check("c_i", 208).unwrap_err().to_string();
        assert!(
            error.contains("port `c_i` of module `t` has 200 bits, but the design has 208"),
            "{error}"
        );
        assert!(matches!(check("d_i", 1), Err(ToolError::MissingPort { .. })));
    }

    #[test]
    fn only_warnings_about_the_bench_are_width_errors() {
        let line = "t_replay.v:3: warning: Port 3 (a_i) of t expects 16 bits, got 11.";
        let error = check_warnings("t", "t_replay.v", line).unwrap_err().to_string();
        assert!(
            error.contains("port `a_i` of module `t` has 16 bits, but the design has 11"),
            "{error}"
        );
        assert!(check_warnings("t", "other.v", line).is_ok());
        assert!(check_warnings("u", "t_replay.v", line).is_ok());
    }
}
