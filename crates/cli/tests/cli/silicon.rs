// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --liberty`: area, timing, leakage and energy in the cells of Debian's library, and
//! the errors for libraries that cannot be used.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use foveate_tools::{
    Tool, Toolchain,
    testing::{require_tools, sampling_step, takes_whole_lists},
};
use serde_json::Value;

use crate::common::silicon::{LIBRARY, is_ready, number};
use crate::common::{expect_failure, foveate, run_in, run_successfully};

const SMALL: [&str; 8] = [
    "--preset",
    "bare",
    "--set",
    "region.size=4",
    "--set",
    "frame={width=8,height=12}",
    "--set",
    "frame.pixel_bits=4",
];

/// The frame of a core of `raster`, which needs rows of four regions.
const WIDE: [&str; 2] = ["--set", "frame.width=16"];

fn report(folder: &Path, args: &[&str]) -> Value {
    let command = [&["estimate", "--json", "--quiet"], args].concat();
    serde_json::from_str(&run_successfully(folder, &command)).unwrap()
}

/// Returns the area of every cell of a library in which each cell begins a line of its own, read
/// without the reader of the program.
fn areas(text: &str) -> Vec<(String, f64)> {
    let cells = text.split("\ncell (").skip(1).map(|cell| {
        let name = cell.split(')').next().unwrap().to_owned();
        let area = cell.split("area : ").nth(1).unwrap().split(';').next().unwrap();
        (name, area.trim().parse().unwrap())
    });
    cells.collect()
}

#[test]
fn an_array_has_the_area_of_its_units_and_of_what_they_share() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let bare = report(dir.path(), &[&SMALL[..], &["--liberty"]].concat());
    assert_eq!(bare["library"]["name"], "osu018_stdcells");
    assert_eq!((bare["unit"]["count"].as_u64(), bare["regions"].as_u64()), (Some(6), Some(6)));
    let [unit, shared, array] =
        ["/unit/cells", "/shared", "/array"].map(|at| number(&bare, &format!("{at}/area_um2")));
    assert!((array - (6.0 * unit + shared)).abs() < 1e-6 * array);
    // The store of 16 pixels of 4 bits, and some registers, are flip-flops.
    let flip_flops = number(&bare, "/unit/cells/flip_flops");
    assert!((64.0..200.0).contains(&flip_flops), "{flip_flops}");
    let areas = areas(&fs::read_to_string(LIBRARY).unwrap());
    let area = |name: &str| areas.iter().find(|(own, _)| own == name).unwrap().1;
    let expected = flip_flops * area("DFFPOSX1");
    assert!((number(&bare, "/unit/cells/flip_flop_area_um2") - expected).abs() < 1e-6 * expected);
    assert_eq!(number(&bare, "/library/gate_area_um2"), area("NAND2X1"));
    // Each leaf module has its own row.
    let leaves = bare["leaves"].as_array().unwrap();
    assert_eq!(leaves[0]["module"], "rpu");
    let store = leaves.iter().find(|leaf| leaf["module"] == "frame_store").unwrap();
    assert_eq!((number(store, "/instances"), number(store, "/cells/flip_flops")), (1.0, 64.0));
    // A path of some gates of 0.18 um, and a clock that it allows.
    let ns = number(&bare, "/path/ns");
    assert!((0.8..20.0).contains(&ns), "{ns}");
    assert!((number(&bare, "/path/mhz") * ns - 1000.0).abs() < 1e-3);
    for end in ["from", "to"] {
        let name = bare["path"][end].as_str().unwrap();
        assert!(name.contains("u_rpu.") && !name.contains("cell_"), "{name}");
    }
    // Leakage grows with the number of regions. The cells of an RPU differ a little with the names
    // around it.
    let larger = [&SMALL[..], &WIDE, &["--liberty", LIBRARY]].concat();
    let ratio = number(&report(dir.path(), &larger), "/leakage_nw") / number(&bare, "/leakage_nw");
    assert!((ratio - 2.0).abs() < 0.2, "{ratio}");
}

