// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damaged images of every type are refused wherever the format makes damage detectable.
//! `docs/inputs.md` names the damage that cannot be detected.

use std::fs;
use std::io::{Cursor, Write as _};
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use foveate_media::{FootageError, decode};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb};

/// JPEG files of one picture in every kind of coding. The last one has a thumbnail in its header.
const JPEGS: [&str; 9] = [
    "baseline",
    "optimized",
    "restarts",
    "progressive",
    "grey",
    "grey_progressive",
    "cmyk",
    "quarter",
    "thumbnail",
];

fn jpeg(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures");
    fs::read(folder.join(name).with_extension("jpg")).unwrap()
}

/// Returns the message of the reader if it refuses these bytes.
fn problem(bytes: &[u8]) -> Option<String> {
    let error = decode(bytes, Path::new("picture"), 8).err()?;
    let expected = matches!(
        error,
        FootageError::Truncated { .. }
            | FootageError::Damaged { .. }
            | FootageError::UnsupportedType { .. }
            | FootageError::UnsupportedFeature { .. }
            | FootageError::TooLarge { .. }
    );
    assert!(expected, "{error:?}");
    Some(error.to_string())
}

fn refused(bytes: &[u8], part: &str, case: &str) {
    let said = problem(bytes).unwrap_or_else(|| panic!("{case} is accepted"));
    assert!(said.contains(part) && !said.contains('\n'), "{case}: {said}");
}

/// Returns the position after the header of the first scan, where coded pixels begin.
fn scan(bytes: &[u8]) -> usize {
    let mut at = 2;
    loop {
        let length = usize::from(u16::from_be_bytes([bytes[at + 2], bytes[at + 3]]));
        let marker = bytes[at + 1];
        at += 2 + length;
        if marker == 0xDA {
            return at;
        }
    }
}

fn pixels(bytes: &[u8]) -> Vec<u16> {
    decode(bytes, Path::new("picture"), 8).unwrap().pixels().to_vec()
}

#[test]
fn whole_jpegs_of_every_kind_are_read() {
    // The same coefficients give the same pixels, however they are coded.
    for name in ["restarts", "progressive"] {
        assert_eq!(pixels(&jpeg(name)), pixels(&jpeg("baseline")), "{name}");
    }
    assert_eq!(pixels(&jpeg("grey_progressive")), pixels(&jpeg("grey")));
    for name in JPEGS {
        let whole = jpeg(name);
        let expected = pixels(&whole);
        let (start, end) = (scan(&whole), whole.len() - 2);
        // Phones add bytes after a picture, and bytes FF may precede a marker.
        for (at, more) in [(whole.len(), &b"trailer\xFF\xD8\xFF"[..]), (end, &[0xFF; 3])] {
            let longer = [&whole[..at], more, &whole[at..]].concat();
            assert_eq!(pixels(&longer), expected, "{name}");
        }
        assert!(start < end);
    }
}

#[test]
fn a_cut_jpeg_is_refused_with_and_without_an_end() {
    for name in JPEGS {
        let whole = jpeg(name);
        for length in (2..whole.len()).step_by(5) {
            refused(&whole[..length], "`picture`", &format!("{name} cut to {length}"));
        }
        // Some cameras and programs add an end marker to an incomplete file.
        for length in (scan(&whole)..whole.len() - 3).step_by(3) {
            let closed = [&whole[..length], &[0xFF, 0xD9]].concat();
            refused(&closed, "`picture`", &format!("{name} closed at {length}"));
        }
    }
}

