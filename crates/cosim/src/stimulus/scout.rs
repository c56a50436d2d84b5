// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells when a pipelined array decides, so that minima can be aimed at the scores of just that clock.

use foveate_design::{Design, FeatureKind, Hardware, PortRole};
use foveate_model::{CoreInput, CycleModel, FrameSync, PipelinedRpu, RpuInput};

/// An RPU of its own: a decision comes at the same clock in every lane. Neither pixels nor borders nor thresholds move it
/// in time.
pub(super) struct Scout {
    rpu: PipelinedRpu,
    /// What stands in front of it, as in front of the lanes.
    sync: FrameSync,
    kinds: Vec<FeatureKind>,
}

impl Scout {
    /// None where thresholds stand still while a frame is under way. `finds_frames` says whether what finds the frames of
    /// the design is simulated.
    pub(super) fn of(design: &Design, finds_frames: bool) -> Option<Self> {
        let own = match design.hardware() {
            Hardware::Pipelined(own) => design.on(own),
            Hardware::Serial(_) | Hardware::Raster(_) => return None,
        };
        let sync = if finds_frames { FrameSync::new(design) } else { FrameSync::absent() };
        Some(Self { rpu: PipelinedRpu::new(own), sync, kinds: design.kinds() })
    }

    /// Whether a decision is there after this edge. It must see every edge of a sequence whose thresholds are aimed; of
    /// others it needs none, since the reset that begins a sequence brings it back into step.
    pub(super) fn decides(&mut self, input: &CoreInput<'_>) -> bool {
        let &CoreInput { reset, valid, sof, border, pixels, thresholds, .. } = input;
        let valid = if reset {
            self.sync.reset();
            false
        } else {
            self.sync.step(valid, sof, true)
        };
        let input = RpuInput { reset, valid, pixel: pixels[0], border };
        self.rpu.step(&input, thresholds).decision_valid
    }

    /// The scores and the temporal count of a lane after this edge. What is decided then does not depend on the minima of
    /// the edge, so that a copy can look ahead.
    pub(super) fn look_ahead(
        &self,
        core: &dyn CycleModel,
        input: &CoreInput<'_>,
        lane: usize,
    ) -> ([u64; FeatureKind::COUNT], u32) {
        let mut ahead = core.duplicate();
        ahead.clock(input);
        let mut values = Vec::new();
        let mut shown = |role| {
            values.clear();
            ahead.show(role, &mut values);
            values[lane]
        };
        let mut scores = [0; FeatureKind::COUNT];
        for (score, &kind) in scores.iter_mut().zip(&self.kinds) {
            *score = shown(PortRole::Score(kind));
        }
        let count = shown(PortRole::TemporalCount);
        (scores, u32::try_from(count).expect("a count has at most 32 bits"))
    }
}