#[test]
#[ignore = "four arrays are mapped, which takes a minute; scripts/release.sh whole runs it"]
fn a_folded_array_and_a_core_are_mapped_deep_and_plain() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let serial = ["--set", "hardware={organization='serial',fold=2}"];
    let raster = ["--set", "hardware={organization='raster'}"];
    for organization in [serial, raster] {
        let both = ["plain", "deep"].map(|pipelining| {
            let deep = format!("hardware.pipelining='{pipelining}'");
            let args = [&SMALL[..], &WIDE, &organization, &["--set", &deep, "--liberty"]].concat();
            let report = report(dir.path(), &args);
            let sum = number(&report, "/shared/area_um2")
                + number(&report, "/unit/count") * number(&report, "/unit/cells/area_um2");
            assert!((number(&report, "/array/area_um2") - sum).abs() < 1e-6 * sum);
            report
        });
        // More registers and shorter paths; in a small core without a filter both are short.
        let [plain, deep] = both.each_ref().map(|report| number(report, "/path/ns"));
        assert!(deep < 1.15 * plain, "{organization:?}: {deep} and {plain} ns");
        let [plain, deep] = both.each_ref().map(|report| number(report, "/array/flip_flops"));
        assert!(deep > plain, "{organization:?}: {deep} and {plain} flip-flops");
    }
}

#[test]
#[ignore = "a core on AXI is mapped, which takes a minute; scripts/release.sh whole runs it"]
fn a_core_on_axi_is_mapped_with_the_parts_around_its_array() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let shared = ["ports", "axi"].map(|interface| {
        let hardware = format!("hardware={{organization='raster',interface='{interface}'}}");
        let args = [&SMALL[..], &WIDE, &["--set", &hardware, "--liberty"]].concat();
        number(&report(dir.path(), &args), "/shared/flip_flops")
    });
    assert!(shared[1] > shared[0] + 500.0, "{shared:?}");
}

/// The mapped netlist, with models that Yosys makes of the library, computes what the model computes.
/// Icarus would pass on unknown values from registers before their first use, where the source does not.
#[test]
fn the_netlist_agrees_with_the_model() {
    if !is_ready() || !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let netlist = dir.path().join("gates/gates.v");
    fs::create_dir(dir.path().join("gates")).unwrap();
    let deep = "hardware={organization='serial',fold=2,pipelining='deep'}";
    let designs: [(&[&str], &[&str]); 3] = [
        (&["--set", "denoise.filter='median3x3'"], &["--level", "rpu"]),
        (&["--set", deep], &["--level", "rcm", "--grid", "2x3"]),
        (
            &["--set", "frame.width=16", "--set", "hardware={organization='raster'}"],
            &["--level", "rcm", "--grid", "4x3"],
        ),
    ];
    let cosim = |design: &[&str], part: &[&str]| {
        let simulate = ["cosim", "--rounds", "1", "--rtl", "gates"];
        run_in(dir.path(), &[&simulate[..], &SMALL, design, part].concat())
    };
    // The first design is mapped below.
    let mapped = if takes_whole_lists() { &designs[..] } else { &[] };
    for &(design, part) in mapped {
        let estimate = [
            "estimate",
            "--quiet",
            "--liberty",
            "--memory-limit",
            "100000",
            "--netlist",
            "gates/gates.v",
        ];
        run_successfully(dir.path(), &[&estimate[..], &SMALL, design].concat());
        let outcome = cosim(design, part);
        assert!(
            outcome.code == 0 && outcome.stdout.contains("no mismatch"),
            "{}{}",
            outcome.stdout,
            outcome.stderr
        );
    }
    // A wrong cell is found, in a design that passes without it.
    let (design, part) = designs[0];
    let estimate = ["estimate", "--quiet", "--liberty", "--netlist", "gates/gates.v"];
    run_successfully(dir.path(), &[&estimate[..], &SMALL, design].concat());
    assert_eq!(cosim(design, part).code, 0);
    let text = fs::read_to_string(&netlist).unwrap();
    let wrong = text.replacen("module XOR2X1(", "module XNOR_AS_XOR(", 1);
    assert_ne!(wrong, text);
    let wrong =
        wrong + "\nmodule XOR2X1(input A, input B, output Y); assign Y = ~(A ^ B); endmodule\n";
    fs::write(&netlist, wrong).unwrap();
    assert_eq!(cosim(design, part).code, 1);
    // A netlist without its memories simulates nothing.
    let raster = ["estimate", "--quiet", "--liberty", "--memory-limit", "63", "--netlist", "n.v"];
    let args = [&raster[..], &SMALL, designs[2].0].concat();
    expect_failure(dir.path(), 2, &args, &["is above the limit of 63", "--memory-limit"]);
}

