// SPDX-License-Identifier: MIT OR Apache-2.0
//! The objects of every frame of a clip, which are the same for all designs: their places in the
//! frame that the camera sees, and their classes.

use std::collections::HashMap;
use std::sync::Arc;

use foveate_media::{
    CropRect, PlaybackError, PlayedFrame, SourceKind,
    boxes::{BoxFile, BoxView, FrameKey},
};
use foveate_pixels::Rect;

use super::class::classes_of;
use super::contrast::SummedAreaTable;
use crate::studies::runner::FrameAnnotator;

/// An object of the current frame.
pub(super) struct FrameObject {
    /// The box in the frame that the camera sees, cut off at its border.
    pub(super) rect: Rect,
    pub(super) track: Option<u64>,
    /// The classes, as indices into [`CLASSES`](super::class::CLASSES).
    pub(super) classes: [usize; 4],
}

/// The boxes of a clip, and the objects of the current frame.
pub(super) struct GroundTruthObjects {
    boxes: Arc<BoxFile>,
    crop: Option<CropRect>,
    /// The number of frames; `found` counts those with an entry in the boxes.
    frames: u64,
    labelled_frames: u64,
    /// The largest number of a frame.
    last_number: u64,
    /// The number of boxes that lie mostly outside of the frame, over all frames.
    outside: u64,
    /// The centres of the tracks in the frame before.
    last_centres: HashMap<u64, (f64, f64)>,
    objects: Vec<FrameObject>,
}

impl GroundTruthObjects {
    pub(super) fn new(boxes: Arc<BoxFile>, crop: Option<CropRect>) -> Self {
        let (before, objects) = (HashMap::new(), Vec::new());
        Self {
            boxes,
            crop,
            frames: 0,
            labelled_frames: 0,
            last_number: 0,
            outside: 0,
            last_centres: before,
            objects,
        }
    }

    pub(super) fn objects(&self) -> &[FrameObject] {
        &self.objects
    }

    /// Fails if no frame of the clip has an entry in the boxes.
    pub(super) fn check(&self, clip: &str) -> Result<(), PlaybackError> {
        if self.labelled_frames > 0 { Ok(()) } else { Err(self.boxes.no_entry_error(clip).into()) }
    }

    /// Returns a sentence about the boxes that are no objects, if there are any.
    pub(super) fn left_out(&self) -> Option<String> {
        self.boxes.left_out_in_words()
    }

    /// Returns a note on the origin of the objects.
    pub(super) fn note(&self, clip: &str) -> String {
        let (path, format) = (self.boxes.path().display(), self.boxes.format().name());
        let Self { outside, frames, labelled_frames: found, .. } = self;
        let without = frames - found;
        let behind = match self.boxes.boxes_behind(self.last_number) {
            0 => String::new(),
            boxes => format!("; {boxes} belong to frames behind the last one"),
        };
        format!(
            "{clip}: boxes {path} ({format}); {outside} lie mostly outside of the frame, left out; \
             {without} of {frames} frames have no entry and count as frames without objects{behind}"
        )
    }
}

impl FrameAnnotator for GroundTruthObjects {
    fn annotate(&mut self, frame: &PlayedFrame) -> Result<(), PlaybackError> {
        self.objects.clear();
        let origin = frame.origin.expect("an input knows where its frames are from");
        let key = FrameKey::from_source_frame(frame, &origin);
        let labelled = self.boxes.boxes_of_frame(&key)?;
        self.last_number = self.last_number.max(self.boxes.frame_number(&key)?);
        self.frames += 1;
        self.labelled_frames += u64::from(labelled.is_some());
        let labelled = labelled.unwrap_or_default();
        // An object of a data set is in a single frame, so it has no track.
        let has_tracks = frame.kind == SourceKind::Clip;
        let view = BoxView::from_source_frame(frame, &origin, self.crop);
        let sums = (!labelled.is_empty()).then(|| SummedAreaTable::from_frame(&frame.frame));
        let before = std::mem::take(&mut self.last_centres);
        for one in labelled {
            let track = one.track.filter(|_| has_tracks);
            let centre = view.transform(&one.rect).centre();
            let last = track.and_then(|track| before.get(&track));
            let speed = last.map(|last| (centre.0 - last.0).hypot(centre.1 - last.1));
            self.last_centres.extend(track.map(|track| (track, centre)));
            let Some(rect) = view.transform_and_cut(&one.rect) else {
                self.outside += 1;
                continue;
            };
            let contrast = sums.as_ref().and_then(|sums| sums.contrast(&rect));
            let classes = classes_of(&rect, speed, contrast);
            self.objects.push(FrameObject { rect, track, classes });
        }
        Ok(())
    }
}
