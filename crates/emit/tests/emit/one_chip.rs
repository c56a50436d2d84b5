// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cores with different prefixes fit into one top, and behave there as each does alone.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::design;
use foveate_design::{Design, PortDirection, PortRole};
use foveate_emit::{Prefix, SourceFile, Top, core_files};
use foveate_tools::{
    Tool, Toolchain,
    testing::{require_tools, sample},
};

/// The clocks of a simulation, enough for a few frames of each core.
const CLOCKS: u32 = 10_000;

/// Returns a core of every organization, and a second one of two of them.
fn designs() -> Vec<(Prefix, Design)> {
    let raster = "frame = { width = 32, height = 24 }\nhardware.organization = 'raster'\n";
    let serial = "frame = { width = 16, height = 16 }\nhardware.organization = 'serial'\n";
    let list = [
        ("left", format!("{raster}hardware.pipelining = 'deep'\n")),
        (
            "right",
            format!(
                "{raster}spatial = [{{ feature = 'corner' }}]\nhardware.store = 'single-port'\n"
            ),
        ),
        ("near", "frame = { width = 16, height = 8 }\n".to_owned()),
        ("far", serial.to_owned()),
        ("auto", format!("{serial}hardware.fold = 2\nhardware.feed = 'raster'\n")),
    ];
    let named = list.into_iter().map(|(name, toml)| {
        let design = design(&toml);
        (Prefix::from_request(Some(name), &design).unwrap(), design)
    });
    named.collect()
}

/// Returns a top in which pixels that change at every clock enter all cores. It prints how often
/// each core decided, and a checksum of its scores.
fn top(cores: &[(&Prefix, &Design)]) -> String {
    let mut text =
        "module chip;\n    reg clk = 0, rst = 1;\n    reg [31:0] pixels = 1;\n".to_owned();
    let mut says = String::new();
    for (number, (prefix, design)) in cores.iter().enumerate() {
        let mut pins = Vec::new();
        let mut counted = 0;
        for port in Top::Rcm.ports(design) {
            let signal = match (port.direction, port.role) {
                (PortDirection::Input, PortRole::Clock) => "clk".to_owned(),
                (PortDirection::Input, PortRole::Reset) => "rst".to_owned(),
                (PortDirection::Input, PortRole::Pixel) => {
                    format!("{{{}{{pixels}}}}", port.bits().div_ceil(32))
                }
                (PortDirection::Input, PortRole::Valid | PortRole::ForwardReady) => {
                    "1'b1".to_owned()
                }
                (PortDirection::Input, _) => format!("{}'d1", port.bits()),
                (PortDirection::Output, PortRole::DecisionValid) => format!("decided_{number}"),
                (PortDirection::Output, PortRole::Score(_) | PortRole::AnyScore) => {
                    counted = port.bits();
                    format!("score_{number}")
                }
                (PortDirection::Output, _) => String::new(),
            };
            pins.push(format!(".{}({signal})", port.name));
        }
        let _ = write!(
            text,
            "    wire decided_{number};\n    wire [{}:0] score_{number};\n    integer count_{number} = 0, sum_{number} = 0;\n    \
             always @(posedge clk) if (!rst && decided_{number}) begin\n        count_{number} = count_{number} + 1;\n        \
             sum_{number} = sum_{number} * 3 + score_{number};\n    end\n    {} u_{number} ({});\n",
            counted - 1,
            prefix.prefixed_name("rcm"),
            pins.join(", ")
        );
        let _ = writeln!(
            says,
            "        $display(\"{} %0d %0d\", count_{number}, sum_{number});",
            Prefix::prefixed_name(prefix, "core")
        );
    }
    let _ = write!(
        text,
        "    always #1 clk = !clk;\n    always @(negedge clk) pixels = pixels * 1664525 + 1013904223;\n    initial begin\n        \
         #5 rst = 0;\n        #{};\n{says}        $finish;\n    end\nendmodule\n",
        2 * CLOCKS
    );
    text
}

/// Writes the Verilog of these cores, as their `rcm.f` lists it, and the top. Returns the names of
/// the files.
fn write(folder: &Path, cores: &[(&Prefix, &Design)]) -> Vec<String> {
    let mut names = Vec::new();
    for (number, (prefix, design)) in cores.iter().enumerate() {
        let files: Vec<SourceFile> = core_files(design, prefix);
        let list = files.iter().find(|file| file.path == prefix.prefixed_name("rcm.f")).unwrap();
        for path in list.contents.lines() {
            let file = files.iter().find(|file| file.path == path).unwrap();
            let name = format!("{number}_{}", path.strip_prefix("rtl/").unwrap());
            fs::write(folder.join(&name), &file.contents).unwrap();
            names.push(name);
        }
    }
    fs::write(folder.join("chip.v"), top(cores)).unwrap();
    names.push("chip.v".to_owned());
    names
}

