// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `check`, `presets`, `completions` and `generate`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, files_below, foveate, run_in, run_successfully};
use serde_json::Value;

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn check_prints_the_card_as_text_and_json() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("camera.toml"), "[region]\nsize = 16\n").unwrap();
    let text = run_successfully(dir.path(), &["check", "camera.toml"]);
    for part in ["14 x 14 = 196 regions of 16x16", "cycles per frame  256", "edge_score_o"] {
        assert!(text.contains(part), "{text}");
    }
    let json = run_successfully(dir.path(), &["check", "--config", "camera.toml", "--json"]);
    let card: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(card["format_version"], 2);
    assert_eq!(card["grid"]["regions"], 196);
    assert_eq!(card["timing"]["cycles_per_frame"], 256);
    assert_eq!(card["rcm_ports"].as_array().unwrap().len(), 16);
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
    // A configuration would leave nothing for frames or packets.
    for command in ["simulate", "decode", "link"] {
        let twice = check("", &[command, "--config", "-", "-", "-o", "out"]);
        let said = String::from_utf8(twice.stderr).unwrap();
        let is_refused = twice.status.code() == Some(2)
            && said.contains("`--config -` and `-` exclude each other");
        assert!(is_refused && said.contains(command), "{said}");
    }
}

/// The card of every organization shows what irrelevant regions send, and benches count it.
#[test]
fn a_periphery_is_checked_and_generated() {
    let dir = tempfile::tempdir().unwrap();
    let fovea = ["--preset", "fovea", "--set", "frame={width=32,height=24}"];
    let text = run_successfully(dir.path(), &[&["check"], &fovea[..]].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = "periphery the means of 2x2 blocks of 4x4 pixels where SRS is 0, sent again when one differs by more than 1";
    assert!(words.contains(line), "{text}");
    assert!(!run_successfully(dir.path(), &["check"]).contains("periphery"));

    let json = [&["generate", "--json", "-o", "core"], &fovea[..]].concat();
    let core: Value = serde_json::from_str(&run_successfully(dir.path(), &json)).unwrap();
    for bench in core["benches"].as_array().unwrap() {
        let count = |key: &str| bench[key].as_u64().unwrap();
        assert!(0 < count("summaries") && count("summaries") < count("blank"), "{bench}");
    }
    let plain = ["generate", "--json", "-o", "plain", "--set", "frame={width=32,height=24}"];
    let core: Value = serde_json::from_str(&run_successfully(dir.path(), &plain)).unwrap();
    assert!(core["benches"][0].get("summaries").is_none());

    for organization in ["serial", "raster"] {
        let key = format!("hardware.organization=\"{organization}\"");
        let asked = [&["check", "--set", &key], &fovea[..]].concat();
        assert!(run_successfully(dir.path(), &asked).contains("periphery"), "{organization}");
    }
}

#[test]
fn check_tells_how_fast_each_organization_is() {
    let dir = tempfile::tempdir().unwrap();
    let check = |args: &[&str]| run_successfully(dir.path(), &[&["check"], args].concat());
    let json = |args: &[&str]| -> Value {
        serde_json::from_str(&check(&[args, &["--json"]].concat())).unwrap()
    };
    assert!(check(&["--clock", "250MHz"]).contains("3906250 frames/s at 250 MHz"));
    let card = json(&["--clock", "64kHz"]);
    assert_eq!(
        (&card["rate"]["clock_hz"], &card["rate"]["frames_per_second"]),
        (&64_000.into(), &1000.0.into())
    );
    for absent in ["array", "proposal", "needs"] {
        assert!(card.get(absent).is_none(), "{absent}");
    }

    let text = check(&["--preset", "serial", "--clock", "250MHz"]);
    for part in [
        "784, 1 region each, parallel feed",
        "128 words of 8 bits, 128 per slot for raw 8x8",
        "7905: 64 to take the frame, 7840 steps, 1 between",
        "31625 frames/s at 250 MHz",
        "ready_o",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let text = check(&["--preset", "raster", "--set", "hardware.pixels_per_clock=2"]);
    for part in [
        "raster, 2 pixels per clock, plain",
        "the frame row by row, a word of 2 pixels per clock",
        " of them references",
        "lost_count_o",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains("pixels per region"), "no streams of regions: {text}");
    let card = json(&["--preset", "serial", "--set", "hardware.fold=4"]);
    assert_eq!(
        (&card["array"]["lanes"], &card["array"]["memory"]["words"]),
        (&196.into(), &512.into())
    );
    assert_eq!(card["timing"]["phases"].as_array().unwrap().len(), 5);
}

/// A frame rate depends on a clock, and a check without `--clock` knows none.
#[test]
fn check_without_a_clock_says_which_one_a_rate_needs() {
    let dir = tempfile::tempdir().unwrap();
    let check = |args: &[&str]| run_successfully(dir.path(), &[&["check"], args].concat());
    let text = check(&["--preset", "serial"]);
    assert!(text.contains("7905 clocks per frame; 1000 frames/s need a clock of 7.905 MHz\n"));
    assert!(!text.contains("frames/s at") && !text.contains("proposal"), "{text}");
    let asked = ["--preset", "bare", "--min-fps", "29.97"];
    // 64 clocks times 29.97 are 1,918.08 clocks.
    let text = check(&asked).split_whitespace().collect::<Vec<_>>().join(" ");
    let line = "29.97 frames/s need a clock of 1.919 kHz. `foveate estimate` says whether";
    assert!(text.contains(line), "{text}");
    let json = check(&[&asked[..], &["--json"]].concat());
    let card: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(card["needs"], serde_json::json!({"frames_per_second": 29.97, "clock_hz": 1919}));
    assert!(card.get("rate").is_none() && card.get("proposal").is_none());
    // The exit code alone would have no meaning.
    expect_failure(dir.path(), 2, &[&["check", "--quiet"], &asked[..]].concat(), &["give --clock"]);
    let given = [&["check", "--quiet", "--clock", "2kHz"], &asked[..]].concat();
    assert_eq!(run_successfully(dir.path(), &given), "");
}

#[test]
fn check_proposes_the_largest_fold_that_reaches_a_rate() {
    let dir = tempfile::tempdir().unwrap();
    let ask =
        |fps| ["check", "--preset", "serial", "--min-fps", fps, "--clock", "250MHz", "--json"];
    let card: Value = serde_json::from_str(&run_successfully(dir.path(), &ask("1000"))).unwrap();
    let proposal = &card["proposal"];
    assert_eq!((&proposal["reached"], &proposal["lanes"]), (&true.into(), &21.into()));
    assert_eq!((&proposal["fold"], &proposal["cycles_per_frame"]), (&38.into(), &244797.into()));
    let text = run_successfully(dir.path(), &ask("1000")[..7]);
    assert!(text.contains("fold 38 for 1000 frames/s: 21 lanes"), "{text}");
    // The design itself reaches 250 MHz / 7905 = 31,625.5 frames per second, and no fold is faster.
    let none = ["no fold reaches 31626 frames/s", "fold 1 is the fastest", "7905 clocks per frame"];
    expect_failure(dir.path(), 1, &ask("31626")[..7], &none);
    run_successfully(dir.path(), &ask("31625.5"));
    // A pipelined design reaches 250 MHz / 64 = 3,906,250 frames per second.
    let pipelined = |rate| ["check", "--preset", "bare", "--clock", "250MHz", "--min-fps", rate];
    let text = run_successfully(dir.path(), &pipelined("3906250"));
    assert!(text.contains("3906250 frames/s are reached: 64 clocks per frame"), "{text}");
    let slow = ["3906251 frames/s are not reached", "3906250 frames/s at 250 MHz", "faster clock"];
    expect_failure(dir.path(), 1, &pipelined("3906251"), &slow);
    let json = run_successfully(dir.path(), &[&pipelined("1000")[..], &["--json"]].concat());
    let card: Value = serde_json::from_str(&json).unwrap();
    let proposal = &card["proposal"];
    assert_eq!((&proposal["reached"], &proposal["fold"]), (&true.into(), &1.into()));
    for args in [["--clock", "fast"], ["--min-fps", "0"]] {
        assert_eq!(run_in(dir.path(), &[&["check"], &args[..]].concat()).code, 2, "{args:?}");
    }
}

#[test]
fn wrong_configurations_end_with_2_and_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    write("unknown.toml", "[region]\nsiez = 8\n");
    write("type.toml", "[region]\nsize = \"big\"\n");
    write("range.toml", "[region]\nsize = 65\n");
    write("syntax.toml", "[region\n");
    write("clash.toml", "[[spatial]]\nfeature = \"mad\"\nlevel = 3\n");
    let fail = |args: &[&str], parts: &[&str]| expect_failure(dir.path(), 2, args, parts);
    fail(&["check", "unknown.toml"], &["unknown.toml", "`region.siez`", "`region.size`"]);
    fail(&["check", "type.toml"], &["type.toml", "`region.size`", "a whole number, 2..=64"]);
    fail(&["check", "range.toml"], &["`region.size` = 65", "2..=64"]);
    fail(&["check", "syntax.toml"], &["syntax.toml", "not valid TOML", "line 1"]);
    fail(&["check", "clash.toml"], &["`spatial[0].level` = 3", "leave the key out"]);
    fail(&["check", "missing.toml"], &["missing.toml", "No such file"]);
    fail(&["check", "--preset", "papre"], &["`papre`", "paper"]);
    fail(&["check", "--set", "region.size"], &["--set region.size", "KEY=VALUE"]);
    fail(&["check", "--set", "hardware.fold=2"], &["`hardware.fold` = 2", "use 1"]);
    fail(
        &["check", "--set", "zones.areas=[]", "--set", "zones.areas.0.class=off"],
        &["`0` is not an index into `zones.areas`"],
    );
    fail(&["generate", "--set", "region.size=1", "-o", "core"], &["2..=64"]);
    assert!(!dir.path().join("core").exists());
}

#[test]
fn usage_errors_end_with_2() {
    let dir = tempfile::tempdir().unwrap();
    for args in [&["frobnicate"][..], &["generate"], &["cosim", "--grid", "0x3"], &["simulate"]] {
        assert_eq!(run_in(dir.path(), args).code, 2, "{args:?}");
    }
    expect_failure(dir.path(), 2, &["cosim", "--grid", "2x2"], &["--level rcm"]);
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
    assert!(run_successfully(dir.path(), &["presets", "--scenes"]).contains("street"));
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
fn check_names_the_organization() {
    let dir = tempfile::tempdir().unwrap();
    for (preset, words) in [
        ("paper", "organization      pipelined\n"),
        ("serial", "organization      serial, parallel feed, fold 1\n"),
        ("raster", "organization      raster, 1 pixel per clock, plain pipelining, block store,\n"),
    ] {
        let text = run_successfully(dir.path(), &["check", "--preset", preset]);
        assert!(text.contains(words), "{text}");
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
    fs::write(dir.path().join("file"), "").unwrap();
    expect_failure(dir.path(), 2, &["man", "-o", "file"], &["cannot make the folder `file`"]);
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

    expect_failure(dir.path(), 2, &["generate", "-o", "b"], &["`b`", "--force"]);
    run_successfully(dir.path(), &["generate", "-o", "b", "--force", "--set", "region.size=16"]);
    assert!(fs::read_to_string(dir.path().join("b/design.toml")).unwrap().contains("size = 16"));

    fs::create_dir(dir.path().join("mine")).unwrap();
    fs::write(dir.path().join("mine/thesis.tex"), "years of work").unwrap();
    expect_failure(dir.path(), 2, &["generate", "-o", "mine", "--force"], &["`mine`"]);
    assert_eq!(files_below(&dir.path().join("mine")).len(), 1);
    expect_failure(
        dir.path(),
        2,
        &["generate", "-o", "mine/thesis.tex/core"],
        &["mine/thesis.tex"],
    );
    let left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "nothing half-written is left: {left:?}");
}
