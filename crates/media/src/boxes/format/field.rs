// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers in the fields of a text file.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use csv::{ErrorKind, Position, StringRecord};

use crate::boxes::BoxError;

/// Parses a field as a finite number.
pub(crate) fn parse_number(name: &str, text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| {
        format!("the {name} `{}` is not valid; expected a number", text.escape_debug())
    })
}

/// Parses a field as a whole number of at least `least`. It may have a decimal point, as in `3.0`.
pub(crate) fn parse_whole(name: &str, text: &str, least: u32) -> Result<u64, String> {
    // Above this limit, `f64` cannot represent every whole number.
    const MOST: f64 = 9e15;
    let value = parse_number(name, text).ok();
    let value = value.filter(|v| v.fract() == 0.0 && (f64::from(least)..MOST).contains(v));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
    value.map(|value| value as u64).ok_or_else(|| {
        let text = text.escape_debug();
        format!("the {name} `{text}` is not valid; expected a whole number of at least {least}")
    })
}

/// Parses fields as numbers, with the names of their columns for messages.
pub(crate) fn parse_numbers<const N: usize>(
    names: [&str; N],
    texts: [&str; N],
) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (value, (name, text)) in values.iter_mut().zip(names.into_iter().zip(texts)) {
        *value = parse_number(name, text)?;
    }
    Ok(values)
}

pub(crate) fn error_in_line(path: &Path, record: &StringRecord, problem: String) -> BoxError {
    match record.position().map(|place| line_of(path, place)) {
        Some(Ok(line)) => BoxError::Line { path: path.to_owned(), line, problem },
        Some(Err(source)) => BoxError::Io { path: path.to_owned(), source },
        None => BoxError::File { path: path.to_owned(), problem },
    }
}

/// Returns the line at which a record begins. Its position may be that of blank lines before it.
fn line_of(path: &Path, place: &Position) -> io::Result<u64> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(place.byte()))?;
    let mut line = place.line();
    for byte in BufReader::new(file).bytes() {
        match byte? {
            b'\n' => line += 1,
            b'\r' => {}
            _ => break,
        }
    }
    Ok(line)
}

/// Returns the error for a record that cannot be read as text.
pub(crate) fn unreadable_record(path: &Path, error: csv::Error) -> BoxError {
    let path = path.to_owned();
    match error.into_kind() {
        ErrorKind::Io(source) => BoxError::Io { path, source },
        ErrorKind::Utf8 { pos: Some(place), .. } => match line_of(&path, &place) {
            Ok(line) => {
                let problem = "it is not text in UTF-8; expected rows of text".to_owned();
                BoxError::Line { path, line, problem }
            }
            Err(source) => BoxError::Io { path, source },
        },
        kind => BoxError::File { path, problem: format!("{kind:?}") },
    }
}
