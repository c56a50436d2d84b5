// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that `--force` replaces only files that Foveate wrote.

use std::fs;

use crate::common::{expect_failure, files_below, run_successfully};

#[test]
fn a_folder_with_files_of_others_is_not_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let pets = dir.path().join("pets/cat");
    fs::create_dir_all(&pets).unwrap();
    fs::write(pets.join("1.pgm"), [b"P5 8 8 255\n".to_vec(), vec![9; 64]].concat()).unwrap();
    for command in [
        &["simulate", "scene:street", "--frames", "2", "-o", "out"][..],
        &["dataset", "pets", "-o", "out"],
        &["analyze", "temporal", "scene:street", "--frames", "3", "-o", "out"],
        &["generate", "-o", "out"],
    ] {
        let again = [command, &["--force", "--quiet"]].concat();
        let out = dir.path().join("out");
        assert_ne!(run_successfully(dir.path(), command), "");
        expect_failure(dir.path(), 2, command, &["`out` is not empty"]);
        // Quiet commands print nothing.
        assert_eq!(run_successfully(dir.path(), &again), "", "{command:?}");
        fs::create_dir_all(out.join("rendered")).unwrap();
        for name in ["notes.txt", "rendered/cover.png"] {
            fs::write(out.join(name), "mine").unwrap();
        }
        let before = files_below(&out);
        expect_failure(
            dir.path(),
            2,
            &again,
            &["`out`", "notes.txt, rendered/cover.png", "move them"],
        );
        assert_eq!(files_below(&out), before, "{command:?}");
        for name in ["notes.txt", "rendered/cover.png", ".foveate"] {
            fs::remove_file(out.join(name)).unwrap();
        }
        // A folder without a list of its files looks as older versions wrote it.
        expect_failure(dir.path(), 2, &again, &["`out`", "no list", "move what is in it"]);
        fs::remove_dir_all(&out).unwrap();
    }
}
