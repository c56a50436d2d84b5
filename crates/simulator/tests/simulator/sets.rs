// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sets of images: IDX and CIFAR with their labels, and labelled folders. Every image is a first
//! frame.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use crate::support::{NpyArray, grey, run};
use flate2::Compression;
use flate2::write::GzEncoder;
use foveate_camera::CameraConfig;
use foveate_design::DesignConfig;
use foveate_media::{
    FootageError, FrameSelection, ImageRelation, InputOptions, SilentHooks, SourceFrame,
    SourceKind, open,
};
use foveate_pixels::luma;
use foveate_simulator::{RunOptions, Simulation};

fn read(path: &Path, options: &InputOptions) -> Result<Vec<SourceFrame>, FootageError> {
    let mut source = open(&[path], &CameraConfig::default(), options)?;
    assert_eq!(source.kind(), SourceKind::Set);
    let mut seen = Vec::new();
    while let Some(frame) = source.next_frame()? {
        seen.push(frame);
    }
    assert_eq!(source.frames(), Some(seen.len() as u64));
    Ok(seen)
}

fn labels(frames: &[SourceFrame]) -> Vec<Option<&str>> {
    frames.iter().map(|frame| frame.label.as_deref()).collect()
}

fn images() -> Vec<u8> {
    let pixels = (0..4 * 3 * 5u8).map(|pixel| pixel.wrapping_mul(7));
    [&[0, 0, 8, 3, 0, 0, 0, 4, 0, 0, 0, 3, 0, 0, 0, 5][..], &pixels.collect::<Vec<_>>()].concat()
}

const LABELS: [u8; 12] = [0, 0, 8, 1, 0, 0, 0, 4, 3, 1, 4, 9];

fn zipped(bytes: &[u8]) -> Vec<u8> {
    let mut zip = GzEncoder::new(Vec::new(), Compression::fast());
    zip.write_all(bytes).unwrap();
    zip.finish().unwrap()
}

#[test]
fn idx_files_are_read_packed_or_not_with_the_labels_beside_them() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let plain = InputOptions::default();
    fs::write(at("t-images-idx3-ubyte"), images()).unwrap();
    let seen = read(&at("t-images-idx3-ubyte"), &plain).unwrap();
    assert_eq!(labels(&seen), [None; 4]);
    assert_eq!((seen[2].frame.width(), seen[2].frame.height()), (5, 3));
    assert_eq!(seen[2].frame.get(1, 1), 36 * 7);
    assert!(seen[2].name.ends_with("t-images-idx3-ubyte[2]"));
    fs::write(at("t-labels-idx1-ubyte.gz"), zipped(&LABELS)).unwrap();
    fs::write(at("t-images-idx3-ubyte.gz"), zipped(&images())).unwrap();
    for name in ["t-images-idx3-ubyte", "t-images-idx3-ubyte.gz"] {
        let seen = read(&at(name), &plain).unwrap();
        assert_eq!(labels(&seen), [Some("3"), Some("1"), Some("4"), Some("9")]);
    }
    fs::write(at("other"), images()).unwrap();
    let given = InputOptions { labels: Some(at("t-labels-idx1-ubyte.gz")), ..plain.clone() };
    assert_eq!(labels(&read(&at("other"), &given).unwrap())[3], Some("9"));
}

#[test]
fn idx_files_that_are_wrong_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("images-idx3");
    let refusal = |bytes: &[u8], labels: Option<&[u8]>| {
        fs::write(&path, bytes).unwrap();
        let beside = dir.path().join("labels-idx1");
        let _ = fs::remove_file(&beside);
        if let Some(labels) = labels {
            fs::write(&beside, labels).unwrap();
        }
        let message = read(&path, &InputOptions::default()).unwrap_err().to_string();
        assert!(!message.contains('\n'), "{message}");
        message
    };
    for length in 4..images().len() {
        assert!(refusal(&images()[..length], None).contains("it ends"), "{length}");
    }
    let packed = zipped(&images());
    assert!(refusal(&packed[..packed.len() - 12], None).contains("data set"));
    assert!(refusal(&images(), Some(&LABELS[..10])).contains("last label"));
    let fewer = [&[0, 0, 8, 1, 0, 0, 0, 2][..], &[1, 2]].concat();
    assert!(refusal(&images(), Some(&fewer)).contains("2 labels for 4 images"));
    assert!(refusal(&images(), Some(&images())).contains("not an IDX file of labels"));
    // Labels are kept in memory, and a gzipped file of 4 GB is small.
    let many = 0x1000_0001_u32.to_be_bytes();
    let many_images = [&[0, 0, 8, 3][..], &many, &[0, 0, 0, 1, 0, 0, 0, 1]].concat();
    let many_labels = [&[0, 0, 8, 1][..], &many].concat();
    assert!(refusal(&many_images, Some(&many_labels)).contains("at most 268435456"));
    let huge = [0, 0, 8, 3, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255];
    assert!(refusal(&huge, None).contains("sides are 1..=16384"));
    let large = [0, 0, 8, 3, 255, 255, 255, 255, 0, 0, 64, 0, 0, 0, 64, 0];
    assert!(refusal(&large, None).contains("it ends before its last image"));
}

