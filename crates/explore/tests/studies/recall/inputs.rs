// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boxes follow the frames that the camera sees, for every kind of input.

use std::fs;
use std::path::PathBuf;
use std::slice::from_ref;

use super::{check_known, frame, images, mot_rows, recall, recall_of, row};
use foveate_design::DesignConfig;
use foveate_media::{CropRect, FrameRate, FrameSelection, ImageRelation, InputOptions};

#[test]
fn boxes_are_cropped_and_scaled_with_the_frames() {
    let dir = tempfile::tempdir().unwrap();
    let (clip, out) = (dir.path().join("clip"), dir.path().join("out"));
    let gt = clip.join("gt.txt");
    images(&clip, 2, 24);
    // An object that lies outside of the crop by more than three quarters does not count.
    fs::write(&gt, mot_rows(2, 24) + "2,9,5,25,24,16,1,1,1\n").unwrap();
    let crop = Some(CropRect { size: (64, 32), origin: (24, 24) });
    let input = InputOptions { crop, resize: Some((32, 16)), ..InputOptions::default() };
    let report = recall(from_ref(&clip), from_ref(&gt), &input, &out).unwrap();
    check_known(&report, "clip", &out);
    let notes = || fs::read_to_string(out.join("recall.csv")).unwrap();
    assert!(notes().contains("(MOT); 1 lie mostly outside"));
    assert!(!notes().contains("behind the last one"));
    // The clip has four frames.
    fs::write(&gt, mot_rows(2, 24) + "5,9,25,25,24,16,1,1,1\n7,9,25,25,24,16,1,1,1\n").unwrap();
    check_known(&recall(&[clip], &[gt], &input, &out).unwrap(), "clip", &out);
    assert!(notes().contains("; 2 belong to frames behind the last one"), "{}", notes());
}

#[test]
fn boxes_follow_the_frames_that_are_seen() {
    let dir = tempfile::tempdir().unwrap();
    let (clip, gt, out) =
        (dir.path().join("a.y4m"), dir.path().join("gt.txt"), dir.path().join("out"));
    let mut stream = b"YUV4MPEG2 W32 H16 F10:1 Cmono\n".to_vec();
    for number in [0, 0, 0, 1, 1, 1] {
        stream.extend([b"FRAME\n".as_slice(), &frame(number, 1, 0).2].concat());
    }
    fs::write(&clip, stream).unwrap();
    // Region 0 changes from the third to the fourth frame. The object moves 0.4 pixels per frame,
    // and more than half of it stays in that region.
    let rows =
        (1..=6).map(|frame| format!("{frame},1,{},1,8,8,1,1,1\n", 0.4 * f64::from(frame) + 0.6));
    fs::write(&gt, rows.collect::<String>()).unwrap();
    let of = |start_us, rate: Option<u32>| {
        let rate = rate.map(|rate| FrameRate::new(rate, 1).unwrap());
        let selection = FrameSelection { start_us, rate, ..FrameSelection::default() };
        let input = InputOptions { selection, ..InputOptions::default() };
        let report = recall(from_ref(&clip), from_ref(&gt), &input, &out).unwrap();
        let speed = ["still", "slow"].into_iter().find(|speed| {
            let of_speed = |row: &&Vec<String>| row[1] == "design" && row[4..6] == ["speed", speed];
            report.rows.iter().any(|row| of_speed(&row))
        });
        (row(&report, "a", "active", ("all", "all"))[..5].join(" "), speed)
    };
    // All frames: 5 frames after the first, and the object is active in one of them. From the third
    // frame on: one of 3. Every second frame: one of 2, and the object moves twice as far.
    assert_eq!(of(None, None), ("5 0.800000 0.200000 0.200000 0.200000".to_owned(), Some("still")));
    let late = "3 0.666667 0.333333 0.333333 0.333333".to_owned();
    assert_eq!(of(Some(200_000), None), (late, Some("still")));
    let sparse = "2 0.500000 0.500000 0.500000 0.500000".to_owned();
    assert_eq!(of(None, Some(5)), (sparse, Some("slow")));
    // Boxes belong to the frames of the input, also if the clip starts later: only the fourth frame
    // has a box.
    fs::write(&gt, "4,1,1,1,8,8,1,1,1\n").unwrap();
    let one = "1 0.000000 1.000000 1.000000 1.000000".to_owned();
    assert_eq!(of(Some(200_000), None), (one, None));
}

