// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data sets as outputs have the form, the names and the labels of the input set, with rendered
//! images.

use std::fs;
use std::path::PathBuf;

use crate::support::data_sets::{
    LABELS, images, made, packed, pixels, rendered, set, unpacked, unpacked_any,
};
use crate::support::{NpyArray, grey, names};
use foveate_media::{InputOptions, SilentHooks, testing::RecordingHooks};

#[test]
fn idx_becomes_idx_byte_by_byte() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("t-images-idx3-ubyte"), images()).unwrap();
    fs::write(at("t-images-idx3-ubyte.gz"), packed(&images())).unwrap();
    fs::write(at("t-labels-idx1-ubyte.gz"), packed(&LABELS)).unwrap();
    for (run, bits) in
        ["frame.pixel_bits=8", "frame.pixel_bits=5", "frame.pixel_bits=12"].into_iter().enumerate()
    {
        let config = ["region.size=4", bits];
        let [shown, srs, trs] =
            rendered(&config, (13, 10), pixels().chunks(130).map(<[u8]>::to_vec));
        assert!(shown.contains(&0) && shown != pixels(), "some regions are left out");
        let whole = [&images()[..16], &shown].concat();
        for name in ["t-images-idx3-ubyte", "t-images-idx3-ubyte.gz"] {
            let out = at(&format!("out-{run}-{}", name.len()));
            let input = [at(name)];
            let summary =
                made(&input, &config, &InputOptions::default(), &out, &SilentHooks).unwrap();
            let file = out.join(name);
            let plain =
                if name.ends_with("gz") { unpacked(&file) } else { fs::read(&file).unwrap() };
            assert_eq!(plain, whole);
            // The labels are gzipped because the input labels were, although the images may not be.
            assert_eq!(unpacked(&out.join("t-labels-idx1-ubyte.gz")), LABELS);
            let made = summary.data_set.unwrap();
            assert_eq!((made.images.as_str(), made.classes.len()), (name, 0));
            assert_eq!(made.labels.as_deref(), Some("t-labels-idx1-ubyte.gz"));
            assert_eq!(NpyArray::read(&out.join("srs.npy")).data, srs);
            assert_eq!(NpyArray::read(&out.join("trs.npy")).data, trs);
            assert!(trs.iter().all(|&bit| bit == 1) && srs.contains(&0));
            let labels = NpyArray::read(&out.join("labels.npy"));
            assert_eq!((labels.descr.as_str(), labels.shape), ("<i8", vec![7]));
            let values: Vec<u8> = labels.data.chunks(8).map(|value| value[0]).collect();
            assert_eq!(values, LABELS[8..]);
        }
    }
}

#[test]
fn a_part_of_a_set_says_how_many_it_holds_and_the_same_run_gives_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t-images.gz");
    fs::write(&path, packed(&images())).unwrap();
    let out = |name: &str| dir.path().join(name);
    let three = InputOptions { frames: Some(3), ..InputOptions::default() };
    made(&[&path], &[], &three, &out("a"), &SilentHooks).unwrap();
    made(&[&path], &[], &three, &out("b"), &SilentHooks).unwrap();
    let all = InputOptions::default();
    let stopped =
        made(&[&path], &[], &all, &out("c"), &RecordingHooks::cancelling_after(3)).unwrap();
    assert_eq!((stopped.frames, stopped.problem.as_deref()), (3, Some("interrupted")));
    assert_eq!(unpacked(&out("a/t-images.gz"))[4..8], [0, 0, 0, 3]);
    for name in ["b/t-images.gz", "c/t-images.gz"] {
        assert_eq!(fs::read(out("a/t-images.gz")).unwrap(), fs::read(out(name)).unwrap());
    }
    assert!(!names(&out("a")).contains(&"labels.npy".to_owned()), "there are no labels");
    let fitted = InputOptions { resize: Some((6, 5)), ..three };
    made(&[&path], &[], &fitted, &out("d"), &SilentHooks).unwrap();
    let bytes = unpacked(&out("d/t-images.gz"));
    assert_eq!((&bytes[8..16], bytes.len()), (&[0, 0, 0, 5, 0, 0, 0, 6][..], 16 + 3 * 30));
}

