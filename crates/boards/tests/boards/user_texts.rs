// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that a file of a board or a sensor is only data: no generated script runs its texts, and
//! every page shows them as plain text. The places come from what the readers accept, and
//! interpreters judge the generated files.

use std::collections::BTreeMap;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use foveate_boards::{Board, BoardError, BoardProject, write_project};
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};
use toml::{Table, Value};

use crate::common::has_tclsh;
use crate::hostile_texts::{CANARY, PathStep, TextPlaces, key_name, texts};
use crate::projects::STUBS;

const SHIPPED: &str = env!("CARGO_MANIFEST_DIR");

/// Returns a shipped file.
fn shipped(kind: &str, name: &str) -> Table {
    let path = Path::new(SHIPPED).join(kind).join(format!("{name}.toml"));
    fs::read_to_string(path).unwrap().parse().unwrap()
}

/// Returns a board of each family of devices, for small frames.
fn boards() -> [(&'static str, Table); 4] {
    ["icebreaker", "ulx3s", "tang-nano-20k", "vcu118"].map(|name| {
        let mut board = shipped("boards", name);
        let set = board["design"]["set"].as_array_mut().unwrap();
        set.push("frame={width=64,height=48}".into());
        (name, board)
    })
}

fn project(name: &str, board: &Table) -> Result<BoardProject, BoardError> {
    let board = Board::from_toml(name, &board.to_string())?;
    let design = board.config()?.validate()?;
    BoardProject::new(board, design)
}

fn files(project: &BoardProject) -> BTreeMap<String, String> {
    project.files().into_iter().map(|file| (file.path, file.contents)).collect()
}

/// Returns true if a text is one plain word in each of the languages.
fn is_plain(text: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._/-".contains(c);
    !text.is_empty() && !text.starts_with('-') && text.len() <= 64 && text.chars().all(is_plain)
}

/// Returns Verilog without its comments. No template has a string that looks like a comment.
fn code(verilog: &str) -> String {
    let lines = verilog.lines().map(|line| line.split("//").next().unwrap_or_default().trim_end());
    lines.map(|line| format!("{line}\n")).collect()
}

/// Returns the comments that are commands to a tool.
fn tool_comments(verilog: &str) -> Vec<&str> {
    let words = ["synopsys", "synthesis", "verilator", "pragma"];
    let comments = verilog.lines().filter_map(|line| Some((line, line.split_once("//")?.1)));
    let directives =
        comments.filter(|(_, text)| words.iter().any(|word| text.trim().starts_with(word)));
    directives.map(|(line, _)| line).collect()
}

/// Returns a script without the lines that are comments.
fn commands(script: &str) -> Vec<&str> {
    script.lines().filter(|line| !line.trim_start().starts_with('#')).collect()
}

/// The folders of projects with hostile texts. The first is that of the benign project.
struct WrittenProjects {
    root: tempfile::TempDir,
    folders: Vec<PathBuf>,
}

impl WrittenProjects {
    fn new() -> Self {
        Self { root: tempfile::tempdir().unwrap(), folders: Vec::new() }
    }

    fn write(&mut self, project: &BoardProject) {
        let folder = self.root.path().join(format!("out{}", self.folders.len()));
        write_project(project, &folder, false).unwrap();
        self.folders.push(folder);
    }

    fn has_canary(folder: &Path) -> bool {
        fs::read_dir(folder).unwrap().any(|entry| {
            let entry = entry.unwrap();
            entry.file_name().to_string_lossy().contains(CANARY)
                || (entry.path().is_dir() && Self::has_canary(&entry.path()))
        })
    }

    /// Runs the script of every `every`th folder, beginning with the first. All of them must call
    /// the same commands.
    fn run(&self, every: usize, with: impl Fn(&Path) -> Command, called: &str) {
        let mut benign = None;
        for folder in self.folders.iter().step_by(every) {
            let output = with(folder).current_dir(folder).output().unwrap();
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {errors}", folder.display());
            let log = match called {
                "" => String::from_utf8_lossy(&output.stdout).into_owned(),
                name => fs::read_to_string(folder.join(name)).unwrap(),
            };
            let first = benign.get_or_insert_with(|| log.clone());
            assert_eq!(*first, log, "{}", folder.display());
        }
        assert!(!Self::has_canary(self.root.path()), "a text was run");
    }

    /// Checks that Yosys reads each top as the module that it is.
    fn assert_yosys_reads_tops(&self) {
        if !require_tools(&[Tool::Yosys]) {
            return;
        }
        let mut script = String::new();
        for folder in &self.folders {
            for name in ["board", "sensor_steps"] {
                let path = folder.join(format!("rtl/{name}.v"));
                if path.is_file() {
                    script += &format!(
                        "read_verilog {}\nselect -assert-any {name}/*\ndesign -reset\n",
                        path.display()
                    );
                }
            }
        }
        let path = self.root.path().join("read.ys");
        fs::write(&path, script).unwrap();
        let run = Command::new("yosys").arg("-q").arg("-s").arg(&path).output().unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    }
}

/// Checks that a project and one whose file has a hostile text differ only in comments and in the
/// page of the project.
fn assert_differs_in_comments_only(
    project: &BoardProject,
    benign: &BTreeMap<String, String>,
    data: &str,
) {
    let files = files(project);
    assert!(files.keys().eq(benign.keys()));
    for (path, contents) in &files {
        let benign_contents = &benign[path];
        let ending = Path::new(path).extension().unwrap_or_default().to_str().unwrap();
        let lines = |text: &str| text.lines().count();
        match ending {
            _ if path == "board.toml" || path == "sensor.toml" => {
                assert!(contents == benign_contents || contents == data, "{path}");
            }
            "v" => {
                assert_eq!(code(contents), code(benign_contents), "{path}");
                assert_eq!(tool_comments(contents), tool_comments(benign_contents), "{path}");
            }
            "md" => {
                assert_eq!(lines(contents), lines(benign_contents), "{path}");
                for (at, letter) in
                    contents.char_indices().filter(|(_, letter)| "<[`|*".contains(*letter))
                {
                    let benign = benign_contents.matches(letter).count();
                    let bare = contents
                        .match_indices(letter)
                        .filter(|(at, _)| !contents[..*at].ends_with('\\'));
                    assert_eq!(bare.count(), benign, "{path}: {letter} at {at}\n{contents}");
                }
            }
            _ => assert_eq!(commands(contents), commands(benign_contents), "{path}"),
        }
        for (number, line) in contents.lines().enumerate().filter(|_| !path.ends_with(".toml")) {
            let is_wild = |c: char| c.is_control() || ('\u{2028}'..='\u{202e}').contains(&c);
            assert!(!line.contains(is_wild), "{path}:{number}: {line:?}");
        }
    }
}

type TextAtPlace = (Vec<PathStep>, String);

/// Returns every text at every place of a file.
fn texts_at_places(schema: &TextPlaces<'_>) -> Vec<TextAtPlace> {
    let places = schema.places();
    places
        .iter()
        .flat_map(|place| texts().into_iter().map(move |text| (place.clone(), text)))
        .collect()
}

/// Tries texts in a file. Texts that are accepted although they are no plain words are written as
/// projects, and returned.
fn try_all(
    schema: &TextPlaces<'_>,
    tried: Vec<TextAtPlace>,
    make: &dyn Fn(&Table) -> Result<BoardProject, BoardError>,
    written: &mut WrittenProjects,
) -> Vec<TextAtPlace> {
    let benign = make(&schema.base).unwrap();
    written.write(&benign);
    let benign = files(&benign);
    let mut accepted = Vec::new();
    for (place, text) in tried {
        let table = schema.with_value(&place, Value::String(text.clone()));
        let excerpt: String = text.chars().take(40).collect();
        match make(&table) {
            _ if is_plain(&text) => {}
            Err(error) => {
                let message = error.to_string();
                assert!(
                    message.contains(key_name(&place)),
                    "{place:?} = {excerpt:?}: {message:.300}"
                );
                assert!(message.len() < 1000, "{place:?} = {excerpt:?}: {} bytes", message.len());
            }
            Ok(project) => {
                assert_differs_in_comments_only(&project, &benign, &table.to_string());
                written.write(&project);
                accepted.push((place, text));
            }
        }
    }
    accepted
}

/// Writes programs in place of Yosys, nextpnr and packers that record their arguments.
fn stubs(folder: &Path) -> PathBuf {
    let stub = folder.join("stub");
    let script = "#!/bin/sh\nprintf '<%s> ' \"$@\" >>called; echo >>called\n\
                  echo \"Info: Max frequency for clock 'clk': 100.00 MHz\"\n\
                  echo \"Info: Max frequency for clock 'sensor_pclk_i': 100.00 MHz\"\n\
                  while [ $# -gt 0 ]; do case $1 in --report) echo {} >\"$2\" ;; esac; shift; done\n";
    fs::write(&stub, script).unwrap();
    fs::set_permissions(&stub, Permissions::from_mode(0o755)).unwrap();
    stub
}

fn assert_shell_runs_no_text(written: &WrittenProjects) {
    let stub = stubs(written.root.path());
    let shell = |_: &Path| {
        let mut command = Command::new("sh");
        command.args(["build.sh", "1"]);
        for tool in ["YOSYS", "NEXTPNR", "PACK"] {
            command.env(tool, &stub);
        }
        command
    };
    // Only a fifth of the folders is run, because a script starts some thirty programs.
    written.run(5, shell, "called");
}

fn assert_tcl_runs_no_text(written: &WrittenProjects) {
    let stubs = written.root.path().join("stubs.tcl");
    fs::write(&stubs, STUBS).unwrap();
    for script in ["build.tcl", "program.tcl"] {
        let tcl = |folder: &Path| {
            let mut command = Command::new("tclsh");
            command.arg(&stubs).arg(folder.join(script));
            command
        };
        written.run(1, tcl, "");
    }
}

/// All boards have one reader, which is tested completely with one board. Each family has scripts
/// of its own.
#[test]
fn no_text_of_a_board_is_run() {
    let mut accepted = None;
    // The first board and the last one: scripts for a shell, and scripts in Tcl.
    for (name, base) in sample(boards(), 3) {
        let make = |table: &Table| project(name, table);
        let complaint = |table: &Table| make(table).err().map(|error| error.to_string());
        let schema = TextPlaces { base, complaint: &complaint };
        let keys: Vec<_> = schema.places().iter().map(|place| key_name(place).to_owned()).collect();
        for known in ["title", "flash", "part", "standard", "tx", "pins", "set", "reset_n"] {
            assert!(keys.iter().any(|key| key == known), "{known} is not found: {keys:?}");
        }
        assert_keys_are_on_the_page(&schema);
        let mut written = WrittenProjects::new();
        let tried = accepted.unwrap_or_else(|| texts_at_places(&schema));
        accepted = Some(try_all(&schema, tried, &make, &mut written));
        assert!(written.folders.len() > 10, "titles are free");
        written.assert_yosys_reads_tops();
        if name == "vcu118" && !has_tclsh() {
            eprintln!("skipped: tclsh is missing");
        } else if name == "vcu118" {
            assert_tcl_runs_no_text(&written);
        } else {
            assert_shell_runs_no_text(&written);
        }
    }
}

/// Checks that the page has a row for every key of a file.
fn assert_keys_are_on_the_page(schema: &TextPlaces<'_>) {
    let page = include_str!("../../../../docs/boards.md");
    let (_, rows) = page.split_once("## Files of boards and sensors").unwrap();
    for key in schema.keys() {
        let is_table =
            schema.base.get(&key).is_some_and(|value| value.is_table() || value.is_array());
        let is_there =
            [format!("`{key}`"), format!(".{key}`")].iter().any(|key| rows.contains(key));
        assert!(is_there || is_table || key == "pins" || key == "i2c", "`{key}` has no row");
    }
}

/// A part is an option of nextpnr, and must be no other option.
#[test]
fn an_option_is_no_part() {
    for (name, mut board) in boards() {
        board["device"]["part"] = "run".into();
        let message =
            Board::from_toml(name, &board.to_string()).err().map(|error| error.to_string());
        let is_word = ["tang-nano-20k", "vcu118"].contains(&name);
        assert_eq!(message.is_none(), is_word, "{message:?}");
        assert!(message.is_none_or(|message| message.contains("device.part = \"run\"")), "{name}");
    }
}

#[test]
fn no_text_of_a_sensor_is_run() {
    let dir = tempfile::tempdir().unwrap();
    let [(name, mut board), ..] = boards();
    board.insert("sensor".to_owned(), "mine.toml".into());
    let path = dir.path().join("here.toml");
    fs::write(&path, board.to_string()).unwrap();
    let make = |sensor: &Table| {
        fs::write(dir.path().join("mine.toml"), sensor.to_string()).unwrap();
        let board = Board::find(path.to_str().unwrap())?;
        let design = board.config()?.validate()?;
        BoardProject::new(board, design)
    };
    let complaint = |table: &Table| make(table).err().map(|error| error.to_string());
    let schema = TextPlaces { base: shipped("sensors", "ov7670-qvga"), complaint: &complaint };
    assert!(schema.places().contains(&vec![PathStep::Key("title".to_owned())]), "{name}");
    assert_keys_are_on_the_page(&schema);
    let mut written = WrittenProjects::new();
    try_all(&schema, texts_at_places(&schema), &make, &mut written);
    written.assert_yosys_reads_tops();
    assert_shell_runs_no_text(&written);
}

/// The name of a file becomes the name of a bitstream in scripts.
#[test]
fn names_of_files_are_plain() {
    let dir = tempfile::tempdir().unwrap();
    let [(_, board), ..] = boards();
    let mut sensor = board.clone();
    fs::write(dir.path().join("mine.toml"), shipped("sensors", "ov7670-qvga").to_string()).unwrap();
    sensor.insert("sensor".to_owned(), "mine.toml".into());
    for text in texts() {
        let name = if is_plain(&text) && !text.contains('/') && !["..", "."].contains(&&*text) {
            ""
        } else {
            "name"
        };
        let message =
            Board::from_toml(&text, &board.to_string()).err().map(|error| error.to_string());
        assert_eq!(message.is_none(), name.is_empty(), "{text:?}: {message:?}");
        assert!(
            message.is_none_or(|message| message.contains(name) && message.len() < 1000),
            "{text:?}"
        );
        if text.is_empty() || text.contains(['/', '\0']) || text.len() > 200 {
            continue;
        }
        let path = dir.path().join(format!("{text}.toml"));
        fs::write(&path, sensor.to_string()).unwrap();
        match Board::find(path.to_str().unwrap()) {
            Ok(board) => assert!(is_plain(&board.name), "{text:?}"),
            Err(error) => assert!(error.to_string().contains(name), "{error}"),
        }
        fs::remove_file(path).unwrap();
    }
}