#[test]
fn zeroed_stretches_of_a_jpeg_are_refused() {
    for name in JPEGS {
        let whole = jpeg(name);
        for length in [100, 400] {
            let (mut cases, mut accepted) = (0, 0);
            for start in (scan(&whole)..whole.len() - 2 - length).step_by(11) {
                let mut damaged = whole.clone();
                damaged[start..start + length].fill(0);
                cases += 1;
                accepted += u32::from(problem(&damaged).is_none());
            }
            // In a scan that refines earlier scans, the codes have one bit, so zeros are valid
            // codes.
            let allowed = if name == "progressive" { cases / 50 } else { 0 };
            assert!(
                cases > 40 && accepted <= allowed,
                "{name}: {accepted} of {cases} are accepted"
            );
        }
    }
}

#[test]
fn markers_of_a_jpeg_come_in_their_order() {
    let whole = jpeg("restarts");
    let restart = |number: u8| {
        let at = whole.windows(2).position(|pair| pair == [0xFF, 0xD0 + number]);
        at.unwrap()
    };
    let with = |at: usize, byte: u8| {
        let mut other = whole.clone();
        other[at] = byte;
        other
    };
    refused(
        &with(restart(1) + 1, 0xD5),
        "marker D5 stands where restart marker D1",
        "another number",
    );
    refused(
        &with(restart(2) + 1, 0xC4),
        "marker C4 stands where restart marker D2",
        "another marker",
    );
    let mut without = whole.clone();
    without.drain(restart(0)..restart(1));
    refused(&without, "marker D1 stands where", "a run is missing");
    let mut with_more = whole.clone();
    with_more.splice(restart(0)..restart(0), [0x12; 4]);
    refused(&with_more, "more coded data", "bytes before a restart marker");
    let end = whole.len() - 2;
    let more = [&whole[..end], &[0; 4], &whole[end..]].concat();
    refused(&more, "more coded data", "bytes before the end marker");
    refused(&whole[..end], "it has no end marker (EOI)", "no end marker");
    let header = scan(&whole);
    refused(&[&whole[..header], &[0xFF, 0xD9]].concat(), "missing before its end", "no pixels");
    let mut stray = jpeg("baseline");
    let at = stray.windows(4).position(|four| four == [0xFF, 0xC0, 0x00, 0x11]).unwrap();
    stray.splice(at..at, [1, 2, 3]);
    refused(&stray, "bytes before a marker", "bytes between segments");
}

/// Makes a PNG of chunks with correct checksums.
fn png(chunks: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (name, data) in chunks {
        bytes.extend(u32::try_from(data.len()).unwrap().to_be_bytes());
        let named = [&name[..], data].concat();
        bytes.extend(&named);
        let sum = flate2::Crc::new();
        bytes.extend(checksum(sum, &named).to_be_bytes());
    }
    bytes
}

fn checksum(mut sum: flate2::Crc, bytes: &[u8]) -> u32 {
    sum.update(bytes);
    sum.sum()
}

fn packed(rows: &[u8]) -> Vec<u8> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::default());
    packer.write_all(rows).unwrap();
    packer.finish().unwrap()
}

/// Returns the header of a grey picture of 4 x 3 pixels.
fn header() -> Vec<u8> {
    vec![0, 0, 0, 4, 0, 0, 0, 3, 8, 0, 0, 0, 0]
}

const ROWS: [u8; 15] = [0, 1, 2, 3, 4, 0, 5, 6, 7, 8, 0, 9, 8, 7, 6];

#[test]
fn every_byte_of_a_png_counts() {
    let text = (b"tEXt", b"Title\0of this picture".to_vec());
    let chunks = [
        (b"IHDR", header()),
        text,
        (b"IDAT", packed(&ROWS)),
        (b"tIME", vec![7, 1, 1, 1, 1, 1, 1]),
        (b"IEND", vec![]),
    ];
    let whole = png(&chunks);
    assert_eq!(pixels(&whole)[..5], [1, 2, 3, 4, 5]);
    for at in 8..whole.len() {
        for bit in [0x01, 0x80] {
            let mut damaged = whole.clone();
            damaged[at] ^= bit;
            refused(&damaged, "`picture`", &format!("byte {at}"));
        }
        refused(&whole[..at], "`picture`", &format!("cut to {at}"));
    }
    // Bytes after the end chunk are not part of the picture.
    assert_eq!(pixels(&[&whole[..], b"more"].concat()), pixels(&whole));
}

