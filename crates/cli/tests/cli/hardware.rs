// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `cosim` and `estimate`, end to end, with the tools and without.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{expect_failure, foveate, run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{data_folder, require_tools, sampling_step, takes_whole_lists},
};
use serde_json::Value;

const SIMULATORS: &[Tool] = &[Tool::Verilator, Tool::Cxx, Tool::Iverilog, Tool::Vvp];

fn edit(file: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(file).unwrap();
    assert_eq!(text.matches(from).count(), 1, "{from}");
    fs::write(file, text.replace(from, to)).unwrap();
}

#[test]
fn model_and_rtl_agree_in_both_simulators() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for simulator in ["verilator", "iverilog"] {
        let args =
            ["cosim", "scene:street", "--preset", "bare", "--simulator", simulator, "--json"];
        let rounds: &[&str] = if takes_whole_lists() { &[] } else { &["--rounds", "1"] };
        let args = [&args[..], rounds].concat();
        let summary: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
        assert_eq!((&summary["format_version"], &summary["passed"]), (&2.into(), &true.into()));
        let report = &summary["runs"][0];
        assert!(report["mismatch"].is_null());
        assert!(report["comparisons"].as_u64().unwrap() > 100_000);
        assert_eq!(report["rtl_sha256"].as_str().unwrap().len(), 64);
    }
    let text = run_successfully(
        dir.path(),
        &["cosim", "--level", "rcm", "--grid", "3x2", "--simulator", "iverilog"],
    );
    assert!(text.contains("no mismatch") && text.contains("3 x 2 regions"), "{text}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "a good run leaves nothing");
}

/// This test uses every region of real images, if the environment variable FOVEATE_DATA names their
/// folder.
#[test]
fn real_images_agree() {
    let Some(data) = data_folder() else { return };
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let folder = data.join("mosquito/culex");
    let args = ["cosim", folder.to_str().unwrap(), "--rounds", "0", "--json"];
    let summary: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
    let report = &summary["runs"][0];
    assert!(report["mismatch"].is_null());
    assert_eq!((&report["sequences"], &report["frames"]), (&784.into(), &(2 * 784).into()));
}

#[test]
fn edited_verilog_is_caught_and_replayed() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let args = ["generate", "--preset", "bare", "-o", "core"];
    run_successfully(dir.path(), &args);
    let cosim = |extra: &[&str]| {
        let args = ["cosim", "--config", "core/design.toml", "--rtl", "core/rtl"];
        run_in(dir.path(), &[&args[..], extra].concat())
    };
    assert_eq!(cosim(&["--simulator", "iverilog"]).code, 0);
    let array = cosim(&["--simulator", "iverilog", "--level", "rcm", "--grid", "3x1"]);
    assert_eq!(array.code, 0, "the array takes any grid: {}", array.stderr);

    edit(&dir.path().join("core/rtl/vote.v"), "score_i >= minimum_i", "score_i > minimum_i");
    let outcome = cosim(&["--junit", "cosim.xml"]);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    for part in
        ["mismatch", "trs_o is 'h0, expected 'h1", "replay it with foveate-replay/replay.sh"]
    {
        assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    }
    let junit = fs::read_to_string(dir.path().join("cosim.xml")).unwrap();
    assert!(junit.contains("<failure") && junit.contains("trs_o"), "{junit}");
    let replay = Command::new(dir.path().join("foveate-replay/replay.sh")).output().unwrap();
    let printed = String::from_utf8(replay.stdout).unwrap();
    assert_eq!(replay.status.code(), Some(1), "{printed}");
    assert!(printed.contains("port trs_o"), "{printed}");
}

