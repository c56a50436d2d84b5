// SPDX-License-Identifier: MIT OR Apache-2.0
//! Marks that say how a frame stands upright: the EXIF orientation of images, and the display
//! matrix of video.

use std::fs;
use std::path::Path;

use crate::clips::{clip, ffmpeg, frames, tools};
use foveate_media::{InputOptions, Orientation, SourceFrame, turned_images_warning};
use foveate_tools::testing::sample;
use image::{ImageBuffer, ImageFormat, Luma};

const SIZE: (u32, u32) = (16, 8);

/// The width, the height and the pixels of a frame.
type Pixels = (u32, u32, Vec<u16>);

fn pixels_of(seen: &SourceFrame) -> Pixels {
    let frame = &seen.frame;
    (frame.width(), frame.height(), frame.borrowed_pixels().to_words())
}

fn first(path: &Path, orientation: Orientation) -> Pixels {
    pixels_of(&frames(path, 8, &InputOptions { orientation, ..InputOptions::default() }).0[0])
}

/// Returns the EXIF data with an orientation: the header of TIFF and one directory with one entry.
fn exif(orientation: u8) -> Vec<u8> {
    let entry = [0x12, 1, 3, 0, 1, 0, 0, 0, orientation, 0, 0, 0];
    [&b"II*\0\x08\0\0\0\x01\0"[..], &entry, &[0; 4]].concat()
}

/// Returns the frame that stands upright, by the definition of the orientations: the place of the
/// stored row 0 and the stored column 0 in the scene.
fn upright((width, height, pixels): &Pixels, orientation: u8) -> Pixels {
    let is_turned = orientation >= 5;
    let size = if is_turned { (*height, *width) } else { (*width, *height) };
    let stored_place = |x: u32, y: u32| match orientation {
        1 => (x, y),
        2 => (width - 1 - x, y),
        3 => (width - 1 - x, height - 1 - y),
        4 => (x, height - 1 - y),
        5 => (y, x),
        6 => (y, height - 1 - x),
        7 => (width - 1 - y, height - 1 - x),
        _ => (width - 1 - y, x),
    };
    let places = (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y)));
    let found = places.map(|(x, y)| {
        let (x, y) = stored_place(x, y);
        pixels[(y * width + x) as usize]
    });
    (size.0, size.1, found.collect())
}

#[test]
fn images_stand_upright_if_it_is_wanted() {
    let dir = tempfile::tempdir().unwrap();
    let image =
        ImageBuffer::from_fn(SIZE.0, SIZE.1, |x, y| Luma([u8::try_from(x * 13 + y * 3).unwrap()]));
    for (format, extension) in [(ImageFormat::Jpeg, "jpg"), (ImageFormat::Png, "png")] {
        let path = dir.path().join("image").with_extension(extension);
        image.save_with_format(&path, format).unwrap();
        let bytes = fs::read(&path).unwrap();
        let plain = first(&path, Orientation::Stored);
        assert_eq!(first(&path, Orientation::Upright), plain, "{extension}");
        for orientation in 1..=8 {
            fs::write(&path, with_exif(&bytes, format, orientation)).unwrap();
            assert_eq!(first(&path, Orientation::Stored), plain, "{extension} {orientation}");
            let warning = turned_images_warning(std::slice::from_ref(&path));
            let named = warning.is_some_and(|text| text.contains("--orientation upright"));
            assert_eq!(named, orientation != 1, "{extension} {orientation}");
            let expected = upright(&plain, orientation);
            assert_eq!(first(&path, Orientation::Upright), expected, "{extension} {orientation}");
        }
    }
}

/// Puts EXIF data into an image.
fn with_exif(bytes: &[u8], format: ImageFormat, orientation: u8) -> Vec<u8> {
    let data = exif(orientation);
    if format == ImageFormat::Jpeg {
        let segment = [&b"Exif\0\0"[..], &data].concat();
        let length = u16::try_from(segment.len() + 2).unwrap().to_be_bytes();
        return [&bytes[..2], &[0xFF, 0xE1], &length, &segment, &bytes[2..]].concat();
    }
    // The header chunk of a PNG ends after 8 + 25 bytes.
    let chunk = [&b"eXIf"[..], &data].concat();
    let length = u32::try_from(data.len()).unwrap().to_be_bytes();
    let checksum = crc32fast::hash(&chunk).to_be_bytes();
    [&bytes[..33], &length, &chunk, &checksum, &bytes[33..]].concat()
}

#[test]
fn video_stands_upright_if_it_is_wanted() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for format in sample(["yuv420p", "yuv422p10le"], 2) {
        let source =
            clip(dir.path(), "source.mov", &["-c:v", "libx264", "-pix_fmt", format, "-t", "0.2"]);
        for degrees in ["90", "180", "270"] {
            let path = dir.path().join(format!("turned{degrees}.mov"));
            let mark = format!("rotate={degrees}");
            let [from, to] = [&source, &path].map(|path| path.to_str().unwrap());
            ffmpeg(&["-i", from, "-metadata:s:v", &mark, "-c", "copy", to]);
            let stored = first(&path, Orientation::Stored);
            assert_eq!((stored.0, stored.1), (80, 60));
            let turned = first(&path, Orientation::Upright);
            assert_eq!(turned.0, if degrees == "180" { 80 } else { 60 });
            assert_ne!(turned.2, stored.2);
            // ffmpeg turns the frames in the same way.
            let other = dir.path().join("turned.y4m");
            let out = other.to_str().unwrap();
            ffmpeg(&["-i", to, "-pix_fmt", format, "-strict", "-1", out]);
            assert_eq!(turned, first(&other, Orientation::Stored), "{format} {degrees}");
        }
    }
}
