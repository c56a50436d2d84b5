// SPDX-License-Identifier: MIT OR Apache-2.0
//! Levels that differ from lane to lane, for bands in which some regions are keen.

use foveate_camera::RegionClass;

use crate::plan::CameraPlan;
use foveate_pixels::lanes::{AlignedBuffer, PixelLane};

/// The levels of all lanes of a band in which a region is keen.
#[derive(Clone, Debug)]
pub(crate) struct LaneLevels<T: PixelLane> {
    /// True if a region of the current band is keen, so that the levels are in use.
    is_used: bool,
    pub(crate) temporal: AlignedBuffer<T>,
    pub(crate) corner: AlignedBuffer<T>,
    /// Half of the levels of `edge`.
    pub(crate) edge: AlignedBuffer<T::Signed>,
}

impl<T: PixelLane> LaneLevels<T> {
    /// Makes room for the levels of a camera, which has no use for them without zones.
    pub(crate) fn new(plan: &CameraPlan<T>) -> Self {
        let lanes = plan.zones.as_ref().map_or(0, |_| plan.stride());
        Self {
            is_used: false,
            temporal: AlignedBuffer::new(lanes),
            corner: AlignedBuffer::new(lanes),
            edge: AlignedBuffer::new(lanes),
        }
    }

    /// Sets the levels for a band with regions of these classes.
    pub(crate) fn set(&mut self, plan: &CameraPlan<T>, classes: &[RegionClass]) {
        self.is_used = classes.contains(&RegionClass::Keen);
        let Some(zones) = plan.zones.as_ref().filter(|_| self.is_used) else { return };
        fill_lanes(&mut self.temporal, plan.side, classes, [plan.level, zones.keen_level]);
        if let (Some(own), Some(keen)) = (plan.passes.corner, zones.keen_passes.corner) {
            fill_lanes(&mut self.corner, plan.side, classes, [own, keen]);
        }
        if let (Some(own), Some(keen)) = (plan.passes.edge, zones.keen_passes.edge) {
            fill_lanes(&mut self.edge, plan.side, classes, [own, keen]);
        }
    }

    /// Returns the levels if the current band has a keen region.
    #[inline(always)]
    pub(crate) fn in_use(&self) -> Option<&Self> {
        self.is_used.then_some(self)
    }
}

/// Writes one of two values into the lanes of each region: that of the camera, or that of keen
/// regions.
fn fill_lanes<V: Copy>(lanes: &mut [V], side: usize, classes: &[RegionClass], [own, keen]: [V; 2]) {
    for (lanes, &class) in lanes.chunks_mut(side).zip(classes) {
        lanes.fill(if class == RegionClass::Keen { keen } else { own });
    }
}
