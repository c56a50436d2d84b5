// SPDX-License-Identifier: MIT OR Apache-2.0
//! Images of every type and depth give the luma that the rules define, or a message that names the
//! reason.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use foveate_media::{FootageError, decode, read};
use foveate_pixels::{convert_depth, luma};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, LumaA, Rgb, Rgba};

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn pixels(bytes: &[u8], bits: u32) -> Vec<u16> {
    decode(bytes, Path::new("test"), bits).unwrap().pixels().to_vec()
}

fn byte(value: u32) -> u8 {
    u8::try_from(value % 256).unwrap()
}

fn word(value: u32) -> u16 {
    u16::try_from(value % 65_536).unwrap()
}

fn grey8() -> DynamicImage {
    ImageBuffer::from_fn(13, 9, |x, y| Luma([byte(x * 17 + y * 31)])).into()
}

fn rgb8() -> DynamicImage {
    ImageBuffer::from_fn(13, 9, |x, y| Rgb([byte(x * 19), byte(y * 29), byte(x * y)])).into()
}

fn grey16() -> DynamicImage {
    ImageBuffer::from_fn(13, 9, |x, y| Luma([word(x * 4_999 + y * 331)])).into()
}

#[test]
fn lossless_types_give_the_same_luma() {
    let expected: Vec<u16> = rgb8()
        .into_rgb8()
        .pixels()
        .map(|p| luma(p.0[0].into(), p.0[1].into(), p.0[2].into()))
        .collect();
    for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Pnm] {
        assert_eq!(pixels(&encoded(&rgb8(), format), 8), expected, "{format:?}");
    }
    let expected: Vec<u16> = grey8().into_luma8().as_raw().iter().map(|&v| v.into()).collect();
    for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Pnm] {
        assert_eq!(pixels(&encoded(&grey8(), format), 8), expected, "{format:?}");
    }
}

#[test]
fn sixteen_bits_stay_sixteen_bits() {
    let expected = grey16().into_luma16().into_raw();
    assert_eq!(pixels(&encoded(&grey16(), ImageFormat::Png), 16), expected);
    assert_eq!(pixels(&encoded(&grey16(), ImageFormat::Pnm), 16), expected);
    let colour: ImageBuffer<Rgb<u16>, Vec<u16>> =
        ImageBuffer::from_fn(5, 4, |x, y| Rgb([word(x * 9_001), word(y * 20_011), 65_535]));
    let expected: Vec<u16> = colour.pixels().map(|p| luma(p.0[0], p.0[1], p.0[2])).collect();
    assert_eq!(pixels(&encoded(&colour.into(), ImageFormat::Png), 16), expected);
}

#[test]
fn depth_follows_the_rule_from_both_source_depths() {
    let narrow: Vec<u16> = grey8().into_luma8().as_raw().iter().map(|&v| v.into()).collect();
    let wide = grey16().into_luma16().into_raw();
    for bits in 1..=16 {
        let expected: Vec<u16> = narrow.iter().map(|&v| convert_depth(v, 8, bits)).collect();
        assert_eq!(pixels(&encoded(&grey8(), ImageFormat::Png), bits), expected);
        let expected: Vec<u16> = wide.iter().map(|&v| v >> (16 - bits)).collect();
        assert_eq!(pixels(&encoded(&grey16(), ImageFormat::Png), bits), expected);
    }
}

#[test]
fn alpha_is_ignored() {
    let grey = ImageBuffer::from_fn(4, 4, |x, y| LumaA([byte(16 * x + y), byte(x)]));
    let expected: Vec<u16> = grey.pixels().map(|p| p.0[0].into()).collect();
    assert_eq!(pixels(&encoded(&grey.into(), ImageFormat::Png), 8), expected);
    let colour = ImageBuffer::from_fn(4, 4, |x, y| Rgba([byte(60 * x), byte(60 * y), 9, byte(x)]));
    let expected: Vec<u16> =
        colour.pixels().map(|p| luma(p.0[0].into(), p.0[1].into(), 9)).collect();
    assert_eq!(pixels(&encoded(&colour.into(), ImageFormat::Png), 8), expected);
}

