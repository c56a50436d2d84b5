// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faults that the benches of a core must find. Each needs a special situation: a mean that waits,
//! a reset while a summary is shown, or a summary behind pixels. After a change of the RTL, a text
//! that is no longer found is replaced by one with the same effect.

use crate::common::in_parallel;
use crate::shipped::{BenchSimulator, bench};
use foveate_design::{Design, DesignConfig};
use foveate_emit::{SourceFile, Top, verilog};
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};

const PIPELINED: &str = "hardware.organization = 'pipelined'\n";
const SERIAL: &str = "hardware.organization = 'serial'\nhardware.fold = 2\n";
const RASTER: &str = "hardware.organization = 'raster'\nperiphery.blocks = 2\n";
const LAST_SENT: &str =
    "hardware.organization = 'raster'\nperiphery.blocks = 2\ntemporal.reference = 'last-sent'\n";

/// Returns a design with this hardware whose irrelevant regions send means.
fn design(hardware: &str) -> Design {
    let toml =
        format!("render.irrelevant = 'mean'\nframe.width = 32\nframe.height = 24\n{hardware}");
    DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
}

/// The design, the module, the text that its file contains exactly once, and its replacement.
#[rustfmt::skip]
const FAULTS: &[(&str, &str, &str, &str)] = &[
    (PIPELINED, "region_summary", "if (active_i) shows_q <= 1'b0;\n            else if", "if"),
    (PIPELINED, "region_summary", "            shows_q <= 1'b0;\n        end", "            shows_q <= shows_q;\n        end"),
    (PIPELINED, "region_summary", "if (active_i) shows_q", "if (srs_i) shows_q"),
    (SERIAL, "serial_summary", "{!active_i && (summary_o || shows)", "{(summary_o || shows)"),
    (SERIAL, "serial_summary", "{!active_i && (summary_o || shows)", "{!srs_i && (summary_o || shows)"),
    (SERIAL, "serial_summary", "shows = was_shown && !first_q;", "shows = was_shown;"),
    (LAST_SENT, "raster_forward", "fetched_q <= fetch && !means && !rst_i", "fetched_q <= fetch && !rst_i"),
    (RASTER, "raster_forward", "shown = stepped_q ? mean : kept_q", "shown = mean"),
    (RASTER, "raster_forward", "kept_q    <= shown;", "kept_q    <= mean;"),
    (RASTER, "raster_summary", "shown_read && !lost_read && over", "shown_read && over"),
    (RASTER, "raster_summary", "shown_read && !lost_read && over", "shown_read && !lost_read"),
    (RASTER, "raster_decision", "(decided_shown && !trs)", "decided_shown"),
];

/// Returns true if the bench of a module passes with this Verilog.
fn passes(design: &Design, top: Top, files: &[SourceFile]) -> bool {
    let bench = bench(design, top);
    let dir = tempfile::tempdir().unwrap();
    for file in files.iter().chain(&bench.files) {
        let path = dir.path().join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    }
    BenchSimulator::Icarus.build(dir.path(), files, &bench);
    let vectors = format!("+vectors={}", bench.files[1].path);
    let (passes, log) = BenchSimulator::Icarus.play(dir.path(), &[&vectors, "+stop"]);
    assert_eq!(passes, log.contains("PASS "), "{log}");
    passes
}

#[test]
fn shipped_benches_find_faults_that_need_a_special_situation() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    // One fault of each organization.
    let failures = in_parallel(&sample(FAULTS, 5), |&&(hardware, module, from, to)| {
        let design = design(hardware);
        let path = format!("rtl/{module}.v");
        let mut found = 0;
        let mut is_caught = false;
        for &top in Top::all_of(&design) {
            let mut files = verilog(&design, top);
            for file in files.iter_mut().filter(|file| file.path == path) {
                found += file.contents.matches(from).count();
                file.contents = file.contents.replace(from, to);
            }
            is_caught = is_caught || !passes(&design, top, &files);
        }
        match (found == Top::all_of(&design).len(), is_caught) {
            (true, true) => Ok(()),
            (false, _) => Err(format!("{module}: `{from}` is there {found} times")),
            (true, false) => Err(format!("{module}: not caught: `{from}` -> `{to}`")),
        }
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The unchanged cores pass, or the tests above would show nothing.
#[test]
fn shipped_benches_of_the_faulty_cores_pass_without_a_fault() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let designs = sample([PIPELINED, SERIAL, RASTER, LAST_SENT], 4);
    let failures = in_parallel(&designs, |hardware| {
        let design = design(hardware);
        let all = Top::all_of(&design).iter();
        match all.clone().all(|&top| passes(&design, top, &verilog(&design, top))) {
            true => Ok(()),
            false => Err((*hardware).to_owned()),
        }
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
