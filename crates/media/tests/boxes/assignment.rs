// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the assignment of box files to several clips.

use std::path::PathBuf;
use std::sync::Arc;

use crate::support::file;
use foveate_media::boxes::{ClipToLabel, assign_boxes};

const ROW: &str = "1,1,1,1,1,1,1,1,1\n";

#[test]
fn a_file_beside_every_clip_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let inside = file(folder.path(), "a/gt/gt.txt", ROW);
    let above = file(folder.path(), "b/gt/gt.txt", ROW);
    file(folder.path(), "b/img1/000001.jpg", "");
    let inputs = [folder.path().join("a"), folder.path().join("b/img1")];
    let clips = [
        ClipToLabel { name: "a", input: &inputs[0] },
        ClipToLabel { name: "b", input: &inputs[1] },
    ];
    let found = assign_boxes(&[PathBuf::from("gt/gt.txt")], &clips).unwrap();
    assert_eq!([found[0].path(), found[1].path()], [inside.as_path(), above.as_path()]);
    // Two files are assigned to two clips in their order.
    let found = assign_boxes(&[above.clone(), inside.clone()], &clips).unwrap();
    assert_eq!([found[0].path(), found[1].path()], [above.as_path(), inside.as_path()]);
    // If the input is a pattern of files, their folder is searched.
    let frames = folder.path().join("b/img1/*.jpg");
    let found =
        assign_boxes(&["gt/gt.txt".into()], &[ClipToLabel { name: "b", input: &frames }]).unwrap();
    assert_eq!(found[0].path(), above);
}

#[test]
fn files_that_do_not_fit_the_clips_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mot = file(folder.path(), "gt.txt", ROW);
    let csv = file(folder.path(), "all.csv", "file,x0,y0,x1,y1\n");
    let input = folder.path().join("frames");
    let [one, two] = ["one", "two"].map(|name| ClipToLabel { name, input: &input });
    let message = |files: &[PathBuf], clips: &[ClipToLabel<'_>]| {
        assign_boxes(files, clips).unwrap_err().to_string()
    };
    let both = message(&[mot.clone(), csv.clone()], &[one]);
    assert!(both.starts_with("2 files of boxes are given for 1 clips"), "{both}");
    let shared = message(&[mot], &[one, two]);
    assert!(shared.contains("`one` and `two`") && shared.contains("gt.txt"), "{shared}");
    let missing = message(&["nowhere.txt".into()], &[one]);
    assert!(missing.contains("nowhere.txt") && missing.contains("`one`"), "{missing}");
    let shared = assign_boxes(&[csv], &[one, two]).unwrap();
    assert!(Arc::ptr_eq(&shared[0], &shared[1]), "read once");
}
