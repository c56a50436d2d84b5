// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that files of others survive every command that writes a folder or a file. The list of
//! commands is compared with the help of the program, so that a new command must be added here.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::{foveate, run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{require_tools, takes_whole_lists},
};

/// Returns every option of every command with this value name, as `command --option`.
pub(crate) fn options_of(value: &str) -> BTreeSet<String> {
    let help = |args: &[&str]| {
        let output = foveate(args).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let commands = help(&["--help"]);
    let (_, commands) = commands.split_once("Commands:\n").unwrap();
    let names = commands.lines().take_while(|line| !line.is_empty());
    let names = names.filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    let mut found = BTreeSet::new();
    for name in names.filter(|&name| name != "help") {
        for line in help(&[name, "--help"]).lines() {
            let option = line.trim_start().split_once(&format!(" <{value}>"));
            let option = option.and_then(|(option, _)| option.rsplit(", ").next());
            let is_option = |option: &&str| option.starts_with("--") && !option.contains(' ');
            found.extend(option.filter(is_option).map(|option| format!("{name} {option}")));
        }
    }
    found
}

/// A command that writes the folder `out`.
struct FolderWriter {
    option: &'static str,
    command: &'static [&'static str],
    /// A file that the command writes and that a user may edit; `None` for pages that are replaced
    /// by their names, as the help says.
    edited: Option<&'static str>,
    tools: &'static [Tool],
}

const fn folder_writer(
    option: &'static str,
    command: &'static [&'static str],
    edited: &'static str,
) -> FolderWriter {
    FolderWriter { option, command, edited: Some(edited), tools: &[] }
}

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");

const WRITERS: [FolderWriter; 12] = [
    folder_writer("generate --output", &["generate", "-o", "out"], "rtl/vote.v"),
    folder_writer(
        "build --output",
        &["build", "--board", "icebreaker", "--project", "-o", "out"],
        "board.pcf",
    ),
    folder_writer(
        "simulate --output",
        &["simulate", "scene:street", "--frames", "2", "-o", "out"],
        "frames.csv",
    ),
    folder_writer("dataset --output", &["dataset", "pets", "-o", "out"], "images.csv"),
    folder_writer("decode --output", &["decode", "sent/packets.bin", "-o", "out"], "frames.csv"),
    folder_writer(
        "analyze --output",
        &["analyze", "temporal", "scene:street", "--frames", "3", "-o", "out"],
        "temporal.csv",
    ),
    folder_writer(
        "explore --output",
        &["explore", "space.toml", "scene:street", "--max-frames", "3", "--no-area", "-o", "out"],
        "points.csv",
    ),
    folder_writer(
        "infer --output",
        &["infer", DENOISER, "scene:street", "--max-frames", "2", "-o", "out"],
        "frames.csv",
    ),
    FolderWriter {
        tools: &[Tool::Ffmpeg],
        ..folder_writer(
            "link --output",
            &["link", "scene:street", "--max-frames", "3", "--codecs", "mjpeg", "-o", "out"],
            "link.csv",
        )
    },
    FolderWriter { edited: None, ..folder_writer("man --output", &["man", "-o", "out"], "") },
    FolderWriter {
        tools: &[Tool::Iverilog, Tool::Vvp],
        ..folder_writer(
            "cosim --replay",
            &[
                "cosim",
                "--config",
                "core/design.toml",
                "--rtl",
                "core/rtl",
                "--level",
                "rpu",
                "--rounds",
                "1",
                "--simulator",
                "iverilog",
                "--replay",
                "out",
            ],
            "rtl/vote.v",
        )
    },
    FolderWriter {
        tools: &[Tool::Verilator, Tool::Cxx],
        ..folder_writer(
            "cosim --end-to-end",
            &[
                "cosim",
                "--config",
                "axi.toml",
                "scene:street",
                "--frames",
                "2",
                "--rounds",
                "0",
                "--level",
                "axi",
                "--end-to-end",
                "out",
            ],
            "simulated/frames.csv",
        )
    },
];

/// The options with folders that are only read.
const READ_ONLY_FOLDERS: [&str; 1] = ["cosim --rtl"];

/// Writes all files that the commands read.
fn prepare(dir: &Path) {
    let pets = dir.join("pets/cat");
    fs::create_dir_all(&pets).unwrap();
    fs::write(pets.join("1.pgm"), [b"P5 8 8 255\n".to_vec(), vec![9; 64]].concat()).unwrap();
    fs::write(dir.join("space.toml"), "[vary]\n\"region.size\" = [8, 16]\n").unwrap();
    let sent = ["simulate", "scene:street", "--frames", "2", "--packets", "-o", "sent"];
    run_successfully(dir, &sent);
    let axi = "frame={width=64,height=48}\nhardware={organization='raster',sync=true,interface='axi'}\n\
               spatial=[{feature='variance'}]\ndenoise={filter='none'}\n";
    fs::write(dir.join("axi.toml"), axi).unwrap();
    run_successfully(dir, &["generate", "--preset", "bare", "-o", "core"]);
    let broken = dir.join("core/rtl/vote.v");
    let text = fs::read_to_string(&broken).unwrap();
    fs::write(&broken, text.replace("score_i >= minimum_i", "score_i > minimum_i")).unwrap();
}

