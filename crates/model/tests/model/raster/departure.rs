// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the last decision and the last word of every row of regions leave at the times of
//! [`RasterStream`], behind a sensor that reads words at its own rate.

use std::collections::VecDeque;

use foveate_design::{Action, RasterStream, RasterTiming, RowDeparture};
use foveate_frame::Frame;
use foveate_model::{CoreInput, RasterOutput, RasterRcm, Thresholds};

use super::camera::recipe;
use super::driver::words;
use super::recipe::RasterRecipe;
use crate::frames::Random;
use crate::hard_cases::hard_frames;

/// The pace of a sensor: clocks from word to word, and clocks between frames.
type Pace = (u64, u64);

/// The stream of a sensor: the words with the edges at which they have been read, and the begin and
/// the pace of each frame.
struct Sensor {
    words: VecDeque<(u64, Vec<u16>)>,
    begins: Vec<(u64, Pace)>,
}

fn sensor(recipe: &RasterRecipe, film: &[Frame], paces: &[Pace]) -> Sensor {
    let (mut sensor, mut now) = (Sensor { words: VecDeque::new(), begins: Vec::new() }, 0);
    for (frame, &pace) in film.iter().zip(paces.iter().cycle()) {
        sensor.begins.push((now, pace));
        for word in words(recipe, frame, &mut Random(7)) {
            now += pace.0;
            sensor.words.push_back((now, word));
        }
        now += pace.1;
    }
    sensor
}

/// Returns the outputs of the core after every edge until nothing is under way.
fn shown(recipe: &RasterRecipe, mut words: VecDeque<(u64, Vec<u16>)>) -> Vec<RasterOutput> {
    let design = recipe.design();
    let (mut rcm, thresholds) = (RasterRcm::new(design.raster().unwrap()), Thresholds::of(&design));
    let nothing = vec![0; recipe.pixels as usize];
    let mut shown = vec![rcm.output().clone()];
    let mut left = RasterTiming::of(design.raster().unwrap()).edges_to_ready() + 5;
    while left > 0 {
        let now = shown.len() as u64;
        let word = words.front().filter(|(read, _)| *read <= now).map(|(_, word)| word.clone());
        let input = CoreInput {
            reset: false,
            valid: word.is_some(),
            sof: false,
            pixels: word.as_ref().unwrap_or(&nothing),
            reference_valid: false,
            reference_pixels: &[],
            forward_ready: true,
            thresholds: &thresholds,
            border: 0,
        };
        if word.is_some() && rcm.output().ready {
            words.pop_front();
        }
        shown.push(rcm.step(&input).clone());
        left -= u64::from(words.is_empty() && !rcm.is_pending());
    }
    shown
}

/// The observed results of a frame: the actions of its regions, and for every row of regions the
/// edges after which its last decision and its last word were on the ports.
#[derive(Default)]
struct Seen {
    actions: Vec<Action>,
    rows: Vec<RowDeparture>,
}

fn seen(recipe: &RasterRecipe, shown: &[RasterOutput]) -> Vec<Seen> {
    let (columns, regions) = (recipe.base.columns(), recipe.base.columns() * recipe.base.rows());
    let mut frames: Vec<Seen> = Vec::new();
    let mut waiting = VecDeque::new();
    for (edge, output) in shown.iter().enumerate() {
        if output.decision_valid {
            if output.region == 0 {
                frames.push(Seen::default());
            }
            let (frame, row) = (frames.len() - 1, (i64::from(output.region) / columns) as usize);
            let Seen { actions, rows } = &mut frames[frame];
            let action = match (output.active, output.summary) {
                (true, _) => Action::Forward,
                (false, true) => Action::Summarize,
                (false, false) => Action::Hold,
            };
            actions.push(action);
            rows.resize(row + 1, RowDeparture { decided: 0, left: None });
            rows[row].decided = edge as u128;
            let leaves = output.active && recipe.forward || output.summary;
            waiting.extend(leaves.then_some((frame, row)));
        }
        if output.forward_valid && output.forward_last {
            let (frame, row) = waiting.pop_front().unwrap();
            frames[frame].rows[row].left = Some(edge as u128);
        }
    }
    assert!(waiting.is_empty() && !shown.last().unwrap().lost);
    assert!(frames.iter().all(|seen| seen.actions.len() as i64 == regions));
    frames
}