#[test]
#[ignore = "a core is mapped three times; scripts/release.sh whole runs it"]
fn large_memories_get_macros_that_fit() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let macros = dir.path().join("ram.lib");
    let port = "bus (Q) { memory_read () { address : A; } }";
    let cell = |name: &str, area: u32, ports: &str| {
        format!(
            "cell ({name}) {{ area : {area}; memory () {{ type : ram; address_width : 5; word_width : 8; }} {ports} }}\n"
        )
    };
    let two = format!("{port} {port}");
    let library = format!(
        "library (ram) {{ nom_voltage : 1.8;\n{}{}}}",
        cell("ONE", 100, port),
        cell("TWO", 1000, &two)
    );
    fs::write(&macros, library).unwrap();
    let args = |limit: &'static str| {
        let base =
            ["--set", "hardware={organization='raster'}", "--liberty", "--memory-limit", limit];
        [&SMALL[..], &WIDE, &base].concat()
    };
    let none = report(dir.path(), &args("1000000"));
    assert_eq!(none["memories"].as_array().unwrap().len(), 0);
    let without = report(dir.path(), &args("63"));
    let bits = number(&without, "/memory/bits");
    assert!(bits >= 384.0 && bits == number(&without, "/memory/bits_without_macro"), "{without}");
    assert!(number(&without, "/array/area_um2") < number(&none, "/array/area_um2"));
    let with = report(dir.path(), &[&args("63")[..], &["--macros", "ram.lib"]].concat());
    let chosen: Vec<_> = with["memories"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|own| !own["macros"].is_null())
        .collect();
    assert!(!chosen.is_empty(), "{with}");
    for memory in &chosen {
        assert_eq!(memory["macros"]["name"], "TWO");
        let macros = memory["words"].as_u64().unwrap().div_ceil(32)
            * memory["width"].as_u64().unwrap().div_ceil(8);
        assert_eq!(memory["macros"]["count"].as_u64(), Some(macros));
    }
    let area: f64 =
        chosen.iter().map(|own| number(own, "/macros/area_um2") * number(own, "/count")).sum();
    assert_eq!(number(&with, "/memory/macro_area_um2"), area);
    // The text fits in a terminal, and says what is missing.
    let text = run_successfully(dir.path(), &[&["estimate", "--quiet"], &args("63")[..]].concat());
    for words in ["no macro holds them", "have no macro", "Not included: wires", "gates: the"] {
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{text}");
    }
    let wide = text.lines().find(|line| line.chars().count() > 80);
    assert_eq!(wide, None);
}

