// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames on the receiver's screen, with the detections in them and in whole frames.

use crate::Detection;
use crate::sight::{Shot, Shots};
use askama::Template;
use foveate_pictures::page::PageError;

/// The box of a detection in a frame.
struct Mark {
    /// The fate of the detection, as a CSS class and in words: `kept`, `lost` or `added`.
    class: &'static str,
    x: String,
    y: String,
    width: String,
    height: String,
    title: String,
}

/// A frame of the page.
struct Picture {
    title: String,
    /// The receiver's screen as a PNG in base64.
    png: String,
    marks: Vec<Mark>,
}

/// The frames of the page.
#[derive(Template)]
#[template(path = "shots.html")]
pub(super) struct Pictures {
    width: u32,
    height: u32,
    /// The width of a line in pixels of the frame.
    line: String,
    pictures: Vec<Picture>,
}

/// Returns the frames that are kept, if there are any.
pub(super) fn pictures(shots: &Shots) -> Result<Option<Pictures>, PageError> {
    if shots.kept().is_empty() {
        return Ok(None);
    }
    let (width, height) = shots.size();
    let picture = |shot: &Shot| {
        let failed = |error: image::ImageError| PageError {
            page: shot.name.clone(),
            problem: error.to_string(),
        };
        let png = shots.png(shot).map_err(failed)?;
        Ok(Picture { title: title(shot), png, marks: marks(shot) })
    };
    let pictures = shots.kept().iter().map(picture).collect::<Result<_, PageError>>()?;
    let line = format!("{:.1}", f64::from(width.max(height)) / 300.0);
    Ok(Some(Pictures { width, height, line, pictures }))
}

fn title(shot: &Shot) -> String {
    let found = shot.found();
    format!(
        "{}, frame {} ({}): {} kept, {} lost, {} added",
        shot.clip,
        shot.number,
        shot.name,
        found.kept,
        found.whole - found.kept,
        found.added
    )
}

/// Returns the boxes of a frame. Lost and added detections are drawn above those that are kept.
fn marks(shot: &Shot) -> Vec<Mark> {
    let whole = shot.pairs.whole.iter();
    let kept = whole.clone().filter(|(_, both)| *both).map(|(one, _)| mark("kept", one));
    let lost = whole.filter(|(_, both)| !both).map(|(one, _)| mark("lost", one));
    let seen = shot.pairs.seen.iter();
    let added = seen.filter(|(_, both)| !both).map(|(one, _)| mark("added", one));
    kept.chain(lost).chain(added).collect()
}

fn mark(class: &'static str, one: &Detection) -> Mark {
    let text = |value: f64| format!("{value:.1}");
    Mark {
        class,
        x: text(one.rect.x0),
        y: text(one.rect.y0),
        width: text(one.rect.width()),
        height: text(one.rect.height()),
        title: format!("{class}: class {}, score {:.2}", one.class, one.score),
    }
}
