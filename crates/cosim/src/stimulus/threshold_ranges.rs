// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds that meet the data: equal to a value, one below and one above
//! ([`ThresholdRanges`]). The data are those of a frame that is to come and the scores that one
//! of its regions will have, or scores that are decided at this clock ([`ThresholdAimer`]).

use super::port_zones::ClassChoice;
use super::random::Random;
use foveate_camera::{DenoiseFilter, FeatureKind, SpatialFeature};
use foveate_design::Design;
use foveate_model::feature::decisive_level;
use foveate_model::feature::mean::rounded_mean;
use foveate_model::window::PixelWindow;
use foveate_model::{RegionScorer, ThresholdInputs, filtered_pixel, region_border};

/// The largest value of every threshold port.
#[derive(Clone, Debug)]
pub(crate) struct ThresholdRanges {
    kinds: Vec<FeatureKind>,
    level: [u32; FeatureKind::COUNT],
    min_score: [u64; FeatureKind::COUNT],
    /// The largest level that pixels can reach, for each feature with a level.
    largest_reached_level: Vec<Option<u32>>,
    temporal_level: u32,
    temporal_min_count: u32,
    /// The largest summary level; `None` if irrelevant regions send no means.
    summary_level: Option<u32>,
    filter: DenoiseFilter,
    /// Side of a region in pixels.
    side: usize,
}

impl ThresholdRanges {
    pub(crate) fn of(design: &Design) -> Self {
        let top = |bits: u32| u64::MAX >> (64 - bits.clamp(1, 64));
        let top_u32 = |bits: u32| u32::try_from(top(bits)).expect("a level has at most 32 bits");
        let (mut level, mut min_score) = ([0; FeatureKind::COUNT], [0; FeatureKind::COUNT]);
        for (index, feature) in design.features().iter().enumerate() {
            level[index] = feature.level().map_or(0, |_| top_u32(feature.level_bits()));
            min_score[index] = top(feature.score_bits());
        }
        Self {
            kinds: design.feature_kinds(),
            level,
            min_score,
            largest_reached_level: design
                .features()
                .iter()
                .map(SpatialFeature::level_max)
                .collect(),
            temporal_level: design.pixel_max(),
            temporal_min_count: top_u32(design.count_bits()),
            summary_level: design.periphery().map(|_| design.pixel_max()),
            filter: design.filter(),
            side: design.region_size() as usize,
        }
    }

    /// Sets levels near the data of the square `now`, which follows the square `before` of the same
    /// size.
    pub(crate) fn aim_levels(
        &self,
        now: &[u16],
        before: &[u16],
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        let (now, before) = (self.denoised(now), self.denoised(before));
        let (at, changed) = (random_place(&now, random), random_place(&now, random));
        self.aim_at_pixel(&now, at, thresholds, random);
        self.aim_temporal_level(now[changed].abs_diff(before[changed]), thresholds, random);
    }

    /// Sets the levels of features near the data of a square of raw pixels.
    pub(crate) fn aim_feature_levels(
        &self,
        square: &[u16],
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        let at = random_place(square, random);
        self.aim_at_pixel(&self.denoised(square), at, thresholds, random);
    }

    /// Returns the pixels of a square after the filter.
    fn denoised(&self, square: &[u16]) -> Vec<u16> {
        if !self.filter.has_window() {
            return square.to_vec();
        }
        let pixel = |at| filtered_pixel(self.filter, &window_at(square, at));
        (0..square.len()).map(pixel).collect()
    }

    /// Sets the levels of features near the level that decides whether a pixel counts.
    fn aim_at_pixel(
        &self,
        denoised: &[u16],
        at: usize,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        for (index, &kind) in self.kinds.iter().enumerate() {
            let value = match kind {
                FeatureKind::Edge | FeatureKind::Corner => {
                    decisive_level(kind, &window_at(denoised, at)).unwrap_or(0)
                }
                FeatureKind::Segment => self.mean(denoised).abs_diff(denoised[at].into()),
                FeatureKind::Mad
                | FeatureKind::Variance
                | FeatureKind::Range
                | FeatureKind::Surface
                | FeatureKind::Flow => continue,
            };
            let max = self.level[index].into();
            thresholds.level[index] = to_u32(value_near(value.into(), max, random));
        }
    }

    /// Returns the mean of the region in the center of a square, rounded to a whole level.
    fn mean(&self, square: &[u16]) -> u32 {
        let stride = square.len().isqrt();
        let margin = (stride - self.side) / 2;
        let rows = square.chunks_exact(stride).skip(margin).take(self.side);
        let pixels = rows.flat_map(|row| &row[margin..][..self.side]);
        let sum = pixels.map(|&pixel| u64::from(pixel)).sum();
        to_u32(rounded_mean(sum, (self.side * self.side) as u64, 0))
    }

    /// Sets the temporal level near the change `difference` of a pixel.
    pub(crate) fn aim_temporal_level(
        &self,
        difference: u16,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        thresholds.temporal_level =
            to_u32(value_near(difference.into(), self.temporal_level.into(), random));
    }

    /// Sets levels one below the largest values that pixels can have; every fifth turn, to these
    /// values.
    pub(crate) fn aim_largest_levels(&self, turn: u32, thresholds: &mut ThresholdInputs) {
        let less = u32::from(turn % 5 != 4);
        for (level, steepest) in thresholds.level.iter_mut().zip(&self.largest_reached_level) {
            if let Some(steepest) = steepest {
                *level = steepest - less;
            }
        }
        thresholds.temporal_level = self.temporal_level - less;
        thresholds.summary_level = self.summary_level.map_or(0, |largest| largest - less);
    }