#[test]
fn a_design_of_few_sizes_is_studied_in_those() {
    let dir = tempfile::tempdir().unwrap();
    let (clip, gt, out) =
        (dir.path().join("clip"), [dir.path().join("gt.txt")], dir.path().join("out"));
    images(&clip, 1, 0);
    fs::write(&gt[0], mot_rows(1, 0)).unwrap();
    // A region of 4x4 pixels has fewer than 20 pixels, and a frame has fewer than 8 regions of
    // 32x32.
    let built = ["temporal.min_count=20", "hardware.organization=\"serial\"", "hardware.fold=8"];
    let config = DesignConfig::from_toml_with("", &built).unwrap();
    let report = recall_of(&config, from_ref(&clip), &gt, &InputOptions::default(), &out).unwrap();
    let size =
        |row: &&Vec<String>| row[1] == "region.size" && row[3..6] == ["active", "all", "all"];
    let sizes: Vec<&String> = report.rows.iter().filter(size).map(|row| &row[2]).collect();
    assert_eq!(sizes, ["8", "16", "32"]);
}

#[test]
fn sets_have_boxes_by_name_and_count_what_is_relevant() {
    let dir = tempfile::tempdir().unwrap();
    let (set, out) = (dir.path().join("set"), dir.path().join("out"));
    images(&set, 1, 0);
    let file = |name: &str, text: &str| {
        let path = dir.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        path
    };
    let csv = file("a.csv", "file,x0,y0,x1,y1\n000002.pgm,0,0,16,8\n000003.pgm,0,0,32,16\n");
    let coco = r#"{"images": [{"id": 1, "file_name": "000002.pgm"}, {"id": 2, "file_name": "000003.pgm"}],
        "annotations": [{"image_id": 2, "bbox": [0, 0, 32, 16]}, {"image_id": 1, "bbox": [0, 0, 16, 8]}]}"#;
    let coco = file("a.json", coco);
    file("yolo/000002.txt", "0 0.25 0.25 0.5 0.5\n");
    let yolo = file("yolo/000003.txt", "1 0.5 0.5 1 1\n").parent().unwrap().to_owned();
    let input = InputOptions { images: ImageRelation::Set, ..InputOptions::default() };
    let mut tables = Vec::new();
    for boxes in [csv.clone(), coco, yolo] {
        let report = recall(from_ref(&set), &[boxes], &input, &out).unwrap();
        // All regions of all frames have an edge, and every frame counts.
        let all = ["2", "0.000000", "1.000000", "1.000000", "1.000000", "", "514"];
        assert_eq!(row(&report, "set", "active", ("all", "all")), all);
        assert!(!report.files.contains(&"recall-tracks.csv".to_owned()));
        assert!(report.rows.iter().all(|row| !row[1].starts_with("temporal")));
        tables.push(report.rows);
    }
    assert!(tables[0] == tables[1] && tables[1] == tables[2]);
    // A single image is a clip of one frame, which counts because there is no other.
    let image = set.join("000002.pgm");
    let report = recall(&[image], &[csv], &InputOptions::default(), &out).unwrap();
    assert_eq!(row(&report, "000002", "active", ("all", "all"))[..2], ["1", "0.000000"]);
}

#[test]
fn boxes_that_do_not_fit_are_refused_and_leave_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let (clip, out) = (dir.path().join("clip"), dir.path().join("out"));
    images(&clip, 1, 0);
    let gt = dir.path().join("gt.txt");
    let message = |text: &str, boxes: &[PathBuf]| {
        fs::write(&gt, text).unwrap();
        let refused = recall(from_ref(&clip), boxes, &InputOptions::default(), &out).unwrap_err();
        assert!(!out.exists());
        refused.to_string()
    };
    let given = [gt.clone()];
    assert!(message("", &[]).contains("--boxes"));
    assert!(message("1,1,x\n", &given).contains("gt.txt`, line 1"));
    assert!(message("9,1,1,1,8,8,1,1,1\n", &given).contains("begins with frame 9"));
    assert!(
        message("1,1,1,1,8,8,1,1,1\n", &given)
            .contains("`clip` has no object to count after its first frame")
    );
    let said = message("2,1,1,1,8,8,0,1,1\n", &given);
    for part in ["no object", "1 of 1 boxes", "gt.txt", "1 not to be counted"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}
