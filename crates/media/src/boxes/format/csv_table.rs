// SPDX-License-Identifier: MIT OR Apache-2.0
//! A CSV table with one row per box. It has the columns file, x0, y0, x1 and y1 in any order; other
//! columns are ignored. `x1` and `y1` are exclusive ends.

use std::collections::HashMap;
use std::path::Path;

use csv::{ReaderBuilder, Trim};

use super::field::{error_in_line, parse_numbers, unreadable_record};
use crate::boxes::image_name::comparison_name;
use crate::boxes::limits::{self, MAX_BOXES};
use crate::boxes::view::ImageBoxes;
use crate::boxes::{BoxError, LabelledBox};
use foveate_pixels::Rect;

pub(crate) const COLUMNS: [&str; 5] = ["file", "x0", "y0", "x1", "y1"];

/// Reads the boxes of every image that has a row, by the name of the image.
pub(crate) fn read(path: &Path) -> Result<HashMap<String, ImageBoxes>, BoxError> {
    let reader = limits::open(path)?;
    let mut file =
        foveate_tools::table_reader(ReaderBuilder::new().flexible(true).trim(Trim::All), reader);
    let headers = file.headers().map_err(|error| unreadable_record(path, error))?.clone();
    let mut places = [0; COLUMNS.len()];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = headers.iter().position(|header| header == column).ok_or_else(|| {
            let problem = format!(
                "there is no column `{column}`; expected the columns {}",
                COLUMNS.join(", ")
            );
            error_in_line(path, &headers, problem)
        })?;
    }
    for column in COLUMNS {
        if headers.iter().filter(|header| *header == column).count() > 1 {
            let problem = format!("the column `{column}` appears twice; leave one out");
            return Err(error_in_line(path, &headers, problem));
        }
    }
    let mut images: HashMap<String, ImageBoxes> = HashMap::new();
    for (number, record) in file.records().enumerate() {
        let record = record.map_err(|error| unreadable_record(path, error))?;
        let wrong = |problem| error_in_line(path, &record, problem);
        if number == MAX_BOXES {
            return Err(wrong(limits::too_many_boxes()));
        }
        if record.len() != headers.len() {
            // A comma in a name without quotation marks shifts the following fields by one column.
            let (found, expected) = (record.len(), headers.len());
            return Err(wrong(format!("the row has {found} columns; expected {expected}")));
        }
        let mut fields = [""; COLUMNS.len()];
        for (field, place) in fields.iter_mut().zip(places) {
            *field = record.get(place).unwrap_or_default();
        }
        let [name, corners @ ..] = fields;
        let names = [COLUMNS[1], COLUMNS[2], COLUMNS[3], COLUMNS[4]];
        let rect = parse_numbers(names, corners).and_then(Rect::from_corners).map_err(wrong)?;
        let name = comparison_name(name)
            .ok_or_else(|| wrong("the name of the image is missing".to_owned()))?;
        images.entry(name).or_default().boxes.push(LabelledBox { rect, track: None });
    }
    Ok(images)
}
