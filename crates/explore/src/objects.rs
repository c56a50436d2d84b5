// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ground-truth objects of a clip, and of how many a camera sends at least half.

use std::path::Path;

use foveate_camera::Camera;
use foveate_footage::boxes::{Boxes, Grid, Place, Rect, View};
use foveate_footage::{Crop, Source, SourceFrame};
use serde::{Deserialize, Serialize};

use crate::ExploreError;

/// Objects over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Objects {
    all: u64,
    /// Those of which at least half of the regions are active.
    sent: u64,
}

impl Objects {
    pub(crate) fn add(&mut self, camera: &Camera, objects: &[Rect], active: &[bool]) {
        let (side, width, height) = (camera.region_size(), camera.width(), camera.height());
        let grid = Grid { side, width, height };
        for object in objects {
            let (yes, regions) = grid.votes(object, active);
            self.all += 1;
            self.sent += u64::from(2 * yes >= regions);
        }
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.all += other.all;
        self.sent += other.sent;
    }

    /// The share that is sent; `None` if there are no objects.
    pub(crate) fn recall(self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
        (self.all > 0).then(|| self.sent as f64 / self.all as f64)
    }
}

/// The objects of the frame that a source gave last, where the frame has them; `None` if the boxes have no entry
/// for it.
pub(crate) fn objects(
    boxes: &Boxes,
    frame: &SourceFrame,
    source: &dyn Source,
    crop: Option<Crop>,
) -> Result<Option<Vec<Rect>>, ExploreError> {
    let origin = source.origin().expect("an input knows where its frames are from");
    let name = Path::new(&frame.name);
    let (number, own_file, size) = (origin.number, origin.own_file, origin.size);
    let found = boxes.at(&Place { name, own_file, number, size })?;
    let seen = (frame.frame.width(), frame.frame.height());
    let view = View::of(size, crop.map(|crop| (crop.size, crop.at)), seen);
    Ok(found.map(|found| found.iter().filter_map(|one| view.see(&one.rect)).collect()))
}