/// Returns the lines that the simulation of a top prints; `None` if the top does not elaborate.
fn simulate(tool: Tool, cores: &[(&Prefix, &Design)]) -> Option<BTreeSet<String>> {
    let dir = tempfile::tempdir().unwrap();
    let names = write(dir.path(), cores);
    let toolchain = Toolchain::system();
    let compile = toolchain.invocation(tool).unwrap().dir(dir.path());
    let compile = match tool {
        Tool::Verilator => compile.args([
            "--binary",
            "--timing",
            "-Wno-fatal",
            "-Wno-lint",
            "-Wno-style",
            "--Mdir",
            "built",
            "-o",
            "../chip",
            "--top-module",
            "chip",
            "-CFLAGS",
            "-O0",
        ]),
        _ => compile.args(["-g2005", "-s", "chip", "-o", "chip.vvp"]),
    };
    toolchain.run_checked(&compile.args(names)).ok()?;
    let mut run = match tool {
        Tool::Verilator => Command::new(dir.path().join("chip")),
        _ => {
            let mut vvp = Command::new("vvp");
            vvp.args(["-n", "chip.vvp"]);
            vvp
        }
    };
    let output = run.current_dir(dir.path()).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    Some(text.lines().filter(|line| line.contains("core ")).map(str::to_owned).collect())
}

#[test]
fn cores_of_different_designs_simulate_in_one_top() {
    if !require_tools(&[Tool::Verilator, Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let designs = designs();
    let all: Vec<(&Prefix, &Design)> =
        designs.iter().map(|(prefix, design)| (prefix, design)).collect();
    let mut alone = BTreeSet::new();
    for core in &all {
        alone.extend(simulate(Tool::Iverilog, &[*core]).unwrap());
    }
    assert_eq!(alone.len(), all.len());
    for said in &alone {
        let count: u32 = said.split(' ').nth(1).unwrap().parse().unwrap();
        assert!(count > 1, "every core decides: {alone:?}");
    }
    // Verilator compiles for long.
    for tool in sample([Tool::Iverilog, Tool::Verilator], 2) {
        assert_eq!(simulate(tool, &all).as_ref(), Some(&alone), "{tool}");
    }
}

/// Without prefixes two designs have modules of the same name, and tools refuse them.
#[test]
fn cores_without_prefixes_do_not_fit_into_one_top() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let designs = designs();
    let none = Prefix::default();
    let pair = [(&none, &designs[0].1), (&none, &designs[1].1)];
    assert!(simulate(Tool::Iverilog, &pair[..1]).is_some());
    assert_eq!(simulate(Tool::Iverilog, &pair), None);
}

/// Every module has a name of its own, and so has every core in FuseSoC, even without a prefix.
#[test]
fn no_names_of_two_cores_are_alike() {
    let designs = designs();
    let (mut modules, mut names) = (BTreeSet::new(), BTreeSet::new());
    for (prefix, design) in &designs {
        for prefix in [prefix, &Prefix::default()] {
            let files = core_files(design, prefix);
            let fusesoc = files.iter().find(|file| file.path == "foveate_rcm.core").unwrap();
            let name =
                fusesoc.contents.lines().find_map(|line| line.strip_prefix("name: ")).unwrap();
            assert!(names.insert(name.to_owned()), "{name}");
            if prefix.text().is_empty() {
                continue;
            }
            for file in files.iter().filter(|file| file.path.starts_with("rtl/")) {
                let start = format!("rtl/{}_", prefix.text());
                assert!(file.path.starts_with(&start), "{}", file.path);
                let module =
                    file.contents.lines().find_map(|line| line.strip_prefix("module ")).unwrap();
                let module = module.split([' ', ';']).next().unwrap();
                assert_eq!(file.path, format!("rtl/{module}.v"));
                assert!(modules.insert(module.to_owned()), "{module}");
            }
            let readme = &files.last().unwrap().contents;
            assert!(readme.contains(&format!("{0}_rcm u_{0}_rcm (", prefix.text())), "{readme}");
        }
    }
}
