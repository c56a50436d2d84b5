// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which frames a bench shows: pictures that the design finds relevant, the same again, others, and
//! nothing, so that regions become active, are held, and are blanked.

use super::damage::DAMAGED;
use super::has_sink;
use super::picture::{TEXTURES, TestPattern};
use super::studio::{Look, Studio};
use crate::stimulus::{Artist, Motif, Random};
use foveate_design::{Combine, Design, Neighborhood, Thresholds as Mode};
use foveate_frame::Frame;
use foveate_model::Thresholds;
use std::ops::RangeInclusive;

/// Frames that every script has; those of few clocks have more.
pub(super) const FRAMES: u64 = 5;
/// Pixels of all regions of a frame that show more than one level.
const MAX_DRAWN: u32 = 16_384;
/// Pixels of such regions, and clocks of a frame, up to which frames near the thresholds follow.
const FEW_PIXELS: usize = 4_096;
const FEW_CLOCKS: u64 = 20_000;
/// What the frames near the thresholds begin with.
const NEAR: [Motif; 4] = [Motif::Bump, Motif::Noise, Motif::Smooth, Motif::Bump];
/// Frames that go beyond the borders of regions.
const WIDE_FRAMES: u32 = 8;
/// Regions from which a frame has a ground that differs from place to place: a word that is stored or read at a
/// wrong place then shows, wherever that is.
const MANY_REGIONS: u32 = 256;
/// Regions of such a frame for each that shows something.
const REGIONS_PER_ACTOR: u32 = 64;
/// Blocks of the ground side by side, and the levels that they have.
const GROUND_BLOCKS: u32 = 8;
const GROUND_LEVELS: u32 = 4;
/// How often a picture is drawn anew before another is tried.
const TRIALS: usize = 2;

/// Where the reset that begins the next sequence finds the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    /// Everything has left.
    Drained,
    /// A pixel, or a mean, is leaving.
    Leaving,
    /// A mean is leaving, where the ports tell.
    MeanLeaving,
}

/// What a sink does meanwhile, where there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SinkMood {
    /// It takes everything.
    Willing,
    /// It takes nothing for so long that regions are lost.
    Losing,
    /// It lets every word wait for some clocks.
    Hesitant,
}

/// Frames behind a reset.
pub(super) struct ShotSequence {
    pub(super) shots: Vec<Shot>,
    pub(super) ending: Ending,
}

/// Frames, each with its thresholds.
pub(super) struct Script {
    /// Sequences; each begins with a reset.
    pub(super) sequences: Vec<ShotSequence>,
    /// What comes damaged to hardware that finds its frames again; see [`super::damage`].
    pub(super) damaged: Vec<Shot>,
}

/// A frame with the thresholds that are applied meanwhile.
pub(super) struct Shot {
    pub(super) frame: Frame,
    pub(super) thresholds: Thresholds,
    pub(super) sink: SinkMood,
}

/// Thresholds under which there is something relevant, and those under which nothing is.
#[derive(Clone, Copy)]
struct ThresholdPair {
    usual: Thresholds,
    blank: Thresholds,
}

/// One region that shows something, with what it shows in turn.
struct Actor {
    first: Vec<u16>,
    other: Vec<u16>,
    last: Vec<u16>,
    /// The scores of the other picture, and its changes against the first.
    scores: Vec<u64>,
    changes: u32,
}

