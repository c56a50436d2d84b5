// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the frames of a bench: pictures that the design finds relevant, the same ones
//! again, other ones, and flat ones, so that regions become active, are held, and are blanked.

use super::delivery::DELIVERED_FRAMES;
use super::has_sink;
use super::picture_scorer::{PictureScorer, PictureScores};
use super::test_pattern::{STRUCTURED_PATTERNS, TestPattern};
use crate::stimulus::{PatternGenerator, Random, StimulusPattern};
use foveate_design::{Design, Neighborhood, ThresholdSource as Mode, VoteCombination};
use foveate_frame::Frame;
use foveate_model::ThresholdInputs;
use std::ops::RangeInclusive;

/// The number of frames that every script has; scripts with short frames have more.
pub(super) const MIN_FRAMES_PER_SCRIPT: u64 = 5;
/// The largest number of pixels in those regions of a frame that show more than one level.
const MAX_DRAWN_PIXELS: u32 = 16_384;
/// The limits for frames near the thresholds: the pixels of drawn regions, and the clocks of a
/// frame.
const FEW_PIXELS: usize = 4_096;
const FEW_CLOCKS: u64 = 20_000;
/// The patterns of the frames near the thresholds.
const NEAR_THRESHOLD_PATTERNS: [StimulusPattern; 4] =
    [StimulusPattern::Bump, StimulusPattern::Noise, StimulusPattern::Smooth, StimulusPattern::Bump];
/// The number of frames whose shapes cross the borders of regions.
const WIDE_FRAMES: u32 = 8;
/// The number of regions from which on a frame has a varying ground. A word that is stored or read
/// at a wrong place then shows wherever that is.
const MANY_REGIONS: u32 = 256;
/// The number of regions of such a frame for each drawn region.
const REGIONS_PER_DRAWN_REGION: u32 = 64;
/// The number of blocks of the ground in each direction; `GROUND_LEVELS` is the number of their
/// levels.
const GROUND_BLOCKS: u32 = 8;
const GROUND_LEVELS: u32 = 4;
/// The number of times that a pattern is drawn anew before the next pattern is tried.
const TRIALS_PER_PATTERN: usize = 2;

/// The state of the core at the reset that begins the next sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BenchSequenceEnd {
    /// All pixels have left.
    Drained,
    /// A pixel or a mean is leaving.
    Leaving,
    /// A mean is leaving, if the ports distinguish means from pixels.
    MeanLeaving,
}

/// The behavior of the sink, if the core has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BenchSinkMode {
    /// The sink takes every word at once.
    AlwaysReady,
    /// The sink takes nothing for so long that regions are lost.
    Stalling,
    /// The sink lets every word wait for some clocks.
    Delaying,
}

/// The frames between two resets.
pub(super) struct BenchSequence {
    pub(super) frames: Vec<BenchFrame>,
    pub(super) ending: BenchSequenceEnd,
}

/// The sequences of frames of a bench.
pub(super) struct BenchScript {
    /// The sequences; each begins with a reset.
    pub(super) sequences: Vec<BenchSequence>,
    /// The frames that are delivered damaged to hardware with `sync`; see [`super::delivery`].
    pub(super) damaged: Vec<BenchFrame>,
}

/// A frame with the thresholds and the sink that apply to it.
pub(super) struct BenchFrame {
    pub(super) frame: Frame,
    pub(super) thresholds: ThresholdInputs,
    pub(super) sink: BenchSinkMode,
}

/// Two sets of thresholds: with `usual` some regions are relevant, with `blank` a flat region is
/// not.
#[derive(Clone, Copy)]
struct ThresholdPair {
    usual: ThresholdInputs,
    blank: ThresholdInputs,
}

/// A region with structure, and the pictures that it shows in turn.
struct DrawnRegion {
    first: Vec<u16>,
    other: Vec<u16>,
    last: Vec<u16>,
    /// The scores of `other`; `changes` is the number of pixels in which it differs from `first`.
    scores: Vec<u64>,
    changes: u32,
}

impl DrawnRegion {
    /// Returns minima that `other` meets exactly (`more` is 0), or misses by `more` if the ports
    /// are wide enough.
    fn exact_thresholds(
        &self,
        part: &Design,
        usual: &ThresholdInputs,
        more: u32,
    ) -> ThresholdInputs {
        let mut exact = *usual;
        let scores = self.scores.iter().zip(part.features());
        for (minimum, (&score, feature)) in exact.min_score.iter_mut().zip(scores) {
            let largest = u64::MAX >> (u64::BITS - feature.score_bits());
            *minimum = (score + u64::from(more)).min(largest);
        }
        let largest = u32::MAX >> (u32::BITS - part.count_bits());
        exact.temporal_min_count = (self.changes + more).min(largest);
        exact
    }
}