#[test]
#[ignore = "an array is mapped twice; scripts/release.sh whole runs it"]
fn a_rom_of_any_size_becomes_gates() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    // Yosys makes a ROM of 16 words of 6 bits of the addresses of this core.
    let serial = [
        "--set",
        "frame={width=8,height=8,pixel_bits=3}",
        "--set",
        "hardware={organization='serial',fold=4}",
        "--liberty",
        "--memory-limit",
    ];
    let [below, above] =
        ["64", "96"].map(|limit| report(dir.path(), &[&SMALL[..], &serial, &[limit]].concat()));
    for pointer in ["/memory/bits", "/array/area_um2"] {
        assert_eq!(number(&below, pointer), number(&above, pointer), "{pointer}");
    }
}

/// OpenSTA of 2019 adds the wire load that a library chooses, and later versions do not.
#[test]
fn wire_loads_of_a_library_are_in_no_figure() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let plain = fs::read_to_string(LIBRARY).unwrap();
    let (head, cells) = plain.split_once("\ncell (").unwrap();
    let wires = "wire_load (\"far\") { capacitance : 1; resistance : 1; area : 1; slope : 100; \
                 fanout_length (1, 100); }\n default_wire_load : \"far\";";
    let with = format!("{head}\n{wires}\ncell ({cells}");
    fs::write(dir.path().join("wires.lib"), with).unwrap();
    let both = ["wires.lib", LIBRARY].map(|path| [&SMALL[..], &["--liberty", path]].concat());
    let [with, without] = both.map(|args| report(dir.path(), &args));
    for figure in ["/path", "/leakage_nw", "/array"] {
        assert_eq!(with.pointer(figure), without.pointer(figure), "{figure}");
    }
}

#[test]
fn a_compressed_library_gives_the_same_report() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut gzip =
        GzEncoder::new(File::create(dir.path().join("cells.lib.gz")).unwrap(), Compression::fast());
    gzip.write_all(&fs::read(LIBRARY).unwrap()).unwrap();
    gzip.finish().unwrap();
    let both = ["cells.lib.gz", LIBRARY].map(|path| [&SMALL[..], &["--liberty", path]].concat());
    let [packed, plain] = both.map(|args| report(dir.path(), &args));
    assert_eq!(packed, plain);
    // Two libraries make two reports.
    let twice = report(
        dir.path(),
        &[&SMALL[..], &["--liberty", LIBRARY, "--liberty", "cells.lib.gz"]].concat(),
    );
    assert_eq!(twice, Value::Array(vec![plain.clone(), plain]));
}