#[test]
fn compressed_pixels_of_a_png_fill_its_rows() {
    let made = |data: Vec<Vec<u8>>| {
        let mut chunks = vec![(b"IHDR", header())];
        chunks.extend(data.into_iter().map(|data| (b"IDAT", data)));
        chunks.push((b"IEND", vec![]));
        png(&chunks)
    };
    let whole = packed(&ROWS);
    let (one, other) = whole.split_at(5);
    assert!(problem(&made(vec![one.to_vec(), vec![], other.to_vec()])).is_none());
    let mut wrong = whole.clone();
    *wrong.last_mut().unwrap() ^= 1;
    for (data, part) in [
        (packed(&ROWS[..10]), "does not have enough data"),
        (whole[..whole.len() - 7].to_vec(), "Corrupt deflate stream"),
        (wrong, "WrongChecksum"),
    ] {
        refused(&made(vec![data]), part, part);
    }
    // The decoder stops at the last pixel.
    for longer in [packed(&[&ROWS[..], &[0]].concat()), [&whole[..], &[0]].concat()] {
        assert_eq!(pixels(&made(vec![longer])), pixels(&made(vec![whole.clone()])));
    }
}

#[test]
fn interlaced_and_deep_pngs_are_as_long_as_they_say() {
    // The seven passes of 5 x 5 grey pixels: the number of rows, and the bytes of each row with its
    // filter byte.
    let passes: usize =
        [(1, 2), (1, 2), (1, 3), (2, 2), (1, 4), (3, 3), (2, 6)].iter().map(|(n, b)| n * b).sum();
    let interlaced = |length: usize| {
        let header = vec![0, 0, 0, 5, 0, 0, 0, 5, 8, 0, 0, 0, 1];
        png(&[(b"IHDR", header), (b"IDAT", packed(&vec![0; length])), (b"IEND", vec![])])
    };
    assert_eq!(problem(&interlaced(passes)), None);
    refused(&interlaced(passes - 1), "does not have enough data", "interlaced");
    let deep: DynamicImage = ImageBuffer::from_fn(5, 3, |x, y| {
        Rgb([7_u16, 0, 0].map(|v| v * u16::try_from(x + y).unwrap()))
    })
    .into();
    let mut bytes = Cursor::new(Vec::new());
    deep.write_to(&mut bytes, ImageFormat::Png).unwrap();
    assert_eq!(problem(&bytes.into_inner()), None);
}

#[test]
fn a_pnm_is_one_image_with_samples_in_range() {
    for (bytes, part) in [
        (&b"P5 2 2 255\nabc"[..], "`picture` is truncated"),
        (b"P5 2 1 100\n\x64\x65", "a sample of 101, but its maximum is 100"),
        (b"P5 1 1 1000\n\x03\xE9", "a sample of 1001, but its maximum is 1000"),
        (b"P5 1 1 255\naP5 1 1 255\nb", "more images follow the first one"),
        (b"P5 1 1 255\nab", "1 bytes follow its last pixel"),
        (b"P4 8 1\n\xA5\xA5", "1 bytes follow its last pixel"),
        (b"P6 1 1 255\nab", "`picture` is truncated"),
        (b"P2 2 1 15\n3 16\n", "a sample of 16, but its maximum is 15"),
        (b"P2 2 1 15\n3", "`picture` is "),
        (b"P2 2 1 15\n3 x\n", "`picture` is damaged"),
        (b"P2 2 1 15\n3 -1\n", "`picture` is damaged"),
        (b"P2 1 1 15\n3 4\n", "bytes follow its last pixel"),
        (b"P1 2 1\n0 2\n", "`picture` is damaged"),
        (b"P1 2 1\n0", "`picture` is "),
        (
            b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 1\nMAXVAL 9\nTUPLTYPE GRAYSCALE\nENDHDR\n\x0A",
            "a sample of 10",
        ),
        (
            b"P7\nWIDTH 1\nHEIGHT 2\nDEPTH 1\nMAXVAL 255\nTUPLTYPE GRAYSCALE\nENDHDR\n\x0A",
            "`picture` is truncated",
        ),
    ] {
        refused(bytes, part, &bytes.escape_ascii().to_string());
    }
    for whole in [
        &b"P5 2 1 255\nab"[..],
        b"P5 2 1 255\nab\n",
        b"P5 # a comment\n2 1 # and another\n100\n\x64\x00",
        b"P2\n# a comment\n2 1\n15\n3 15",
        b"P1 4 1 0110",
        b"P4 9 1\n\xA5\x80",
        b"P6 1 1 1000\n\0\x01\x03\xE8\0\x03",
    ] {
        assert_eq!(problem(whole), None, "{}", whole.escape_ascii());
    }
}