#[test]
fn few_bits_count_as_the_full_range() {
    assert_eq!(pixels(b"P1 4 1 0 1 1 0", 8), [255, 0, 0, 255]);
    assert_eq!(pixels(b"P2 4 1 15 0 1 8 15", 8), [0, 17, 136, 255]);
    assert_eq!(pixels(b"P2 3 1 100 0 50 100", 8), [0, 128, 255]);
    // The 10 bits of a sensor in a PGM are unchanged.
    let raw: Vec<u8> = (0..1024u16).flat_map(u16::to_be_bytes).collect();
    let pgm = [&b"P5 1024 1 1023\n"[..], &raw].concat();
    assert_eq!(pixels(&pgm, 10), (0..1024).collect::<Vec<u16>>());
}

#[test]
fn jpeg_is_near_what_was_encoded() {
    let smooth: DynamicImage =
        ImageBuffer::from_fn(32, 32, |x, y| Luma([byte(3 * x + 2 * y)])).into();
    let seen = pixels(&encoded(&smooth, ImageFormat::Jpeg), 8);
    let expected = smooth.into_luma8();
    assert!(seen.iter().zip(expected.as_raw()).all(|(&a, &b)| a.abs_diff(b.into()) < 8));
}

/// Returns a picture with so much detail that no coder leaves its last bytes unused.
fn busy() -> DynamicImage {
    ImageBuffer::from_fn(24, 24, |x, y| Luma([byte((x * 7_919 + y * 104_729) * (x + 3 * y) / 7)]))
        .into()
}

#[test]
fn an_image_cut_anywhere_is_refused() {
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp, ImageFormat::Pnm] {
        let whole = encoded(&busy(), format);
        assert!(decode(&whole, Path::new("whole"), 8).is_ok());
        for length in 0..whole.len() {
            let error = decode(&whole[..length], Path::new("cut.img"), 8);
            let message = error.expect_err(&format!("{format:?} cut to {length}")).to_string();
            assert!(message.contains("`cut.img`") && !message.contains('\n'), "{message}");
        }
        let half = decode(&whole[..whole.len() / 2], Path::new("half.img"), 8).unwrap_err();
        assert!(matches!(half, FootageError::Truncated { .. }), "{format:?} cut in half: {half}");
    }
}

#[test]
fn damage_is_named() {
    let mut png = encoded(&busy(), ImageFormat::Png);
    let middle = png.len() / 2;
    png[middle] ^= 0x55;
    let error = decode(&png, Path::new("bad.png"), 8).unwrap_err();
    assert!(matches!(error, FootageError::Damaged { .. }), "{error}");
    assert!(error.to_string().starts_with("image `bad.png` is damaged: "));
}

#[test]
fn images_beyond_the_limits_are_refused_before_they_are_decoded() {
    for header in ["P5 16385 1 255\n", "P5 1 16385 255\n", "P6 100000 100000 65535\n"] {
        let error = decode(header.as_bytes(), Path::new("big.pgm"), 8).unwrap_err();
        assert!(matches!(error, FootageError::TooLarge { .. }), "{header}: {error}");
        assert!(error.to_string().contains("16384 pixels per side"));
    }
    // The picture is within the limit of sides, but beyond the limit of memory.
    let error = decode(b"P6 16384 16384 65535\n", Path::new("big.ppm"), 8).unwrap_err();
    assert!(matches!(error, FootageError::TooLarge { .. }), "{error}");
    let wide = [&b"P5 16384 1 255\n"[..], &[7; 16_384]].concat();
    assert_eq!(pixels(&wide, 8), [7; 16_384]);
}

#[test]
fn files_are_told_apart_by_content_and_folders_are_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("really-a-png.jpg");
    fs::write(&path, encoded(&grey8(), ImageFormat::Png)).unwrap();
    assert_eq!(read(&path, 8).unwrap().width(), 13);
    assert!(read(folder.path(), 8).unwrap_err().to_string().starts_with("cannot read `"));
}
