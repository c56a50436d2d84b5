// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `dataset`, end to end.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, files_below, run_successfully};
use serde_json::Value;

fn names(folder: &Path) -> Vec<String> {
    files_below(folder).into_iter().map(|(name, _)| name.display().to_string()).collect()
}

/// Writes an IDX file with two images of 16x16 pixels.
fn idx(folder: &Path, name: &str) {
    let header = [0, 0, 8, 3, 0, 0, 0, 2, 0, 0, 0, 16, 0, 0, 0, 16];
    let pixels = (0..512u32).map(|pixel| (pixel * pixel / 16).to_le_bytes()[0]);
    fs::write(folder.join(name), header.into_iter().chain(pixels).collect::<Vec<u8>>()).unwrap();
}

#[test]
fn idx_files_become_data_sets() {
    let dir = tempfile::tempdir().unwrap();
    idx(dir.path(), "train-images");
    idx(dir.path(), "test-images");
    fs::write(dir.path().join("train-labels"), [0, 0, 8, 1, 0, 0, 0, 2, 7, 1]).unwrap();
    let args = ["dataset", "train-images", "-o", "out", "--preset", "steady"];
    let text = run_successfully(dir.path(), &args);
    assert!(text.contains("data set in out/train-images, labels in out/train-labels"), "{text}");
    assert_eq!(fs::read(dir.path().join("out/train-labels")).unwrap()[8..], [7, 1]);
    assert_eq!(fs::read(dir.path().join("out/train-images")).unwrap().len(), 16 + 512);
    assert!(names(&dir.path().join("out")).iter().all(|name| !name.ends_with(".png")));
    expect_failure(dir.path(), 2, &args, &["out", "not empty"]);
    let json =
        run_successfully(dir.path(), &[&args[..], &["--force", "--json", "--quiet"]].concat());
    let summary: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(summary["data_set"]["labels"], "train-labels");
    let both = ["dataset", "train-images", "test-images", "-o", "both", "--max-frames", "1"];
    run_successfully(dir.path(), &both);
    for name in ["train-images", "test-images"] {
        let file = dir.path().join("both").join(name).join(name);
        assert_eq!(fs::read(file).unwrap().len(), 16 + 256);
    }
}

#[test]
fn a_folder_is_a_set_here() {
    let dir = tempfile::tempdir().unwrap();
    for (class, name) in [("cat", "1"), ("cat", "2"), ("dog", "1")] {
        fs::create_dir_all(dir.path().join("pets").join(class)).unwrap();
        let path = dir.path().join("pets").join(class).join(format!("{name}.pgm"));
        fs::write(path, [b"P5 8 8 255\n".to_vec(), (0..64).map(|p| p * 4).collect()].concat())
            .unwrap();
    }
    let text = run_successfully(dir.path(), &["dataset", "pets", "-o", "out"]);
    assert!(text.contains("data set in out/images, 2 classes"), "{text}");
    assert_eq!(names(&dir.path().join("out/images")), ["cat/1.png", "cat/2.png", "dog/1.png"]);
}

/// An interrupt ends a long run soon, with a message, and leaves a set whose header has its length.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_set_that_can_be_read() {
    let dir = tempfile::tempdir().unwrap();
    let count: u32 = 100_000;
    let header = [[0, 0, 8, 3], count.to_be_bytes(), [0, 0, 0, 16], [0, 0, 0, 16]].concat();
    let file = fs::File::create(dir.path().join("long-images")).unwrap();
    std::io::Write::write_all(&mut &file, &header).unwrap();
    file.set_len(16 + 256 * u64::from(count)).unwrap();
    let child = crate::common::foveate_with_signals()
        .args(["dataset", "long-images", "-o", "out"])
        .current_dir(dir.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let started = || {
        let mut entries = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().path());
        let hidden = entries.find(|path| path.is_dir())?;
        (fs::metadata(hidden.join("work/long-images")).ok()?.len() > 1000).then_some(())
    };
    while started().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = fs::read(dir.path().join("out/long-images")).unwrap();
    let said = u32::from_be_bytes(bytes[4..8].try_into().unwrap());
    assert!(said < count);
    assert_eq!(bytes.len(), 16 + 256 * said as usize);
}