/// Makes a BMP with 8 bits per pixel and rows coded in runs: 6 x 2 pixels, the lower row first.
fn runs(codes: &[u8]) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    let offset = 14 + 40 + 1024;
    let words = |bytes: &mut Vec<u8>, words: &[usize]| {
        for &word in words {
            bytes.extend(u32::try_from(word).unwrap().to_le_bytes());
        }
    };
    words(
        &mut bytes,
        &[offset + codes.len(), 0, offset, 40, 6, 2, 1 | 8 << 16, 1, codes.len(), 0, 0, 256, 0],
    );
    bytes.extend((0..=255).flat_map(|grey: u8| [grey, grey, grey, 0]));
    bytes.extend(codes);
    bytes
}

#[test]
fn runs_of_a_bmp_fill_its_rows() {
    let whole = runs(&[6, 40, 0, 0, 2, 80, 0, 4, 1, 2, 3, 4, 0, 0, 0, 1]);
    assert_eq!(pixels(&whole), [80, 80, 1, 2, 3, 4, 40, 40, 40, 40, 40, 40]);
    for length in 0..whole.len() {
        refused(&whole[..length], "`picture`", &format!("cut to {length}"));
    }
    for (codes, part) in [
        (&[6, 40, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1][..], "ends before its last pixel"),
        (&[6, 40, 0, 0, 6, 80, 0, 0, 6, 3, 0, 1], "more rows"),
        (&[6, 40, 0, 1], "end before the last row"),
        (&[6, 40, 0, 0, 0, 2, 9, 0, 0, 1], "`picture` is damaged"),
    ] {
        refused(&runs(codes), part, &format!("{codes:?}"));
    }
    let plain: DynamicImage =
        ImageBuffer::from_fn(7, 5, |x, y| Luma([u8::try_from(x * y).unwrap()])).into();
    let mut bytes = Cursor::new(Vec::new());
    plain.write_to(&mut bytes, ImageFormat::Bmp).unwrap();
    let bytes = bytes.into_inner();
    assert_eq!(problem(&bytes), None);
    refused(&bytes[..bytes.len() - 1], "truncated", "a plain BMP");
}

#[test]
fn images_of_other_types_are_named() {
    for (bytes, name) in [
        (&b"II*\0\x08\0\0\0\0\0\0\0\0\0"[..], "TIFF"),
        (b"RIFF\x1A\0\0\0WEBPVP8L\x0D\0\0\0", "WebP"),
        (b"\0\0\0\x20ftypavif\0\0\0\0", "AVIF"),
    ] {
        let said = decode(bytes, Path::new("a.png"), 8).unwrap_err().to_string();
        for part in [
            &format!("`a.png` is an image of the type {name}, which is not read"),
            "magick 'a.png' 'a.converted.png'",
        ] {
            assert!(said.contains(part), "{said}");
        }
    }
}
