// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutated images of every type are decoded or refused, and none causes a panic.
//! `FOVEATE_FUZZ_CASES` sets the number of cases per seed image for a longer search.

use std::io::Cursor;
use std::path::Path;

use foveate_media::decode;
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};

/// The number of cases per seed image of a normal test run.
const CASES: u64 = 5_000;

/// The generator xorshift64*, which gives the same cases on every machine.
struct RandomNumbers(u64);

impl RandomNumbers {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33;
        usize::try_from(high).unwrap() % bound.max(1)
    }

    fn byte(&mut self) -> u8 {
        const NASTY: [u8; 8] = [0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF, b'9', b' '];
        match self.below(3) {
            0 => NASTY[self.below(NASTY.len())],
            _ => u8::try_from(self.below(256)).unwrap(),
        }
    }
}

fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let value = |v: u32| u8::try_from(v % 256).unwrap();
    let grey: DynamicImage =
        ImageBuffer::from_fn(9, 7, |x, y| Luma([value(x * 29 + y * y * 5)])).into();
    let colour: DynamicImage =
        ImageBuffer::from_fn(17, 9, |x, y| Rgb([value(x * 15), value(y * 27), 80])).into();
    let deep: DynamicImage = ImageBuffer::from_fn(5, 4, |x, y| Luma([word(x * y)])).into();
    let alpha: DynamicImage =
        ImageBuffer::from_fn(6, 6, |x, y| Rgba([value(x * 40), value(y * 40), 7, value(x)])).into();
    let encoded = |image: &DynamicImage, format| {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    };
    vec![
        ("png grey", encoded(&grey, ImageFormat::Png)),
        ("png deep", encoded(&deep, ImageFormat::Png)),
        ("png alpha", encoded(&alpha, ImageFormat::Png)),
        ("jpeg grey", encoded(&grey, ImageFormat::Jpeg)),
        ("jpeg colour", encoded(&colour, ImageFormat::Jpeg)),
        ("jpeg progressive", pictured("grey_progressive")),
        ("jpeg restarts", pictured("restarts")),
        ("bmp grey", encoded(&grey, ImageFormat::Bmp)),
        ("bmp colour", encoded(&colour, ImageFormat::Bmp)),
        ("pgm", encoded(&grey, ImageFormat::Pnm)),
        ("pgm deep", encoded(&deep, ImageFormat::Pnm)),
        ("ppm", encoded(&colour, ImageFormat::Pnm)),
        ("pgm text", b"P2\n# made here\n3 2\n15\n0 1 2\n3 14 15\n".to_vec()),
        ("pbm text", b"P1 4 2 0101 1100".to_vec()),
        ("pbm", b"P4 9 2\n\xA5\x80\x3C\x00".to_vec()),
        (
            "pam",
            b"P7\nWIDTH 2\nHEIGHT 1\nDEPTH 2\nMAXVAL 255\nTUPLTYPE GRAYSCALE_ALPHA\nENDHDR\nabcd"
                .to_vec(),
        ),
    ]
}

/// Returns a JPEG of the folder of test pictures.
fn pictured(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures");
    std::fs::read(folder.join(name).with_extension("jpg")).unwrap()
}

fn word(value: u32) -> u16 {
    u16::try_from(value * 5_003 % 65_536).unwrap()
}

fn mutate(bytes: &mut Vec<u8>, chance: &mut RandomNumbers) {
    for _ in 0..=chance.below(4) {
        let at = chance.below(bytes.len());
        match chance.below(6) {
            0 | 1 => replace(bytes, at, chance.byte()),
            2 => {
                let bit = 1 << chance.below(8);
                let old = bytes.get(at).copied().unwrap_or(0);
                replace(bytes, at, old ^ bit);
            }
            3 => bytes.insert(at, chance.byte()),
            4 if !bytes.is_empty() => drop(bytes.remove(at)),
            _ => {
                // Copies some bytes over others, as a bad disk block does.
                let from = chance.below(bytes.len());
                let length = chance.below(12);
                let stretch: Vec<u8> = bytes.iter().skip(from).take(length).copied().collect();
                for (offset, byte) in stretch.into_iter().enumerate() {
                    replace(bytes, at + offset, byte);
                }
            }
        }
    }
    if chance.below(8) == 0 {
        bytes.truncate(chance.below(bytes.len() + 1));
    }
}

fn replace(bytes: &mut [u8], at: usize, value: u8) {
    if let Some(byte) = bytes.get_mut(at) {
        *byte = value;
    }
}

/// Corrects the checksums of a PNG, so that mutations get past their check.
fn mend_png(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(&length) = bytes.get(at..).and_then(<[u8]>::first_chunk::<4>) {
        let end = at + 8 + u32::from_be_bytes(length) as usize;
        let Some(content) = bytes.get(at + 4..end) else { return };
        let sum = crc32(content).to_be_bytes();
        let Some(place) = bytes.get_mut(end..end + 4) else { return };
        place.copy_from_slice(&sum);
        at = end + 4;
    }
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & 0u32.wrapping_sub(crc & 1))
        })
    })
}

#[test]
fn no_image_makes_the_reader_panic() {
    let cases = std::env::var("FOVEATE_FUZZ_CASES").map_or(CASES, |text| text.parse().unwrap());
    let mut chance = RandomNumbers(0x5EED_F00D_1234_5678);
    for (name, seed) in seeds() {
        assert!(decode(&seed, Path::new(name), 8).is_ok(), "{name} is valid before mutation");
        let (mut accepted, mut refused) = (0, 0);
        for case in 0..cases {
            let mut bytes = seed.clone();
            mutate(&mut bytes, &mut chance);
            if name.starts_with("png") && case % 4 != 0 {
                mend_png(&mut bytes);
            }
            let bits = 1 + u32::try_from(case % 16).unwrap();
            match decode(&bytes, Path::new(name), bits) {
                Ok(frame) => {
                    assert_eq!(frame.bits(), bits);
                    accepted += 1;
                }
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.contains(name) && !message.contains('\n'), "{message:?}");
                    refused += 1;
                }
            }
        }
        assert!(cases < 100 || accepted > 0 && refused > 0, "{name}: {accepted} and {refused}");
    }
}
