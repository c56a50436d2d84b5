// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds aimed at data: at a frame that is to come and the scores that one of its regions will have, or at scores
//! that are decided now.

use super::aim::Ranges;
use super::random::Random;
use foveate_design::{Design, FeatureKind};
use foveate_model::{RegionScorer, Thresholds, region_border};

/// How thresholds are chosen, where they are ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ThresholdAim {
    /// As the design is configured.
    Design,
    /// Levels on, just below or just above what a pixel of the frame has, minima likewise with the scores
    /// of its region.
    Exact,
    /// Levels just below the largest value that a pixel can have, or on it; minima as with `Exact`.
    Largest,
    /// The least that is not nothing: what is not flat is relevant, what changes has changed.
    Least,
    /// The same where thresholds are ports, else those of the design; neither they nor the data are aimed at each other. So what is
    /// flat is irrelevant, and what is not is relevant.
    Unaimed,
    /// Levels of the design; by turns no score is enough and every one is, and never have enough pixels changed: a region is
    /// irrelevant, is held, and is irrelevant again.
    Held,
    /// In the first of three frames every region is active. In the others regions are relevant as the design says, but never have
    /// enough pixels changed. A pixel has changed that is off by two, and a mean differs that is off by one.
    Drifting,
    /// All change at every clock; minima are exact where a decision is made. For hardware that takes thresholds at every
    /// clock.
    Restless,
}

/// Looks ahead.
pub(super) struct Aimer {
    design: Design,
    ranges: Ranges,
    scorer: RegionScorer,
}

impl Aimer {
    pub(super) fn new(design: &Design) -> Self {
        Self {
            design: design.clone(),
            ranges: Ranges::of(design),
            scorer: RegionScorer::new(design),
        }
    }

    /// Thresholds without any relation to the data, for clocks at which they do not matter.
    pub(super) fn shake(&self, thresholds: &mut Thresholds, random: &mut Random) {
        self.ranges.shake(thresholds, random);
    }

    /// The number of any region.
    pub(super) fn any_region(&self, random: &mut Random) -> u32 {
        random.up_to_u32(self.design.regions() - 1)
    }

    /// Thresholds near the data of one region of the frame that the model takes next: its stream, and what it
    /// is compared with, and the means that the screen shows of it. With `largest` levels near the largest values that there are, by turns.
    pub(super) fn exact(
        &mut self,
        region: u32,
        stream: &[u16],
        reference: Option<&[u16]>,
        shown: Option<&[u16]>,
        largest: Option<u32>,
        random: &mut Random,
    ) -> Thresholds {
        self.scorer.take(stream.iter().copied(), region_border(&self.design, region));
        let mut thresholds = Thresholds::of(&self.design);
        let difference = reference.and_then(|reference| {
            let pairs = self.scorer.pixels().zip(reference);
            let differences: Vec<u16> = pairs.map(|(now, then)| now.abs_diff(*then)).collect();
            random.of(&differences)
        });
        self.ranges.aim_feature_levels(stream, &mut thresholds, random);
        self.ranges.aim_temporal_level(difference.unwrap_or(0), &mut thresholds, random);
        if let Some(turn) = largest {
            self.ranges.aim_largest_levels(turn, &mut thresholds);
        }
        let scores = self.scorer.scores(reference, &thresholds);
        let count = self.scorer.temporal_count(reference, &thresholds);
        self.minima(&scores, count, &mut thresholds, random);
        if largest.is_none() {
            let widest = shown.and_then(|shown| {
                let means = self.scorer.means();
                means.iter().zip(shown).map(|(now, then)| now.abs_diff(*then).into()).max()
            });
            self.summary_level(widest, &mut thresholds, random);
        }
        thresholds
    }

    /// Levels near the data of a square that is to come after another; the minima stay. With `largest` near the largest
    /// values that there are, by turns.
    pub(super) fn levels(
        &self,
        (now, before): (&[u16], &[u16]),
        largest: Option<u32>,
        thresholds: &mut Thresholds,
        random: &mut Random,
    ) {
        match largest {
            Some(turn) => self.ranges.aim_largest_levels(turn, thresholds),
            None => self.ranges.aim_levels(now, before, thresholds, random),
        }
    }

    /// Levels of the design, and minima that no region meets or, every other turn, all regions; too few pixels have changed.
    pub(super) fn held(&self, turn: u32) -> Thresholds {
        let mut thresholds = Thresholds::of(&self.design);
        self.ranges.aim_at_held(turn, &mut thresholds);
        thresholds
    }

    /// Minima that every region meets, every third turn; else those of the design for scores, and too few pixels have changed.
    pub(super) fn drifting(&self, turn: u32) -> Thresholds {
        let mut thresholds = Thresholds::of(&self.design);
        self.ranges.aim_at_drift(turn, &mut thresholds);
        thresholds
    }

    /// Minima for scores that are decided now.
    pub(super) fn minima(
        &self,
        scores: &[u64; FeatureKind::COUNT],
        count: u32,
        thresholds: &mut Thresholds,
        random: &mut Random,
    ) {
        self.ranges.aim_minima(scores, count, thresholds, random);
        self.ranges.aim_at_summary(thresholds, random);
    }

    /// The summary level for a decision that is made now, if there is one at which it turns.
    pub(super) fn summary_level(
        &self,
        difference: Option<u32>,
        thresholds: &mut Thresholds,
        random: &mut Random,
    ) {
        self.ranges.aim_summary_level(difference, thresholds, random);
    }

    /// Levels of 0 and minima of 1.
    pub(super) fn least() -> Thresholds {
        Thresholds {
            level: [0; FeatureKind::COUNT],
            min_score: [1; FeatureKind::COUNT],
            temporal_level: 0,
            temporal_min_count: 1,
            summary_level: 0,
        }
    }
}