#[test]
fn the_energy_follows_from_the_activity_of_a_clip() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    // Frames 2 to 5 are all different and frames 10 to 13 are all equal.
    fs::create_dir(dir.path().join("clip")).unwrap();
    for frame in 0..16_u32 {
        let pixel = |place: u32| match frame {
            0..8 => (place * 7919 + frame.wrapping_mul(0x9E37_79B9) / 97).to_le_bytes()[0],
            _ => place.to_le_bytes()[0] % 8 * 16,
        };
        let pixels: Vec<u8> = (0..96).map(pixel).collect();
        let image = [b"P5 8 12 255\n", pixels.as_slice()].concat();
        fs::write(dir.path().join(format!("clip/{frame:02}.pgm")), image).unwrap();
    }
    for organization in ["pipelined", "serial"].into_iter().step_by(sampling_step(2)) {
        let hardware = format!("hardware.organization='{organization}'");
        let args = |more: &[&'static str]| {
            [&SMALL[..], &["--set", &hardware, "--liberty"], more]
                .concat()
                .into_iter()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        let run = |more: &[&'static str]| {
            let args = args(more);
            report(dir.path(), &args.iter().map(String::as_str).collect::<Vec<_>>())
        };
        let found = run(&["--activity", "clip", "--clock", "5"]);
        let [quiet, busiest] = [0, 2].map(|at| found["energy"]["stretches"][at].clone());
        let parts = |stretch: &Value, pointer: &str| -> f64 {
            let parts = ["clock", "memory", "flip_flops", "logic"];
            parts.iter().map(|part| number(stretch, &format!("/{pointer}/{part}"))).sum()
        };
        let pj = "unit_pj_per_clock";
        assert!(parts(&quiet, pj) < parts(&busiest, pj), "{organization}: {quiet} {busiest}");
        assert_eq!(number(&quiet, "/sent_share"), 0.0);
        let shown = number(&busiest, "/clocks_per_frame") * parts(&busiest, pj);
        let region = parts(&busiest, "region_nj_per_frame") * 1000.0;
        // The logic that lanes share is in the energy of a region and not in that of a lane.
        let range = if organization == "pipelined" { 0.999..1.001 } else { 1.0..3.0 };
        assert!(range.contains(&(region / shown)), "{organization}: {region} {shown}");
        let power = |stretch: &Value, name: &str| number(stretch, &format!("/{name}"));
        assert!(power(&quiet, "stopped_clock_mw") < power(&quiet, "running_clock_mw"));
        // All flip-flops are of one kind, so each takes the same energy from the clock, wherever it is.
        let clocks = number(&quiet, "/clocks_per_frame");
        let array_clock_pj = number(&quiet, "/region_nj_per_frame/clock") * 6.0 * 1000.0 / clocks;
        let of_array = array_clock_pj / number(&found, "/array/flip_flops");
        let of_unit =
            number(&quiet, "/unit_pj_per_clock/clock") / number(&found, "/unit/cells/flip_flops");
        assert!((of_array / of_unit - 1.0).abs() < 1e-6, "{organization}: {of_array} {of_unit}");
        let frame_mw = parts(&quiet, "region_nj_per_frame") * 6.0 * 30.0 * 1e-6;
        let leakage = number(&found, "/energy/leakage_mw");
        assert!((power(&quiet, "stopped_clock_mw") / (frame_mw + leakage) - 1.0).abs() < 1e-9);
        let idle_mw = array_clock_pj * (5e6 - clocks * 30.0) * 1e-9;
        assert!(
            (power(&quiet, "running_clock_mw") / (frame_mw + leakage + idle_mw) - 1.0).abs() < 1e-9
        );
        let fast = run(&["--activity", "clip", "--clock", "5", "--fps", "60"]);
        let of = |found: &Value| number(found, "/energy/stretches/0/stopped_clock_mw") - leakage;
        assert!((of(&fast) / of(&found) - 2.0).abs() < 1e-6);
        let text = run_successfully(
            dir.path(),
            &[
                &["estimate", "--quiet"],
                &args(&["--activity", "clip"]).iter().map(String::as_str).collect::<Vec<_>>()[..],
            ]
            .concat(),
        );
        assert!(
            text.contains("Energy on 16 frames of clip") && text.contains("pJ/clock"),
            "{text}"
        );
        assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    }
}

#[test]
fn a_cell_without_an_area_and_a_missing_timer_are_named() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(LIBRARY).unwrap();
    let (before, cell) = text.split_once("cell (DFFPOSX1)").unwrap();
    let no_area = cell.replacen("area : ", "other : ", 1);
    let library = format!("{before}cell (DFFPOSX1){no_area}");
    fs::write(dir.path().join("area.lib"), library).unwrap();
    let estimate = [&["estimate", "--quiet"], &SMALL[..], &["--liberty"]].concat();
    let words = "the cell `DFFPOSX1` of the library `osu018_stdcells` has no area";
    expect_failure(dir.path(), 2, &[&estimate[..], &["area.lib"]].concat(), &[words]);
    let yosys = Toolchain::system().find(Tool::Yosys).unwrap().path;
    let mut missing = foveate(&estimate);
    let output =
        missing.env("PATH", "/nowhere").env("FOVEATE_YOSYS", yosys).env_remove("FOVEATE_STA");
    let output = output.output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    let is_explained =
        message.contains("sta is not installed") && message.contains("apt-get install opensta");
    assert!(output.status.code() == Some(3) && is_explained, "{message}");
}
