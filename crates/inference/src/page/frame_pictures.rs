// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames on the receiver's screen, with the detections in them and in whole frames.

use crate::Detection;
use crate::whole_frames::{KeptScreen, KeptScreens};
use askama::Template;
use foveate_output::page::PageError;

struct DetectionBox {
    /// The fate of the detection, as a CSS class and in words: `kept`, `lost` or `added`.
    class: &'static str,
    x: String,
    y: String,
    width: String,
    height: String,
    title: String,
}

/// A frame of the page.
struct FramePicture {
    title: String,
    /// The receiver's screen as a PNG in base64.
    png: String,
    marks: Vec<DetectionBox>,
}

/// The frames of the page.
#[derive(Template)]
#[template(path = "shots.html")]
pub(super) struct FramePictures {
    width: u32,
    height: u32,
    /// The width of a line in pixels of the frame.
    line: String,
    pictures: Vec<FramePicture>,
}

/// Returns the frames that are kept, if there are any.
pub(super) fn frame_pictures(shots: &KeptScreens) -> Result<Option<FramePictures>, PageError> {
    if shots.screens().is_empty() {
        return Ok(None);
    }
    let (width, height) = shots.size();
    let picture = |shot: &KeptScreen| {
        let failed = |error: image::ImageError| PageError {
            page: shot.name.clone(),
            problem: error.to_string(),
        };
        let png = shots.png_base64(shot).map_err(failed)?;
        Ok(FramePicture { title: picture_title(shot), png, marks: detection_boxes(shot) })
    };
    let pictures = shots.screens().iter().map(picture).collect::<Result<_, PageError>>()?;
    let line = format!("{:.1}", f64::from(width.max(height)) / 300.0);
    Ok(Some(FramePictures { width, height, line, pictures }))
}

fn picture_title(shot: &KeptScreen) -> String {
    let found = shot.detection_counts();
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
fn detection_boxes(shot: &KeptScreen) -> Vec<DetectionBox> {
    let whole = shot.pairs.whole.iter();
    let kept = whole.clone().filter(|(_, both)| *both).map(|(one, _)| detection_box("kept", one));
    let lost = whole.filter(|(_, both)| !both).map(|(one, _)| detection_box("lost", one));
    let seen = shot.pairs.seen.iter();
    let added = seen.filter(|(_, both)| !both).map(|(one, _)| detection_box("added", one));
    kept.chain(lost).chain(added).collect()
}

fn detection_box(class: &'static str, one: &Detection) -> DetectionBox {
    let text = |value: f64| format!("{value:.1}");
    DetectionBox {
        class,
        x: text(one.rect.x0),
        y: text(one.rect.y0),
        width: text(one.rect.width()),
        height: text(one.rect.height()),
        title: format!("{class}: class {}, score {:.2}", one.class, one.score),
    }
}
