// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds that are aimed at data: at a frame that is to come and the scores that one of its
//! regions will have, or at scores that are decided at this clock.

use super::port_zones::ClassChoice;
use super::random::Random;
use super::threshold_ranges::ThresholdRanges;
use foveate_camera::FeatureKind;
use foveate_design::Design;
use foveate_model::{RegionScorer, ThresholdInputs, region_border};

/// The choice of thresholds that are ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ThresholdAim {
    /// The thresholds of the design.
    Configured,
    /// Levels that equal a value in the frame, or are one below or above it; minima likewise with
    /// the scores of a region.
    Exact,
    /// Levels that equal the largest value that pixels can have, or are one below it; minima as
    /// with `Exact`.
    Largest,
    /// Levels of 0 and minima of 1: a region that is not flat is relevant, and any change counts.
    Smallest,
    /// The thresholds of `Smallest` if they are ports, or else those of the design, for which noise
    /// is drawn until it is relevant. A flat region is irrelevant, and noise is relevant.
    Independent,
    /// The levels of the design, with minima that in turn no score and every score meets, and a
    /// minimum of changed pixels that is never met. A region is irrelevant, is held, and is
    /// irrelevant again.
    HeldRegions,
    /// In the first of three frames every region is active. In the others the minima of the scores
    /// are those of the design, and too few pixels ever change. A difference of two counts as a
    /// changed pixel, and a difference of one as a changed mean.
    DriftingRegions,
    /// All thresholds change at every clock, and the minima are exact at the clock of a decision.
    /// It is for hardware that takes thresholds at every clock.
    EveryClock,
}

impl ThresholdAim {
    /// Returns the classes of regions, which change unless the purpose of the aim is that of normal
    /// regions.
    pub(super) const fn classes(self) -> ClassChoice {
        match self {
            Self::Configured | Self::Exact | Self::Largest | Self::EveryClock => {
                ClassChoice::Changing
            }
            Self::Smallest | Self::Independent | Self::HeldRegions | Self::DriftingRegions => {
                ClassChoice::Normal
            }
        }
    }
}

/// A source of thresholds near the data.
pub(crate) struct ThresholdAimer {
    design: Design,
    ranges: ThresholdRanges,
    scorer: RegionScorer,
}

impl ThresholdAimer {
    pub(super) fn new(design: &Design) -> Self {
        Self {
            design: design.clone(),
            ranges: ThresholdRanges::of(design),
            scorer: RegionScorer::new(design),
        }
    }

    /// Sets thresholds that are unrelated to the data, for clocks at which they have no effect.
    pub(super) fn randomize(&self, thresholds: &mut ThresholdInputs, random: &mut Random) {
        self.ranges.randomize(thresholds, random);
    }

    /// Returns the index of a random region.
    pub(super) fn any_region(&self, random: &mut Random) -> u32 {
        random.up_to_u32(self.design.regions() - 1)
    }

    /// Returns thresholds near the data of one region of the frame that the model takes next.
    /// `stream` is the region's stream, `reference` the pixels with which it is compared, and
    /// `shown` the means of it on the screen. With `largest` the levels are near the largest
    /// possible values instead, for the turn that it gives.
    pub(super) fn near_region(
        &mut self,
        region: u32,
        stream: &[u16],
        reference: Option<&[u16]>,
        shown: Option<&[u16]>,
        largest: Option<u32>,
        random: &mut Random,
    ) -> ThresholdInputs {
        self.scorer.load(stream.iter().copied(), region_border(&self.design, region));
        let mut thresholds = ThresholdInputs::from_camera(&self.design);
        let difference = reference.and_then(|reference| {
            let pairs = self.scorer.pixels().zip(reference);
            let differences: Vec<u16> = pairs.map(|(now, then)| now.abs_diff(*then)).collect();
            random.choose(&differences)
        });
        self.ranges.aim_feature_levels(stream, &mut thresholds, random);
        self.ranges.aim_temporal_level(difference.unwrap_or(0), &mut thresholds, random);
        if let Some(turn) = largest {
            self.ranges.aim_largest_levels(turn, &mut thresholds);
        }
        let scores = self.scorer.scores(reference, &thresholds);
        let count = self.scorer.temporal_count(reference, &thresholds);
        self.aim_minima(&scores, count, &mut thresholds, random);
        if largest.is_none() {
            let widest = shown.and_then(|shown| {
                let means = self.scorer.means();
                means.iter().zip(shown).map(|(now, then)| now.abs_diff(*then).into()).max()
            });
            self.aim_summary_level(widest, &mut thresholds, random);
        }
        thresholds
    }

    /// Sets levels near the data of a square that follows another one; the minima stay. With
    /// `largest` the levels are near the largest possible values instead, for the turn that it
    /// gives.
    pub(super) fn aim_levels(
        &self,
        (now, before): (&[u16], &[u16]),
        largest: Option<u32>,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        match largest {
            Some(turn) => self.ranges.aim_largest_levels(turn, thresholds),
            None => self.ranges.aim_levels(now, before, thresholds, random),
        }
    }

    /// Returns the levels of the design, with minima that no region meets or, every second turn,
    /// all regions meet; too few pixels change.
    pub(super) fn held_thresholds(&self, turn: u32) -> ThresholdInputs {
        let mut thresholds = ThresholdInputs::from_camera(&self.design);
        self.ranges.aim_at_held(turn, &mut thresholds);
        thresholds
    }

    /// Returns minima that every region meets, every third turn; otherwise the minima of the design
    /// for scores, and a minimum of changed pixels that no region meets.
    pub(super) fn drifting_thresholds(&self, turn: u32) -> ThresholdInputs {
        let mut thresholds = ThresholdInputs::from_camera(&self.design);
        self.ranges.aim_at_drift(turn, &mut thresholds);
        thresholds
    }

    /// Sets the minima for scores that are decided at this clock.
    pub(super) fn aim_minima(
        &self,
        scores: &[u64; FeatureKind::COUNT],
        count: u32,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        self.ranges.aim_minima(scores, count, thresholds, random);
        self.ranges.aim_at_summary(thresholds, random);
    }

    /// Sets the summary level for a decision that is made at this clock; `difference` is the level
    /// at which it changes, if there is one.
    pub(super) fn aim_summary_level(
        &self,
        difference: Option<u32>,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        self.ranges.aim_summary_level(difference, thresholds, random);
    }

    /// Returns levels of 0 and minima of 1.
    pub(crate) fn smallest_thresholds() -> ThresholdInputs {
        ThresholdInputs {
            level: [0; FeatureKind::COUNT],
            min_score: [1; FeatureKind::COUNT],
            temporal_level: 0,
            temporal_min_count: 1,
            summary_level: 0,
        }
    }
}