/// The command without options finds a fault of the array alone, in both organizations. A file that
/// no simulation reaches is named, and the command does not pass.
#[test]
fn the_whole_folder_is_simulated() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (organization, from, to) in [
        ("pipelined", "pixel_i[REGION*8+:8]", "pixel_i[(REGION^1)*8+:8]"),
        ("serial", ".pixel_i(pixel_i),", ".pixel_i(~pixel_i),"),
    ]
    .into_iter()
    .step_by(sampling_step(2))
    {
        let core = format!("core-{organization}");
        let organization = format!("hardware.organization=\"{organization}\"");
        let frame = "frame={width=20,height=16}";
        let design =
            ["--preset", "bare", "--set", "region.size=4", "--set", frame, "--set", &organization];
        run_successfully(dir.path(), &[&["generate", "-o", &core][..], &design].concat());
        let (toml, rtl) = (format!("{core}/design.toml"), format!("{core}/rtl"));
        let cosim = |extra: &[&str]| {
            let args = ["cosim", "--config", &toml, "--rtl", &rtl, "--simulator", "iverilog"];
            run_in(dir.path(), &[&args[..], &["--rounds", "1", "--json"], extra].concat())
        };
        let json = |text: &str| serde_json::from_str::<Value>(text).unwrap();

        let sound = cosim(&[]);
        assert_eq!(sound.code, 0, "{}", sound.stderr);
        let sound = json(&sound.stdout);
        let names = [&sound["runs"][0]["name"], &sound["runs"][1]["name"]];
        assert_eq!(names, ["rpu iverilog", "rcm 3x2 iverilog"]);
        assert_eq!(sound["not_simulated"], serde_json::json!([]));
        assert_eq!(sound["not_elaborated"], serde_json::json!([]));
        // An array of equal RPUs is read, but not simulated as a whole.
        let whole = organization.contains("serial").then_some("full iverilog");
        assert_eq!(sound["runs"][2]["name"].as_str(), whole);
        let readme = fs::read_to_string(dir.path().join(&core).join("README.md")).unwrap();
        for run in sound["runs"].as_array().unwrap() {
            assert!(readme.contains(run["design"].as_str().unwrap()), "{run}\n{readme}");
        }

        let spare = dir.path().join(&rtl).join("spare.v");
        fs::write(&spare, "module spare; endmodule\n").unwrap();
        let incomplete = cosim(&["--junit", "spare.xml"]);
        assert_eq!(incomplete.code, 1, "{}", incomplete.stdout);
        assert!(incomplete.stderr.contains("rtl/spare.v (module spare)"), "{}", incomplete.stderr);
        let summary = json(&incomplete.stdout);
        assert_eq!(summary["passed"], false);
        assert_eq!(summary["not_simulated"][0]["file"], "rtl/spare.v");
        let junit = fs::read_to_string(dir.path().join("spare.xml")).unwrap();
        assert!(junit.contains("failures=\"1\"") && junit.contains("spare.v"), "{junit}");
        let part = cosim(&["--level", "rpu"]);
        assert_eq!(part.code, 0, "a part was asked for: {}", part.stderr);
        let part = json(&part.stdout);
        let files: Vec<_> = part["not_simulated"].as_array().unwrap().iter().collect();
        assert_eq!(files.len(), 2, "the array and the spare file: {files:?}");
        fs::remove_file(spare).unwrap();

        edit(&dir.path().join(&rtl).join("rcm.v"), from, to);
        let broken = cosim(&[]);
        assert_eq!(broken.code, 1, "{}", broken.stderr);
        let broken = json(&broken.stdout);
        assert!(broken["runs"][0]["mismatch"].is_null(), "{broken}");
        assert!(!broken["runs"][1]["mismatch"].is_null(), "{broken}");
    }
}

/// Broken Verilog is refused by the tool and is no mismatch. Files of another design are bad input.
#[test]
fn verilog_that_does_not_fit_is_refused() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &["generate", "--preset", "bare", "-o", "core"]);
    let other = ["cosim", "--preset", "mad", "--rtl", "core/rtl", "--simulator", "iverilog"];
    expect_failure(dir.path(), 2, &other, &["mad_min_i"]);
    edit(&dir.path().join("core/rtl/vote.v"), "assign vote_o", "asign vote_o");
    let same = ["cosim", "--preset", "bare", "--rtl", "core/rtl"];
    let outcome = run_in(dir.path(), &same);
    assert_eq!(outcome.code, 3);
    assert!(outcome.stderr.contains("vote.v"), "{}", outcome.stderr);
    assert_eq!(run_in(dir.path(), &[&same[..], &["--junit", "cosim.xml"]].concat()).code, 3);
    let junit = fs::read_to_string(dir.path().join("cosim.xml")).unwrap();
    assert!(junit.contains("<error") && junit.contains("vote.v"), "{junit}");
}