#[test]
fn every_command_that_writes_a_folder_is_looked_at() {
    let known = WRITERS.iter().map(|writer| writer.option).chain(READ_ONLY_FOLDERS);
    assert_eq!(options_of("DIR"), known.map(str::to_owned).collect());
}

/// Files of others in the folder, and edited files, survive each command, with `--force` and
/// without.
#[test]
fn files_of_others_survive_every_command() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path());
    let out = dir.path().join("out");
    for FolderWriter { option, command, edited, tools } in WRITERS {
        if !require_tools(tools) {
            continue;
        }
        let forced = [command, &["--force"]].concat();
        let has_force = run_in(dir.path(), &[command[0], "--help"]).stdout.contains("--force");
        let commands = if has_force { vec![command, &forced] } else { vec![command] };
        // The folder was not written by Foveate, but has names that Foveate uses.
        fs::create_dir(&out).unwrap();
        let names = [
            "thesis.tex",
            "replay.sh",
            "waves.fst",
            "summary.json",
            "exploration.json",
            "packets.bin",
            "link.json",
            "inference.json",
            "board.f",
            "foveate_rcm.core",
            "simulated",
            "designs",
        ];
        for name in names {
            fs::write(out.join(name), "mine").unwrap();
        }
        let survives = |names: &[&str], when: &str| {
            for name in names {
                let text = fs::read_to_string(out.join(name)).ok();
                assert_eq!(text.as_deref(), Some("mine"), "{option}: {name}, {when}");
            }
        };
        for command in &commands {
            run_in(dir.path(), command);
            survives(&names, "in a folder of somebody else");
        }
        fs::remove_dir_all(&out).unwrap();
        // The folder was written by Foveate.
        run_in(dir.path(), command);
        assert!(out.is_dir(), "{option}: {}", run_in(dir.path(), command).stderr);
        fs::create_dir_all(out.join("sub/deep")).unwrap();
        let mine = ["notes.txt", "sub/deep/notes.txt", "build.log"];
        mine.iter().for_each(|name| fs::write(out.join(name), "mine").unwrap());
        commands.iter().for_each(|command| drop(run_in(dir.path(), command)));
        survives(&mine, "beside its own files");
        let Some(edited) = edited else {
            fs::remove_dir_all(&out).unwrap();
            continue;
        };
        mine.iter().for_each(|name| fs::remove_file(out.join(name)).unwrap());
        let text = fs::read_to_string(out.join(edited)).unwrap() + "mine";
        fs::write(out.join(edited), &text).unwrap();
        for command in &commands {
            let ran = run_in(dir.path(), command);
            let kept = fs::read_to_string(out.join(edited)).ok();
            assert_eq!(kept.as_deref(), Some(text.as_str()), "{option}: {edited}");
            let is_named = ran.stderr.contains(edited) && ran.stderr.contains("(changed)");
            let is_refused = ran.code == 2 && (is_named || ran.stderr.contains("--force"));
            assert!(is_refused, "{option}: {}", ran.stderr);
        }
        fs::remove_dir_all(&out).unwrap();
    }
}

/// A file that is written keeps the mode of the file that it replaces, and is named if it cannot be
/// written.
#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_mode() {
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
    let read = [
        "--config",
        "--labels",
        "--boxes",
        "--sensor-events",
        "--sink-stalls",
        "--macros",
        "--timestamps",
        "--task",
    ];
    let is_read = |option: &String| read.iter().any(|read| option.ends_with(read));
    let written =
        ["cosim --junit", "cosim --packets", "estimate --netlist", "fit --output", "live --page"];
    let options = options_of("FILE").into_iter().filter(|option| !is_read(option));
    assert_eq!(options.collect::<Vec<_>>(), written, "an option that writes belongs here");

    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path());
    let design = ["--preset", "bare", "--level", "rpu", "--rounds", "1", "--simulator", "iverilog"];
    let cosim = [&["cosim"][..], &design, &["--junit", "out"]].concat();
    let small = ["--set", "frame={width=32,height=24}", "--frames", "8", "--max-syntheses", "1"];
    let fit = [&["fit", "scene:street", "-o", "out"][..], &small].concat();
    let commands = [
        (&["live", "--page", "out"][..], &[][..]),
        (&cosim, &[Tool::Iverilog, Tool::Vvp]),
        (&fit, &[Tool::Yosys]),
    ];
    // A fit takes seconds.
    let count = if takes_whole_lists() { 3 } else { 2 };
    for (command, tools) in commands.into_iter().take(count) {
        if !require_tools(tools) {
            continue;
        }
        let out = dir.path().join("out");
        let mode = || fs::metadata(&out).unwrap().mode() & 0o7777;
        run_in(dir.path(), command);
        let plain = dir.path().join("plain");
        fs::write(&plain, "").unwrap();
        assert_eq!(mode(), fs::metadata(&plain).unwrap().mode() & 0o7777, "{command:?}");
        fs::write(&out, "secret").unwrap();
        fs::set_permissions(&out, fs::Permissions::from_mode(0o600)).unwrap();
        run_in(dir.path(), command);
        assert_ne!(fs::read(&out).unwrap(), b"secret");
        assert_eq!(mode(), 0o600, "{command:?}");
        fs::remove_file(&out).unwrap();
    }
}

