// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones: the thresholds of keen regions, and levels that differ from lane to lane.

use foveate_camera::{Camera, RegionClass};

use crate::plan::{CameraPlan, FeaturePasses, FeaturePlan, feature_plans};
use foveate_lanes::{AlignedBuffer, BLOCK_LANES, Block, PixelLane, saturated_threshold};

/// The thresholds of the classes of regions that differ from those of the camera.
#[derive(Clone, Debug)]
pub(crate) struct ZonePlan<T: PixelLane> {
    /// The passes with the levels of keen regions. They are the same passes as those of the camera.
    pub(crate) keen_passes: FeaturePasses<T>,
    /// The features with the minimum scores of keen regions.
    pub(crate) keen_features: Vec<FeaturePlan>,
    /// The level of the temporal score of keen regions.
    pub(crate) keen_level: T,
    pub(crate) keen_min_count: u32,
    keen_summary_level: T,
    off_summary_level: T,
}

impl<T: PixelLane> ZonePlan<T> {
    /// Returns the thresholds of a camera, or `None` if it has no zones.
    pub(crate) fn from_camera(camera: &Camera) -> Option<Self> {
        camera.zones()?;
        let keen = camera.class_thresholds(RegionClass::Keen);
        let off = camera.class_thresholds(RegionClass::Off);
        // Without summaries their levels have no meaning.
        let summary_level = |level: Option<u32>| saturated_threshold(level.unwrap_or(0));
        Some(Self {
            keen_passes: FeaturePasses::from_features(keen.features),
            keen_features: feature_plans(keen.features),
            keen_level: saturated_threshold(keen.temporal_level),
            keen_min_count: keen.min_count,
            keen_summary_level: summary_level(keen.summary_level),
            off_summary_level: summary_level(off.summary_level),
        })
    }

    /// Returns the level of the summaries of a region. `own` is that of the camera.
    #[inline(always)]
    pub(crate) fn summary_level(&self, class: RegionClass, own: T) -> T {
        match class {
            RegionClass::Normal | RegionClass::Always => own,
            RegionClass::Off => self.off_summary_level,
            RegionClass::Keen => self.keen_summary_level,
        }
    }
}

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

/// The levels of the lanes of a run of blocks.
pub(crate) trait BlockLevels<V>: Copy {
    /// Returns the level of lane `i` of block `at`.
    fn level(self, at: usize, i: usize) -> V;
}

/// One level for all lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UniformLevel<V>(pub(crate) V);

impl<V: Copy> BlockLevels<V> for UniformLevel<V> {
    #[inline(always)]
    fn level(self, _at: usize, _i: usize) -> V {
        self.0
    }
}

impl<V: Copy> BlockLevels<V> for &[Block<V>] {
    #[inline(always)]
    fn level(self, at: usize, i: usize) -> V {
        debug_assert!(i < BLOCK_LANES, "a block has {BLOCK_LANES} lanes");
        self[at][i]
    }
}
