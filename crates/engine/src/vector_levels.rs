// SPDX-License-Identifier: MIT OR Apache-2.0
//! Levels that differ from element to element, for bands in which some regions are keen.

use foveate_camera::RegionClass;

use crate::plan::CameraPlan;
use foveate_pixels::vectors::{AlignedBuffer, VectorPixel};

/// The levels of all elements of a band in which a region is keen.
#[derive(Clone, Debug)]
pub(crate) struct VectorLevels<T: VectorPixel> {
    /// True if a region of the current band is keen, so that the levels are in use.
    is_used: bool,
    pub(crate) temporal: AlignedBuffer<T>,
    pub(crate) corner: AlignedBuffer<T>,
    /// Half of the levels of `edge`.
    pub(crate) edge: AlignedBuffer<T::Signed>,
}

impl<T: VectorPixel> VectorLevels<T> {
    /// Makes room for the levels of a camera, which has no use for them without zones.
    pub(crate) fn new(plan: &CameraPlan<T>) -> Self {
        let elements = plan.zones.as_ref().map_or(0, |_| plan.stride());
        Self {
            is_used: false,
            temporal: AlignedBuffer::new(elements),
            corner: AlignedBuffer::new(elements),
            edge: AlignedBuffer::new(elements),
        }
    }

    /// Sets the levels for a band with regions of these classes.
    pub(crate) fn set(&mut self, plan: &CameraPlan<T>, classes: &[RegionClass]) {
        self.is_used = classes.contains(&RegionClass::Keen);
        let Some(zones) = plan.zones.as_ref().filter(|_| self.is_used) else { return };
        fill_elements(&mut self.temporal, plan.side, classes, [plan.level, zones.keen_level]);
        if let (Some(own), Some(keen)) = (plan.passes.corner, zones.keen_passes.corner) {
            fill_elements(&mut self.corner, plan.side, classes, [own, keen]);
        }
        if let (Some(own), Some(keen)) = (plan.passes.edge, zones.keen_passes.edge) {
            fill_elements(&mut self.edge, plan.side, classes, [own, keen]);
        }
    }

    /// Returns the levels if the current band has a keen region.
    #[inline(always)]
    pub(crate) fn in_use(&self) -> Option<&Self> {
        self.is_used.then_some(self)
    }
}

/// Writes one of two values into the elements of each region: that of the camera, or that of keen
/// regions.
fn fill_elements<V: Copy>(
    elements: &mut [V],
    side: usize,
    classes: &[RegionClass],
    [own, keen]: [V; 2],
) {
    for (elements, &class) in elements.chunks_mut(side).zip(classes) {
        elements.fill(if class == RegionClass::Keen { keen } else { own });
    }
}