impl BenchScript {
    /// Returns the frames for `part`, which is one region or lane, or an array. With `is_wide` some
    /// frames have shapes that cross the borders of regions. They are for regions so small that
    /// their neighbors' pixels decide.
    pub(super) fn for_design(part: &Design, is_wide: bool) -> Self {
        let (mut studio, mut random) = (PictureScorer::new(part), Random::new(1));
        let pair = threshold_pair(part, &mut studio, &mut random);
        let stage = DrawnPlaces::new(part);
        let cast: Vec<DrawnRegion> = (0..stage.places.len())
            .map(|number| draw_region(part, &mut studio, &pair.usual, number, &mut random))
            .collect();
        let flat = TestPattern::Flat.draw(stage.side, stage.max, false, &mut random);
        let shot = |turn, thresholds, square: &dyn Fn(usize, &DrawnRegion) -> Vec<u16>| {
            let squares: Vec<_> = cast.iter().enumerate().map(|(i, a)| square(i, a)).collect();
            BenchFrame {
                frame: stage.frame(&squares, turn),
                thresholds,
                sink: BenchSinkMode::AlwaysReady,
            }
        };
        let mixed = |number: usize, actor: &DrawnRegion| match number % 3 {
            0 => actor.other.clone(),
            1 => actor.first.clone(),
            _ => flat.clone(),
        };
        let sequences = vec![vec![
            shot(0, pair.usual, &|_, actor| actor.first.clone()),
            shot(0, pair.usual, &|_, actor| actor.first.clone()),
            shot(1, pair.usual, &mixed),
            shot(2, pair.blank, &|_, _| flat.clone()),
            shot(2, pair.usual, &|_, actor| actor.last.clone()),
        ]];
        let mut with_means = Vec::new();
        if let Some(periphery) = part.periphery() {
            let level = periphery.level;
            // The levels of adjacent regions differ, or a mean could be mistaken for another one.
            // They are equal if regions see the pixels of their neighbors.
            let apart = match part.neighborhood() {
                Neighborhood::Isolated => 2 * level + 3,
                Neighborhood::Shared => 0,
            };
            let plain = |number: usize, more: u32| {
                let place = u32::try_from(number % 3).unwrap_or_default();
                let level = u16::try_from(more + place * apart).unwrap_or(u16::MAX);
                vec![level.min(stage.max); flat.len()]
            };
            let means = |more: u32| shot(2, pair.blank, &|number, _| plain(number, more));
            let active = |turn| shot(turn, pair.usual, &|_, actor| actor.first.clone());
            let last = || shot(2, pair.usual, &|_, actor| actor.last.clone());
            let never = |of| ThresholdInputs { temporal_min_count: largest_minimum(part), ..of };
            // Means are sent, stay twice, and are sent again as soon as they differ by more than
            // the level. The same means are sent again behind pixels, and behind a held region.
            let mut shots = vec![active(0)];
            shots.extend([0, 0, level, level + 1].map(means));
            shots.extend([last(), means(level + 1)]);
            if part.threshold_source() == Mode::Runtime {
                // With a second pass a decision is made with the thresholds of the next frame.
                let held = shot(2, never(pair.usual), &|_, actor| actor.first.clone());
                let behind = shot(2, never(pair.blank), &|number, _| plain(number, level + 1));
                shots.extend([held, behind]);
            }
            with_means.push(BenchSequence { frames: shots, ending: BenchSequenceEnd::Drained });
            // The same frame follows a reset. Then every second region is held beside means that
            // wait for the sink. The held regions drift by the temporal level, up and down, so they
            // stay held only if they are compared with what was sent, and not with a later frame.
            let drift = u16::try_from(pair.usual.temporal_level).unwrap_or(u16::MAX);
            let up = |pixel: &u16| pixel.saturating_add(drift).min(stage.max);
            let down = |pixel: &u16| pixel.saturating_sub(drift);
            let beside = |more: u32, is_up: bool| BenchFrame {
                sink: BenchSinkMode::Delaying,
                ..shot(2, pair.usual, &|number, actor| match (number % 2, is_up) {
                    (0, true) => actor.first.iter().map(up).collect(),
                    (0, false) => actor.first.iter().map(down).collect(),
                    _ => plain(number, more),
                })
            };
            let far = 2 * level + 2;
            let shots = vec![
                means(level + 1),
                active(2),
                beside(0, true),
                beside(far, false),
                beside(0, true),
            ];
            with_means.push(BenchSequence { frames: shots, ending: BenchSequenceEnd::MeanLeaving });
        }
        let mut sequences: Vec<BenchSequence> =
            sequences.into_iter().map(drained_sequence).collect();
        sequences.extend(with_means);
        // This sequence comes first, so that a reset follows it.
        let pictures =
            [|actor: &DrawnRegion| actor.first.clone(), |actor: &DrawnRegion| actor.other.clone()];
        let stalled = (0..stalled_frames(part)).map(|number| {
            let usual =
                || shot(0, pair.usual, &|_, actor| pictures[number % pictures.len()](actor));
            // More regions must be lost than have their own structure, because the counters must
            // reach large values.
            let turn = u32::try_from(number).unwrap_or_default();
            let wide = || BenchFrame {
                frame: stage.wide_frame(turn),
                thresholds: pair.usual,
                sink: BenchSinkMode::AlwaysReady,
            };
            BenchFrame {
                sink: BenchSinkMode::Stalling,
                ..if stage.has_ground() { wide() } else { usual() }
            }
        });
        let stalled: Vec<BenchFrame> = stalled.collect();
        if !stalled.is_empty() {
            let last = shot(1, pair.usual, &|_, actor| actor.last.clone());
            // Summaries are lost, and sent again.
            let means = || BenchFrame {
                sink: BenchSinkMode::Stalling,
                ..shot(2, pair.blank, &|_, _| flat.clone())
            };
            let means = part.periphery().map(|_| [means(), means()]).into_iter().flatten();
            let lossy = stalled.into_iter().chain(means).chain([last]).collect();
            sequences.insert(0, drained_sequence(lossy));
        }
        let drawn = cast.len() * stage.side * stage.side;
        let is_small = drawn <= FEW_PIXELS && part.timing().clocks_per_frame() <= FEW_CLOCKS;
        if is_small {
            let mut artists: Vec<PatternGenerator> = cast
                .iter()
                .map(|_| PatternGenerator::new(part, part.region_size(), random.fork()))
                .collect();
            let near = NEAR_THRESHOLD_PATTERNS.iter().map(|&motif| {
                artists.iter_mut().for_each(|artist| artist.draw_near_minimum(motif));
                let squares: Vec<_> = artists.iter().map(|artist| artist.pixels.clone()).collect();
                BenchFrame {
                    frame: stage.frame(&squares, 0),
                    thresholds: pair.usual,
                    sink: BenchSinkMode::AlwaysReady,
                }
            });
            sequences.push(drained_sequence(near.collect()));
        }
        // For a large frame there is no sequence whose minima are missed by one.
        let minima: &[u32] = if is_small { &[0, 1] } else { &[0] };
        for &more in minima.iter().filter(|_| part.threshold_source() == Mode::Runtime) {
            let exact = cast[0].exact_thresholds(part, &pair.usual, more);
            sequences.push(drained_sequence(vec![
                shot(0, exact, &|_, actor| actor.first.clone()),
                shot(0, exact, &|_, actor| actor.other.clone()),
            ]));
        }
        let wide = || -> Vec<BenchFrame> {
            let of = |turn| (stage.wide_frame(turn), pair.usual);
            let shots = (0..WIDE_FRAMES).map(of);
            shots
                .map(|(frame, thresholds)| BenchFrame {
                    frame,
                    thresholds,
                    sink: BenchSinkMode::AlwaysReady,
                })
                .collect()
        };
        if is_wide {
            sequences.push(drained_sequence(wide()));
        }
        // A reset comes while pixels leave.
        let leaving = match is_wide {
            true => wide(),
            false => vec![shot(1, pair.usual, &|_, actor| actor.first.clone())],
        };
        // No region has a reference, and yet none has changed, because the minimum is above all
        // counts.
        let never = match part.threshold_source() {
            Mode::Runtime => {
                ThresholdInputs { temporal_min_count: largest_minimum(part), ..pair.usual }
            }
            Mode::Constant => pair.usual,
        };
        let again = [never, never, pair.usual];
        let again = again.map(|of| BenchFrame {
            sink: BenchSinkMode::Delaying,
            ..shot(1, of, &|_, actor| actor.first.clone())
        });
        sequences.insert(0, BenchSequence { frames: leaving, ending: BenchSequenceEnd::Leaving });
        sequences.insert(1, drained_sequence(again.into()));
        let damaged = (0..DELIVERED_FRAMES).map(|number| {
            shot(0, pair.usual, &|_, actor| pictures[number % pictures.len()](actor))
        });
        Self { damaged: damaged.collect(), sequences }
    }
}

