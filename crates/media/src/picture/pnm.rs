// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check that a PNM file has exactly one complete image: no sample above its maximum, and
//! nothing after the last pixel. The decoder reads larger samples as white, and ignores what
//! follows.

use super::damage::PictureFault;
use crate::limits::MAX_SIDE;

/// The fields of the header of a PNM.
struct PnmHeader {
    /// The digit after the `P`.
    kind: u8,
    width: u64,
    height: u64,
    samples: u64,
    largest: u64,
}

/// Finds damage that the decoder ignores. A wrong header is left to the decoder.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let Some((header, raster)) = header(bytes) else { return Ok(()) };
    match header.kind {
        b'1'..=b'3' => check_text(&header, raster),
        _ => check_binary(&header, raster),
    }
}

fn check_binary(header: &PnmHeader, raster: &[u8]) -> Result<(), PictureFault> {
    let row = match header.kind {
        b'4' => header.width.div_ceil(8),
        _ => header.width * header.samples * if header.largest > 255 { 2 } else { 1 },
    };
    let length = row * header.height;
    let Some((pixels, after)) =
        usize::try_from(length).ok().and_then(|length| raster.split_at_checked(length))
    else {
        let found = raster.len();
        return Err(PictureFault::truncated(format!(
            "it has {found} bytes of pixels, but needs {length}"
        )));
    };
    let beyond = |value: &u64| *value > header.largest;
    let sample = match (header.kind, header.largest) {
        (b'4', _) | (_, 255 | 65_535) => None,
        (_, 256..) => pixels
            .chunks_exact(2)
            .map(|word| u64::from(u16::from_be_bytes([word[0], word[1]])))
            .find(beyond),
        _ => pixels.iter().map(|&byte| u64::from(byte)).find(beyond),
    };
    refuse_sample(header, sample)?;
    refuse_trailing_bytes(after)
}

fn check_text(header: &PnmHeader, raster: &[u8]) -> Result<(), PictureFault> {
    let needed = header.width * header.height * header.samples;
    let mut rest = raster;
    let mut found = 0;
    while found < needed {
        rest = rest.trim_ascii_start();
        // The digits of a bitmap may follow each other without spaces.
        let most = if header.kind == b'1' { 1 } else { rest.len() };
        let length = rest.iter().take(most).take_while(|byte| byte.is_ascii_digit()).count();
        let digits = str::from_utf8(&rest[..length]).unwrap_or_default();
        let Ok(value) = digits.parse::<u64>() else {
            return match rest.first() {
                None => Err(PictureFault::truncated(format!(
                    "it has {found} samples, but needs {needed}"
                ))),
                Some(byte) => Err(PictureFault::damaged(format!(
                    "`{}` stands among its samples, where numbers are expected",
                    byte.escape_ascii()
                ))),
            };
        };
        refuse_sample(header, Some(value).filter(|&value| value > header.largest))?;
        rest = &rest[length..];
        found += 1;
    }
    refuse_trailing_bytes(rest)
}

fn refuse_sample(header: &PnmHeader, sample: Option<u64>) -> Result<(), PictureFault> {
    let largest = header.largest;
    sample.map_or(Ok(()), |value| {
        Err(PictureFault::damaged(format!(
            "it has a sample of {value}, but its maximum is {largest}"
        )))
    })
}

/// Refuses everything but white space after the pixels.
fn refuse_trailing_bytes(after: &[u8]) -> Result<(), PictureFault> {
    match after.trim_ascii_start() {
        [] => Ok(()),
        [b'P', b'1'..=b'7', ..] => Err(PictureFault::damaged(
            "more images follow the first one, which alone would be read; save each in a file of its own",
        )),
        more => Err(PictureFault::damaged(format!("{} bytes follow its last pixel", more.len()))),
    }
}

/// Returns the header and the bytes after it.
fn header(bytes: &[u8]) -> Option<(PnmHeader, &[u8])> {
    let (&[b'P', kind @ b'1'..=b'7'], mut rest) = bytes.split_first_chunk()? else { return None };
    if kind == b'7' {
        return pam_header(rest);
    }
    let width = number(&mut rest)?;
    let height = number(&mut rest)?;
    let largest = if matches!(kind, b'1' | b'4') { 1 } else { number(&mut rest)? };
    let samples = if matches!(kind, b'3' | b'6') { 3 } else { 1 };
    // One white space ends the header.
    let raster = rest.split_first().map_or(rest, |(_, raster)| raster);
    within_limits(PnmHeader { kind, width, height, samples, largest }, raster)
}

fn within_limits(header: PnmHeader, raster: &[u8]) -> Option<(PnmHeader, &[u8])> {
    let sides = header.width.max(header.height) <= u64::from(MAX_SIDE);
    (sides && header.samples <= 4 && (1..=65_535).contains(&header.largest))
        .then_some((header, raster))
}

/// Reads a number after white space and comments.
fn number(rest: &mut &[u8]) -> Option<u64> {
    loop {
        *rest = rest.trim_ascii_start();
        match rest.strip_prefix(b"#") {
            Some(comment) => {
                let end = comment.iter().position(|byte| matches!(byte, b'\n' | b'\r'))?;
                *rest = &comment[end..];
            }
            None => break,
        }
    }
    let length = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let digits = str::from_utf8(&rest[..length]).ok()?;
    *rest = &rest[length..];
    digits.parse().ok().filter(|&number| number <= u64::from(u32::MAX))
}

/// Reads the header of a PAM, in which every line begins with a name.
fn pam_header(mut rest: &[u8]) -> Option<(PnmHeader, &[u8])> {
    let mut values = [None; 4];
    loop {
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        let line = str::from_utf8(&rest[..end]).ok()?.trim();
        rest = &rest[end + 1..];
        if line == "ENDHDR" {
            break;
        }
        let (name, value) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let place = ["WIDTH", "HEIGHT", "DEPTH", "MAXVAL"].iter().position(|known| *known == name);
        if let Some(place) = place {
            values[place] = Some(u64::from(value.trim().parse::<u32>().ok()?));
        }
    }
    let [width, height, samples, largest] = values;
    let header = PnmHeader {
        kind: b'7',
        width: width?,
        height: height?,
        samples: samples?,
        largest: largest?,
    };
    within_limits(header, rest)
}
