// SPDX-License-Identifier: MIT OR Apache-2.0
//! The area that `estimate` prints for a core on AXI, compared with the area that Yosys finds in
//! the folder of `generate`, on every device family.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{run_in, run_successfully};
use foveate_tools::{Tool, Toolchain, testing::require_tools};
use serde_json::Value;

const DESIGN: [&str; 10] = [
    "--preset",
    "raster",
    "--set",
    "hardware.interface='axi'",
    "--set",
    "frame={width=32,height=16}",
    "--set",
    "region.size=4",
    "--set",
    "denoise.filter='none'",
];

type Cells = BTreeMap<String, u64>;

/// Runs a command in the folder of a core, and returns its output.
fn run(core: &Path, mut command: Command) -> String {
    let output = command.current_dir(core).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

/// Returns the cells of a module of a generated core, as Yosys alone finds them with the commands
/// that the report names. Modules that were kept separate are added up. `preparation` has commands
/// between reading and synthesis.
fn synthesized_cells(core: &Path, top: &str, preparation: &str) -> Cells {
    let files = fs::read_to_string(core.join(format!("{top}.f"))).unwrap();
    let script = format!(
        "read_verilog {}\n\
         {preparation}hierarchy -check -top {top}\n\
         synth_xilinx -family xcup -abc9 -nosrl -noiopad -noclkbuf -flatten -top {top}\n\
         xilinx_srl -fixed -minlen 3\n\
         setparam -set ENPOL 1 t:$__XILINX_SHREG_\n\
         techmap -map +/xilinx/cells_map.v\n\
         clean\n\
         setattr -mod -unset keep_hierarchy *\n\
         flatten\n\
         tee -o stat.txt stat\n",
        files.lines().collect::<Vec<_>>().join(" ")
    );
    fs::write(core.join("own.ys"), script).unwrap();
    let mut yosys = Command::new(Toolchain::system().find(Tool::Yosys).unwrap().path);
    yosys.args(["-q", "-s", "own.ys"]);
    run(core, yosys);
    let text = fs::read_to_string(core.join("stat.txt")).unwrap();
    // A line has type and number; newer versions print the number first.
    let cell = |line: &str| match line.split_whitespace().collect::<Vec<_>>()[..] {
        [one, other] => one.parse().map_or_else(
            |_| Some((one.to_owned(), other.parse().ok()?)),
            |count| Some((other.to_owned(), count)),
        ),
        _ => None,
    };
    text.lines().filter_map(cell).collect()
}

fn count(cells: &Cells, kinds: &[&str]) -> u64 {
    cells
        .iter()
        .filter(|(name, _)| kinds.iter().any(|kind| name.starts_with(kind)))
        .map(|(_, n)| n)
        .sum()
}

/// Returns the LUTs of logic, flip-flops, carry blocks and halves of block RAM, as in the report of
/// an area.
fn area_figures(cells: &Cells) -> [u64; 4] {
    let luts = (1..=6).map(|inputs| cells.get(&format!("LUT{inputs}")).unwrap_or(&0)).sum::<u64>();
    [
        luts + count(cells, &["INV"]),
        count(cells, &["FD"]),
        count(cells, &["CARRY4"]) + 2 * count(cells, &["CARRY8"]),
        count(cells, &["RAMB18"]) + 2 * count(cells, &["RAMB36"]),
    ]
}

fn reported_figures(area: &Value) -> [u64; 4] {
    ["lut_logic_high", "ff", "carry", "bram18"].map(|name| area[name].as_u64().unwrap())
}

#[test]
#[ignore = "a core on AXI is synthesized twice; scripts/release.sh whole runs it"]
fn the_area_of_a_core_on_axi_is_that_of_its_folder() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &[&["generate", "-o", "core"], &DESIGN[..]].concat());
    let outcome = run_in(dir.path(), &[&["estimate", "--json"], &DESIGN[..]].concat());
    assert!(outcome.code == 0 && !outcome.stderr.contains("warning"), "{}", outcome.stderr);
    let report: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let core = dir.path().join("core");
    let whole = reported_figures(&report["bus"]["whole"]);
    // `estimate` reads fewer cells than Yosys alone, with the same names; without those names this
    // core has two LUTs fewer.
    assert_eq!(whole, area_figures(&synthesized_cells(&core, "rcm_axi", "")));
    // The array has another number, which is smaller.
    let array = reported_figures(&report["rcm"]);
    // `estimate` sets the parameters of the array, which are its defaults. Yosys names a module
    // after parameters that are set and orders nets by names; without the setting this array has
    // six LUTs more.
    let preparation = "chparam -set COLUMNS 8 -set ROWS 4 rcm\n";
    assert_eq!(array, area_figures(&synthesized_cells(&core, "rcm", preparation)));
    assert!(array[0] < whole[0] && array[1] < whole[1], "{array:?} of {whole:?}");
    // Each part takes some LUTs. Together with the array the parts take a little more than the
    // whole core, which shares logic.
    let parts = report["bus"]["parts"].as_array().unwrap();
    let luts = parts.iter().map(|part| reported_figures(&part["area"])[0]).collect::<Vec<_>>();
    assert!(luts.len() == 5 && luts.iter().all(|&luts| luts > 0), "{parts:?}");
    let sum = array[0] + luts.iter().sum::<u64>();
    assert!(sum.abs_diff(whole[0]) * 5 < whole[0], "{sum} beside {}", whole[0]);

    // The text output has the same area, which was synthesized before.
    let text = run_successfully(dir.path(), &[&["estimate"], &DESIGN[..]].concat());
    for row in [
        "core ",
        "RCM ",
        "registers ",
        "repair of frames ",
        "packets ",
        "queue of regions ",
        "time and counters ",
        "RCM on AXI ",
        "axi_video ",
    ] {
        assert!(text.lines().any(|line| line.starts_with(row)), "{row} in\n{text}");
    }

    // A folder with another core on the bus has another number.
    let path = core.join("rtl/rcm_axi.v");
    let sound = fs::read_to_string(&path).unwrap();
    let less = sound.replace("64'd0 : time_q + 1'b1", "64'd0 : {32'd0, time_q[31:0] + 1'b1}");
    assert_ne!(less, sound);
    fs::write(path, less).unwrap();
    let fewer = area_figures(&synthesized_cells(&core, "rcm_axi", ""));
    assert!(fewer[1] + 64 <= whole[1], "{fewer:?} of {whole:?}: 32 bits of the time, twice");
}