    /// Sets thresholds that are unrelated to the data.
    pub(crate) fn randomize(&self, thresholds: &mut ThresholdInputs, random: &mut Random) {
        let count = self.kinds.len();
        for (level, &max) in thresholds.level[..count].iter_mut().zip(&self.level) {
            let reach = if random.one_in(2) { max } else { max / 16 };
            *level = random.up_to_u32(reach);
        }
        thresholds.temporal_level = random.up_to_u32(self.temporal_level);
        for (minimum, &max) in thresholds.min_score[..count].iter_mut().zip(&self.min_score) {
            *minimum = random.up_to(max);
        }
        thresholds.temporal_min_count = random.up_to_u32(self.temporal_min_count);
        if let Some(max) = self.summary_level {
            let reach = if random.one_in(2) { max } else { max / 16 };
            thresholds.summary_level = random.up_to_u32(reach);
        }
    }

    /// If irrelevant regions send their means, sets minima that no score meets about every second
    /// time.
    pub(crate) fn aim_at_summary(&self, thresholds: &mut ThresholdInputs, random: &mut Random) {
        if self.summary_level.is_some() && random.one_in(2) {
            self.set_largest_minima(thresholds);
        }
    }

    /// Sets the largest minima of the ports, which no score meets.
    pub(crate) fn set_largest_minima(&self, thresholds: &mut ThresholdInputs) {
        thresholds.min_score = self.min_score;
    }

    /// Sets minima that no score meets or, every second turn, all scores meet, and a minimum of
    /// changed pixels above the pixels of a region.
    pub(crate) fn aim_at_held(&self, turn: u32, thresholds: &mut ThresholdInputs) {
        thresholds.min_score =
            if turn.is_multiple_of(2) { self.min_score } else { [0; FeatureKind::COUNT] };
        thresholds.temporal_min_count = self.temporal_min_count;
    }

    /// Sets minima that all regions meet every third turn; otherwise a minimum of changed pixels
    /// above the pixels of a region. With the levels, a pixel has changed if it is off by two, and
    /// a mean if it is off by one.
    pub(crate) fn aim_at_drift(&self, turn: u32, thresholds: &mut ThresholdInputs) {
        if turn.is_multiple_of(3) {
            thresholds.min_score = [0; FeatureKind::COUNT];
            thresholds.temporal_min_count = 0;
        } else {
            thresholds.temporal_min_count = self.temporal_min_count;
        }
        thresholds.temporal_level = 1.min(self.temporal_level);
        thresholds.summary_level = 0;
    }

    /// Sets the summary level for means whose widest difference is `difference`: equal to it, so
    /// that the means are kept, or near it. Without a difference it is often the largest level, or
    /// random: a summary is then sent for another reason.
    pub(crate) fn aim_summary_level(
        &self,
        difference: Option<u32>,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        let Some(max) = self.summary_level else { return };
        thresholds.summary_level = match (difference, random.up_to(9)) {
            (Some(difference), 0..=3) => difference,
            (Some(difference), 4..=7) => difference.saturating_sub(1),
            (Some(difference), 8) => (difference + 1).min(max),
            (None, 0..=4) => max,
            _ => random.up_to_u32(max),
        };
    }

    /// Sets minima that the scores meet exactly (`more` is 0), or miss by `more` if the ports are
    /// wide enough.
    pub(crate) fn set_minima(
        &self,
        (scores, temporal_count): (&[u64], u32),
        more: u32,
        thresholds: &mut ThresholdInputs,
    ) {
        let minima = thresholds.min_score.iter_mut().zip(scores).zip(&self.min_score);
        for ((minimum, &score), &max) in minima {
            *minimum = (score + u64::from(more)).min(max);
        }
        thresholds.temporal_min_count = (temporal_count + more).min(self.temporal_min_count);
    }

    /// Sets the minima for scores that are decided at this clock.
    pub(crate) fn aim_minima(
        &self,
        scores: &[u64; FeatureKind::COUNT],
        temporal_count: u32,
        thresholds: &mut ThresholdInputs,
        random: &mut Random,
    ) {
        let minima = thresholds.min_score.iter_mut().zip(scores).zip(&self.min_score);
        for ((minimum, &score), &max) in minima.take(self.kinds.len()) {
            *minimum = value_near(score, max, random);
        }
        let max = self.temporal_min_count.into();
        thresholds.temporal_min_count = to_u32(value_near(temporal_count.into(), max, random));
    }
}

/// Returns the value, or one less or more; rarely something else.
fn value_near(value: u64, max: u64, random: &mut Random) -> u64 {
    let chosen = match random.up_to(9) {
        0..=3 => value,
        4..=6 => value + 1,
        7..=8 => value.saturating_sub(1),
        _ if random.one_in(2) => random.up_to(max),
        _ => 0,
    };
    chosen.min(max)
}

/// Returns the window around a pixel of a square; beyond the square its border repeats.
fn window_at(square: &[u16], at: usize) -> PixelWindow {
    let side = square.len().isqrt();
    let around = |place: usize| [place.saturating_sub(1), place, (place + 1).min(side - 1)];
    let (columns, rows) = (around(at % side), around(at / side));
    std::array::from_fn(|number| square[rows[number / 3] * side + columns[number % 3]])
}

fn random_place(square: &[u16], random: &mut Random) -> usize {
    random.index(square.len() - 1)
}

fn to_u32(value: u64) -> u32 {
    u32::try_from(value).expect("levels and counts have at most 32 bits")
}

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
