// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the frames of a bench: pictures that the design finds relevant, the same ones
//! again, other ones, and flat ones, so that regions become active, are held, and are blanked.

use super::drawn_region::{
    DrawnPlaces, DrawnRegion, ThresholdPair, draw_region, flat_square, threshold_pair,
};
use crate::situations::{has_sink, largest_min_count};
use crate::stimulus::{
    ClassChoice, FrameDelivery, PatternGenerator, Random, SequenceEnd, SinkPattern,
    StimulusPattern, Texture,
};
use foveate_camera::{FeatureKind, Neighborhood};
use foveate_design::{Design, ThresholdSource as Mode};
use foveate_model::ThresholdInputs;
use foveate_pixels::Frame;

/// The number of frames that every script has; scripts with short frames have more.
pub(super) const MIN_FRAMES_PER_SCRIPT: u64 = 5;
/// The limits for frames near the thresholds: the pixels of drawn regions, and the clocks of a
/// frame.
const FEW_PIXELS: usize = 4_096;
const FEW_CLOCKS: u64 = 20_000;
/// The patterns of the frames near the thresholds.
const NEAR_THRESHOLD_PATTERNS: [StimulusPattern; 4] =
    [StimulusPattern::Bump, StimulusPattern::Noise, StimulusPattern::Smooth, StimulusPattern::Bump];
/// The number of frames whose shapes cross the borders of regions.
const WIDE_FRAMES: u32 = 8;

/// The deliveries of the damaged frames, with one error of each kind. The frame behind the short
/// one comes too early, and is dropped.
const DELIVERIES: [FrameDelivery; 6] = [
    FrameDelivery::Strays,
    FrameDelivery::Whole,
    FrameDelivery::ONE_BEAT_SHORT,
    FrameDelivery::Whole,
    FrameDelivery::ONE_BEAT_LONG,
    FrameDelivery::Whole,
];

/// The frames between two resets.
pub(super) struct BenchSequence {
    pub(super) frames: Vec<BenchFrame>,
    /// The state of the core at the reset that begins the next sequence.
    pub(super) end: SequenceEnd,
    /// The classes of the regions, in a core with zones.
    pub(super) classes: ClassChoice,
}

impl BenchSequence {
    /// Creates a sequence after which everything leaves.
    fn drained(frames: Vec<BenchFrame>) -> Self {
        Self::ending_at(frames, SequenceEnd::Drained)
    }

    fn ending_at(frames: Vec<BenchFrame>, end: SequenceEnd) -> Self {
        Self { frames, end, classes: ClassChoice::Normal }
    }
}

/// The sequences of frames of a bench.
pub(super) struct BenchScript {
    /// The sequences; each begins with a reset.
    pub(super) sequences: Vec<BenchSequence>,
    /// The frames for hardware with `sync`, each with its damage.
    pub(super) damaged: Vec<(BenchFrame, FrameDelivery)>,
}

/// A frame with the thresholds and the sink that apply to it.
pub(super) struct BenchFrame {
    pub(super) frame: Frame,
    pub(super) thresholds: ThresholdInputs,
    pub(super) sink: SinkPattern,
}

impl BenchFrame {
    /// Creates a frame for a sink that takes every word at once.
    fn new(frame: Frame, thresholds: ThresholdInputs) -> Self {
        Self { frame, thresholds, sink: SinkPattern::Always }
    }

    fn with_sink(self, sink: SinkPattern) -> Self {
        Self { sink, ..self }
    }
}

impl BenchScript {
    /// Returns the frames for `part`, which is one region or lane, or an array. With `is_wide` some
    /// frames have shapes that cross the borders of regions. They are for regions so small that
    /// their neighbors' pixels decide.
    pub(super) fn for_design(part: &Design, is_wide: bool) -> Self {
        let mut random = Random::new(1);
        let writer = ScriptWriter::new(part, &mut random);
        // A reset must follow frames that are leaving or lost, so their sequences come first.
        let mut sequences = vec![writer.leaving_sequence(is_wide), writer.high_minimum_sequence()];
        if part.has_class_memory() {
            let frames = writer.wide_frames();
            let drained = BenchSequence::drained(frames);
            sequences.push(BenchSequence { classes: ClassChoice::Configured, ..drained });
        }
        sequences.extend(writer.lossy_sequence(is_wide));
        sequences.push(writer.usual_sequence());
        if let Some(periphery) = part.periphery() {
            let level = periphery.level;
            sequences.push(writer.means_sequence(level));
            sequences.push(writer.means_beside_held_sequence(level));
        }
        if writer.is_small() {
            sequences.push(writer.near_threshold_sequence(&mut random));
        }
        sequences.extend(writer.exact_sequences());
        if is_wide {
            sequences.push(BenchSequence::drained(writer.wide_frames()));
        }
        if part.zones().is_some() {
            let frames = writer.wide_frames();
            let drained = BenchSequence::drained(frames);
            sequences.push(BenchSequence { classes: ClassChoice::Changing, ..drained });
        }
        Self { sequences, damaged: writer.damaged_frames() }
    }
}

