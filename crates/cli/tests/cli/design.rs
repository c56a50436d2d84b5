// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `check`, `presets`, `completions` and `generate`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{files_below, foveate, run_in, run_successfully};
use serde_json::Value;

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn check_reads_standard_input() {
    let dir = tempfile::tempdir().unwrap();
    let check = |text: &str, args: &[&str]| {
        let mut command = foveate(args);
        command.current_dir(dir.path()).write_stdin(text.to_owned());
        command.output().unwrap()
    };
    for args in [&["check", "-"][..], &["check", "--config", "-"]] {
        let found = check("[region]\nsize = 16\n", args);
        let text = String::from_utf8(found.stdout).unwrap();
        assert!(found.status.success() && text.contains("14 x 14 = 196 regions"), "{text}");
        // The text is read again for the message of an error.
        let wrong = check("[region]\nsize = 0\n", args);
        let said = String::from_utf8(wrong.stderr).unwrap();
        assert!(wrong.status.code() == Some(2) && said.contains("region.size"), "{said}");
    }
    let long = check(&"#".repeat((1 << 20) + 1), &["check", "-"]);
    let said = String::from_utf8(long.stderr).unwrap();
    assert!(said.contains("`standard input`") && said.contains("larger than 1 MiB"), "{said}");
}

#[test]
fn benches_count_what_a_periphery_sends() {
    let dir = tempfile::tempdir().unwrap();
    let fovea = ["--preset", "fovea", "--set", "frame={width=32,height=24}"];
    let json = [&["generate", "--json", "-o", "core"], &fovea[..]].concat();
    let core: Value = serde_json::from_str(&run_successfully(dir.path(), &json)).unwrap();
    for bench in core["benches"].as_array().unwrap() {
        let count = |key: &str| bench[key].as_u64().unwrap();
        assert!(0 < count("summaries") && count("summaries") < count("blank"), "{bench}");
    }
    let plain = ["generate", "--json", "-o", "plain", "--set", "frame={width=32,height=24}"];
    let core: Value = serde_json::from_str(&run_successfully(dir.path(), &plain)).unwrap();
    assert!(core["benches"][0].get("summaries").is_none());
}

#[test]
fn every_preset_is_a_file_that_check_takes() {
    let dir = tempfile::tempdir().unwrap();
    let list: Value =
        serde_json::from_str(&run_successfully(dir.path(), &["presets", "--json"])).unwrap();
    for preset in list["entries"].as_array().unwrap() {
        let name = preset["name"].as_str().unwrap();
        fs::write(dir.path().join("p.toml"), run_successfully(dir.path(), &["presets", name]))
            .unwrap();
        let from_file = run_successfully(dir.path(), &["check", "p.toml"]);
        assert_eq!(from_file, run_successfully(dir.path(), &["check", "--preset", name]), "{name}");
    }
}

/// A preset as a file has every key that a user can change, and the size of its frames if it has
/// one.
#[test]
fn every_preset_has_every_key_and_the_right_size() {
    let dir = tempfile::tempdir().unwrap();
    let values = [
        ("hardware.pipelining", "'deep'"),
        ("hardware.store", "'ultra'"),
        ("hardware.forward", "false"),
        ("hardware.pixels_per_clock", "2"),
        ("hardware.feed", "'raster'"),
        ("hardware.fold", "2"),
        ("hardware.thresholds", "'constant'"),
        ("hardware.organization", "'pipelined'"),
    ];
    for preset in foveate_design::PRESETS {
        let name = preset.name;
        let text = run_successfully(dir.path(), &["presets", name]);
        for (key, value) in values {
            let set = format!("{key}={value}");
            let is_taken = run_in(dir.path(), &["check", "-p", name, "--set", &set]).code == 0;
            let line = format!("\n{} = ", key.split_once('.').unwrap().1);
            assert!(text.contains(&line) || !is_taken, "{name} lacks {key}: {text}");
        }
        let (heading, keys) = text.split_once("\n\n").unwrap();
        let sized = keys.contains("\nwidth = 640\nheight = 480\n");
        assert_eq!(heading.contains("frames of 640 x 480 pixels"), sized, "{text}");
        assert_eq!(heading.contains("224"), !keys.contains("\nwidth = "), "{text}");
    }
}

#[test]
fn completions_name_the_commands() {
    let dir = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        assert!(run_successfully(dir.path(), &["completions", shell]).contains("cosim"));
    }
}

#[test]
fn there_is_a_manual_page_for_each_command() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &["man", "-o", "man/man1"]);
    let page = |name: &str| fs::read_to_string(dir.path().join("man/man1").join(name)).unwrap();
    let main = page("foveate.1");
    let names: Vec<&str> = main
        .lines()
        .filter_map(|line| line.strip_prefix("foveate\\-")?.strip_suffix("(1)"))
        .collect();
    assert!(names.contains(&"simulate") && names.contains(&"man"), "{main}");
    for name in &names {
        assert!(page(&format!("foveate-{name}.1")).contains(".SH SYNOPSIS"), "{name}");
    }
    assert_eq!(fs::read_dir(dir.path().join("man/man1")).unwrap().count(), names.len() + 1);
}

/// The cores are regenerated with the commands in CONTRIBUTING.md under "Change what is generated".
#[test]
fn the_committed_cores_are_not_stale() {
    let names = |files: &[(std::path::PathBuf, Vec<u8>)]| {
        files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>()
    };
    let contributing = fs::read_to_string(repository().join("CONTRIBUTING.md")).unwrap();
    let frame = ["--set", "frame.width=64", "--set", "frame.height=48"];
    let serial = [&["--preset", "serial", "--set", "hardware.fold=4"][..], &frame].concat();
    let raster = [&["--preset", "raster"][..], &frame].concat();
    for (folder, options) in
        [("paper", &["--preset", "paper"][..]), ("serial", &serial), ("raster", &raster)]
    {
        let command = format!("generate {} -o rtl/generated/{folder} --force", options.join(" "));
        assert!(contributing.contains(&command), "{command}");
        let dir = tempfile::tempdir().unwrap();
        run_successfully(dir.path(), &[&["generate", "-o", "core"], options].concat());
        let fresh = files_below(&dir.path().join("core"));
        let committed = files_below(&repository().join("rtl/generated").join(folder));
        assert_eq!(names(&fresh), names(&committed), "{folder}");
        for ((name, fresh), (_, committed)) in fresh.iter().zip(&committed) {
            let name = name.display();
            assert!(fresh == committed, "{folder}: {name} is stale; see this test's documentation");
        }
    }
}

#[test]
fn generated_folders_are_whole_or_absent() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &["generate", "-o", "a/core"]);
    run_successfully(dir.path(), &["generate", "-o", "b"]);
    assert_eq!(files_below(&dir.path().join("a/core")), files_below(&dir.path().join("b")));

    run_successfully(dir.path(), &["generate", "-o", "b", "--force", "--set", "region.size=16"]);
    assert!(fs::read_to_string(dir.path().join("b/design.toml")).unwrap().contains("size = 16"));

    let left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "nothing half-written is left: {left:?}");
}