/// File names appear in scripts of Yosys, which runs the text behind a `;` or a `!`.
#[test]
fn names_of_verilog_that_a_script_would_run_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let canary = dir.path().join("canary");
    run_successfully(dir.path(), &["generate", "--preset", "bare", "-o", "core"]);
    let rtl = dir.path().join("core/rtl");
    fs::write(rtl.join("a.v"), "module a; endmodule\n").unwrap();
    for name in [
        "a.v; exec -- touch $CANARY; #.v",
        "a.v\n!touch $CANARY\n#.v",
        "$(touch $CANARY).v",
        "-f.v",
        "\u{1b}[2J.v",
    ] {
        let file = rtl.join(name);
        fs::write(&file, "module b; endmodule\n").unwrap();
        for more in [&["--netlist"][..], &[]] {
            let args = ["cosim", "--preset", "bare", "--rtl", "core/rtl", "--level", "rcm"];
            let output = foveate(&[&args[..], more].concat())
                .current_dir(dir.path())
                .env("CANARY", &canary)
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{name}: {said}");
            assert!(said.contains("source name") && said.contains("--rtl"), "{name}: {said}");
            assert!(
                !said.contains(['\u{1b}', '\n']) || said.trim_end().lines().count() == 1,
                "{said:?}"
            );
        }
        assert!(!canary.exists(), "{name} was run");
        fs::remove_file(file).unwrap();
    }
}

/// An interrupt stops the compiler, too, and leaves no folder behind.
#[cfg(unix)]
#[test]
fn ctrl_c_stops_a_build() {
    if !require_tools(SIMULATORS) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let temporary = dir.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    let mut child = crate::common::foveate_with_signals()
        .args(["cosim", "--full", "--rounds", "0", "scene:street"])
        .current_dir(dir.path())
        .env("FOVEATE_CACHE", "off")
        .env("TMPDIR", &temporary)
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(2));
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let left: Vec<_> = fs::read_dir(&temporary).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
#[ignore = "the array of the paper is synthesized; scripts/release.sh whole runs it"]
fn the_area_is_beside_the_papers() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    if takes_whole_lists() {
        let text = run_successfully(dir.path(), &["estimate", "--preset", "bare", "--modules"]);
        assert!(text.lines().all(|line| line.len() <= 80), "{text}");
        for part in ["Yosys estimate (Yosys ", "143,472", "edge_detector"] {
            assert!(text.contains(part), "{text}");
        }
        // The answer comes first.
        assert!(text.find("RCM, paper") < text.find("each synthesized apart"), "{text}");
    }
    let json = run_successfully(dir.path(), &["estimate", "--preset", "bare", "--json"]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&report["format_version"], &report["regions"]), (&1.into(), &784.into()));
    // The paper has 183 LUTs, of which 16 are memory, and 90 flip-flops. A pair of SRL16 shares a
    // LUT.
    let rpu = &report["rpu"];
    assert!(rpu["lut_total_packed"].as_u64().unwrap() <= 183, "{rpu}");
    assert!(rpu["lut_memory_packed"].as_u64().unwrap() <= 16, "{rpu}");
    assert!(rpu["ff"].as_u64().unwrap() <= 90, "{rpu}");
}

/// The report has one core for all regions, its modules with the numbers of the design, and the
/// memory of the frame store as a row of its own.
#[test]
#[ignore = "a core is synthesized; scripts/release.sh whole runs it"]
fn the_area_of_a_raster_core_is_no_rpus() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let frame = "frame={width=128,height=72}";
    let design = ["--preset", "bare", "--set", "hardware.organization='raster'", "--set", frame];
    let text = run_successfully(dir.path(), &[&["estimate"], &design[..]].concat());
    for (part, is_there) in [
        ("Area of 144 regions, one core for all", true),
        ("\ncore ", true),
        ("RPU", false),
        ("paper", false),
        // The last two rows are for cores on AXI only.
        ("AXI", false),
        ("\nregisters ", false),
    ] {
        assert_eq!(text.contains(part), is_there, "{part}: {text}");
    }
    let json = run_successfully(dir.path(), &[&["estimate", "--json"], &design[..]].concat());
    let report: Value = serde_json::from_str(&json).unwrap();
    let leaves = report["leaves"].as_array().unwrap();
    let has = |leaf: &Value, parameter: &str| {
        leaf["parameters"].as_array().unwrap().contains(&Value::from(parameter))
    };
    // 128 x 72 words of 8 bits take more than two blocks of 36 Kbit; half a block counts as 1 here.
    let store: Vec<_> = leaves.iter().filter(|leaf| has(leaf, "WORDS=9216")).collect();
    let blocks = |leaf: &Value| leaf["area"]["bram18"].as_u64().unwrap();
    let memory = store.iter().find(|leaf| leaf["module"] == "raster_memory").unwrap();
    assert!(blocks(memory) >= 5 && blocks(memory) < report["rcm"]["bram18"].as_u64().unwrap());
    assert_eq!((&report["unit"], &report["units"]), (&"core".into(), &1.into()));
}

