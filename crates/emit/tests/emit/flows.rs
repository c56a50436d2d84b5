// SPDX-License-Identifier: MIT OR Apache-2.0
//! The module that FuseSoC and Vivado synthesize from a generated core is the one that a user
//! integrates into a chip, with its clock.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{covering_values, design, every_design_on_a_bus, has_tclsh};
use foveate_emit::{Prefix, SourceFile, core_files};
use foveate_tools::testing::sample;

/// Returns a core of each organization and the selected cores on AXI, each with the module that
/// goes into a chip and its clock.
fn cores() -> Vec<(String, &'static str, &'static str)> {
    let ports = ["pipelined", "serial", "raster"].map(|organization| {
        let frame = "frame = { width = 32, height = 24 }";
        (format!("{frame}\nhardware.organization = '{organization}'\n"), "rcm", "clk_i")
    });
    let buses =
        covering_values(every_design_on_a_bus()).into_iter().map(|toml| (toml, "rcm_axi", "aclk"));
    ports.into_iter().chain(buses).collect()
}

fn contents<'a>(files: &'a [SourceFile], path: &str) -> &'a str {
    let found = files.iter().find(|file| file.path == path);
    &found.unwrap_or_else(|| panic!("there is no {path}")).contents
}

/// Returns the lines below a key of a FuseSoC file.
fn lines_below<'a>(text: &'a str, key: &str) -> Vec<&'a str> {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let mut lines = text.lines().skip_while(|line| *line != key);
    let own = depth(lines.next().unwrap_or_else(|| panic!("there is no `{key}`")));
    lines.take_while(|line| depth(line) > own).map(str::trim).collect()
}

/// The files and settings of a target of FuseSoC.
struct FuseSocTarget {
    top: String,
    /// The files of the core, and their names where tools run.
    files: Vec<(String, String)>,
    lines: Vec<String>,
}

impl FuseSocTarget {
    fn of(core: &[SourceFile], name: &str) -> Self {
        let (sets, targets) =
            contents(core, "foveate_rcm.core").split_once("\ntargets:\n").unwrap();
        let lines = lines_below(targets, &format!("  {name}:"));
        let value = |key: &str| lines.iter().find_map(|line| line.strip_prefix(key)).unwrap();
        let own = value("filesets: [").trim_end_matches(']').split(", ");
        let file = |line: &str| {
            let named = line.strip_prefix("- ")?;
            let (path, copied) = named.split_once(": {").unwrap_or((named, ""));
            let to = copied.split_once("copyto: ").map_or(path, |(_, to)| to);
            Some((path.to_owned(), to.trim_end_matches('}').to_owned()))
        };
        Self {
            top: value("toplevel: ").to_owned(),
            files: own
                .flat_map(|set| {
                    lines_below(sets, &format!("  {set}:")).into_iter().filter_map(file)
                })
                .collect(),
            lines: lines.into_iter().map(str::to_owned).collect(),
        }
    }
}

/// Runs a script where stubs check what it requests from Vivado or Yosys. Returns the synthesized
/// module and its clock.
fn run_flow_script(folder: &Path, words: &[&str]) -> Result<String, String> {
    let stub = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/emit/flow_stub.tcl");
    let output = Command::new("tclsh").arg(stub).args(words).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if output.status.success() { Ok(text(&output.stdout)) } else { Err(text(&output.stderr)) }
}

