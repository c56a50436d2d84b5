// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the last decision and the last word of every row of regions leave at the times of
//! [`RasterStreamTiming`], behind a sensor that reads words at its own rate.

use std::collections::VecDeque;

use foveate_design::{RasterStreamTiming, RasterTiming, RegionAction, RowDeparture};
use foveate_frame::Frame;
use foveate_model::{CoreInput, RasterOutput, RasterRcm, ThresholdInputs};

use super::camera::recipe;
use super::driver::frame_words;
use super::raster_parameters::RasterParameters;
use crate::frames::SeededRandom;
use crate::hard_cases::hard_frames;

/// The pace of a sensor: clocks from word to word, and clocks between frames.
type SensorPace = (u64, u64);

/// The stream of a sensor: each word with the edge at which the sensor has read it, and for each
/// frame its first edge and its pace.
struct SensorStream {
    words: VecDeque<(u64, Vec<u16>)>,
    begins: Vec<(u64, SensorPace)>,
}

fn sensor_stream(recipe: &RasterParameters, clip: &[Frame], paces: &[SensorPace]) -> SensorStream {
    let (mut sensor, mut now) = (SensorStream { words: VecDeque::new(), begins: Vec::new() }, 0);
    for (frame, &pace) in clip.iter().zip(paces.iter().cycle()) {
        sensor.begins.push((now, pace));
        for word in frame_words(recipe, frame, &mut SeededRandom(7)) {
            now += pace.0;
            sensor.words.push_back((now, word));
        }
        now += pace.1;
    }
    sensor
}

/// Returns the outputs of the core after every edge until nothing is under way.
fn core_outputs(
    recipe: &RasterParameters,
    mut words: VecDeque<(u64, Vec<u16>)>,
) -> Vec<RasterOutput> {
    let design = recipe.design();
    let (mut rcm, thresholds) =
        (RasterRcm::new(design.as_raster().unwrap()), ThresholdInputs::from_camera(&design));
    let nothing = vec![0; recipe.word_pixels as usize];
    let mut shown = vec![rcm.output().clone()];
    let mut edges_left =
        RasterTiming::from_design(design.as_raster().unwrap()).edges_to_ready() + 5;
    while edges_left > 0 {
        let edge = shown.len() as u64;
        let word = words.front().filter(|(read, _)| *read <= edge).map(|(_, word)| word.clone());
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
        edges_left -= u64::from(words.is_empty() && !rcm.is_pending());
    }
    shown
}

/// The observed results of a frame: the actions of its regions, and for every row of regions the
/// edges after which its last decision and its last word were on the ports.
#[derive(Default)]
struct ObservedFrame {
    actions: Vec<RegionAction>,
    rows: Vec<RowDeparture>,
}

fn observed_frames(recipe: &RasterParameters, shown: &[RasterOutput]) -> Vec<ObservedFrame> {
    let (columns, regions) = (recipe.base.columns(), recipe.base.columns() * recipe.base.rows());
    let mut frames: Vec<ObservedFrame> = Vec::new();
    let mut pending = VecDeque::new();
    for (edge, output) in shown.iter().enumerate() {
        if output.decision_valid {
            if output.region == 0 {
                frames.push(ObservedFrame::default());
            }
            let (frame, row) = (frames.len() - 1, (i64::from(output.region) / columns) as usize);
            let ObservedFrame { actions, rows } = &mut frames[frame];
            let action = match (output.active, output.summary) {
                (true, _) => RegionAction::Forward,
                (false, true) => RegionAction::Summarize,
                (false, false) => RegionAction::Hold,
            };
            actions.push(action);
            rows.resize(row + 1, RowDeparture { last_decision: 0, last_word: None });
            rows[row].last_decision = edge as u128;
            let leaves = output.active && recipe.forward || output.summary;
            pending.extend(leaves.then_some((frame, row)));
        }
        if output.forward_valid && output.forward_last {
            let (frame, row) = pending.pop_front().unwrap();
            frames[frame].rows[row].last_word = Some(edge as u128);
        }
    }
    assert!(pending.is_empty() && !shown.last().unwrap().lost);
    assert!(frames.iter().all(|frame| frame.actions.len() as i64 == regions));
    frames
}

