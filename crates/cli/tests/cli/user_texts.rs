// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that names of clips, whatever their characters, are plain text in every generated page,
//! chart, table and command, and in a project of a board whose file has such a name.

use std::fs;
use std::path::Path;
use std::process::Command;

use foveate_tools::{
    Tool,
    testing::{require_tools, takes_whole_lists},
};
use roxmltree::{Document, ParsingOptions};

use crate::common::{expect_failure, files_below, foveate};

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");

/// The paths of clips. Each would end a comment, an attribute, an element, a word or a line, or
/// would start a command.
const CLIPS: &[&str] = &[
    "plain.y4m",
    "\"><script>alert(1)</script>.y4m",
    "x---><svg onload=alert(1)>.y4m",
    "--->/<a href=x>.y4m",
    "-flag.y4m",
    "a\u{1}b\u{1b}[2J.y4m",
    "it's $(touch canary) `touch canary`; touch canary.y4m",
    "a\nb,c\"d.y4m",
    "]]>&amp;%2C#\u{e4}\u{202e}.y4m",
];

/// A space with values that no design takes. The page must show them, including those that contain
/// markup.
const SPACE: &str = r#"
[vary]
"region.size" = [4, 8]
"region.neighborhood" = ["isolated", "</script><script>alert(1)</script>", "a\u0001\n*/ ---> <svg onload=alert(1)>"]
"#;

/// Returns a folder with a short clip of each name, and their paths, which begin with `./`.
fn clips() -> (tempfile::TempDir, Vec<String>) {
    let dir = tempfile::tempdir().unwrap();
    let mut clip = b"YUV4MPEG2 W64 H48 F30:1 Cmono\n".to_vec();
    for frame in 0..3_u8 {
        clip.extend(b"FRAME\n");
        clip.extend(
            (0..64 * 48).map(|at| if at % 64 < 8 * usize::from(frame) { 250 } else { 10_u8 }),
        );
    }
    for name in CLIPS {
        let path = dir.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, &clip).unwrap();
    }
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    (dir, CLIPS.iter().map(|name| format!("./{name}")).collect())
}