/// The pictures of a design, of which the sequences are made.
struct ScriptWriter<'a> {
    part: &'a Design,
    pair: ThresholdPair,
    places: DrawnPlaces<'a>,
    /// The regions with structure, in the order of their places.
    regions: Vec<DrawnRegion>,
    /// The pixels of a flat region, and of one with bars.
    flat: Vec<u16>,
    bars: Vec<u16>,
}

impl<'a> ScriptWriter<'a> {
    fn new(part: &'a Design, random: &mut Random) -> Self {
        let mut generator = PatternGenerator::new(part, part.region_size(), random.fork());
        let pair = threshold_pair(part, &mut generator);
        let places = DrawnPlaces::new(part);
        let regions = (0..places.places.len())
            .map(|number| draw_region(part, &mut generator, &pair.usual, number))
            .collect();
        generator.draw(StimulusPattern::Texture(Texture::Rows(2)));
        Self { part, pair, places, regions, flat: flat_square(part), bars: generator.pixels }
    }

    /// Returns a frame in which `square` gives the pixels of each region with structure, by its
    /// number. The ground is that of the turn.
    fn frame(
        &self,
        turn: u32,
        thresholds: ThresholdInputs,
        square: impl Fn(usize, &DrawnRegion) -> Vec<u16>,
    ) -> BenchFrame {
        let squares: Vec<_> = self
            .regions
            .iter()
            .enumerate()
            .map(|(number, region)| square(number, region))
            .collect();
        BenchFrame::new(self.places.frame(&squares, turn), thresholds)
    }

    fn frame_of_first(&self, turn: u32, thresholds: ThresholdInputs) -> BenchFrame {
        self.frame(turn, thresholds, |_, region| region.first.clone())
    }

    fn frame_of_last(&self, turn: u32) -> BenchFrame {
        self.frame(turn, self.pair.usual, |_, region| region.last.clone())
    }

    fn flat_frame(&self) -> BenchFrame {
        self.frame(2, self.pair.blank, |_, _| self.flat.clone())
    }

    /// Returns a frame of the first or of the other pictures, by turns.
    fn alternating_frame(&self, number: usize) -> BenchFrame {
        match number % 2 {
            0 => self.frame_of_first(0, self.pair.usual),
            _ => self.frame(0, self.pair.usual, |_, region| region.other.clone()),
        }
    }

    fn wide_frame(&self, turn: u32) -> BenchFrame {
        BenchFrame::new(self.places.wide_frame(turn), self.pair.usual)
    }

    fn wide_frames(&self) -> Vec<BenchFrame> {
        (0..WIDE_FRAMES).map(|turn| self.wide_frame(turn)).collect()
    }

    fn damaged_frames(&self) -> Vec<(BenchFrame, FrameDelivery)> {
        let numbered = DELIVERIES.into_iter().enumerate();
        numbered.map(|(number, delivery)| (self.alternating_frame(number), delivery)).collect()
    }

    /// Regions become active, are held, are blanked, and become active again.
    fn usual_sequence(&self) -> BenchSequence {
        let usual = self.pair.usual;
        // A flat region behind one with structure may have a displacement, so there are two.
        let flat_frames = 1 + usize::from(self.part.displacement_feature().is_some());
        let mut frames = vec![
            self.frame_of_first(0, usual),
            self.frame_of_first(0, usual),
            self.frame(1, usual, |number, region| match number % 3 {
                0 => region.other.clone(),
                1 => region.first.clone(),
                _ => self.flat.clone(),
            }),
        ];
        frames.extend((0..flat_frames).map(|_| self.flat_frame()));
        frames.push(self.frame_of_last(2));
        BenchSequence::drained(frames)
    }

