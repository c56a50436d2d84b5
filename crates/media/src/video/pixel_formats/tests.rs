// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raw bytes of every pixel format that ffmpeg knows go through the filters of video. The resulting
//! luma is compared with the bytes, by an independent table of the formats.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

use foveate_pixels::{convert_depth, luma};
use foveate_tools::{Interrupt, Invocation, Tool, Toolchain, testing::require_tools};
use serde::Deserialize;

use super::*;
use crate::video::VideoMedium;
use crate::video::decoder::{DecodingParameters, VideoDecoder};

const WIDTH: usize = 16;
const HEIGHT: usize = 8;
const AREA: usize = WIDTH * HEIGHT;

#[derive(Deserialize)]
struct ListedFormat {
    pixel_formats: Vec<PixelFormat>,
}

#[derive(Deserialize)]
struct PixelFormat {
    name: String,
    flags: FormatFlags,
    #[serde(default)]
    components: Vec<ListedComponent>,
}

#[derive(Deserialize)]
struct FormatFlags {
    hwaccel: u8,
}

#[derive(Deserialize)]
struct ListedComponent {
    bit_depth: u32,
}

/// The position of the samples of one plane or channel.
#[derive(Clone, Copy)]
struct ComponentPlace {
    offset: usize,
    step: usize,
    shift: u32,
    depth: u32,
    big_endian: bool,
}

impl ComponentPlace {
    fn samples(self, bytes: &[u8]) -> Vec<u16> {
        let word = |at: usize| match (self.depth + self.shift > 8, self.big_endian) {
            (false, _) => u16::from(bytes[at]),
            (true, true) => u16::from_be_bytes([bytes[at], bytes[at + 1]]),
            (true, false) => u16::from_le_bytes([bytes[at], bytes[at + 1]]),
        };
        let at = |pixel: usize| word(self.offset + pixel * self.step) >> self.shift;
        (0..AREA).map(|pixel| at(pixel) & (u16::MAX >> (16 - self.depth))).collect()
    }
}

/// Returns the position of the luma of a format that has it, by its name.
fn place_of_luma(name: &str, depth: u32) -> Option<ComponentPlace> {
    let big_endian = name.ends_with("be");
    let wide = if depth > 8 { 2 } else { 1 };
    let place =
        |offset, step, shift| Some(ComponentPlace { offset, step, shift, depth, big_endian });
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    match name {
        "yuyv422" | "yvyu422" | "ya8" => place(0, 2, 0),
        "uyvy422" => place(1, 2, 0),
        "vuya" | "vuyx" => place(2, 4, 0),
        "uyyvyy411" => None,
        _ if name.starts_with("ya16") => place(0, 4, 0),
        _ if name.starts_with("ayuv64") => place(2, 8, 0),
        _ if name.starts_with("y2") => place(0, 4, 16 - depth),
        _ if starts(&["p0", "p2", "p4"]) => place(0, 2, 16 - depth),
        // Other formats whose words hold more than luma are not in this table.
        _ if starts(&["xv", "v30", "nv20"]) => None,
        _ if starts(&["yuv", "nv"]) || name.starts_with("gray") && !name.starts_with("grayf") => {
            place(0, wide, 0)
        }
        _ => None,
    }
}

/// Returns the positions of red, green and blue of a format of 8 or 16 bits with separate samples.
fn places_of_colours(name: &str) -> Option<[ComponentPlace; 3]> {
    let big_endian = name.ends_with("be");
    let (channels, depth) = match name {
        "rgb24" | "bgr24" | "rgba" | "bgra" | "argb" | "abgr" => (name.trim_end_matches("24"), 8),
        "0rgb" | "0bgr" | "rgb0" | "bgr0" => (name, 8),
        _ => {
            let deep = name.strip_suffix("le").or(name.strip_suffix("be"))?;
            (deep.strip_suffix("48").or(deep.strip_suffix("64"))?, 16)
        }
    };
    let wide = if depth > 8 { 2 } else { 1 };
    let step = channels.len() * wide;
    let place = |channel: char| {
        let offset = channels.find(channel)? * wide;
        Some(ComponentPlace { offset, step, shift: 0, depth, big_endian })
    };
    Some([place('r')?, place('g')?, place('b')?])
}

/// Returns the luma of raw bytes of this format and its depth, if the tables contain the format.
fn expected(format: &PixelFormat, bytes: &[u8]) -> Option<(Vec<u16>, u32)> {
    let name = &format.name[..];
    if let Some([red, green, blue]) = places_of_colours(name) {
        let [red, green, blue] =
            [red, green, blue].map(|place| (place.samples(bytes), place.depth));
        let colours = red.0.iter().zip(&green.0).zip(&blue.0);
        return Some((colours.map(|((&r, &g), &b)| luma(r, g, b)).collect(), red.1));
    }
    if name == "monow" || name == "monob" {
        let bit = |pixel: usize| bytes[pixel / 8] >> (7 - pixel % 8) & 1 == 1;
        let white = |pixel| if bit(pixel) == (name == "monob") { 255 } else { 0 };
        return Some(((0..AREA).map(white).collect(), 8));
    }
    let depth = format.components.first()?.bit_depth;
    let place = place_of_luma(name, depth)?;
    Some((place.samples(bytes), depth))
}