/// The area is that of the RTL that was tested, and the counted netlist is the simulated one.
#[test]
#[ignore = "two netlists and two simulators are made; scripts/release.sh whole runs it"]
fn estimate_and_cosim_are_about_the_same_rtl() {
    if !require_tools(SIMULATORS) || !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let json = |command: &[&str]| -> Value {
        let design =
            ["--preset", "bare", "--set", "region.size=4", "--set", "frame={width=8,height=4}"];
        let args = [command, &design[..], &["--json"]].concat();
        serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap()
    };
    let area = json(&["estimate"]);
    let rpu = &json(&["cosim", "--rounds", "1", "--netlist"])["runs"][0];
    let array = &json(&["cosim", "--full", "--simulator", "iverilog"])["runs"][0];
    assert_eq!(rpu["name"], "rpu netlist iverilog");
    assert_eq!(rpu["netlist"]["tool"], area["tool"]);
    assert_eq!(rpu["rtl_sha256"], area["rpu_sha256"]);
    assert_eq!(array["rtl_sha256"], area["rtl_sha256"]);
    assert!(area["paths"]["rcm"]["levels"].as_u64() >= area["paths"]["rpu"]["levels"].as_u64());
}

/// The test places one small core on a device of each family. Its longest path is printed with the
/// names of the source.
#[test]
fn a_small_core_is_placed_and_routed() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrEcp5, Tool::NextpnrIce40]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let small = ["--preset", "bare", "--set", "region.size=4", "--set", "frame={width=8,height=4}"];
    let place = ["estimate", "--place-and-route", "ecp5-25k,hx8k", "--seeds", "2"];
    let text = run_successfully(dir.path(), &[&place[..], &small[..]].concat());
    assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    let json = run_successfully(dir.path(), &[&place[..], &small[..], &["--json"]].concat());
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["top"], "rpu");
    for (device, available) in [(0, 24_288), (1, 7_680)] {
        let placed = &report["devices"][device]["placed"];
        assert_eq!(placed["logic"]["available"], available);
        assert!(placed["ff"]["used"].as_u64().unwrap() > 20, "{placed}");
        let fmax = &placed["fmax"];
        assert_eq!(fmax["seeds_mhz"].as_array().unwrap().len(), 2);
        assert!(fmax["min_mhz"].as_f64() <= fmax["median_mhz"].as_f64(), "{fmax}");
        assert!(fmax["median_mhz"].as_f64() > Some(20.0), "{fmax}");
        let path = &placed["critical"];
        for end in ["from", "to"] {
            let [module, name] = ["module", "name"].map(|key| path[end][key].as_str().unwrap());
            assert!(!name.contains('$') && !name.contains("_LUT4_"), "{path}");
            let file = format!("{}/../../rtl/{module}.v", env!("CARGO_MANIFEST_DIR"));
            assert!(module == "rpu" || fs::exists(file).unwrap(), "{path}");
        }
        let [ns, wires] = ["ns", "wire_ns"].map(|key| path[key].as_f64().unwrap());
        assert!(0.0 < wires && wires < ns, "{path}");
    }
}

/// One line names the resources of which the device has too few, and the exit code says that the
/// core does not fit.
#[test]
fn a_core_that_does_not_fit_says_what_is_over() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrIce40]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let place = ["estimate", "--place-and-route", "hx1k", "--preset", "bare", "--json"];
    let outcome = run_in(dir.path(), &place);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    let report: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(report["devices"][0]["placed"], Value::Null);
    let over = &report["devices"][0]["over"][0];
    assert_eq!(
        (&over["place"], &over["available"]),
        (&"ICESTORM_LC".into(), &1280.into()),
        "{report}"
    );
    let message = outcome.stderr;
    assert!(message.contains("it does not fit hx1k: ICESTORM_LC "), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
}
