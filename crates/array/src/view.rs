// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output ports of all RPUs, as they are after an edge.

use foveate_design::FeatureKind;
use foveate_model::RpuOutput;

use crate::tail::Decision;
use crate::wide::Types;

/// Every output port after an edge; lane i is region i.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<'a> {
    core: &'a dyn Ports,
    regions: usize,
}

/// The ports of a core of any lane types.
pub(crate) trait Ports: std::fmt::Debug {
    fn decision(&self) -> &Decision;
    fn score(&self, place: usize, lane: usize) -> u64;
    fn features(&self) -> usize;
    fn temporal_count(&self, lane: usize) -> u64;
    fn forward_valid(&self) -> &[u8];
    fn forward_pixel(&self, lane: usize) -> u16;
}

impl<'a> Outputs<'a> {
    pub(crate) fn of(core: &'a dyn Ports, regions: usize) -> Self {
        Self { core, regions }
    }

    /// `decision_valid_o`, the same in every lane.
    #[must_use]
    pub fn decision_valid(self) -> bool {
        self.core.decision().valid
    }

    /// `srs_o`, 1 or 0 per region.
    #[must_use]
    pub fn srs(self) -> &'a [u8] {
        &self.core.decision().srs[..self.regions]
    }

    /// `trs_o`, 1 or 0 per region.
    #[must_use]
    pub fn trs(self) -> &'a [u8] {
        &self.core.decision().trs[..self.regions]
    }

    /// `active_o`, 1 or 0 per region.
    #[must_use]
    pub fn active(self) -> &'a [u8] {
        &self.core.decision().active[..self.regions]
    }

    /// `forward_valid_o`, 1 or 0 per region.
    #[must_use]
    pub fn forward_valid(self) -> &'a [u8] {
        &self.core.forward_valid()[..self.regions]
    }

    /// All ports of one RPU.
    ///
    /// # Panics
    /// When there is no such region.
    #[must_use]
    pub fn rpu(self, region: usize) -> RpuOutput {
        assert!(region < self.regions, "region {region} of {}", self.regions);
        let decision = self.core.decision();
        let mut scores = [0; FeatureKind::COUNT];
        for (place, score) in scores.iter_mut().enumerate().take(self.core.features()) {
            *score = self.core.score(place, region);
        }
        RpuOutput {
            decision_valid: decision.valid,
            srs: decision.srs[region] != 0,
            trs: decision.trs[region] != 0,
            active: decision.active[region] != 0,
            scores,
            temporal_count: u32::try_from(self.core.temporal_count(region))
                .expect("a region has at most 4096 pixels"),
            forward_valid: self.core.forward_valid()[region] != 0,
            forward_pixel: self.core.forward_pixel(region),
        }
    }
}

impl<Y: Types> Ports for crate::core::Core<Y> {
    fn decision(&self) -> &Decision {
        &self.tail.decision
    }

    fn score(&self, place: usize, lane: usize) -> u64 {
        self.tail.scores(&self.plan, place).get(lane)
    }

    fn features(&self) -> usize {
        self.plan.features.len()
    }

    fn temporal_count(&self, lane: usize) -> u64 {
        self.tail.temporal_count(lane)
    }

    fn forward_valid(&self) -> &[u8] {
        &self.tail.forward.valid
    }

    fn forward_pixel(&self, lane: usize) -> u16 {
        let pixel: u64 = self.tail.forward.pixels[lane].into();
        u16::try_from(pixel).expect("a pixel has at most 16 bits")
    }
}
