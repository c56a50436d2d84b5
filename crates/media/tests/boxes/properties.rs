// SPDX-License-Identifier: MIT OR Apache-2.0
//! Property tests: regions of random boxes against a count of half pixels, random boxes through
//! every format, and mutated files, none of which may cause a panic. `PROPTEST_CASES` sets the
//! number of cases for a longer search.

use std::fmt::Write as _;

use crate::support::{at, file, frame, image};
use foveate_media::boxes::{BoxFile, FrameKey, LabelledBox, RegionGrid};
use foveate_pixels::Rect;
use proptest::collection::vec;
use proptest::prelude::*;

/// Returns the half pixels of every line of a grid, and how many of them a span covers.
fn covered(from: u32, to: u32, side: u32, size: u32) -> Vec<(u32, u32)> {
    let mut lines = vec![(0, 0); size.div_ceil(side) as usize];
    for half in 0..2 * size {
        let line = &mut lines[(half / 2 / side) as usize];
        line.0 += 1;
        line.1 += u32::from((from..to).contains(&half));
    }
    lines
}

/// An independent implementation of the rule: lines that are covered by half, otherwise the line
/// that is covered most.
fn lines(spans: &[(u32, u32)]) -> Vec<usize> {
    let by_half: Vec<usize> =
        (0..spans.len()).filter(|&at| 2 * spans[at].1 >= spans[at].0).collect();
    if !by_half.is_empty() {
        return by_half;
    }
    let most = spans.iter().map(|span| span.1).max().unwrap();
    vec![spans.iter().position(|span| span.1 == most).unwrap()]
}

/// Returns boxes in a frame, in half pixels.
fn spans(width: u32, height: u32) -> impl Strategy<Value = [u32; 4]> {
    let side =
        |size: u32| (0..2 * size).prop_flat_map(move |from| (Just(from), from + 1..=2 * size));
    (side(width), side(height)).prop_map(|((x0, x1), (y0, y1))| [x0, y0, x1, y1])
}

proptest! {
    #[test]
    fn regions_are_those_that_the_rule_names(
        (side, width, height, corners) in (1u32..12, 1u32..40, 1u32..40)
            .prop_flat_map(|(s, w, h)| (Just(s), Just(w), Just(h), spans(w, h))),
    ) {
        let [x0, y0, x1, y1] = corners;
        let rect = Rect::from_corners(corners.map(|half| f64::from(half) / 2.0)).unwrap();
        let found: Vec<usize> = RegionGrid { side, width, height }.regions(&rect).collect();
        let columns = covered(x0, x1, side, width);
        let rows = lines(&covered(y0, y1, side, height));
        let expected: Vec<usize> = rows
            .iter()
            .flat_map(|row| lines(&columns).into_iter().map(|c| row * columns.len() + c).collect::<Vec<_>>())
            .collect();
        prop_assert!(!found.is_empty());
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn every_format_says_the_same(boxes in vec(spans(200, 100), 1..20)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let (mut mot, mut csv, mut yolo) = (String::new(), "file,x0,y0,x1,y1\n".to_owned(), String::new());
        let mut annotations = Vec::new();
        for (track, corners) in boxes.iter().enumerate() {
            let [x0, y0, x1, y1] = corners.map(|half| f64::from(half) / 2.0);
            let (w, h) = (x1 - x0, y1 - y0);
            writeln!(mot, "9,{track},{},{},{w},{h},1,1,1", x0 + 1.0, y0 + 1.0).unwrap();
            writeln!(csv, "a.jpg,{x0},{y0},{x1},{y1}").unwrap();
            let (x, y) = ((x0 + x1) / 400.0, (y0 + y1) / 200.0);
            writeln!(yolo, "0 {x} {y} {} {}", w / 200.0, h / 100.0).unwrap();
            annotations.push(serde_json::json!({"image_id": 0, "bbox": [x0, y0, w, h]}));
        }
        let images = serde_json::json!([{"id": 0, "file_name": "a.jpg"}]);
        let coco = serde_json::json!({"images": images, "annotations": annotations}).to_string();
        file(path, "yolo/a.txt", yolo);
        let expected: Vec<[f64; 4]> =
            boxes.iter().map(|corners| corners.map(|half| f64::from(half) / 2.0)).collect();
        for (from, place) in [
            (file(path, "gt.txt", mot), frame(8)),
            (file(path, "a.csv", csv), image("a.jpg")),
            (file(path, "a.json", coco), image("a.jpg")),
            (path.join("yolo"), image("a.jpg")),
        ] {
            let found = BoxFile::read(&from).unwrap().boxes_of_frame(&place).unwrap().unwrap();
            prop_assert_eq!(found.len(), expected.len());
            for (LabelledBox { rect, .. }, corners) in found.iter().zip(&expected) {
                let own = [rect.x0, rect.y0, rect.x1, rect.y1];
                prop_assert!(own.iter().zip(corners).all(|(a, b)| (a - b).abs() < 1e-9), "{from:?}");
            }
        }
    }

    #[test]
    fn mutated_files_are_read_or_refused(
        seed in 0usize..3,
        edits in vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..3), 0..8),
    ) {
        let seeds: [&[u8]; 3] = [
            b"1,7,11,21,30,40,1,1,0.9\n3,7,0.5,-3,1e2,2,1,1,0.25\n",
            b"file,x0,y0,x1,y1\n\"a\",1,2,3,4\nb/c,1,2.5,3,4\n",
            b"{\"images\":[{\"id\":1,\"file_name\":\"a\"}],\"annotations\":[{\"image_id\":1,\"bbox\":[0,1,2,3]}]}",
        ];
        let mut bytes = seeds[seed].to_vec();
        for (at, byte, kind) in edits {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ if bytes.len() > 1 => drop(bytes.remove(at)),
                _ => {}
            }
        }
        let folder = tempfile::tempdir().unwrap();
        let path = file(folder.path(), "boxes", &bytes);
        match BoxFile::read(&path).and_then(|boxes| boxes.boxes_of_frame(&FrameKey { number: 0, ..image("a") })) {
            Ok(found) => for LabelledBox { rect, .. } in found.into_iter().flatten() {
                prop_assert!(rect.width() >= 0.0 && rect.height() >= 0.0 && rect.area().is_finite());
            },
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.contains("boxes`") && !message.contains('\n'), "{message}");
            }
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "[0-9a-z,.{}\\[\\]\": \n-]{0,80}") {
        let _ = at(&text, &frame(0));
        let folder = tempfile::tempdir().unwrap();
        file(folder.path(), "a.txt", &text);
        let _ = BoxFile::read(folder.path()).unwrap().boxes_of_frame(&image("a.jpg"));
    }
}