fn write(folder: &Path, path: &str, text: &str) {
    let path = folder.join(path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// Returns what a target of FuseSoC synthesizes with open tools, after an edit of one file.
fn fusesoc_synthesis(
    core: &[SourceFile],
    name: &str,
    edit: Option<FileEdit<'_>>,
) -> Result<String, String> {
    let dir = tempfile::tempdir().unwrap();
    let core: Vec<SourceFile> = core.iter().map(|file| edited(file, edit)).collect();
    let target = FuseSocTarget::of(&core, name);
    for (path, to) in &target.files {
        write(dir.path(), to, contents(&core, path));
    }
    let script = format!("{name}.tcl");
    assert!(target.lines.contains(&format!("yosys_template: {script}")), "{:?}", target.lines);
    run_flow_script(dir.path(), &[&script, &target.top])
}

/// Returns what Vivado synthesizes if its script is called with these words, after an edit of one
/// file.
fn vivado_synthesis(
    core: &[SourceFile],
    words: &[&str],
    edit: Option<FileEdit<'_>>,
) -> Result<String, String> {
    let dir = tempfile::tempdir().unwrap();
    for file in core {
        write(dir.path(), &file.path, &edited(file, edit).contents);
    }
    run_flow_script(dir.path(), &[&["vivado_ooc.tcl", ""], words].concat())
}

/// The path of a file, a part of its text, and the replacement.
type FileEdit<'a> = (&'a str, &'a str, &'a str);

fn edited(file: &SourceFile, edit: Option<FileEdit<'_>>) -> SourceFile {
    match edit {
        Some((path, from, to)) if path == file.path => {
            assert!(file.contents.contains(from), "`{from}` is not in {path}");
            SourceFile { contents: file.contents.replace(from, to), ..file.clone() }
        }
        _ => file.clone(),
    }
}

#[test]
fn fusesoc_takes_the_module_that_goes_into_a_chip() {
    for (toml, module, clock) in sample(cores(), 3) {
        for prefix in [Prefix::default(), Prefix::new("left").unwrap()] {
            let files = core_files(&design(&toml), &prefix);
            let top = prefix.prefixed_name(module);
            // The target of Vivado makes no bitstream, because no file of a core has the pins.
            let target = FuseSocTarget::of(&files, "synth");
            assert_eq!(target.top, top, "{toml}");
            assert!(target.lines.iter().any(|line| line == "pnr: none"), "{:?}", target.lines);
            let constraints = target.files.iter().filter(|(path, _)| path.ends_with(".xdc"));
            let clocks: Vec<_> = constraints.map(|(path, _)| contents(&files, path)).collect();
            assert_eq!(clocks.len(), 1, "{toml}");
            assert!(clocks[0].contains(&format!(" [get_ports {clock}]\n")), "{}", clocks[0]);
            // The open tools place that module with a register at each port.
            for name in ["ecp5", "ice40"] {
                assert_eq!(FuseSocTarget::of(&files, name).top, format!("{top}_ports"), "{toml}");
            }
        }
    }
}

#[test]
fn the_scripts_of_a_core_synthesize_the_module_that_goes_into_a_chip() {
    if !has_tclsh() {
        return;
    }
    for (toml, module, clock) in sample(cores(), 3) {
        let files = core_files(&design(&toml), &Prefix::default());
        let expected = Ok(format!("{module} with the clock {clock}"));
        assert_eq!(vivado_synthesis(&files, &[], None), expected, "{toml}");
        assert_eq!(vivado_synthesis(&files, &[module], None), expected, "{toml}");
        let array = Ok("rcm with the clock clk_i".to_owned());
        assert_eq!(vivado_synthesis(&files, &["rcm"], None), array, "{toml}");
        for name in ["ecp5", "ice40"] {
            assert_eq!(fusesoc_synthesis(&files, name, None), expected, "{name}: {toml}");
        }
    }
}

/// Each planted fault must be found.
#[test]
fn scripts_that_ask_for_what_is_not_there_are_seen() {
    if !has_tclsh() {
        return;
    }
    let files = core_files(&design(&every_design_on_a_bus()[0]), &Prefix::new("left").unwrap());
    let whole = Ok("left_rcm_axi with the clock aclk".to_owned());
    let array = Ok("left_rcm with the clock clk_i".to_owned());
    assert_eq!(vivado_synthesis(&files, &[], None), whole);
    assert_eq!(vivado_synthesis(&files, &["rcm"], None), array);
    for word in ["rpu", "left_rcm", "axi"] {
        let refused = vivado_synthesis(&files, &[word], None).unwrap_err();
        assert!(refused.contains("the top is rcm or rcm_axi, not"), "{refused}");
    }
    for edit in [
        ("constraints/ooc.xdc", "aclk", "clk_i"),
        ("constraints/ooc.xdc", "[get_ports aclk]", "[get_ports interrupt_o]"),
        ("vivado_ooc.tcl", "\"constraints/rcm_ooc.xdc\" : ", "\"constraints/ooc.xdc\" : "),
        ("vivado_ooc.tcl", "open $top.f", "open rcm.f"),
        ("vivado_ooc.tcl", "set top left_", "set top "),
        ("left_rcm_axi.f", "rtl/left_axi_video.v\n", ""),
        ("vivado_ooc.tcl", "-mode out_of_context -flatten", "-flatten"),
    ] {
        let both = [&[][..], &["rcm"]].map(|words| vivado_synthesis(&files, words, Some(edit)));
        assert_ne!(both, [whole.clone(), array.clone()], "not seen: {edit:?}");
    }
    for name in ["ecp5", "ice40"] {
        assert_eq!(fusesoc_synthesis(&files, name, None), whole);
        let script = format!("synth/{name}.tcl");
        for edit in [
            (&*script, "left_rcm_axi", "left_rcm"),
            (&*script, "left_rcm_axi", "rcm_axi"),
            (&*script, "-check -top left_rcm_axi_ports", "-check -top left_rcm_axi"),
            (&*script, &format!(" {name}_registers.v"), ""),
            ("synth/left_rcm_axi_ports.v", ".aclk(clk_i)", ".aresetn(clk_i)"),
            ("synth/left_rcm_axi_ports.v", "left_rcm_axi u_core", "left_rcm u_core"),
            ("foveate_rcm.core", "toplevel: left_rcm_axi_ports", "toplevel: left_rcm_ports"),
            ("foveate_rcm.core", "copyto: left_rcm_axi_ports.v", "copyto: ports.v"),
        ] {
            assert_ne!(fusesoc_synthesis(&files, name, Some(edit)), whole, "not seen: {edit:?}");
        }
    }
}
