// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `foveate build` without the tools of a device: the list of boards, the projects, the
//! difference between a slow and a missing bitstream, and the error messages.

use std::fs;

use serde_json::Value;

use crate::common::{expect_failure, foveate, run_successfully};

#[test]
fn a_project_is_written_and_a_board_of_ones_own_is_built_from_it() {
    let dir = tempfile::tempdir().unwrap();
    let made = ["build", "--board", "icesugar", "--project", "-o", "out"];
    let text = run_successfully(dir.path(), &[&made[..], &["--set", "periphery.level=9"]].concat());
    assert!(text.contains("start with README.md") && text.contains("sh build.sh"), "{text}");
    let toml = fs::read_to_string(dir.path().join("out/design.toml")).unwrap();
    assert!(toml.contains("level = 9"), "{toml}");
    expect_failure(dir.path(), 2, &made, &["`out`"]);

    // The files of the project are a start for another board with another sensor.
    let board = fs::read_to_string(dir.path().join("out/board.toml")).unwrap();
    let board = board.replace("sensor = \"hm01b0-4\"", "sensor = \"mine.toml\"");
    let sensor = fs::read_to_string(dir.path().join("out/sensor.toml")).unwrap();
    fs::create_dir(dir.path().join("own")).unwrap();
    fs::write(dir.path().join("own/here.toml"), board.replace("data = [\"34\"", "data = [\"32\""))
        .unwrap();
    fs::write(dir.path().join("own/mine.toml"), sensor.replace("4-high", "4-low")).unwrap();
    let own = ["build", "--board", "own/here.toml", "--project", "-o", "out", "--force"];
    let text = run_successfully(dir.path(), &own);
    assert!(text.contains("for here,"), "{text}");
    let read = |name: &str| fs::read_to_string(dir.path().join("out").join(name)).unwrap();
    assert!(read("board.pcf").contains("set_io sensor_data_i[0] 32"));
    assert!(read("rtl/board.v").contains(".FORMAT(4)"));
    // `cosim` takes a core of that design, too.
    assert!(read("board.f").lines().all(|path| dir.path().join("out").join(path).is_file()));

    let json =
        ["build", "--board", "vcu118", "--set", "frame={width=64,height=48}", "-o", "v", "--json"];
    let report: Value = serde_json::from_str(&run_successfully(dir.path(), &json)).unwrap();
    assert_eq!((&report["board"], report.get("bitstream")), (&"vcu118".into(), None));
    assert!(dir.path().join("v/build.tcl").is_file());

    // A preset replaces the board's design; here it is an array, with keys of its own.
    let array = [
        "build",
        "--board",
        "vcu118",
        "--preset",
        "paper",
        "--set",
        "frame={width=32,height=16}",
        "-o",
        "array",
    ];
    let text = run_successfully(dir.path(), &array);
    assert!(text.contains("32 x 16 pixels") && text.contains("vivado -mode batch"), "{text}");
    let top = fs::read_to_string(dir.path().join("array/rtl/board.v")).unwrap();
    assert!(top.contains("localparam COLUMNS = 4;"), "{top}");
}

/// A bitstream that is too slow exists and is a failed check. A tool that fails is another case.
#[cfg(unix)]
#[test]
fn a_slow_bitstream_is_no_failure_of_a_tool() {
    use std::os::unix::fs::PermissionsExt as _;
    let dir = tempfile::tempdir().unwrap();
    let tool = |name: &str, script: &str| {
        let path = dir.path().join(name);
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    };
    let place = "echo \"Info: Max frequency for clock 'clk': 20.00 MHz (FAIL at 24.00 MHz)\"\n\
                 echo \"Info: Max frequency for clock 'sensor_pclk_i': 60.00 MHz\"\n\
                 while [ $# -gt 0 ]; do case $1 in --report | --asc) echo {} >\"$2\" ;; esac; shift; done";
    let (fine, place) = (tool("fine", "exit 0"), tool("place", place));
    let run = |pack: &std::path::Path, more: &[&str]| {
        let args = [&["build", "--board", "icebreaker", "-o", "out", "--force"], more].concat();
        let mut command = foveate(&args);
        command.current_dir(dir.path()).env("YOSYS", &fine).env("NEXTPNR", &place);
        let output = command.env("PACK", pack).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    let pack = tool("pack", "for last; do :; done; echo bits >\"$last\"");
    let (code, told, said) = run(&pack, &["--seeds", "2"]);
    assert!(
        code == Some(1) && said.contains("too slow, so `out/icebreaker.bin`"),
        "{code:?} {said}"
    );
    assert!(told.contains("core    20.0 MHz (slowest of 2 seeds 20.0), needs 24"), "{told}");
    let (code, told, _) = run(&pack, &["--json"]);
    let report: Value = serde_json::from_str(&told).unwrap();
    assert_eq!((code, &report["packed_mhz"]), (Some(1), &serde_json::json!(20.0)));

    let (code, told, said) = run(&tool("torn", "exit 1"), &[]);
    assert!(code == Some(3) && told.is_empty() && said.contains("torn failed"), "{code:?} {said}");
}
