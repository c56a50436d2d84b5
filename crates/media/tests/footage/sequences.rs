// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered files such as `f%04d.png`.

use std::fs;
use std::path::Path;

use crate::clips::{all, opened};
use foveate_media::{InputOptions, input_warnings};

fn write(folder: &Path, names: &[&str]) {
    for name in names {
        fs::write(folder.join(name), "P2 2 1 255 1 2\n").unwrap();
    }
}

fn warnings(name: &Path) -> Vec<String> {
    input_warnings(&[name], &InputOptions::default())
}

#[test]
fn files_are_read_in_the_order_of_their_numbers() {
    let dir = tempfile::tempdir().unwrap();
    write(
        dir.path(),
        &["f0010.pgm", "f0009.pgm", "f10000.pgm", "f0011.pgm", "f12.pgm", "g0012.pgm"],
    );
    fs::write(dir.path().join("f0012.txt"), "text").unwrap();
    let name = dir.path().join("f%04d.pgm");
    let (found, problem) = all(&name);
    let names: Vec<String> = found
        .iter()
        .map(|frame| Path::new(&frame.name).file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(
        (problem, names),
        (None, ["f0009.pgm", "f0010.pgm", "f0011.pgm", "f10000.pgm"].map(str::to_owned).to_vec())
    );
    let said = warnings(&name).join("\n");
    assert!(said.contains("have 1 gap: ") && said.contains("f0012.pgm` does not exist"), "{said}");
    write(dir.path(), &["f0013.pgm"]);
    assert!(warnings(&name)[0].contains("have 2 gaps, the first of them: "));
}

#[test]
fn a_sequence_without_files_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), &["f1.pgm"]);
    let error = |name: &str| {
        opened(&dir.path().join(name), 8, &InputOptions::default()).err().unwrap().to_string()
    };
    let problem = error("f%03d.pgm");
    assert!(
        problem.contains("f1.pgm` exists; write `") && problem.ends_with("/f%d.pgm`"),
        "{problem}"
    );
    assert!(error("g%03d.pgm").contains("no image matches"));
    write(dir.path(), &["100%-007.pgm"]);
    let problem = error("100%%-%d.pgm");
    assert!(problem.ends_with("/100%%-%03d.pgm`"), "{problem}");
    fs::write(dir.path().join("a1.zip"), "PK\x05\x06").unwrap();
    for name in ["a%d.zip", "a*.zip"] {
        let problem = error(name);
        assert!(
            problem.contains("a1.zip`, but a pattern is for images; name one archive"),
            "{problem}"
        );
    }
    assert!(error("none/f%03d.pgm").contains("cannot read"));
    // Other names with a percent sign are names of files.
    assert!(error("f%x.pgm").contains("does not exist"));
    fs::write(dir.path().join("f2.webp"), "RIFF\x10\0\0\0WEBPVP8X").unwrap();
    assert!(error("f%d.webp").contains("type WebP"));
    fs::create_dir(dir.path().join("f3.bmp")).unwrap();
    assert!(error("f%d.bmp").contains("f3.bmp`: it is not a file"));
    // A file that has such a name is read itself.
    write(dir.path(), &["%d.pgm", "7.pgm"]);
    let (found, _) = all(&dir.path().join("%d.pgm"));
    assert_eq!(found.len(), 1);
    assert!(warnings(&dir.path().join("f%d.pgm")).is_empty());
}

#[test]
fn unusual_names_of_sequences_are_read() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("s[6]");
    fs::create_dir(&folder).unwrap();
    write(&folder, &["f0.pgm", "f1.pgm", "f18446744073709551616.pgm"]);
    for name in ["f%d.pgm", "f%0d.pgm"] {
        assert_eq!(all(&folder.join(name)).0.len(), 3, "{name}");
    }
    assert!(warnings(&folder.join("f%d.pgm"))[0].contains("1 gap: "));
    fs::create_dir(folder.join("f2.pgm")).unwrap();
    let error = opened(&folder.join("f%d.pgm"), 8, &InputOptions::default()).err().unwrap();
    assert!(error.to_string().contains("f2.pgm`: it is not a file"), "{error}");
}
