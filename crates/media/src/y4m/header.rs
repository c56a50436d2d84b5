// SPDX-License-Identifier: MIT OR Apache-2.0
//! The header lines of a YUV4MPEG2 stream, and the frame layout that follows from them.

use std::io::{BufRead, Read};

use super::MAGIC;
use crate::{FrameRate, MAX_SIDE};

/// The largest length of a header line in bytes.
const MAX_LINE: u64 = 1024;

/// The fields of the header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Y4mHeader {
    pub(super) width: u32,
    pub(super) height: u32,
    /// The number of bits per sample.
    pub(super) depth: u32,
    /// The number of samples of a frame that are not luma.
    pub(super) others: u64,
    pub(super) rate: Option<FrameRate>,
    /// True if black is 16 and white is 235, of 8 bits.
    pub(super) is_narrow: bool,
}

pub(super) fn read_line(input: &mut dyn BufRead) -> Result<String, String> {
    let mut bytes = Vec::new();
    input.take(MAX_LINE).read_until(b'\n', &mut bytes).map_err(|error| error.to_string())?;
    match bytes.pop() {
        Some(b'\n') => String::from_utf8(bytes).map_err(|_| "a header is not text".to_owned()),
        _ => Err("it ends inside a header, or is not YUV4MPEG2".to_owned()),
    }
}

impl Y4mHeader {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut words = text.split(' ');
        if words.next().map(str::as_bytes) != Some(MAGIC) {
            return Err("it does not start with YUV4MPEG2".to_owned());
        }
        let (mut width, mut height, mut colour, mut rate) = (None, None, "420", None);
        let mut range = None;
        for word in words.filter(|word| word.is_ascii()) {
            let (key, value) = word.split_at(word.len().min(1));
            match key {
                "W" => width = Some(parse_side(value)?),
                "H" => height = Some(parse_side(value)?),
                "C" => colour = value,
                "F" => rate = parse_rate(value),
                "X" => range = value.strip_prefix("COLORRANGE=").or(range),
                _ => {}
            }
        }
        let (Some(width), Some(height)) = (width, height) else {
            return Err("its header lacks width or height".to_owned());
        };
        let unknown = || format!("its colour space `{colour}` is not supported");
        let (others, depth) =
            chroma_samples_and_depth(colour, width.into(), height.into()).ok_or_else(unknown)?;
        // A stream without colours has all values, whatever range is stated, as in ffmpeg.
        let is_narrow = !colour.starts_with("mono") && range != Some("FULL");
        Ok(Self { width, height, depth, others, rate, is_narrow })
    }
}

fn parse_side(text: &str) -> Result<u32, String> {
    let limit = || format!("a side of `{text}` pixels is not in 1..={MAX_SIDE}");
    text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side)).ok_or_else(limit)
}

/// Parses a rate such as `30:1`. The rate `0:0` is unknown.
fn parse_rate(text: &str) -> Option<FrameRate> {
    let (frames, seconds) = text.split_once(':')?;
    FrameRate::new(frames.parse().ok()?, seconds.parse().ok()?).ok()
}

/// Returns the number of samples that are not luma, and the bits of each sample, for a colour space
/// such as `420`, `420jpeg`, `422p10`, `444alpha` or `mono12`.
fn chroma_samples_and_depth(name: &str, width: u64, height: u64) -> Option<(u64, u32)> {
    let halves = |size: u64, parts: u64| size.div_ceil(parts);
    let (others, rest) = if let Some(rest) = name.strip_prefix("420") {
        (2 * halves(width, 2) * halves(height, 2), rest)
    } else if let Some(rest) = name.strip_prefix("422") {
        (2 * halves(width, 2) * height, rest)
    } else if let Some(rest) = name.strip_prefix("444alpha") {
        (3 * width * height, rest)
    } else if let Some(rest) = name.strip_prefix("444") {
        (2 * width * height, rest)
    } else if let Some(rest) = name.strip_prefix("411") {
        (2 * halves(width, 4) * height, rest)
    } else if let Some(rest) = name.strip_prefix("440") {
        (2 * width * halves(height, 2), rest)
    } else {
        (0, name.strip_prefix("mono")?)
    };
    let depth = match rest {
        "" | "jpeg" | "mpeg2" | "paldv" => 8,
        deep => deep.trim_start_matches('p').parse().ok()?,
    };
    (8..=16).contains(&depth).then_some((others, depth))
}
