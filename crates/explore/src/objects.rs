// SPDX-License-Identifier: MIT OR Apache-2.0
//! The number of ground-truth objects of which a camera sends at least half.

use foveate_camera::Camera;
use foveate_media::boxes::RegionGrid;
use foveate_pixels::Rect;
use serde::{Deserialize, Serialize};

/// Counts of objects over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ObjectCounts {
    all: u64,
    /// The number of objects of which at least half of the regions are active.
    sent: u64,
}

impl ObjectCounts {
    pub(crate) fn add_frame(&mut self, camera: &Camera, objects: &[Rect], active: &[bool]) {
        let (side, width, height) = (camera.region_size(), camera.width(), camera.height());
        let grid = RegionGrid { side, width, height };
        for object in objects {
            let (yes, regions) = grid.count_votes(object, active);
            self.all += 1;
            self.sent += u64::from(2 * yes >= regions);
        }
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.all += other.all;
        self.sent += other.sent;
    }

    /// Returns the share that is sent; `None` if there are no objects.
    pub(crate) fn recall(self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
        (self.all > 0).then(|| self.sent as f64 / self.all as f64)
    }
}