impl Actor {
    /// Minima that the other picture meets exactly, or misses by as much as `more` if the ports reach as far.
    fn exact(&self, part: &Design, usual: &Thresholds, more: u32) -> Thresholds {
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

impl Script {
    /// The frames for a design: `part` is one region or lane alone, or an array. With `is_wide` come frames
    /// that go beyond the borders of regions, for regions so small that their neighbors' pixels decide.
    pub(super) fn of(part: &Design, is_wide: bool) -> Self {
        let (mut studio, mut random) = (Studio::new(part), Random::new(1));
        let pair = threshold_pair(part, &mut studio, &mut random);
        let stage = Stage::new(part);
        let cast: Vec<Actor> = (0..stage.places.len())
            .map(|number| actor(part, &mut studio, &pair.usual, number, &mut random))
            .collect();
        let flat = TestPattern::Flat.draw(stage.side, stage.max, false, &mut random);
        let shot = |turn, thresholds, square: &dyn Fn(usize, &Actor) -> Vec<u16>| {
            let squares: Vec<_> = cast.iter().enumerate().map(|(i, a)| square(i, a)).collect();
            Shot { frame: stage.frame(&squares, turn), thresholds, sink: SinkMood::Willing }
        };
        let mixed = |number: usize, actor: &Actor| match number % 3 {
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
            // Levels of regions side by side differ, or a mean could stand for another; not where their pixels would be seen.
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
            let never = |of| Thresholds { temporal_min_count: most_changes(part), ..of };
            // Means that are sent, stay twice, and are sent again as soon as the level lets them; the same again behind pixels,
            // and behind a region that is held.
            let mut shots = vec![active(0)];
            shots.extend([0, 0, level, level + 1].map(means));
            shots.extend([last(), means(level + 1)]);
            if part.thresholds() == Mode::Runtime {
                // With a second pass a decision is made with the thresholds of the next frame.
                let held = shot(2, never(pair.usual), &|_, actor| actor.first.clone());
                let behind = shot(2, never(pair.blank), &|number, _| plain(number, level + 1));
                shots.extend([held, behind]);
            }
            with_means.push(ShotSequence { shots, ending: Ending::Drained });
            // The same frame behind a reset; and every other region held beside means, which wait for the sink.
            // Held ones drift as far as they may, up and down: what they are compared with is what was sent, and no later frame.
            let drift = u16::try_from(pair.usual.temporal_level).unwrap_or(u16::MAX);
            let up = |pixel: &u16| pixel.saturating_add(drift).min(stage.max);
            let down = |pixel: &u16| pixel.saturating_sub(drift);
            let beside = |more: u32, is_up: bool| Shot {
                sink: SinkMood::Hesitant,
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
            with_means.push(ShotSequence { shots, ending: Ending::MeanLeaving });
        }
        let mut sequences: Vec<ShotSequence> = sequences.into_iter().map(drained).collect();
        sequences.extend(with_means);
        // First, so that a reset follows.
        let pictures = [|actor: &Actor| actor.first.clone(), |actor: &Actor| actor.other.clone()];
        let stalled = (0..stalled_frames(part)).map(|number| {
            let usual =
                || shot(0, pair.usual, &|_, actor| pictures[number % pictures.len()](actor));
            // More regions are lost than have something of their own to show: counters are to get far.
            let turn = u32::try_from(number).unwrap_or_default();
            let wide = || Shot {
                frame: stage.wide(turn),
                thresholds: pair.usual,
                sink: SinkMood::Willing,
            };
            Shot { sink: SinkMood::Losing, ..if stage.has_ground() { wide() } else { usual() } }
        });
        let stalled: Vec<Shot> = stalled.collect();
        if !stalled.is_empty() {
            let last = shot(1, pair.usual, &|_, actor| actor.last.clone());
            // Summaries are lost, and sent again.
            let means =
                || Shot { sink: SinkMood::Losing, ..shot(2, pair.blank, &|_, _| flat.clone()) };
            let means = part.periphery().map(|_| [means(), means()]).into_iter().flatten();
            let lossy = stalled.into_iter().chain(means).chain([last]).collect();
            sequences.insert(0, drained(lossy));
        }
        let drawn = cast.len() * stage.side * stage.side;
        let is_small = drawn <= FEW_PIXELS && part.timing().clocks_per_frame() <= FEW_CLOCKS;
        if is_small {
            let mut artists: Vec<Artist> =
                cast.iter().map(|_| Artist::new(part, part.region_size(), random.fork())).collect();
            let near = NEAR.iter().map(|&motif| {
                artists.iter_mut().for_each(|artist| artist.draw_near_minimum(motif));
                let squares: Vec<_> = artists.iter().map(|artist| artist.pixels.clone()).collect();
                Shot {
                    frame: stage.frame(&squares, 0),
                    thresholds: pair.usual,
                    sink: SinkMood::Willing,
                }
            });
            sequences.push(drained(near.collect()));
        }
        // Of a large frame the minima that are met, and not those that are missed by one.
        let minima: &[u32] = if is_small { &[0, 1] } else { &[0] };
        for &more in minima.iter().filter(|_| part.thresholds() == Mode::Runtime) {
            let exact = cast[0].exact(part, &pair.usual, more);
            sequences.push(drained(vec![
                shot(0, exact, &|_, actor| actor.first.clone()),
                shot(0, exact, &|_, actor| actor.other.clone()),
            ]));
        }
        let wide = || -> Vec<Shot> {
            let of = |turn| (stage.wide(turn), pair.usual);
            let shots = (0..WIDE_FRAMES).map(of);
            shots
                .map(|(frame, thresholds)| Shot { frame, thresholds, sink: SinkMood::Willing })
                .collect()
        };
        if is_wide {
            sequences.push(drained(wide()));
        }
        // A reset meets what leaves.
        let leaving = match is_wide {
            true => wide(),
            false => vec![shot(1, pair.usual, &|_, actor| actor.first.clone())],
        };
        // Nothing has a reference, and yet no region has changed, where the minimum is above all counts.
        let never = match part.thresholds() {
            Mode::Runtime => Thresholds { temporal_min_count: most_changes(part), ..pair.usual },
            Mode::Constant => pair.usual,
        };
        let again = [never, never, pair.usual];
        let again = again.map(|of| Shot {
            sink: SinkMood::Hesitant,
            ..shot(1, of, &|_, actor| actor.first.clone())
        });
        sequences.insert(0, ShotSequence { shots: leaving, ending: Ending::Leaving });
        sequences.insert(1, drained(again.into()));
        let damaged = (0..DAMAGED).map(|number| {
            shot(0, pair.usual, &|_, actor| pictures[number % pictures.len()](actor))
        });
        Self { damaged: damaged.collect(), sequences }
    }
}

/// Frames behind which everything leaves.
fn drained(shots: Vec<Shot>) -> ShotSequence {
    ShotSequence { shots, ending: Ending::Drained }
}

/// A minimum that no count reaches.
fn most_changes(part: &Design) -> u32 {
    u32::MAX >> (u32::BITS - part.count_bits())
}

/// Frames during which a sink must stall for regions of more than one frame to be lost; one where none is ever lost; none
/// without a sink.
fn stalled_frames(part: &Design) -> usize {
    let kept = part.timing().departure().kept_rows;
    match (has_sink(part), kept) {
        (false, _) => 0,
        (true, None) => 1,
        (true, Some(kept)) => 1 + (kept + 2).div_ceil(part.rows()) as usize,
    }
}

/// Where in a frame something is shown.
struct Stage<'a> {
    part: &'a Design,
    /// Regions that show something, in order.
    places: Vec<u32>,
    side: usize,
    max: u16,
    /// The level of a region that shows nothing.
    flat: u16,
}

impl<'a> Stage<'a> {
    /// Everywhere in a small array, else evenly spread, the first and the last region among them.
    fn new(part: &'a Design) -> Self {
        let regions = part.regions();
        let least = (MAX_DRAWN / part.region_pixels()).clamp(6, 48);
        let count = least.max(regions / REGIONS_PER_ACTOR).min(regions);
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

    /// A frame with these squares at the places, and the ground of this turn elsewhere.
    fn frame(&self, squares: &[Vec<u16>], turn: u32) -> Frame {
        let (part, side) = (self.part, self.part.region_size());
        let pixel = |x: u32, y: u32| {
            let region = y / side * part.columns() + x / side;
            match self.places.binary_search(&region) {
                Ok(at) => squares[at][(y % side * side + x % side) as usize],
                Err(_) => self.ground(x / side, y / side, turn),
            }
        };
        self.drawn(pixel)
    }

    /// Whether the ground differs from place to place and from turn to turn.
    fn has_ground(&self) -> bool {
        self.part.regions() >= MANY_REGIONS
    }

    /// The level of a region that shows nothing: in a wide frame one of a few, by blocks of regions.
    fn ground(&self, column: u32, row: u32, turn: u32) -> u16 {
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

impl Stage<'_> {
    /// Squares all over the frame, elsewhere each turn: their edges and corners reach every region, and a
    /// median leaves them.
    fn wide(&self, turn: u32) -> Frame {
        let size = (self.part.region_size() / 2).max(3);
        let is_bright = |at: u32, shift: u32| (at + shift) % (2 * size) < size;
        let pixel = |x, y| match is_bright(x, turn) && is_bright(y, turn * 2 % 7) {
            true => self.max,
            false => 0,
        };
        self.drawn(pixel)
    }

    fn drawn(&self, pixel: impl FnMut(u32, u32) -> u16) -> Frame {
        let part = self.part;
        Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
            .unwrap_or_else(|error| unreachable!("pixels are those of the design: {error}"))
    }
}

/// The thresholds of the design, if pictures lead to all kinds of regions under them; else, where they are
/// inputs, the smallest that tell something from nothing.
fn threshold_pair(part: &Design, studio: &mut Studio, random: &mut Random) -> ThresholdPair {
    let own = Thresholds::of(part);
    let configured = ThresholdPair { usual: own, blank: own };
    match part.thresholds() {
        Mode::Constant => configured,
        Mode::Runtime if is_telling(part, studio, &own, random) => configured,
        Mode::Runtime => least(part, studio, random),
    }
}

/// Whether some picture is relevant, nothing is not, and a change counts.
fn is_telling(
    part: &Design,
    studio: &mut Studio,
    thresholds: &Thresholds,
    random: &mut Random,
) -> bool {
    let (side, max) = size(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let flat = studio.look(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut good = TEXTURES.iter().filter(|texture| {
        let picture = texture.draw(side, max, false, random);
        let look = studio.look(&picture, Some(&flat), thresholds);
        look.is_relevant && look.changes(&flat, thresholds) >= least
    });
    !flat.is_relevant && least > 0 && good.next().is_some()
}

/// Levels of 0 and minima of 1; a feature that never finds anything (corners in 2x2 pixels behind a median)
/// must vote with a minimum of 0 where its vote is needed.
fn least(part: &Design, studio: &mut Studio, random: &mut Random) -> ThresholdPair {
    let (side, max) = size(part);
    let mut blank = Thresholds::of(part);
    (blank.temporal_level, blank.temporal_min_count) = (0, 1);
    for (level, minimum) in blank.level.iter_mut().zip(&mut blank.min_score) {
        (*level, *minimum) = (0, 1);
    }
    let mut usual = blank;
    let looks: Vec<Look> = TEXTURES
        .iter()
        .map(|texture| studio.look(&texture.draw(side, max, false, random), None, &blank))
        .collect();
    let is_needed = part.combine() == Combine::All || part.features().len() == 1;
    for (feature, minimum) in usual.min_score.iter_mut().enumerate().take(part.features().len()) {
        if is_needed && looks.iter().all(|look| look.scores[feature] == 0) {
            *minimum = 0;
        }
    }
    ThresholdPair { usual, blank }
}

/// Pictures for a region: relevant ones, each with enough changes against the one before.
fn actor(
    part: &Design,
    studio: &mut Studio,
    thresholds: &Thresholds,
    number: usize,
    random: &mut Random,
) -> Actor {
    let (side, max) = size(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let nothing = studio.look(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut pick = |from: usize, before: &Look, wanted: RangeInclusive<u32>| {
        for step in 0..2 * TRIALS * TEXTURES.len() {
            let texture = TEXTURES[(from + step / (2 * TRIALS)) % TEXTURES.len()];
            let picture = texture.draw(side, max, step % 2 == 1, random);
            let look = studio.look(&picture, Some(before), thresholds);
            let changes = look.changes(before, thresholds);
            if look.is_relevant && wanted.contains(&changes) {
                return Some((picture, look));
            }
        }
        None
    };
    let all = part.region_pixels();
    // Without a reference everything has changed.
    let first = pick(number, &nothing, 0..=all);
    let (first, seen) = first.unwrap_or_else(|| (flat.clone(), nothing.clone()));
    // Better a change of some pixels than of all.
    let other = pick(number + 1, &seen, least..=all - 1);
    let other = other.or_else(|| pick(number + 1, &seen, least..=all));
    let last = pick(number + 2, &nothing, least..=all).map_or_else(|| first.clone(), |last| last.0);
    let (other, look) = other.unwrap_or_else(|| {
        let negative: Vec<u16> = first.iter().map(|&pixel| max - pixel).collect();
        let look = studio.look(&negative, Some(&seen), thresholds);
        (negative, look)
    });
    let (changes, scores) = (look.changes(&seen, thresholds), look.scores);
    Actor { first, other, last, scores, changes }
}

fn size(part: &Design) -> (usize, u16) {
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    (part.region_size() as usize, max)
}
