// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames as the receiver sees them, with what the network finds in them and in whole frames.

use crate::Detection;
use crate::sight::{Shot, Shots};
use askama::Template;
use foveate_pictures::page::PageError;

/// A box of a picture.
struct Mark {
    /// What it is, as a class of the style and in words.
    class: &'static str,
    x: String,
    y: String,
    width: String,
    height: String,
    title: String,
}

/// A frame.
struct Picture {
    title: String,
    /// A PNG in base64.
    png: String,
    marks: Vec<Mark>,
}

/// All of them.
#[derive(Template)]
#[template(path = "shots.html")]
pub(super) struct Pictures {
    width: u32,
    height: u32,
    /// Width of a line in pixels of the frame.
    line: String,
    pictures: Vec<Picture>,
}

/// The frames that are kept, if there are any.
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

/// What is lost or added lies above what is kept.
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