/// Returns a sequence after which everything leaves.
fn drained_sequence(shots: Vec<BenchFrame>) -> BenchSequence {
    BenchSequence { frames: shots, ending: BenchSequenceEnd::Drained }
}

/// Returns the largest minimum of the port, which no count reaches if the port has room for a
/// larger number.
fn largest_minimum(part: &Design) -> u32 {
    u32::MAX >> (u32::BITS - part.count_bits())
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

/// The places in a frame at which regions have structure.
struct DrawnPlaces<'a> {
    part: &'a Design,
    /// The indices of the regions with structure, in ascending order.
    places: Vec<u32>,
    side: usize,
    max: u16,
    /// The level of a flat region.
    flat: u16,
}

impl<'a> DrawnPlaces<'a> {
    /// Creates the places: all regions of a small array, or else evenly spread regions, with the
    /// first and the last one among them.
    fn new(part: &'a Design) -> Self {
        let regions = part.regions();
        let least = (MAX_DRAWN_PIXELS / part.region_pixels()).clamp(6, 48);
        let count = least.max(regions / REGIONS_PER_DRAWN_REGION).min(regions);
        let last = u64::from(count - 1).max(1);
        let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
        let place = |number: u32| {
            let place = u64::from(number) * u64::from(regions - 1) / last;
            u32::try_from(place).expect("a region of the array")
        };
        Self {
            part,
            places: (0..count).map(place).collect(),
            side: part.region_size() as usize,
            max,
            flat: TestPattern::Flat.draw(1, max, false, &mut Random::new(1))[0],
        }
    }

