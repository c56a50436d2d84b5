// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that every scene has any size and depth, and that its bytes do not change.
//! `FOVEATE_BLESS=1` rewrites the golden file.

use std::fmt::Write;

use foveate_pixels::{Frame, Scene, SceneError, SceneParameters};

fn size(width: u32, height: u32, bits: u32, region_size: u32, frames: u32) -> SceneParameters {
    SceneParameters { width, height, bits, region_size, frames }
}

/// Returns the FNV-1a hash of the little-endian bytes of all pixels.
fn checksum(frames: impl Iterator<Item = Frame>) -> u64 {
    frames.fold(0xCBF2_9CE4_8422_2325, |hash, frame| {
        frame
            .pixels()
            .iter()
            .flat_map(|pixel| pixel.to_le_bytes())
            .fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3))
    })
}

#[test]
fn bytes_are_those_of_the_golden_file() {
    let mut actual = String::new();
    for scene in Scene::ALL {
        for size in [size(64, 48, 8, 8, 6), size(37, 53, 12, 5, 4), size(17, 9, 1, 4, 3)] {
            let sum = checksum(scene.frames(size));
            let SceneParameters { width, height, bits, region_size, frames } = size;
            writeln!(
                actual,
                "{scene} {width}x{height} P{bits} N{region_size} T{frames} {sum:016x}"
            )
            .unwrap();
        }
    }
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/golden/checksums.txt");
    if std::env::var_os("FOVEATE_BLESS").is_some() {
        std::fs::write(golden, &actual).unwrap();
    }
    assert_eq!(std::fs::read_to_string(golden).unwrap(), actual);
}

#[test]
fn every_size_and_depth_works() {
    for scene in Scene::ALL {
        for (width, height) in [(1, 1), (2, 1), (1, 7), (8, 8), (9, 9), (300, 1), (31, 64)] {
            for bits in 1..=16 {
                for region_size in [2, 5, 64] {
                    let size = size(width, height, bits, region_size, 3);
                    let frames: Vec<Frame> = scene.frames(size).collect();
                    assert_eq!(frames.len(), 3, "{scene} {size:?}");
                    assert!(
                        frames
                            .iter()
                            .all(|f| (f.width(), f.height(), f.bits()) == (width, height, bits)),
                        "{scene} {size:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn sizes_out_of_range_are_clamped() {
    for scene in Scene::ALL {
        let frame = scene.frames(size(0, 0, 0, 0, 1)).next().unwrap();
        assert_eq!((frame.width(), frame.height(), frame.bits()), (1, 1, 1));
        let frame = scene.frames(size(3, 3, 99, 99, 1)).next().unwrap();
        assert_eq!(frame.bits(), 16);
    }
}

#[test]
fn the_iterator_knows_its_length() {
    let mut frames = Scene::Zero.frames(size(4, 4, 8, 2, 5));
    assert_eq!(frames.len(), 5);
    frames.next();
    assert_eq!(frames.len(), 4);
    assert_eq!(frames.by_ref().count(), 4);
    assert_eq!(frames.len(), 0);
    assert!(frames.next().is_none());
}

#[test]
fn scenes_are_found_by_name_and_their_names_are_distinct() {
    for &scene in Scene::ALL {
        assert_eq!(Scene::find(scene.name()), Ok(scene));
        assert!(scene.default_frames() > 0 && !scene.summary().is_empty());
    }
    let error = Scene::find("stret").unwrap_err();
    let SceneError::UnknownScene { nearest, known, .. } = &error else { panic!("{error}") };
    assert_eq!(nearest.as_deref(), Some("street"));
    assert!(known.starts_with("street, zero, max"));
    assert!(error.to_string().starts_with("unknown scene `stret`; did you mean `street`?"));
    assert!(!Scene::find("xyzzy").unwrap_err().to_string().contains("did you mean"));
}
