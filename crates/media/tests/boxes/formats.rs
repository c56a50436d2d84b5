// SPDX-License-Identifier: MIT OR Apache-2.0
//! Known files of every format.

use crate::support::{at, file, frame, image, labelled};
use foveate_media::boxes::{BoxFile, BoxFormat, FrameKey};

const MOT: &str = "1,7,11,21,30,40,1,1,0.9\n\
                   1,8,11,21,30,40,0,1,1\n\
                   1,9,11,21,30,40,1,3,1\n\
                   1,10,11,21,30,40,1,1,0.24\n\
                   \n\
                   3, 7, 0.5, -3, 1.5, 2, 1, 1, 0.25\r\n\
                   5,8,1,1,1,1,0,8,1\n";

#[test]
fn mot_rows_are_objects_if_they_count_are_pedestrians_and_can_be_seen() {
    let first = vec![labelled([10., 20., 40., 60.], Some(7))];
    assert_eq!(at(MOT, &frame(0)).unwrap(), Some(first.clone()));
    assert_eq!(at(MOT, &frame(1)).unwrap(), None, "frame 2 has no row");
    let third = vec![labelled([-0.5, -4., 1., -2.], Some(7))];
    assert_eq!(at(MOT, &frame(2)).unwrap(), Some(third.clone()));
    assert_eq!(at(MOT, &frame(4)).unwrap(), Some(vec![]), "a row without an object is an entry");
    // A number in the name of an image decides, whatever the image's position in the input.
    assert_eq!(at(MOT, &image("img1/000003.jpg")).unwrap(), Some(third));
    assert_eq!(at(MOT, &image("img1/frame3.jpg")).unwrap(), Some(first));
    let zero = at(MOT, &image("0000.png")).unwrap_err().to_string();
    assert!(zero.contains("`0000.png` would be frame 0") && zero.contains("begin at 1"), "{zero}");
}

#[test]
fn coco_has_boxes_of_images_and_no_crowds() {
    let text = r#" {"info": {"a": [1, {"b": null}]}, "images": [
        {"id": 4, "file_name": "a.jpg", "width": 9}, {"id": 2, "file_name": "val/b.jpg"}],
        "annotations": [
        {"image_id": 2, "bbox": [1, 2, 3.5, 4], "segmentation": [[1, 2]], "category_id": 1},
        {"image_id": 2, "bbox": [0, 0, 9, 9], "iscrowd": 1}]}"#;
    let boxes = vec![labelled([1., 2., 4.5, 6.], None)];
    assert_eq!(at(text, &image("/data/val/b.jpg")).unwrap(), Some(boxes));
    assert_eq!(at(text, &image("x/a.jpg")).unwrap(), Some(vec![]));
    assert_eq!(at(text, &image("b.jpg")).unwrap(), None, "another folder");
}

#[test]
fn csv_columns_have_any_order() {
    let text =
        "\u{feff}x1,file,y0,label,x0,y1\n9,\"a, b.jpg\",2,cat,1,8\n\n4,.\\c\\d.jpg,0,dog,0,4\n";
    let cat = vec![labelled([1., 2., 9., 8.], None)];
    assert_eq!(at(text, &image("set/a, b.jpg")).unwrap(), Some(cat));
    assert_eq!(at(text, &image("c/d.jpg")).unwrap(), Some(vec![labelled([0., 0., 4., 4.], None)]));
    assert_eq!(at(text, &image("d.jpg")).unwrap(), None);
}

#[test]
fn yolo_has_a_file_for_every_image_with_objects() {
    let folder = tempfile::tempdir().unwrap();
    file(folder.path(), "classes.txt", "cat\ndog\n");
    file(folder.path(), "a.txt", "0 0.5 0.5 0.25 0.5\n\n3  .125 0.25 .25 .5\n");
    file(folder.path(), "val/a.txt", "");
    let boxes = BoxFile::read(folder.path()).unwrap();
    assert_eq!(boxes.format(), BoxFormat::Yolo);
    let expected = vec![labelled([75., 25., 125., 75.], None), labelled([0., 0., 50., 50.], None)];
    assert_eq!(boxes.boxes_of_frame(&image("images/a.png")).unwrap(), Some(expected));
    assert_eq!(boxes.boxes_of_frame(&image("images/val/a.png")).unwrap(), Some(vec![]));
    assert_eq!(boxes.boxes_of_frame(&image("images/b.png")).unwrap(), None);
}

#[test]
fn a_name_is_of_one_image() {
    let folder = tempfile::tempdir().unwrap();
    let table = file(folder.path(), "boxes.csv", "file,x0,y0,x1,y1\na.jpg,0,0,1,1\n");
    let boxes = BoxFile::read(&table).unwrap();
    for _ in 0..2 {
        assert!(boxes.boxes_of_frame(&image("one/a.jpg")).unwrap().is_some());
    }
    let message = boxes.boxes_of_frame(&image("other/a.jpg")).unwrap_err().to_string();
    for part in ["`a.jpg`", "boxes.csv", "`one/a.jpg`", "`other/a.jpg`", "folders"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_clip_without_any_entry_is_refused_with_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let mot = BoxFile::read(&file(folder.path(), "gt.txt", "12,7,1,1,3,4,1,1,1\n")).unwrap();
    assert!(mot.boxes_of_frame(&FrameKey { number: 12, ..frame(0) }).unwrap().is_none());
    let message = mot.no_entry_error("street").to_string();
    assert!(message.contains("`street`") && message.contains("frame 12"), "{message}");
}