/// Counts of the rows of regions that have been compared.
#[derive(Debug, Default)]
struct RowCounts {
    compared: usize,
    /// Rows that sent the pixels of some of their regions, and nothing of others.
    partly_sent: usize,
    /// Rows that sent a summary.
    with_summaries: usize,
    /// Rows that sent both a summary and pixels.
    mixed: usize,
}

fn check(recipe: &RasterParameters, clip: &[Frame], paces: &[SensorPace], rows: &mut RowCounts) {
    let sensor = sensor_stream(recipe, clip, paces);
    let observed = observed_frames(recipe, &core_outputs(recipe, sensor.words));
    assert_eq!(observed.len(), clip.len());
    let mut stream =
        RasterStreamTiming::new(RasterTiming::from_design(recipe.design().as_raster().unwrap()), 1);
    for (observed, (begin, (word, _))) in observed.iter().zip(sensor.begins) {
        let of_row = word * recipe.taken_row_words() as u64;
        let read = |row: u32| {
            let begin = begin + u64::from(row) * of_row;
            (begin.into(), (begin + of_row).into())
        };
        assert_eq!(
            stream.advance_frame(read, &observed.actions),
            observed.rows,
            "{paces:?}, {recipe:?}"
        );
        rows.compared += observed.rows.len();
        for actions in observed.actions.chunks(recipe.base.columns() as usize) {
            let has = |action| actions.contains(&action);
            let (forwards, summarizes) = (has(RegionAction::Forward), has(RegionAction::Summarize));
            rows.partly_sent += usize::from(forwards && has(RegionAction::Hold));
            rows.with_summaries += usize::from(summarizes);
            rows.mixed += usize::from(summarizes && forwards);
        }
    }
}

/// Returns frames in which each region changes, with equal probability, or stays as it was in the
/// frame before.
fn blinking_frames(recipe: &RasterParameters) -> Vec<Frame> {
    let (width, height) = (recipe.base.width as u32, recipe.base.height as u32);
    let mut random = SeededRandom(3);
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
enum SentRegions {
    /// All regions leave.
    All,
    /// Random regions leave.
    Random,
    /// Random regions leave, with pixels or with summaries.
    Mixed,
}

/// The designs have K of 1, 2 and 4, N of 2 to 8, and ragged frames. They have or lack a median,
/// windows, a second pass, summaries and forwarding, and are plain or deep. Frames come as fast as
/// words can, or slower, with and without pauses.
#[test]
fn every_row_of_regions_leaves_when_the_design_says() {
    let mut rows = RowCounts::default();
    for number in 0..56 {
        for leaving in [SentRegions::All, SentRegions::Random, SentRegions::Mixed] {
            let mut recipe = recipe(number);
            let needs_pixels = recipe.base.last_sent || recipe.base.periphery.is_some();
            recipe.forward = number % 9 > 0 || needs_pixels;
            recipe.base.temporal_min = i64::from(leaving != SentRegions::All);
            if leaving != SentRegions::Mixed {
                recipe.base.features.iter_mut().for_each(|feature| feature.min_milli = 0);
            } else if recipe.base.periphery.is_none() {
                continue;
            }
            let clip = match leaving {
                SentRegions::All => hard_frames(&recipe.base),
                SentRegions::Random | SentRegions::Mixed => blinking_frames(&recipe),
            };
            for paces in [&[(1, 0)][..], &[(3, 0)], &[(1, 400), (7, 11), (2, 0)]] {
                check(&recipe, &clip, paces, &mut rows);
            }
        }
    }
    // There must be enough rows of all kinds, so that the queue is both filled and bypassed.
    assert!(rows.compared > 4_000 && rows.partly_sent > 1_000, "{rows:?}");
    assert!(rows.with_summaries > 300 && rows.mixed > 50, "{rows:?}");
}