    /// Returns the pixels of a flat region. The levels of adjacent regions differ, or a mean could
    /// be mistaken for another one. They are equal if regions see the pixels of their neighbors.
    fn plain_square(&self, summary_level: u32, number: usize, level: u32) -> Vec<u16> {
        let apart = match self.part.neighborhood() {
            Neighborhood::Isolated => 2 * summary_level + 3,
            Neighborhood::Shared => 0,
        };
        let place = u32::try_from(number % 3).unwrap_or_default();
        let level = u16::try_from(level + place * apart).unwrap_or(u16::MAX);
        vec![level.min(self.places.max); self.flat.len()]
    }

    fn frame_of_means(
        &self,
        summary_level: u32,
        level: u32,
        thresholds: ThresholdInputs,
    ) -> BenchFrame {
        self.frame(2, thresholds, |number, _| self.plain_square(summary_level, number, level))
    }

    /// Means are sent, also behind pixels of equal means. They stay, and are sent again as soon as
    /// they differ by more than the level. The same means are sent again behind pixels, and stay
    /// behind a held region.
    fn means_sequence(&self, level: u32) -> BenchSequence {
        let ThresholdPair { usual, blank } = self.pair;
        let means = |more| self.frame_of_means(level, more, blank);
        let mut frames = vec![self.frame_of_first(0, usual)];
        frames.push(means(0));
        frames.extend(self.frames_of_equal_means());
        frames.extend([0, level, level + 1].map(means));
        frames.extend([self.frame_of_last(2), means(level + 1)]);
        if self.part.threshold_source() == Mode::Runtime {
            // With a second pass a decision is made with the thresholds of the next frame.
            frames.push(self.frame_of_first(2, self.without_changes(self.relevant_thresholds())));
            frames.push(self.frame_of_means(level, level + 1, self.without_changes(blank)));
        }
        BenchSequence::drained(frames)
    }

    /// Returns a frame of bars, and a frame of flat regions whose means are those of the bars.
    fn frames_of_equal_means(&self) -> [BenchFrame; 2] {
        let ThresholdPair { usual, blank } = self.pair;
        let bars = &self.bars;
        let middle = vec![self.places.max.div_ceil(2); self.flat.len()];
        [self.frame(2, usual, |_, _| bars.clone()), self.frame(2, blank, |_, _| middle.clone())]
    }

    /// The frame before the reset comes again. Then every second region is held beside means that
    /// wait for the sink. The held regions drift by the temporal level, up and down, so they stay
    /// held only if they are compared with what was sent, and not with a later frame.
    fn means_beside_held_sequence(&self, level: u32) -> BenchSequence {
        let ThresholdPair { usual, blank } = self.pair;
        let drift = u16::try_from(usual.temporal_level).unwrap_or(u16::MAX);
        let up = |pixel: &u16| pixel.saturating_add(drift).min(self.places.max);
        let down = |pixel: &u16| pixel.saturating_sub(drift);
        let beside = |more, is_up| {
            let frame = self.frame(2, usual, |number, region| match (number % 2, is_up) {
                (0, true) => region.first.iter().map(up).collect(),
                (0, false) => region.first.iter().map(down).collect(),
                _ => self.plain_square(level, number, more),
            });
            frame.with_sink(SinkPattern::Delaying)
        };
        let frames = vec![
            self.frame_of_means(level, level + 1, blank),
            self.frame_of_first(2, usual),
            beside(0, true),
            beside(2 * level + 2, false),
            beside(0, true),
        ];
        BenchSequence::ending_at(frames, SequenceEnd::MeanLeaving)
    }

    /// Returns the sequence in which the sink stalls until regions are lost, and summaries are lost
    /// and sent again; `None` without a sink.
    fn lossy_sequence(&self, is_wide: bool) -> Option<BenchSequence> {
        let stalled = stalled_frames(self.part);
        if stalled == 0 {
            return None;
        }
        // More regions must be lost than have their own structure, because the counters must reach
        // large values. Where neighbors decide, few pictures of single regions are relevant.
        let frame = |number: usize| match is_wide || self.places.has_ground() {
            true => self.wide_frame(u32::try_from(number).unwrap_or_default()),
            false => self.alternating_frame(number),
        };
        let summaries = if self.part.periphery().is_some() { 2 } else { 0 };
        let frames = (0..stalled).map(frame).chain((0..summaries).map(|_| self.flat_frame()));
        let frames = frames.map(|frame| frame.with_sink(SinkPattern::StallingUntilLoss));
        Some(BenchSequence::drained(frames.chain([self.frame_of_last(1)]).collect()))
    }