    /// Returns a frame with the given squares at the places, and the ground of this turn elsewhere.
    fn frame(&self, squares: &[Vec<u16>], turn: u32) -> Frame {
        let (part, side) = (self.part, self.part.region_size());
        let pixel = |x: u32, y: u32| {
            let region = y / side * part.columns() + x / side;
            match self.places.binary_search(&region) {
                Ok(at) => squares[at][(y % side * side + x % side) as usize],
                Err(_) => self.ground_level(x / side, y / side, turn),
            }
        };
        self.frame_from_pixels(pixel)
    }

    /// Returns true if the ground differs from place to place and from turn to turn.
    fn has_ground(&self) -> bool {
        self.part.regions() >= MANY_REGIONS
    }

    /// Returns the level of a flat region. In a frame with many regions it is one of a few levels,
    /// by blocks of regions.
    fn ground_level(&self, column: u32, row: u32, turn: u32) -> u16 {
        if !self.has_ground() {
            return self.flat;
        }
        let block = column * GROUND_BLOCKS / self.part.columns();
        let mixed = (row * GROUND_BLOCKS + block).wrapping_mul(0x9e37_79b9) >> 16;
        let level = (mixed + turn * (1 + mixed / GROUND_LEVELS % 2)) % GROUND_LEVELS;
        let level = level * u32::from(self.max) / (GROUND_LEVELS - 1);
        u16::try_from(level).expect("no more than the largest")
    }
}

impl DrawnPlaces<'_> {
    /// Returns a frame with squares all over, shifted from turn to turn. Their edges and corners
    /// reach every region, and a median filter keeps them.
    fn wide_frame(&self, turn: u32) -> Frame {
        let size = (self.part.region_size() / 2).max(3);
        let is_bright = |at: u32, shift: u32| (at + shift) % (2 * size) < size;
        let pixel = |x, y| match is_bright(x, turn) && is_bright(y, turn * 2 % 7) {
            true => self.max,
            false => 0,
        };
        self.frame_from_pixels(pixel)
    }

    fn frame_from_pixels(&self, pixel: impl FnMut(u32, u32) -> u16) -> Frame {
        let part = self.part;
        Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
            .unwrap_or_else(|error| unreachable!("pixels are those of the design: {error}"))
    }
}

