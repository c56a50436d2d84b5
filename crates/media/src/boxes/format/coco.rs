// SPDX-License-Identifier: MIT OR Apache-2.0
//! The format COCO: a JSON document with `images` (id, `file_name`) and `annotations` (`image_id`,
//! `bbox` as left, top, width, height, and `iscrowd`). Annotations of crowds are not objects. All
//! other content, such as masks, is skipped while it is read, so that memory grows only with the
//! number of boxes.

use std::collections::HashMap;
use std::fmt;
use std::io::{BufRead, BufReader, Read};
use std::marker::PhantomData;
use std::path::Path;

use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::boxes::exclusions::BoxExclusions;
use crate::boxes::image_name::comparison_name;
use crate::boxes::limits::{self, MAX_BOXES};
use crate::boxes::view::ImageBoxes;
use crate::boxes::{BoxError, LabelledBox};
use foveate_pixels::Rect;

#[derive(Deserialize)]
struct CocoDocument {
    #[serde(deserialize_with = "deserialize_limited")]
    images: Vec<CocoImage>,
    #[serde(deserialize_with = "deserialize_limited")]
    annotations: Vec<CocoAnnotation>,
}

#[derive(Deserialize)]
struct CocoImage {
    id: u64,
    file_name: String,
    width: Option<u32>,
    height: Option<u32>,
}

#[derive(Deserialize)]
struct CocoAnnotation {
    image_id: u64,
    bbox: [f64; 4],
    #[serde(default)]
    iscrowd: u8,
}

/// Reads the boxes of every image, by the name of the image, and counts those that are no objects.
pub(crate) fn read(
    path: &Path,
    left_out: &mut BoxExclusions,
) -> Result<HashMap<String, ImageBoxes>, BoxError> {
    let wrong = |problem| BoxError::File { path: path.to_owned(), problem };
    let document: CocoDocument = serde_json::from_reader(without_mark(path)?).map_err(|error| {
        if error.is_io() {
            return BoxError::Io { path: path.to_owned(), source: error.into() };
        }
        wrong(format!("{error}; expected a JSON object of COCO with `images` and `annotations`"))
    })?;
    let mut names: HashMap<u64, String> = HashMap::new();
    let mut images: HashMap<String, ImageBoxes> = HashMap::new();
    for CocoImage { id, file_name, width, height } in document.images {
        let name = comparison_name(&file_name)
            .ok_or_else(|| wrong(format!("the image with the id {id} has no file name")))?;
        let boxes = ImageBoxes { size: width.zip(height), boxes: Vec::new() };
        if images.insert(name.clone(), boxes).is_some() {
            return Err(wrong(format!("two images are called `{name}`")));
        }
        if names.insert(id, name).is_some() {
            return Err(wrong(format!("two images have the id {id}")));
        }
    }
    for (number, CocoAnnotation { image_id, bbox, iscrowd }) in (1..).zip(document.annotations) {
        let wrong = |problem: String| wrong(format!("annotation {number}: {problem}"));
        let rect = Rect::from_corner_and_size(bbox).map_err(wrong)?;
        let boxes = names.get(&image_id).and_then(|name| images.get_mut(name));
        let boxes = boxes.ok_or_else(|| wrong(format!("no image has the id {image_id}")))?;
        left_out.count((iscrowd != 0).then_some("of crowds (iscrowd)"));
        if iscrowd == 0 {
            boxes.boxes.push(LabelledBox { rect, track: None });
        }
    }
    Ok(images)
}

/// Opens a file behind the byte order mark of UTF-8, if it has one.
fn without_mark(path: &Path) -> Result<BufReader<impl Read>, BoxError> {
    const MARK: &[u8] = b"\xEF\xBB\xBF";
    let mut file = limits::open(path)?;
    let start = file.fill_buf();
    let start = start.map_err(|source| BoxError::Io { path: path.to_owned(), source })?;
    if start.starts_with(MARK) {
        file.consume(MARK.len());
    }
    Ok(file)
}

/// Deserializes a list of at most [`MAX_BOXES`] items.
fn deserialize_limited<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    from: D,
) -> Result<Vec<T>, D::Error> {
    struct LimitedListVisitor<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for LimitedListVisitor<T> {
        type Value = Vec<T>;

        fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            formatter.write_str("a list")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<T>, A::Error> {
            let mut items = Vec::new();
            while let Some(item) = list.next_element()? {
                if items.len() == MAX_BOXES {
                    return Err(A::Error::custom(limits::too_many_boxes()));
                }
                items.push(item);
            }
            Ok(items)
        }
    }

    from.deserialize_seq(LimitedListVisitor(PhantomData))
}
