// SPDX-License-Identifier: MIT OR Apache-2.0
//! The format YOLO: one text file per image, with the image's name and the extension `txt`, and one
//! line per object: class, centre (x, y), width and height. The last four are fractions of the
//! image. An image without a file has no entry.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::field::{parse_numbers, parse_whole};
use crate::boxes::limits::{self, MAX_BOXES};
use crate::boxes::{BoxError, LabelledBox};
use foveate_pixels::Rect;

/// The largest length of a line in bytes, with its end. Five numbers take a few dozen bytes.
const MAX_LINE: usize = 4096;
const COLUMNS: [&str; 5] = ["class", "x", "y", "width", "height"];

/// Finds the file of an image below `folder`, with as many of the image's folders as exist there.
pub(crate) fn find_file(folder: &Path, names: &[String]) -> Option<PathBuf> {
    names.iter().map(|name| folder.join(name).with_extension("txt")).find(|file| file.is_file())
}

/// Reads the boxes of an image of this size.
pub(crate) fn read(path: &Path, (width, height): (u32, u32)) -> Result<Vec<LabelledBox>, BoxError> {
    let mut reader = limits::open(path)?;
    let mut boxes = Vec::new();
    for number in 1.. {
        let mut line = Vec::new();
        let read = reader.by_ref().take(MAX_LINE as u64).read_until(b'\n', &mut line);
        if read.map_err(|source| BoxError::Io { path: path.to_owned(), source })? == 0 {
            break;
        }
        let wrong = |problem| BoxError::Line { path: path.to_owned(), line: number, problem };
        // Without this check, the rest of the line would be read as another line.
        if line.len() == MAX_LINE && !line.ends_with(b"\n") {
            let problem = format!(
                "it has {MAX_LINE} bytes or more, which is the limit; expected five numbers"
            );
            return Err(wrong(problem));
        }
        let text = str::from_utf8(&line)
            .map_err(|_| wrong("it is not text in UTF-8; expected numbers".to_owned()))?;
        let fields: Vec<&str> = text.split_whitespace().collect();
        if fields.is_empty() {
            continue;
        }
        if boxes.len() == MAX_BOXES {
            return Err(wrong(limits::too_many_boxes()));
        }
        let shares = parse_fractions(&fields).map_err(wrong)?;
        let rect = shares.scaled(f64::from(width), f64::from(height));
        boxes.push(LabelledBox { rect, track: None });
    }
    Ok(boxes)
}

/// Returns the box in fractions of the image.
fn parse_fractions(fields: &[&str]) -> Result<Rect, String> {
    let [class, x, y, width, height] = *fields else {
        let (found, names) = (fields.len(), COLUMNS.join(", "));
        return Err(format!("the line has {found} numbers; expected 5: {names}"));
    };
    parse_whole("class", class, 0)?;
    let names = [COLUMNS[1], COLUMNS[2], COLUMNS[3], COLUMNS[4]];
    let values = parse_numbers(names, [x, y, width, height])?;
    if let Some(value) = values.iter().find(|value| !(0.0..=1.0).contains(*value)) {
        return Err(format!("{value} is not a share of the image; expected 0 to 1"));
    }
    let [x, y, width, height] = values;
    Rect::from_corner_and_size([x - width / 2.0, y - height / 2.0, width, height])
}