/// A run removes the leftovers of a killed run beside its output, and keeps those of a running one.
#[cfg(target_os = "linux")]
#[test]
fn the_next_run_removes_what_a_killed_one_left() {
    use std::process::{Command, Stdio};
    let dir = tempfile::tempdir().unwrap();
    let names = || {
        let entries = fs::read_dir(dir.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    // The command waits, because it reads from a pipe that stays open.
    let start = |out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_foveate"));
        command.args(["simulate", "-", "-o", out]).current_dir(dir.path());
        let child = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = child.spawn().unwrap();
        let mut clip = b"YUV4MPEG2 W16 H16 F30:1 Ip A1:1 Cmono\n".to_vec();
        (0..3).for_each(|_| clip.extend([b"FRAME\n".as_slice(), &[7; 256]].concat()));
        std::io::Write::write_all(child.stdin.as_mut().unwrap(), &clip).unwrap();
        let begun = std::time::Instant::now();
        // The folder for the work is made after the lock.
        let works = |name: &String| {
            name.starts_with(&format!(".{out}.partial-"))
                && dir.path().join(name).join("work").is_dir()
        };
        while !names().iter().any(works) {
            assert!(child.try_wait().unwrap().is_none(), "it has ended");
            assert!(begun.elapsed().as_secs() < 30, "it does not begin");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        child
    };
    let (mut killed, mut living) = (start("killed"), start("living"));
    killed.kill().unwrap();
    killed.wait().unwrap();
    // A user or an older version may have given such a name to a folder.
    fs::create_dir(dir.path().join(".mine.partial-1234567890")).unwrap();
    fs::write(dir.path().join(".mine.partial-1234567890/file"), "mine").unwrap();
    assert_eq!(names().len(), 3, "{:?}", names());
    run_successfully(dir.path(), &["simulate", "scene:street", "--frames", "1", "-o", "other"]);
    let left = names();
    assert!(left.len() == 3 && !left.iter().any(|name| name.contains("killed")), "{left:?}");
    assert!(left.iter().any(|name| name.starts_with(".living.partial-")), "{left:?}");
    living.kill().unwrap();
    living.wait().unwrap();
}

/// A cache from which another user could make the command run programs is refused, with a line that
/// says what to do.
#[cfg(unix)]
#[test]
fn a_cache_that_others_can_write_is_refused() {
    use std::os::unix::fs::PermissionsExt as _;
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let cache = dir.path().join("cache");
    fs::create_dir(&cache).unwrap();
    let args =
        ["cosim", "--preset", "bare", "--level", "rpu", "--rounds", "1", "--simulator", "iverilog"];
    let run = |name: &str, value: &Path| {
        foveate(&args)
            .current_dir(dir.path())
            .env("XDG_CACHE_HOME", dir.path())
            .env_remove("FOVEATE_CACHE")
            .env(name, value)
            .output()
            .unwrap()
    };
    fs::set_permissions(&cache, fs::Permissions::from_mode(0o777)).unwrap();
    for name in ["FOVEATE_CACHE", "XDG_CACHE_HOME"] {
        let said = run(name, &cache);
        let text = String::from_utf8(said.stderr).unwrap();
        assert_eq!((said.status.code(), text.lines().count()), (Some(2), 1), "{text}");
        assert!(text.contains("everybody may write to") && text.contains("chmod go-w"), "{text}");
        assert_eq!(fs::read_dir(&cache).unwrap().count(), 0);
    }
    fs::set_permissions(&cache, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(run("FOVEATE_CACHE", &cache).status.code(), Some(0));
    assert!(fs::read_dir(&cache).unwrap().count() > 0);
    if std::os::unix::fs::chown(&cache, Some(54_321), None).is_err() {
        return foveate_tools::testing::report_skip("only root can give a folder away");
    }
    let said = run("FOVEATE_CACHE", &cache);
    let text = String::from_utf8(said.stderr).unwrap();
    assert_eq!(said.status.code(), Some(2), "{text}");
    assert!(text.contains("belongs to another user (uid 54321); set FOVEATE_CACHE to"), "{text}");
}
