// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times of events, computed from the list of edges that take a pixel, without any clocked
//! state. Every step is an edge number that follows from other edge numbers by the rules of
//! `docs/timing.md`.

use crate::oracle::{OracleOutcome, score_of_terms};
use crate::parameters::DesignParameters;

/// The expected outputs of the RPU of one region after an edge.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ExpectedOutput {
    pub(crate) valid: bool,
    pub(crate) srs: bool,
    pub(crate) trs: bool,
    pub(crate) scores: Vec<i64>,
    pub(crate) temporal_count: i64,
    pub(crate) summary: bool,
    pub(crate) forward: Option<i64>,
}

/// Returns the edges of the centers of an isolated window of side N for the edges of its pixels,
/// both by frame.
fn isolated_centers(pixels: &[Vec<usize>], side: usize) -> Vec<Vec<usize>> {
    let mut centers = Vec::new();
    for (frame, own) in pixels.iter().enumerate() {
        let last = *own.last().unwrap();
        let next: &[usize] = pixels.get(frame + 1).map_or(&[], Vec::as_slice);
        // These are the edges at which the window advances after the last pixel of the frame.
        let begin = next.first().copied().unwrap_or(usize::MAX);
        let mut advances: Vec<usize> = (last + 1..begin).take(side + 1).collect();
        advances.extend(next);
        let all: Vec<usize> = own.iter().copied().chain(advances).collect();
        centers.push(all[side + 1..][..own.len()].to_vec());
    }
    centers
}

/// Returns the edges of the centers of a shared window on squares of side S.
fn shared_centers(pixels: &[Vec<usize>], side: usize) -> Vec<Vec<usize>> {
    let inner = |(place, _): &(usize, &usize)| place % side >= 2 && place / side >= 2;
    let edges = |frame: &Vec<usize>| {
        frame.iter().enumerate().filter(inner).map(|(_, &edge)| edge).collect()
    };
    pixels.iter().map(edges).collect()
}

/// Returns the edges of the tail steps by frame for the edges of the pixels of the stream.
pub(crate) fn tail_steps(recipe: &DesignParameters, stream: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let windows = recipe.has_feature_window();
    let median_delay = if recipe.deep { 3 } else { 2 };
    let tail_delay = tail_delay(recipe);
    let mut side = recipe.side as usize;
    if recipe.shared {
        side += 2 * (usize::from(recipe.has_filter()) + usize::from(windows));
    }
    let mut steps = stream.to_vec();
    for (there, registers) in [(recipe.has_filter(), median_delay), (windows, 0)] {
        if there && recipe.shared {
            steps = shared_centers(&steps, side);
            side -= 2;
        } else if there {
            steps = isolated_centers(&steps, side);
        }
        if there {
            steps.iter_mut().flatten().for_each(|edge| *edge += registers);
        }
    }
    steps.iter_mut().flatten().for_each(|edge| *edge += tail_delay);
    steps
}

/// Returns the edges from a step of the last window to its tail step.
pub(crate) fn tail_delay(recipe: &DesignParameters) -> usize {
    match recipe.deep {
        true => 2,
        false => {
            let delaying = ["mad", "variance", "range", "surface", "segment"];
            usize::from(delaying.iter().any(|name| recipe.has_feature(name)))
        }
    }
}

/// Returns the expected outputs of `region` after each of the first `edges` edges.
pub(crate) fn expected_outputs(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    steps: &[Vec<usize>],
    region: usize,
    edges: usize,
) -> Vec<ExpectedOutput> {
    (0..edges).map(|edge| expected_output(recipe, history, steps, region, edge)).collect()
}

fn expected_output(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    steps: &[Vec<usize>],
    region: usize,
    edge: usize,
) -> ExpectedOutput {
    let second_pass = recipe.has_second_pass();
    let frame = |index: usize| &history[index].regions[region];
    let done_at = |index: usize| *steps[index].last().unwrap();
    // `done` counts the frames that are done by this edge, and `over` those whose done clock is
    // over.
    let done = (0..steps.len()).filter(|&index| done_at(index) <= edge).count();
    let over = (0..steps.len()).filter(|&index| done_at(index) < edge).count();
    // `running` is the frame whose counters run, and `counted` is the number of its steps that have
    // happened.
    let running = over;
    let counted =
        steps.get(running).map_or(0, |frame| frame.iter().take_while(|&&at| at <= edge).count());

    let mut scores = Vec::new();
    for (index, feature) in recipe.features.iter().enumerate() {
        let last = |count: usize| count.checked_sub(1).map_or(0, |at| frame(at).scores[index]);
        scores.push(match (feature.name, second_pass) {
            ("mad" | "segment", _) if counted == 0 => 0,
            ("mad" | "segment", _) => running.checked_sub(1).map_or(0, |before| {
                score_of_terms(feature.name, &frame(before).terms[index][..counted])
            }),
            ("variance" | "range" | "surface", false) => last(done),
            (_, true) => last(over),
            (_, false) if counted == 0 => 0,
            (name, false) => score_of_terms(name, &frame(running).terms[index][..counted]),
        });
    }
    let temporal_count = if second_pass {
        over.checked_sub(1).map_or(0, |at| frame(at).temporal_count)
    } else if counted == 0 {
        0
    } else {
        frame(running).temporal_hits.iter().take(counted).filter(|&&hit| hit).count() as i64
    };

    let decided =
        (done > over).then(|| over.checked_sub(usize::from(second_pass))).flatten().map(frame);
    let stepping = steps.get(running).and_then(|s| s.iter().position(|&at| at == edge));
    let leaving = running.checked_sub(1 + usize::from(second_pass)).map(frame);
    let forward = match (stepping, leaving) {
        (Some(position), Some(frame)) if frame.active => Some(frame.payload[position]),
        (Some(position), Some(frame)) if frame.action == "summarize" => {
            block_ending_at(recipe, position as i64).map(|block| frame.means[block])
        }
        _ => None,
    };
    ExpectedOutput {
        valid: decided.is_some(),
        srs: decided.is_some_and(|frame| frame.srs),
        trs: decided.is_some_and(|frame| frame.trs),
        scores,
        temporal_count,
        summary: decided.is_some_and(|frame| frame.action == "summarize"),
        forward,
    }
}

/// Returns the block whose last pixel, the lower right one, is at a position of the region.
fn block_ending_at(recipe: &DesignParameters, position: i64) -> Option<usize> {
    let blocks = recipe.periphery?.blocks;
    let side = recipe.side / blocks;
    let (x, y) = (position % recipe.side + 1, position / recipe.side + 1);
    (x % side == 0 && y % side == 0).then(|| ((y / side - 1) * blocks + x / side - 1) as usize)
}
