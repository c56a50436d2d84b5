// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of a core on AXI, end to end: generated, simulated, its packets decoded, and with planted
//! faults.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{run_in, run_successfully};
use foveate_tools::{
    Tool, Toolchain,
    testing::{require_tools, takes_whole_lists},
};

/// Writes a small core on AXI into `core`.
fn core(folder: &Path) {
    let settings = [
        "hardware.interface=\"axi\"",
        "frame={width=64,height=48}",
        "render.irrelevant=\"mean\"",
        "denoise.filter=\"none\"",
        "spatial=[{feature=\"variance\"}]",
    ];
    let mut args = vec!["generate", "--preset", "raster", "--prefix", "cam0", "-o", "core"];
    settings.iter().for_each(|setting| args.extend(["--set", setting]));
    run_successfully(folder, &args);
}

#[test]
fn the_packets_of_a_core_on_axi_are_what_simulate_says() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    core(dir.path());
    let cosim = ["cosim", "--config", "core/design.toml", "--rtl", "core/rtl"];
    let clip = ["scene:street", "--frames", "5"];
    let text =
        run_successfully(dir.path(), &[&cosim[..], &clip, &["--end-to-end", "out"]].concat());
    assert!(
        text.contains("axi verilator:") && text.matches("values compared").count() == 3,
        "{text}"
    );
    // The nine files are five pictures, three arrays of decisions, and one array of sent means.
    assert!(text.contains("end to end: 5 frames, 9 files"), "{text}");

    let design = ["--config", "core/design.toml"];
    run_successfully(
        dir.path(),
        &[&["decode", "out/packets.bin", "-o", "seen"][..], &design].concat(),
    );
    let simulate = [&["simulate", "-o", "sim"][..], &clip, &design].concat();
    run_successfully(dir.path(), &simulate);
    let names = ["active.npy", "srs.npy", "trs.npy"].map(str::to_owned);
    let pictures = (0..5).map(|frame| format!("rendered/{frame:06}.png"));
    for name in names.into_iter().chain(pictures) {
        let [seen, sim] =
            ["seen", "sim"].map(|folder| fs::read(dir.path().join(folder).join(&name)));
        let (seen, received) = (seen.unwrap(), dir.path().join("out/received").join(&name));
        assert_eq!(seen, sim.unwrap(), "{name}");
        assert_eq!(seen, fs::read(received).unwrap(), "{name}");
    }
}

#[test]
fn edited_verilog_around_an_array_is_caught_and_replayed() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    core(dir.path());
    let path = dir.path().join("core/rtl/cam0_packet_writer.v");
    let sound = fs::read_to_string(&path).unwrap();
    fs::write(&path, sound.replace("last_o = data_last_q", "last_o = 1'b0")).unwrap();
    let cosim = ["cosim", "--config", "core/design.toml", "--rtl", "core/rtl", "--level", "axi"];
    // Waves and the replay each compile the core once more.
    let waves: &[&str] = if takes_whole_lists() { &["--trace"] } else { &[] };
    let edited = [&cosim[..], &["--junit", "cosim.xml"], waves].concat();
    let outcome = run_in(dir.path(), &edited);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    for part in ["sequence \"video\"", "m_axis_packets", "foveate-replay/replay.sh"] {
        assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    }
    let junit = fs::read_to_string(dir.path().join("cosim.xml")).unwrap();
    assert!(junit.contains("<failure") && junit.contains("m_axis_packets"), "{junit}");
    let folder = dir.path().join("foveate-replay");
    assert!(folder.join("traffic.txt").is_file());
    if takes_whole_lists() {
        assert!(folder.join("waves.fst").is_file());
        let replay = Command::new(folder.join("replay.sh")).output().unwrap();
        assert_eq!(replay.status.code(), Some(1), "it shows the same");
    }

    fs::write(&path, sound).unwrap();
    run_successfully(dir.path(), &cosim);
    assert!(!folder.exists(), "what an earlier run has left is gone");
    fs::remove_file(dir.path().join("core/rtl/cam0_rcm_axi.v")).unwrap();
    let missing = run_in(dir.path(), &cosim);
    assert!(missing.stderr.contains("no module `cam0_rcm_axi`"), "{}", missing.stderr);
}

/// Every C compiler accepts the header and the guide's use of the driver without a warning.
#[test]
fn what_the_guide_shows_of_a_core_is_c() {
    if !require_tools(&[Tool::Cxx]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let bus = "hardware.interface='axi'";
    let small = "frame={width=64,height=48}";
    let generate = ["generate", "--preset", "raster", "--set", bus, "--set", small, "-o", "core"];
    let made = run_in(dir.path(), &generate);
    assert!(made.code == 0, "{}", made.stderr);
    let guide = include_str!("../../../../docs/guides/bus.md");
    let (_, shown) = guide.split_once("```c\n").unwrap();
    let (shown, _) = shown.split_once("```").unwrap();
    let source =
        format!("#include \"foveate_registers.h\"\n{shown}\nint main(void) {{ return 0; }}\n");
    fs::write(dir.path().join("core/software/main.c"), source).unwrap();
    let compiler = Toolchain::system().find(Tool::Cxx).unwrap().path;
    let checks = [
        "-x",
        "c",
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-fsyntax-only",
        "main.c",
    ];
    let folder = dir.path().join("core/software");
    let output = Command::new(compiler).args(checks).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