/// Counts of the rows of regions that have been compared.
#[derive(Debug, Default)]
struct Rows {
    compared: usize,
    /// Rows that sent the pixels of some of their regions, and nothing of others.
    partly: usize,
    /// Rows that sent a summary.
    with_summaries: usize,
    /// Rows that sent both a summary and pixels.
    mixed: usize,
}

fn check(recipe: &RasterRecipe, film: &[Frame], paces: &[Pace], rows: &mut Rows) {
    let sensor = sensor(recipe, film, paces);
    let seen = seen(recipe, &shown(recipe, sensor.words));
    assert_eq!(seen.len(), film.len());
    let mut stream = RasterStream::new(RasterTiming::of(recipe.design().raster().unwrap()), 1);
    for (seen, (begin, (word, _))) in seen.iter().zip(sensor.begins) {
        let of_row = word * recipe.taken_of_row() as u64;
        let read = |row: u32| {
            let begin = begin + u64::from(row) * of_row;
            (begin.into(), (begin + of_row).into())
        };
        assert_eq!(stream.frame(read, &seen.actions), seen.rows, "{paces:?}, {recipe:?}");
        rows.compared += seen.rows.len();
        for actions in seen.actions.chunks(recipe.base.columns() as usize) {
            let has = |action| actions.contains(&action);
            let (forwards, summarizes) = (has(Action::Forward), has(Action::Summarize));
            rows.partly += usize::from(forwards && has(Action::Hold));
            rows.with_summaries += usize::from(summarizes);
            rows.mixed += usize::from(summarizes && forwards);
        }
    }
}

/// Returns frames in which each region changes, with equal probability, or stays as it was in the
/// frame before.
fn blinking(recipe: &RasterRecipe) -> Vec<Frame> {
    let (width, height) = (recipe.base.width as u32, recipe.base.height as u32);
    let mut random = Random(3);
    let mut light = vec![false; (recipe.base.columns() * recipe.base.rows()) as usize];
    let frame = |_| {
        light.iter_mut().for_each(|light| *light ^= random.below(2) > 0);
        let place = |x: u32, y: u32| {
            let (column, row) = (i64::from(x) / recipe.base.side, i64::from(y) / recipe.base.side);
            (row * recipe.base.columns() + column) as usize
        };
        let pixel = |x, y| 200 * u16::from(light[place(x, y)]);
        Frame::from_fn(width, height, recipe.base.bits, pixel).unwrap()
    };
    (0..4).map(frame).collect()
}

/// The regions of a frame that leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leaving {
    /// All regions leave.
    All,
    /// Random regions leave.
    Some,
    /// Random regions leave, with pixels or with summaries.
    Mixed,
}

/// The designs have K of 1, 2 and 4, N of 2 to 8, and ragged frames. They have or lack a median,
/// windows, a second pass, summaries and forwarding, and are plain or deep. Frames come as fast as
/// words can, or slower, with and without pauses.
#[test]
fn every_row_of_regions_leaves_when_the_design_says() {
    let mut rows = Rows::default();
    for number in 0..56 {
        for leaving in [Leaving::All, Leaving::Some, Leaving::Mixed] {
            let mut recipe = recipe(number);
            let needs_pixels = recipe.base.last_sent || recipe.base.periphery.is_some();
            recipe.forward = number % 9 > 0 || needs_pixels;
            recipe.base.temporal_min = i64::from(leaving != Leaving::All);
            if leaving != Leaving::Mixed {
                recipe.base.features.iter_mut().for_each(|feature| feature.min_milli = 0);
            } else if recipe.base.periphery.is_none() {
                continue;
            }
            let film = match leaving {
                Leaving::All => hard_frames(&recipe.base),
                Leaving::Some | Leaving::Mixed => blinking(&recipe),
            };
            for paces in [&[(1, 0)][..], &[(3, 0)], &[(1, 400), (7, 11), (2, 0)]] {
                check(&recipe, &film, paces, &mut rows);
            }
        }
    }
    // There must be enough rows of all kinds, so that the queue is both filled and bypassed.
    assert!(rows.compared > 4_000 && rows.partly > 1_000, "{rows:?}");
    assert!(rows.with_summaries > 300 && rows.mixed > 50, "{rows:?}");
}