#[test]
fn a_tree_becomes_a_tree_with_the_same_names() {
    let dir = tempfile::tempdir().unwrap();
    let root = dir.path().join("in");
    for class in ["b 2", "b10"] {
        fs::create_dir_all(root.join(class)).unwrap();
    }
    let file = |name: &str, at: u32| -> PathBuf {
        grey(&root.join(name), 20, 16, |x, _| if x > at { 200 } else { 9 })
    };
    // The files are in natural order.
    let inputs = [file("loose.png", 3), file("b 2/a.b.png", 2), file("b 2/x.png", 6)];
    let inputs = [&inputs[..], &[file("b 2/x.bmp", 6), file("b10/x.png", 12)]].concat();
    let out = dir.path().join("out");
    let summary = made(&[&root], &["frame.pixel_bits=8"], &set(), &out, &SilentHooks).unwrap();
    assert_eq!(summary.data_set.unwrap().classes, ["b 2", "b10"]);
    let table = fs::read_to_string(out.join("images.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows[0], "image,file,label");
    let files: Vec<&str> = rows[1..].iter().map(|row| row.split(',').nth(1).unwrap()).collect();
    assert_eq!(files[..2], ["images/loose.png", "images/b 2/a.b.png"]);
    // Two images of one name get different names.
    assert_eq!(files[2..], ["images/b 2/x.png", "images/b 2/x-000003.png", "images/b10/x.png"]);
    let labels = NpyArray::read(&out.join("labels.npy"));
    let numbers: Vec<i64> =
        labels.data.chunks(8).map(|value| i64::from_le_bytes(value.try_into().unwrap())).collect();
    assert_eq!(numbers, [-1, 0, 0, 0, 1]);
    let order = fs::read_to_string(out.join("frames.csv")).unwrap();
    for (row, file) in order.lines().skip(1).zip(files) {
        let name = row.split(',').nth(2).unwrap();
        assert!(inputs.iter().any(|input| input.display().to_string() == name));
        let original = image::open(name).unwrap().to_luma8().into_raw();
        let [shown, ..] = rendered(&[], (20, 16), [original].into_iter());
        assert_eq!(image::open(out.join(file)).unwrap().to_luma8().into_raw(), shown, "{file}");
    }
}

#[test]
fn cifar_becomes_a_labelled_tree() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("batch.bin");
    let record =
        |label: u8| [vec![label], (0..3072u32).map(|p| (p * p / 64).to_le_bytes()[0]).collect()];
    fs::write(&path, [record(9), record(0), record(9)].concat().concat()).unwrap();
    let out = dir.path().join("out");
    made(&[&path], &[], &InputOptions::default(), &out, &SilentHooks).unwrap();
    assert_eq!(names(&out.join("images/9")), ["000000.png", "000002.png"]);
    assert_eq!(image::open(out.join("images/0/000001.png")).unwrap().width(), 32);
    assert_eq!(NpyArray::read(&out.join("labels.npy")).data[8], 0);
    assert_eq!(names(&out.join("images")), ["0", "9"]);
}

#[test]
fn a_clip_is_no_set_and_the_message_says_what_is() {
    let dir = tempfile::tempdir().unwrap();
    let path = grey(&dir.path().join("a.png"), 8, 8, |_, _| 0);
    let out = dir.path().join("out");
    for input in [path.to_str().unwrap(), "scene:street"] {
        let error = made(&[input], &[], &InputOptions::default(), &out, &SilentHooks).unwrap_err();
        let said = error.to_string();
        assert!(said.starts_with(input) && said.contains("--images set"), "{said}");
        assert!(!said.contains('\n') && !out.exists());
    }
}

#[test]
fn labels_have_a_name_of_their_own() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("labels")).unwrap();
    fs::write(at("a.idx"), images()).unwrap();
    fs::write(at("labels/a.idx"), LABELS).unwrap();
    fs::write(at("labels/b.idx"), LABELS).unwrap();
    let run = |labels: &str| {
        let input = InputOptions { labels: Some(at(labels)), ..InputOptions::default() };
        made(&[at("a.idx")], &[], &input, &at("out"), &SilentHooks)
    };
    let said = run("labels/a.idx").unwrap_err().to_string();
    assert!(said.contains("--labels") && said.contains("both called `a.idx`"), "{said}");
    assert!(!at("out").exists());
    run("labels/b.idx").unwrap();
    assert_eq!(fs::read(at("out/b.idx")).unwrap(), LABELS);
}

/// Tests the real MNIST in the folder that the environment variable FOVEATE_DATA names.
#[test]
fn mnist_becomes_mnist() {
    let Some(data) = foveate_tools::testing::data_folder() else { return };
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let name = "t10k-images-idx3-ubyte.gz";
    let input = InputOptions { frames: Some(200), ..InputOptions::default() };
    let summary = made(&[data.join("mnist").join(name)], &[], &input, &out, &SilentHooks).unwrap();
    assert_eq!(summary.frames, 200);
    let original = unpacked_any(&data.join("mnist").join(name));
    let digits = original[16..].chunks(784).take(200).map(<[u8]>::to_vec);
    let [shown, srs, _] = rendered(&[], (28, 28), digits);
    let result = unpacked(&out.join(name));
    assert_eq!(result[..16], [0, 0, 8, 3, 0, 0, 0, 200, 0, 0, 0, 28, 0, 0, 0, 28]);
    assert_eq!(result[16..], shown);
    assert_eq!(NpyArray::read(&out.join("srs.npy")).data, srs);
    let labels = unpacked_any(&data.join("mnist/t10k-labels-idx1-ubyte.gz"));
    let kept = unpacked(&out.join("t10k-labels-idx1-ubyte.gz"));
    assert_eq!((&kept[4..8], &kept[8..]), (&[0, 0, 0, 200][..], &labels[8..208]));
}