fn run(dir: &Path, before: &[&str], clips: &[String], after: &[&str]) {
    let clips: Vec<_> = clips.iter().map(String::as_str).collect();
    let args = [before, &clips, after].concat();
    let output = foveate(&args).current_dir(dir).output().unwrap();
    assert!(output.status.success(), "{before:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Fails unless every page and chart of a folder is well-formed XML with only its own scripts and
/// handlers, and tables have their columns.
fn check_folder(folder: &Path) {
    for (path, bytes) in files_below(folder) {
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        match ending.as_str() {
            "svg" | "html" => check_markup(&path, std::str::from_utf8(&bytes).unwrap()),
            "json" => {
                let json: Result<serde_json::Value, _> = serde_json::from_slice(&bytes);
                assert!(json.is_ok(), "{}", path.display());
            }
            _ => {}
        }
    }
    assert!(!folder.parent().unwrap().join("canary").exists());
}

fn check_markup(path: &Path, text: &str) {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let parsed = Document::parse_with_options(text, options);
    let document = parsed.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let is_page = path.extension().is_some_and(|ending| ending == "html");
    for node in document.root().descendants().filter(roxmltree::Node::is_element) {
        let name = node.tag_name().name();
        assert!(name != "script" || is_page, "{}: a chart has a script", path.display());
        if name == "script" || name == "style" {
            // A browser reads up to the first end of the element.
            assert!(!node.text().unwrap_or_default().contains("alert"), "{}", path.display());
        }
        for attribute in node.attributes() {
            assert!(!attribute.name().starts_with("on"), "{}: {name}", path.display());
            assert!(!attribute.value().starts_with("javascript:"), "{}: {name}", path.display());
        }
    }
    let children =
        |node: roxmltree::Node<'_, '_>| node.children().filter(|child| child.is_element()).count();
    assert_eq!(children(document.root()), 1, "{}", path.display());
}

#[test]
fn names_of_clips_are_text_on_the_page_of_a_network() {
    let (dir, clips) = clips();
    run(dir.path(), &["infer", DENOISER], &clips, &["-o", "out"]);
    check_folder(&dir.path().join("out"));
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("&lt;svg onload") || page.contains("&#60;svg onload"));
    // A shell reads the same words from the command on the page.
    let (_, command) = page.split_once("<pre>foveate infer ").unwrap();
    let (command, _) = command.split_once("</pre>").unwrap();
    let pre = format!("<pre>{command}</pre>");
    let command = Document::parse(&pre).unwrap().root_element().text().unwrap().to_owned();
    let script = format!("printf '%s\\0' {command}");
    let told = Command::new("sh").args(["-c", &script]).current_dir(dir.path()).output().unwrap();
    let told = String::from_utf8(told.stdout).unwrap();
    let words: Vec<_> = told.split('\0').collect();
    for clip in clips.iter().filter(|clip| !clip.contains('\u{1}')) {
        assert!(words.contains(&clip.as_str()), "{clip:?} is not in {words:?}");
    }
    assert!(!dir.path().join("canary").exists());
}

#[test]
fn names_of_clips_are_text_in_charts_and_reports() {
    let (dir, clips) = clips();
    for study in ["temporal", "activity"] {
        run(dir.path(), &["analyze", study, "-o", study], &clips, &[]);
        check_folder(&dir.path().join(study));
        let table =
            fs::read_to_string(dir.path().join(study).join(format!("{study}.csv"))).unwrap();
        let commas = |line: &str| line.matches(',').count();
        let mut rows = table.lines().filter(|line| !line.starts_with('#')).map(commas);
        let first = rows.next().unwrap();
        assert!(rows.all(|row| row == first), "{table}");
    }
    run(dir.path(), &["explore", "space.toml"], &clips, &["-o", "explored", "--no-area"]);
    check_folder(&dir.path().join("explored"));
    let page = fs::read_to_string(dir.path().join("explored/report.html")).unwrap();
    assert!(
        page.contains("script&#62;alert(1)") || page.contains("script&gt;alert(1)"),
        "it is told"
    );
    if takes_whole_lists() && require_tools(&[Tool::Ffmpeg]) {
        run(dir.path(), &["link"], &clips, &["-o", "linked", "--codecs", "mjpeg"]);
        check_folder(&dir.path().join("linked"));
    }
}

/// The name of a board's file becomes the name of a bitstream in scripts.
#[test]
fn a_board_whose_file_has_a_hostile_name_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let args = ["build", "--board", "icebreaker", "--project", "-o", "first"];
    assert!(foveate(&args).current_dir(dir.path()).output().unwrap().status.success());
    let board = fs::read_to_string(dir.path().join("first/board.toml")).unwrap();
    for name in [
        "a; touch canary",
        "$(touch canary)",
        "`touch canary`",
        "a\ntouch canary\n",
        "-flag",
        "..",
        "a'b",
        "\u{e4}",
    ] {
        let file = format!("./{name}.toml");
        fs::write(dir.path().join(&file), &board).unwrap();
        expect_failure(
            dir.path(),
            2,
            &["build", "--board", &file, "-o", "out"],
            &["rename the file"],
        );
    }
    let texts = [
        ("part = \"up5k\"", "part = \"up5k; touch canary; :\"", "device.part"),
        ("package = \"sg48\"", "package = \"$(touch canary)\"", "device.package"),
        ("title = \"", "title = \"a\\ntouch canary\\n#", "title"),
        ("tx = \"9\"", "tx = \"[exec touch canary]\"", "serial.tx"),
        ("flash = \"", "flash = \"true; ", "flash"),
    ];
    for (from, to, key) in texts {
        assert!(board.contains(from), "{from}");
        fs::write(dir.path().join("here.toml"), board.replace(from, to)).unwrap();
        expect_failure(dir.path(), 2, &["build", "--board", "here.toml", "-o", "out"], &[key]);
    }
    assert!(!dir.path().join("canary").exists() && !dir.path().join("out").exists());
}