/// Returns the cells of the netlist that a script of a core has left, without the registers at its
/// ports.
fn placed_cells(folder: &Path) -> Cells {
    let netlist: Value =
        serde_json::from_slice(&fs::read(folder.join("netlist.json")).unwrap()).unwrap();
    let modules = netlist["modules"].as_object().unwrap();
    let top = modules.values().find(|module| !module["attributes"]["top"].is_null()).unwrap();
    let mut cells = Cells::new();
    for (name, cell) in top["cells"].as_object().unwrap() {
        if !name.ends_with("u_bit") {
            *cells.entry(cell["type"].as_str().unwrap().to_owned()).or_default() += 1;
        }
    }
    cells
}

/// This test places the core on AXI, and the array in it, which is another module.
#[test]
#[ignore = "a minute of synthesis and routing; scripts/release.sh whole runs it"]
fn the_script_of_a_core_on_axi_places_what_the_estimate_counts() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrIce40]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    run_successfully(
        dir.path(),
        &[&["generate", "-o", "core", "--prefix", "cam0"], &DESIGN[..]].concat(),
    );
    // Without an argument the script takes the whole core, as an estimate does without a level.
    let whole = same_when_placed(dir.path(), ("", "rcm_axi"), &[&[], &["--level", "axi"]]);
    let array = same_when_placed(dir.path(), ("rcm", "rcm"), &[&["--level", "rcm"]]);
    assert!(count(&whole, &["SB_LUT4"]) > count(&array, &["SB_LUT4"]), "{whole:?}, {array:?}");
}

/// Returns the cells that the script of the core places for the module that it calls `word`.
/// Estimates with each of these options must count the same.
fn same_when_placed(dir: &Path, (word, top): (&str, &str), estimates: &[&[&str]]) -> Cells {
    let program = |tool| Toolchain::system().find(tool).unwrap().path;
    let (core, kept) = (dir.join("core"), format!("kept-{top}"));
    fs::create_dir(core.join(&kept)).unwrap();
    let mut command = Command::new("sh");
    command.args(["synth/ice40.sh", word, "hx8k", "1"]).env("KEEP", &kept);
    command.env("YOSYS", program(Tool::Yosys)).env("NEXTPNR", program(Tool::NextpnrIce40));
    run(&core, command);
    let cells = placed_cells(&core.join(kept));
    for more in estimates {
        let estimate = ["estimate", "--place-and-route", "hx8k", "--seeds", "1", "--json"];
        let text = run_successfully(dir, &[&estimate[..], more, &DESIGN[..]].concat());
        let report: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["top"], top);
        let taken = |what: &str| report["devices"][0]["placed"][what]["used"].as_u64().unwrap();
        assert_eq!(taken("ff"), count(&cells, &["SB_DFF"]), "{top}");
        assert_eq!(taken("block_ram"), count(&cells, &["SB_RAM40"]), "{top}");
    }
    cells
}
