// SPDX-License-Identifier: MIT OR Apache-2.0
//! Edited port widths of the emitted RPU and RCM. They are the part of the negative control in
//! which the Verilog is refused and never simulated.

use crate::common::{cosimulate, design, directed_stimulus};
use foveate_cosim::{CosimError, CosimLevel, Simulator};
use foveate_design::DesignConfig;
use foveate_tools::testing::require_tools;

/// The file, a text that occurs once in it, its replacement, the port, its bits after the edit, and
/// its bits in the design.
const EDITS: [(&str, &str, &str, &str, u32, u32); 4] = [
    (
        "rpu",
        "input  wire [10:0] edge_level_i",
        "input wire [15:0] edge_level_i",
        "edge_level_i",
        16,
        11,
    ),
    (
        "rpu",
        "output wire [6:0]  edge_score_o",
        "output wire [7:0] edge_score_o",
        "edge_score_o",
        8,
        7,
    ),
    ("rcm", "COLUMNS*ROWS*8-1:0] pixel_i", "COLUMNS*ROWS*8-2:0] pixel_i", "pixel_i", 47, 48),
    ("rcm", "[10:0]               edge_level_i", "[11:0] edge_level_i", "edge_level_i", 12, 11),
];

#[test]
fn edited_widths_are_refused_in_both_simulators() {
    let design = design(&DesignConfig::default(), (3, 2));
    let output = tempfile::tempdir().unwrap();
    for simulator in Simulator::ALL {
        if !require_tools(simulator.tools()) {
            continue;
        }
        for (module, from, to, name, bits, of_design) in EDITS {
            let level = match module {
                "rcm" => CosimLevel::Rcm { columns: 3, rows: 2 },
                _ => CosimLevel::Rpu,
            };
            let edit = |job: &mut foveate_cosim::CosimJob| {
                let path = format!("rtl/{module}.v");
                let file = job.sources.iter_mut().find(|file| file.path == path).unwrap();
                assert_eq!(file.contents.matches(from).count(), 1, "{from}\n{}", file.contents);
                file.contents = file.contents.replace(from, to);
            };
            let result = cosimulate(
                &design,
                simulator,
                directed_stimulus(level, 1),
                &output.path().join("out"),
                edit,
            );
            match result {
                Err(CosimError::PortWidth { top, port, found, wanted }) => {
                    assert_eq!((top.as_str(), port.as_str()), (module, name), "{simulator}");
                    assert_eq!((found, wanted), (bits, of_design), "{simulator}");
                }
                other => panic!("{simulator} {module} {to}: {other:?}"),
            }
        }
    }
}