fn byte(value: usize) -> u8 {
    u8::try_from(value % 251).unwrap()
}

#[test]
fn cifar_comes_as_batches_and_as_sheets() {
    let dir = tempfile::tempdir().unwrap();
    let colour =
        |image: usize, pixel: usize| [byte(pixel), byte(pixel * 3 + image), byte(7 * image)];
    let mix = |[r, g, b]: [u8; 3]| luma(r.into(), g.into(), b.into());
    for tags in [1, 2] {
        let mut bytes = Vec::new();
        for image in 0..3 {
            bytes.extend((0..tags).map(|tag| byte(10 * tag + image)));
            for channel in 0..3 {
                bytes.extend((0..1024).map(|pixel| colour(image, pixel)[channel]));
            }
        }
        let path = dir.path().join(format!("data_batch_{tags}.bin"));
        fs::write(&path, &bytes).unwrap();
        let seen = read(&path, &InputOptions::default()).unwrap();
        assert_eq!(seen.len(), 3);
        assert_eq!(seen[2].label, Some((10 * (tags - 1) + 2).to_string()));
        let expected: Vec<u16> = (0..1024).map(|pixel| mix(colour(2, pixel))).collect();
        assert_eq!(seen[2].frame.borrowed_pixels().to_words(), expected);
    }
    let path = dir.path().join("sheet.png");
    let sheet =
        image::RgbImage::from_fn(1024, 3, |x, y| image::Rgb(colour(y as usize, x as usize)));
    sheet.save(&path).unwrap();
    let options = InputOptions { images: ImageRelation::CifarSheet, ..InputOptions::default() };
    let seen = read(&path, &options).unwrap();
    assert_eq!((seen.len(), seen[1].frame.width(), seen[1].frame.height()), (3, 32, 32));
    let expected: Vec<u16> = (0..1024).map(|pixel| mix(colour(1, pixel))).collect();
    assert_eq!(seen[1].frame.borrowed_pixels().to_words(), expected);
    grey(&path, 100, 3, |_, _| 0);
    assert!(read(&path, &options).unwrap_err().to_string().contains("1024 pixels wide"));
}

#[test]
fn a_tree_of_images_is_a_set_with_labels() {
    let dir = tempfile::tempdir().unwrap();
    for (class, count) in [("ant", 2), ("bee", 1)] {
        fs::create_dir(dir.path().join(class)).unwrap();
        for number in 0..count {
            grey(&dir.path().join(class).join(format!("{number}.png")), 8, 8, |_, _| number);
        }
    }
    let options = InputOptions { images: ImageRelation::Set, ..InputOptions::default() };
    let seen = read(dir.path(), &options).unwrap();
    assert_eq!(labels(&seen), [Some("ant"), Some("ant"), Some("bee")]);
    let selection = FrameSelection { end_us: Some(5), ..FrameSelection::default() };
    let error = read(dir.path(), &InputOptions { selection, ..options }).unwrap_err();
    assert!(error.to_string().contains("no times"), "{error}");
}

#[test]
fn every_image_of_a_set_is_a_first_frame() {
    let dir = tempfile::tempdir().unwrap();
    let frames = dir.path().join("frames");
    fs::create_dir(&frames).unwrap();
    for number in 0..3 {
        grey(&frames.join(format!("{number}.png")), 16, 16, |x, y| u8::try_from(x * y).unwrap());
    }
    let trs = |images| {
        let output = dir.path().join(format!("{images:?}"));
        let options = InputOptions { images, ..InputOptions::default() };
        let source = open(&[&frames], &CameraConfig::default(), &options).unwrap();
        let simulation = Simulation::new(&DesignConfig::default(), source).unwrap();
        simulation.run(&output, &RunOptions::default(), &SilentHooks).unwrap();
        NpyArray::read(&output.join("trs.npy")).data
    };
    assert_eq!(trs(ImageRelation::Set), [1; 12]);
    assert_eq!(trs(ImageRelation::Clip), [1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0]);
}

/// Tests the real sets in the folder that the environment variable FOVEATE_DATA names.
#[test]
fn real_sets_are_read() {
    let Some(data) = foveate_tools::testing::data_folder() else { return };
    let seen =
        read(&data.join("mnist/t10k-images-idx3-ubyte.gz"), &InputOptions::default()).unwrap();
    assert_eq!((seen.len(), seen[0].label.as_deref()), (10_000, Some("7")));
    let options = InputOptions { images: ImageRelation::CifarSheet, ..InputOptions::default() };
    assert_eq!(read(&data.join("cifar10/cifar10_batch_0.png"), &options).unwrap().len(), 1000);
    let dir = tempfile::tempdir().unwrap();
    let mosquitoes = data.join("mosquito/aedes");
    assert!(run(&[mosquitoes], &[], &dir.path().join("out"), &RunOptions::default()).is_ok());
}
