// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damaged data sets are refused: no record is left out, and none is invented.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use foveate_media::InputOptions;

use crate::clips::opened;

fn zipped(bytes: &[u8]) -> Vec<u8> {
    let mut zip = GzEncoder::new(Vec::new(), Compression::fast());
    zip.write_all(bytes).unwrap();
    zip.finish().unwrap()
}

/// Returns the number of frames of a file, or the message of its error.
fn frames(path: &Path) -> Result<usize, String> {
    let said = |error: foveate_media::FootageError| error.to_string();
    let mut source = opened(path, 8, &InputOptions::default()).map_err(said)?;
    let mut frames = 0;
    while source.next_frame().map_err(said)?.is_some() {
        frames += 1;
    }
    Ok(frames)
}

fn refused(path: &Path, bytes: &[u8], part: &str) {
    fs::write(path, bytes).unwrap();
    let said = frames(path).expect_err(part);
    let named = said.contains(path.file_name().unwrap().to_str().unwrap());
    assert!(named && said.contains(part) && !said.contains('\n'), "{part}: {said}");
}

#[test]
fn an_idx_file_holds_what_its_header_says_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let images = folder.path().join("t-images-idx3-ubyte");
    let pixels: Vec<u8> = (0..3 * 20).map(|pixel: u8| pixel.wrapping_mul(37)).collect();
    let whole = [&[0, 0, 8, 3, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, 5][..], &pixels].concat();
    let packed = zipped(&whole);
    for bytes in [&whole, &packed] {
        fs::write(&images, bytes).unwrap();
        assert_eq!(frames(&images), Ok(3));
    }
    refused(&images, &[&whole[..], &[1, 2]].concat(), "2 bytes follow the last image");
    refused(&images, &zipped(&[&whole[..], &[1]].concat()), "1 bytes follow the last image");
    refused(&images, &[&packed[..], b"more"].concat(), "its compressed data");
    for length in 20..packed.len() {
        refused(&images, &packed[..length], "data set");
    }
    // The checksum and the length are at the end of the file.
    for at in packed.len() - 8..packed.len() {
        let mut damaged = packed.clone();
        damaged[at] ^= 1;
        refused(&images, &damaged, "its compressed data are damaged");
    }
    fs::write(&images, &whole).unwrap();
    let labels = folder.path().join("t-labels-idx1-ubyte");
    let right = [0, 0, 8, 1, 0, 0, 0, 3, 7, 8, 9];
    for (bytes, part) in [
        ([&right[..], &[1]].concat(), "1 bytes follow the last label"),
        (right[..10].to_vec(), "ends before its last label"),
        (zipped(&right)[..24].to_vec(), "its compressed data have no end"),
    ] {
        fs::write(&labels, bytes).unwrap();
        let said = frames(&images).unwrap_err();
        assert!(said.contains("t-labels-idx1-ubyte") && said.contains(part), "{said}");
    }
    fs::write(&labels, right).unwrap();
    assert_eq!(frames(&images), Ok(3));
}

#[test]
fn labels_of_a_cifar_batch_are_classes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("data_batch.bin");
    let batch =
        |labels: [&[u8]; 2]| labels.map(|labels| [labels, &[40; 3072][..]].concat()).concat();
    for labels in [[&[0][..], &[9]], [&[19, 99], &[0, 0]]] {
        // A batch of bytes that are all printable could be taken for text.
        fs::write(&path, batch(labels)).unwrap();
        assert_eq!(frames(&path), Ok(2));
    }
    refused(&path, &batch([&[1], &[10]]), "the label 10 of image 1 is not one of 10 classes");
    refused(&path, &batch([&[20, 1], &[1, 1]]), "the label 20 of image 0 is not one of 20 classes");
    refused(
        &path,
        &batch([&[1, 1], &[1, 100]]),
        "the label 100 of image 1 is not one of 100 classes",
    );
}
