// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of cores with a prefix: their benches, and co-simulation that finds them.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{expect_failure, run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};

/// Writes a small core with a prefix into a folder of the same name.
fn core(folder: &Path, prefix: &str, settings: &[&str]) {
    let mut args = vec!["generate", "--preset", "bare", "--prefix", prefix, "-o", prefix];
    for setting in ["region.size=4", "frame={width=16,height=8}"].iter().chain(settings) {
        args.extend(["--set", setting]);
    }
    run_successfully(folder, &args);
}

/// Returns the command that co-simulates a folder with one round in Icarus, with more options.
fn cosim<'a>(config: &'a str, rtl: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let args =
        ["cosim", "--config", config, "--rtl", rtl, "--rounds", "1", "--simulator", "iverilog"];
    [&args[..], more].concat()
}

#[test]
fn a_core_with_a_prefix_passes_its_benches_and_cosim_without_further_options() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let organizations: [(&str, &[&str]); 2] =
        [("left", &[]), ("right", &["hardware={organization='serial',fold=2}"])];
    for (prefix, settings) in organizations {
        core(dir.path(), prefix, settings);
    }
    for (prefix, _) in sample(organizations, 2) {
        let folder = dir.path().join(prefix);
        let replay = Command::new("sh").arg("tb/replay.sh").current_dir(&folder).output().unwrap();
        let text = String::from_utf8(replay.stdout).unwrap();
        assert_eq!((replay.status.code(), text.matches(": PASS ").count()), (Some(0), 2), "{text}");
        let (config, rtl) = (format!("{prefix}/design.toml"), format!("{prefix}/rtl"));
        let text = run_successfully(dir.path(), &cosim(&config, &rtl, &[]));
        let runs = if prefix == "left" { 2 } else { 3 };
        assert_eq!(text.matches("no mismatch").count(), runs, "{text}");
        // A fault in a leaf is found, so that it is this Verilog that runs.
        let leaf = folder.join(format!("rtl/{prefix}_rcm.v"));
        let sound = fs::read_to_string(&leaf).unwrap();
        fs::write(&leaf, sound.replace(".trs_o(trs_o", ".trs_o(srs_o")).unwrap();
        assert_eq!(run_in(dir.path(), &cosim(&config, &rtl, &[])).code, 1, "{prefix}");
        fs::write(&leaf, sound).unwrap();
    }
    // With both cores in one folder, one must be chosen, and the other is reported as not
    // simulated.
    for entry in fs::read_dir(dir.path().join("right/rtl")).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, dir.path().join("left/rtl").join(path.file_name().unwrap())).unwrap();
    }
    let both = ["`left_rcm`", "`right_rcm`", "--prefix left"];
    expect_failure(dir.path(), 2, &cosim("left/design.toml", "left/rtl", &[]), &both);
    let chosen = cosim("left/design.toml", "left/rtl", &["--prefix", "left"]);
    expect_failure(dir.path(), 1, &chosen, &["not all of the Verilog", "right_rcm"]);
}
