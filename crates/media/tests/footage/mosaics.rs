// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mosaics of a Bayer filter, as images and as raw video.

use std::fs;
use std::path::Path;

use crate::clips::{frames, opened};
use foveate_media::{BayerPattern, InputOptions, LumaRange, RawLayout};
use foveate_pixels::{convert_depth, luma};
use image::{ImageBuffer, Luma, Rgb};

const WIDTH: usize = 9;
const HEIGHT: usize = 6;

/// Returns the sample at a place, which may lie a pixel outside of the mosaic.
fn sample(samples: &[u16], x: isize, y: isize) -> u32 {
    let mirrored = |place: isize, count: usize| {
        let count = isize::try_from(count).unwrap();
        usize::try_from(if place < 0 {
            -place
        } else if place < count {
            place
        } else {
            2 * count - 2 - place
        })
        .unwrap()
    };
    samples[mirrored(y, HEIGHT) * WIDTH + mirrored(x, WIDTH)].into()
}

/// Converts a mosaic by the words of the documents: the mean of the nearest pixels of a colour.
fn converted(samples: &[u16], pattern: &str) -> Vec<u16> {
    let colour_at = |x: isize, y: isize| {
        pattern.as_bytes()[usize::try_from(x.rem_euclid(2) + 2 * y.rem_euclid(2)).unwrap()]
    };
    let of_colour = |colour: u8, x: isize, y: isize| {
        if colour_at(x, y) == colour {
            return samples[usize::try_from(y).unwrap() * WIDTH + usize::try_from(x).unwrap()];
        }
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
        let same: Vec<(isize, isize)> =
            around.filter(|(dx, dy)| colour_at(x + dx, y + dy) == colour).collect();
        let nearest = same.iter().map(|(dx, dy)| dx.abs() + dy.abs()).min().unwrap();
        let near: Vec<u32> = same
            .iter()
            .filter(|(dx, dy)| dx.abs() + dy.abs() == nearest)
            .map(|(dx, dy)| sample(samples, x + dx, y + dy))
            .collect();
        // Twice the mean, plus 1, halved: halves are rounded up.
        let count = u32::try_from(near.len()).unwrap();
        u16::try_from((2 * near.iter().sum::<u32>() + count) / (2 * count)).unwrap()
    };
    let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    let pixels = places.map(|(x, y)| {
        let at = |colour| of_colour(colour, x.try_into().unwrap(), y.try_into().unwrap());
        luma(at(b'r'), at(b'g'), at(b'b'))
    });
    pixels.collect()
}

/// Returns samples without a pattern, of some bits.
fn noise(bits: u32) -> Vec<u16> {
    let mut state = 1_u32;
    let next = |_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        u16::try_from(state >> (32 - bits)).unwrap()
    };
    (0..WIDTH * HEIGHT).map(next).collect()
}

fn options(pattern: BayerPattern) -> InputOptions {
    InputOptions { bayer: Some(pattern), ..InputOptions::default() }
}

fn pixels(path: &Path, bits: u32, options: &InputOptions) -> Vec<u16> {
    frames(path, bits, options).0[0].frame.borrowed_pixels().to_words()
}

#[test]
fn images_of_a_mosaic_give_the_luma_of_the_nearest_colours() {
    let dir = tempfile::tempdir().unwrap();
    let (narrow, wide) = (dir.path().join("8.png"), dir.path().join("16.png"));
    let (bytes, words) = (noise(8), noise(16));
    let size = (u32::try_from(WIDTH).unwrap(), u32::try_from(HEIGHT).unwrap());
    let place = |x: u32, y: u32| y as usize * WIDTH + x as usize;
    ImageBuffer::from_fn(size.0, size.1, |x, y| Luma([u8::try_from(bytes[place(x, y)]).unwrap()]))
        .save(&narrow)
        .unwrap();
    ImageBuffer::from_fn(size.0, size.1, |x, y| Luma([words[place(x, y)]])).save(&wide).unwrap();
    for pattern in BayerPattern::ALL {
        let options = options(pattern);
        assert_eq!(pixels(&narrow, 8, &options), converted(&bytes, pattern.name()), "{pattern}");
        let deep = converted(&words, pattern.name());
        assert_eq!(pixels(&wide, 16, &options), deep, "{pattern}");
        // Low bits are dropped after the conversion.
        let dropped: Vec<u16> = deep.iter().map(|value| value >> 8).collect();
        assert_eq!(pixels(&wide, 8, &options), dropped, "{pattern}");
    }
}

#[test]
fn raw_video_of_a_mosaic_is_converted_at_its_own_depth() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mosaic.raw");
    for (bits, format) in [(8, "gray"), (12, "gray12le"), (10, "gray10be")] {
        let samples = noise(bits);
        let bytes: Vec<u8> = match format {
            "gray" => samples.iter().map(|&value| u8::try_from(value).unwrap()).collect(),
            "gray10be" => samples.iter().flat_map(|value| value.to_be_bytes()).collect(),
            _ => samples.iter().flat_map(|value| value.to_le_bytes()).collect(),
        };
        fs::write(&path, bytes).unwrap();
        for pattern in BayerPattern::ALL {
            let raw = RawLayout::parse(&format!("{WIDTH}x{HEIGHT},{format}")).ok();
            // A mosaic has all values, so the range of luma changes nothing.
            let options = InputOptions { raw, luma: LumaRange::Full, ..options(pattern) };
            let expected = converted(&samples, pattern.name());
            let expected: Vec<u16> =
                expected.into_iter().map(|value| convert_depth(value, bits, 8)).collect();
            assert_eq!(pixels(&path, 8, &options), expected, "{format} {pattern}");
        }
    }
}

#[test]
fn inputs_that_are_no_mosaic_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let plain = options(BayerPattern::Rggb);
    let refused = |path: &Path, options: &InputOptions| {
        let error = opened(path, 8, options).err().unwrap().to_string();
        assert!(error.starts_with("--bayer cannot be used: "), "{error}");
        error
    };
    let colours = dir.path().join("colours.png");
    ImageBuffer::from_pixel(4, 4, Rgb([1_u8, 2, 3])).save(&colours).unwrap();
    assert!(refused(&colours, &plain).contains("colours.png` has colours"));
    let line = dir.path().join("line.png");
    ImageBuffer::from_pixel(4, 1, Luma([1_u8])).save(&line).unwrap();
    assert!(refused(&line, &plain).contains("smaller than 2x2"));
    assert!(refused(Path::new("scene:street"), &plain).contains("leave the option out"));
    let clip = dir.path().join("clip.yuv");
    fs::write(&clip, [0; 24]).unwrap();
    for (layout, problem) in [("4x4,yuv420p", "a mosaic are grey"), ("4x1,gray", "at least 2x2")] {
        let raw = RawLayout::parse(layout).ok();
        assert!(refused(&clip, &InputOptions { raw, ..plain.clone() }).contains(problem));
    }
}