    /// Returns true if the bench has room for frames near the thresholds.
    fn is_small(&self) -> bool {
        let drawn = self.regions.len() * self.places.side * self.places.side;
        drawn <= FEW_PIXELS && self.part.timing().clocks_per_frame() <= FEW_CLOCKS
    }

    /// Scores of the regions are near the minima.
    fn near_threshold_sequence(&self, random: &mut Random) -> BenchSequence {
        let side = self.part.region_size();
        let mut generators: Vec<_> = (self.regions.iter())
            .map(|_| PatternGenerator::new(self.part, side, random.fork()))
            .collect();
        let frames = NEAR_THRESHOLD_PATTERNS.iter().map(|&pattern| {
            generators.iter_mut().for_each(|generator| generator.draw_near_minimum(pattern));
            let squares: Vec<_> = generators.iter().map(|own| own.pixels.clone()).collect();
            BenchFrame::new(self.places.frame(&squares, 0), self.pair.usual)
        });
        BenchSequence::drained(frames.collect())
    }

    /// Minima are met exactly, and missed by one if the design is small.
    fn exact_sequences(&self) -> Vec<BenchSequence> {
        let minima: &[u32] = match (self.part.threshold_source(), self.is_small()) {
            (Mode::Constant, _) => &[],
            (Mode::Runtime, true) => &[0, 1],
            (Mode::Runtime, false) => &[0],
        };
        let sequence = |&more: &u32| {
            let exact = self.regions[0].exact_thresholds(self.part, &self.pair.usual, more);
            BenchSequence::drained(vec![
                self.frame_of_first(0, exact),
                self.frame(0, exact, |_, region| region.other.clone()),
            ])
        };
        minima.iter().map(sequence).collect()
    }

    /// A reset comes while pixels leave.
    fn leaving_sequence(&self, is_wide: bool) -> BenchSequence {
        let frames = if is_wide { self.wide_frames() } else { self.relevant_frames() };
        BenchSequence::ending_at(frames, SequenceEnd::Leaving(0))
    }

    /// Returns a frame of relevant regions. With `flow` there are two, because a region has a
    /// displacement from the second frame on.
    fn relevant_frames(&self) -> Vec<BenchFrame> {
        let relevant = self.relevant_thresholds();
        let mut frames = vec![self.frame_of_first(1, relevant)];
        if self.part.displacement_feature().is_some() {
            frames.push(self.frame(1, relevant, |_, region| region.other.clone()));
        }
        frames
    }

    /// No region has a reference, and yet none has changed, because the minimum is above all
    /// counts.
    fn high_minimum_sequence(&self) -> BenchSequence {
        let usual = self.pair.usual;
        let never = match self.part.threshold_source() {
            Mode::Runtime => self.without_changes(self.relevant_thresholds()),
            Mode::Constant => usual,
        };
        let frames = [never, never, usual]
            .map(|thresholds| self.frame_of_first(1, thresholds).with_sink(SinkPattern::Delaying));
        BenchSequence::drained(frames.into())
    }

    /// Returns thresholds under which the pictures of regions are relevant. With `flow` that
    /// depends on the picture before, unless every score meets the minimum.
    fn relevant_thresholds(&self) -> ThresholdInputs {
        let usual = self.pair.usual;
        match (self.part.displacement_feature(), self.part.threshold_source()) {
            (Some(_), Mode::Runtime) => {
                ThresholdInputs { min_score: [0; FeatureKind::COUNT], ..usual }
            }
            _ => usual,
        }
    }

    /// Returns the thresholds with the largest minimum of the port, which no count reaches if the
    /// port has room for a larger number.
    fn without_changes(&self, thresholds: ThresholdInputs) -> ThresholdInputs {
        ThresholdInputs { temporal_min_count: largest_min_count(self.part), ..thresholds }
    }
}

/// Returns the number of frames during which the sink must stall so that regions of more than one
/// frame are lost. It is 1 if no region is ever lost, and 0 without a sink.
fn stalled_frames(part: &Design) -> usize {
    let kept = part.timing().departure().buffered_rows;
    match (has_sink(part), kept) {
        (false, _) => 0,
        (true, None) => 1,
        (true, Some(kept)) => 1 + (kept + 2).div_ceil(part.rows()) as usize,
    }
}