/// Returns the thresholds of the design if some test pictures lead to all kinds of regions under
/// them. Otherwise, if thresholds are inputs, it returns the smallest ones that distinguish a
/// pattern from a flat region.
fn threshold_pair(part: &Design, studio: &mut PictureScorer, random: &mut Random) -> ThresholdPair {
    let own = ThresholdInputs::from_camera(part);
    let configured = ThresholdPair { usual: own, blank: own };
    match part.threshold_source() {
        Mode::Constant => configured,
        Mode::Runtime if separates_regions(part, studio, &own, random) => configured,
        Mode::Runtime => smallest_thresholds(part, studio, random),
    }
}

/// Returns true if some pattern is relevant, a flat region is not, and an unchanged region is held.
fn separates_regions(
    part: &Design,
    studio: &mut PictureScorer,
    thresholds: &ThresholdInputs,
    random: &mut Random,
) -> bool {
    let (side, max) = region_shape(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let flat = studio.score_picture(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut good = STRUCTURED_PATTERNS.iter().filter(|texture| {
        let picture = texture.draw(side, max, false, random);
        let look = studio.score_picture(&picture, Some(&flat), thresholds);
        look.is_relevant && look.changed_pixels_from(&flat, thresholds) >= least
    });
    !flat.is_relevant && least > 0 && good.next().is_some()
}

/// Returns thresholds with levels of 0 and minima of 1. A feature that never finds anything
/// (corners in 2x2 pixels behind a median filter) gets a minimum of 0 if its vote is needed.
fn smallest_thresholds(
    part: &Design,
    studio: &mut PictureScorer,
    random: &mut Random,
) -> ThresholdPair {
    let (side, max) = region_shape(part);
    let mut blank = ThresholdInputs::from_camera(part);
    (blank.temporal_level, blank.temporal_min_count) = (0, 1);
    for (level, minimum) in blank.level.iter_mut().zip(&mut blank.min_score) {
        (*level, *minimum) = (0, 1);
    }
    let mut usual = blank;
    let looks: Vec<PictureScores> = STRUCTURED_PATTERNS
        .iter()
        .map(|texture| studio.score_picture(&texture.draw(side, max, false, random), None, &blank))
        .collect();
    let is_needed = part.combine() == VoteCombination::All || part.features().len() == 1;
    for (feature, minimum) in usual.min_score.iter_mut().enumerate().take(part.features().len()) {
        if is_needed && looks.iter().all(|look| look.scores[feature] == 0) {
            *minimum = 0;
        }
    }
    ThresholdPair { usual, blank }
}

/// Returns the pictures of a region: relevant ones, each with enough changes against the picture
/// before it.
fn draw_region(
    part: &Design,
    studio: &mut PictureScorer,
    thresholds: &ThresholdInputs,
    number: usize,
    random: &mut Random,
) -> DrawnRegion {
    let (side, max) = region_shape(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let nothing = studio.score_picture(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut pick = |from: usize, before: &PictureScores, wanted: RangeInclusive<u32>| {
        for step in 0..2 * TRIALS_PER_PATTERN * STRUCTURED_PATTERNS.len() {
            let texture = STRUCTURED_PATTERNS
                [(from + step / (2 * TRIALS_PER_PATTERN)) % STRUCTURED_PATTERNS.len()];
            let picture = texture.draw(side, max, step % 2 == 1, random);
            let look = studio.score_picture(&picture, Some(before), thresholds);
            let changes = look.changed_pixels_from(before, thresholds);
            if look.is_relevant && wanted.contains(&changes) {
                return Some((picture, look));
            }
        }
        None
    };
    let all = part.region_pixels();
    // Without a reference every pixel counts as changed.
    let first = pick(number, &nothing, 0..=all);
    let (first, seen) = first.unwrap_or_else(|| (flat.clone(), nothing.clone()));
    // A change of some pixels is preferred to a change of all.
    let other = pick(number + 1, &seen, least..=all - 1);
    let other = other.or_else(|| pick(number + 1, &seen, least..=all));
    let last = pick(number + 2, &nothing, least..=all).map_or_else(|| first.clone(), |last| last.0);
    let (other, look) = other.unwrap_or_else(|| {
        let negative: Vec<u16> = first.iter().map(|&pixel| max - pixel).collect();
        let look = studio.score_picture(&negative, Some(&seen), thresholds);
        (negative, look)
    });
    let (changes, scores) = (look.changed_pixels_from(&seen, thresholds), look.scores);
    DrawnRegion { first, other, last, scores, changes }
}

fn region_shape(part: &Design) -> (usize, u16) {
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    (part.region_size() as usize, max)
}