/// Returns bytes without a pattern. The unused high bits of words are zero, as decoders leave them.
fn noise(format: &PixelFormat) -> Vec<u8> {
    let mut state = 0x2545_F491_u32;
    let mut bytes: Vec<u8> = std::iter::repeat_with(|| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state.to_le_bytes()[1]
    })
    .take(AREA * 48)
    .collect();
    let depth = format.components.first().map_or(8, |component| component.bit_depth);
    let place = place_of_luma(&format.name, depth);
    let is_narrow = |place: ComponentPlace| place.depth > 8 && place.depth < 16 && place.shift == 0;
    if let Some(place) = place.filter(|&place| is_narrow(place)) {
        let high = if place.big_endian { 0 } else { 1 };
        let mask = u8::MAX >> (16 - place.depth);
        bytes.iter_mut().skip(high).step_by(2).for_each(|byte| *byte &= mask);
    }
    bytes
}

/// Returns the first frame of raw bytes after the filters of video, at 16 bits, or the reason why
/// there is none.
fn decoded(ffmpeg: &DecodingParameters, name: &str, file: &Path) -> Result<Vec<u16>, String> {
    let size = format!("{WIDTH}x{HEIGHT}");
    let input = Invocation::new(&ffmpeg.found.path)
        .args(["-hide_banner", "-nostdin", "-nostats", "-loglevel", "repeat+level+info"])
        .args(["-f", "rawvideo", "-pixel_format", name, "-video_size", &size, "-i"])
        .arg(file)
        .args(["-frames:v", "1"]);
    let mut decoder =
        VideoDecoder::from_invocation(ffmpeg, &ffmpeg.with_frame_output(input)).unwrap();
    let Some(shown) = decoder.next_announced().unwrap() else {
        return Err(decoder.finish().unwrap().unwrap_or_default());
    };
    let mut bytes = Vec::new();
    decoder.pixels(shown.layout, &mut bytes).map_err(|error| error.to_string())?;
    Ok(shown.layout.byte_frame(bytes, 16).unwrap().borrowed_pixels().to_words())
}

#[test]
fn every_pixel_format_gives_its_luma_or_says_that_it_cannot() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let listed = Command::new("ffprobe")
        .args(["-v", "error", "-show_pixel_formats", "-of", "json"])
        .output()
        .unwrap();
    let listed: ListedFormat = serde_json::from_slice(&listed.stdout).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let found = Toolchain::system().find(Tool::Ffmpeg).unwrap();
    let formats =
        Mutex::new(listed.pixel_formats.iter().filter(|format| format.flags.hwaccel == 0));
    let (exact, inexact) = (Mutex::new(0), Mutex::new(Vec::new()));
    let next = || formats.lock().unwrap().next();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some(format) = next() {
                    let name = &format.name;
                    let bytes = noise(format);
                    let file = dir.path().join(name);
                    fs::write(&file, &bytes).unwrap();
                    let conversion = conversion_filter(name);
                    let medium = VideoMedium::File(file.clone());
                    let (found, interrupt) = (found.clone(), Interrupt::default());
                    let ffmpeg = DecodingParameters {
                        found,
                        medium,
                        container: String::new(),
                        stream: 0,
                        conversion,
                        interrupt,
                    };
                    let seen = match decoded(&ffmpeg, name, &file) {
                        Ok(seen) => seen,
                        Err(problem) => {
                            // Some formats exist only as names.
                            assert!(problem.contains("Impossible to convert"), "{name}: {problem}");
                            continue;
                        }
                    };
                    let Some((luma, depth)) = expected(format, &bytes) else {
                        inexact.lock().unwrap().push(name.clone());
                        continue;
                    };
                    let luma: Vec<u16> =
                        luma.iter().map(|&value| convert_depth(value, depth, 16)).collect();
                    assert_eq!(seen, luma, "{name}");
                    *exact.lock().unwrap() += 1;
                }
            });
        }
    });
    let (exact, inexact) = (exact.into_inner().unwrap(), inexact.into_inner().unwrap());
    // Packed colours, palettes and floating-point formats are only checked to give a frame.
    let has_luma = |name: &&String| name.starts_with("yuv") || name.starts_with("p0");
    assert_eq!(inexact.iter().find(has_luma), None);
    assert!(exact >= 100, "{exact} formats are exact, of {inexact:?} a picture is there");
}

#[test]
fn colours_decide_what_is_asked_for() {
    for name in ["yuv420p", "yuvj422p", "nv12", "gray", "gray12le", "ya8", ""] {
        assert!(conversion_filter(name).starts_with("extractplanes=y,format=gray"), "{name}");
    }
    for (name, planar) in [
        ("p010le", "yuv420p10le"),
        ("p012be", "yuv420p12le"),
        ("p216le", "yuv422p16le"),
        ("y210le", "yuv422p10le"),
        ("nv20be", "yuv422p10le"),
        ("xv36le", "yuv444p12le"),
        ("xv48be", "yuv444p16le"),
        ("v30xle", "yuv444p10le"),
        ("ayuv64le", "yuva444p16le"),
    ] {
        assert!(conversion_filter(name).starts_with(&format!("format={planar},extract")), "{name}");
    }
    for name in ["rgb24", "bgr0", "bgra", "gbrp", "pal8", "rgb555le", "0rgb"] {
        assert_eq!(conversion_filter(name), "format=rgb24", "{name}");
    }
    for name in ["gbrp10le", "gbrap12le", "rgb48be", "rgba64le", "x2rgb10le"] {
        assert_eq!(conversion_filter(name), "format=rgb48le", "{name}");
    }
    assert_eq!(conversion_filter("monow"), "format=gray");
}
