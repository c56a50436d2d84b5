// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every mistake in a file gives one line that names the file, the place, and what is expected.

use crate::support::{at, file, frame, image};
use foveate_media::boxes::BoxFile;

#[test]
fn damaged_files_are_refused_in_one_line() {
    let coco = |images: &str, annotations: &str| {
        format!("{{\"images\": [{images}],\n\"annotations\": [{annotations}]}}")
    };
    let one = r#"{"id": 1, "file_name": "a"}"#;
    for (text, parts) in [
        ("", vec!["empty", "MOT"]),
        ("\u{1}\u{2}", vec!["no known format", "COCO"]),
        ("[{\"image_id\": 1}]", vec!["list of results"]),
        ("1,1,1,1,1,1,1,1\n", vec!["line 1", "8 columns", "expected 9"]),
        ("1,1,1,1,1,1,1,1,1\n2,1,1,x,1,1,1,1,1\n", vec!["line 2", "the top `x` is not valid"]),
        (
            "1,1,1,1,1,1,1,1,1\n\n0,1,1,1,1,1,1,1,1\n",
            vec!["line 3", "the frame `0` is not valid", "at least 1"],
        ),
        ("1,-1,1,1,1,1,1,1,1\n", vec!["line 1", "the track `-1` is not valid"]),
        ("1.5,1,1,1,1,1,1,1,1\n", vec!["the frame `1.5` is not valid"]),
        ("1,1,1,1,-3,1,1,1,1\n", vec!["line 1", "-3 x 1", "at least 0"]),
        ("1,1,1,1,1,1,1,1,nan\n", vec!["the visibility `nan` is not valid"]),
        ("1,1,1e300,1,1,1,1,1,1\n", vec!["out of range", "10000000"]),
        ("1,1,1,1,1,1,1,1,1\n1,1,5,5,1,1,0,1,1\n", vec!["line 2", "second box in frame 1"]),
        ("file,x0,y0,x1\na,1,2,3\n", vec!["line 1", "no column `y1`"]),
        ("file,x0,y0,x1,y1\na,1,2,3\n", vec!["line 2", "4 columns; expected 5"]),
        ("file,x0,y0,x1,y1\na,b.png,1,2,3,4\n", vec!["line 2", "6 columns; expected 5"]),
        ("file,x0,y0,x1,y1,x0\na,1,2,3,4,5\n", vec!["line 1", "`x0` appears twice"]),
        ("file,x0,y0,x1,y1\na,1,2,3,4\nb,5,2,3,4\n", vec!["line 3", "ends before it begins"]),
        ("file,x0,y0,x1,y1\n,1,2,3,4\n", vec!["line 2", "name of the image"]),
        ("file,x0,y0,x1,y1\na,,2,3,4\n", vec!["line 2", "the x0 `` is not valid"]),
        ("{\"images\": [\n", vec!["line 2", "COCO"]),
        ("{\"images\": []}", vec!["annotations"]),
        (&coco(one, r#"{"image_id": 2, "bbox": [0, 0, 1, 1]}"#), vec!["annotation 1", "id 2"]),
        (&coco(one, r#"{"image_id": 1, "bbox": [0, 0, 1]}"#), vec!["line 2", "array of length 4"]),
        (&coco(one, r#"{"image_id": 1, "bbox": [0, 0, -1, 1]}"#), vec!["annotation 1", "-1 x 1"]),
        (&coco(&format!("{one}, {one}"), ""), vec!["two images are called `a`"]),
        (&coco(r#"{"id": 1, "file_name": "/"}"#, ""), vec!["id 1", "no file name"]),
    ] {
        let message = at(text, &frame(0)).unwrap_err().to_string();
        assert!(message.contains("boxes`") && !message.contains('\n'), "{message}");
        for part in parts {
            assert!(message.contains(part), "{part} for {text:?}: {message}");
        }
    }
}

#[test]
fn text_that_is_no_text_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, part) in [
        ("gt.txt", &b"1,1,1,1,1,1,1,1,1\n2,1,\xff,1,1,1,1,1,1\n"[..], "line 2"),
        ("a.csv", &b"file,x0,y0,x1,y1\n\xff,1,2,3,4\n"[..], "line 2"),
        ("a.json", &b"{\"images\": \"\xff\"}"[..], "a.json"),
    ] {
        let message = BoxFile::read(&file(folder.path(), name, bytes)).unwrap_err().to_string();
        assert!(message.contains(part) && message.contains(name), "{message}");
    }
}

#[test]
fn a_damaged_file_of_a_yolo_folder_names_itself() {
    let long = format!("{:<4096}{}", "0 0.5 0.5 1 1", "0 0.1 0.1 0.1 0.1").into_bytes();
    let folder = tempfile::tempdir().unwrap();
    for (text, parts) in [
        (&b"0 0.5 0.5 1 1\n0 0.5 0.5 1\n"[..], ["line 2", "4 numbers; expected 5"]),
        (b"0 0.5 0.5 1 1.5\n", ["line 1", "1.5 is not a share"]),
        (b"0.5 0.5 0.5 1 1\n", ["line 1", "the class `0.5` is not valid"]),
        (b"0 0.5 \xff 1 1\n", ["line 1", "UTF-8"]),
        // A line that is cut at its limit would be two boxes.
        (&long, ["line 1", "4096 bytes or more"]),
    ] {
        file(folder.path(), "a.txt", text);
        let boxes = BoxFile::read(folder.path()).unwrap();
        let message = boxes.boxes_of_frame(&image("a.jpg")).unwrap_err().to_string();
        for part in parts.into_iter().chain(["a.txt"]) {
            assert!(message.contains(part), "{part}: {message}");
        }
    }
}

#[test]
fn a_folder_of_yolo_files_is_checked_without_frames() {
    let folder = tempfile::tempdir().unwrap();
    file(folder.path(), "a.txt", "0 0.5 0.5 1 1\n");
    file(folder.path(), "b.txt", "0 0.5 0.5 1\n");
    // The names of the classes are no boxes.
    file(folder.path(), "classes.txt", "person\n");
    let boxes = BoxFile::read(folder.path()).unwrap();
    assert!(boxes.check_images(&["in/a.jpg", "in/c.jpg"]).is_ok());
    let message = boxes.check_images(&["in/a.jpg", "in/b.jpg"]).unwrap_err().to_string();
    assert!(message.contains("b.txt") && message.contains("line 1"), "{message}");
}

#[test]
fn an_image_of_another_size_than_coco_states_is_refused() {
    let text = |size: &str| {
        format!(
            "\u{FEFF}{{\"images\": [{{\"id\": 1, \"file_name\": \"a.jpg\"{size}}}], \"annotations\": \
             [{{\"image_id\": 1, \"bbox\": [0, 0, 5, 5]}}]}}"
        )
    };
    for fits in ["", ", \"width\": 200, \"height\": 100", ", \"width\": 200"] {
        assert_eq!(at(&text(fits), &image("a.jpg")).unwrap().unwrap().len(), 1, "{fits}");
    }
    for (other, parts) in [
        (", \"width\": 100, \"height\": 50", ["states 100x50", "has 200x100", "labelled"]),
        (
            ", \"width\": 100, \"height\": 200",
            ["states 100x200", "200x100", "--orientation upright"],
        ),
    ] {
        let message = at(&text(other), &image("a.jpg")).unwrap_err().to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
}

#[test]
fn boxes_that_are_left_out_are_counted_by_reason() {
    let folder = tempfile::tempdir().unwrap();
    let words = |name: &str, text: &str| {
        BoxFile::read(&file(folder.path(), name, text)).unwrap().left_out_in_words()
    };
    let rows = "1,1,1,1,5,5,1,1,1\n1,2,1,1,5,5,1,3,1\n1,3,1,1,5,5,0,1,1\n2,4,1,1,5,5,1,1,0.2\n2,5,1,1,5,5,0,7,0\n";
    let said = words("gt.txt", rows).unwrap();
    for part in
        ["4 of 5 boxes", "gt.txt", "2 of another class", "1 not to be counted", "1 visible by less"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert_eq!(words("one.txt", "1,1,1,1,5,5,1,1,1\n"), None);
    let crowds = r#"{"images": [{"id": 1, "file_name": "a"}], "annotations": [{"image_id": 1, "bbox": [0, 0, 5, 5], "iscrowd": 1}]}"#;
    assert!(words("a.json", crowds).unwrap().contains("1 of 1 boxes"));
    let mot = BoxFile::read(&file(folder.path(), "gt.txt", rows)).unwrap();
    assert_eq!((mot.boxes_behind(0), mot.boxes_behind(1)), (1, 0));
}
