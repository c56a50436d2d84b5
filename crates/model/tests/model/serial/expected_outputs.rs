// SPDX-License-Identifier: MIT OR Apache-2.0
//! The expected outputs after every edge, as a list of the edges that have outputs. The list is
//! extended frame by frame, and is the only state.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use foveate_model::SerialOutput;

use super::serial_parameters::{ExpectedPhase, SerialParameters};
use crate::oracle::{OracleOutcome, OracleRegion};

/// The expected results of one region and frame: the temporal count and the scores, the decision,
/// the pixels that leave if the region is active, and the means that leave if its summary is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RegionResults {
    pub(crate) scores: Vec<u64>,
    /// Columns to the right and rows down; 0 without `flow`.
    pub(crate) displacement: (i64, i64),
    pub(crate) srs: bool,
    pub(crate) trs: bool,
    pub(crate) summary: bool,
    pub(crate) payload: Vec<u16>,
    pub(crate) means: Vec<u16>,
}

impl RegionResults {
    pub(crate) fn is_active(&self) -> bool {
        self.srs && self.trs
    }

    /// Returns the pixels that leave.
    fn sent_pixels(&self) -> &[u16] {
        if self.is_active() { &self.payload } else { &[] }
    }

    /// Returns the means that leave.
    fn sent_means(&self) -> &[u16] {
        if self.summary { &self.means } else { &[] }
    }
}

/// Returns the results of the oracle for every region.
pub(crate) fn region_results(outcome: &OracleOutcome) -> Vec<RegionResults> {
    let pixels = |values: &[i64]| values.iter().map(|&value| value as u16).collect();
    let results_of = |region: &OracleRegion| RegionResults {
        scores: std::iter::once(&region.temporal_count)
            .chain(&region.scores)
            .map(|&score| score as u64)
            .collect(),
        displacement: region.displacement,
        srs: region.srs,
        trs: region.trs,
        summary: region.action == "summarize",
        payload: pixels(&region.payload),
        means: pixels(&region.means),
    };
    outcome.regions.iter().map(results_of).collect()
}

/// The values at the ports that have a meaning, except `ready_o`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct MeaningfulOutputs {
    /// Number, region and value of the score.
    pub(crate) score: Option<(u32, u32, u64)>,
    /// The ports of the displacement, which are 0 without the score of `flow`.
    pub(crate) displacement: (u64, u64),
    /// SRS, TRS, active and summary.
    pub(crate) decision: Option<[bool; 4]>,
    /// Port and value of each pixel.
    pub(crate) pixels: Vec<(usize, u16)>,
    /// Position, slot and region of the pixels, if there are any.
    pub(crate) place: Option<(u32, u32, u32)>,
}

impl MeaningfulOutputs {
    pub(crate) fn from_output(output: &SerialOutput) -> Self {
        let decision = [output.srs, output.trs, output.active, output.summary];
        assert!(output.decision_valid || decision == [false; 4]);
        let ports = output.forward_valid.iter().zip(&output.forward_pixel).enumerate();
        let pixels: Vec<(usize, u16)> = ports
            .filter(|(_, (valid, _))| **valid)
            .map(|(port, (_, &pixel))| (port, pixel))
            .collect();
        let place = (output.forward_position, output.forward_slot, output.forward_region);
        Self {
            score: output.score_valid.then_some((output.score_index, output.region, output.score)),
            displacement: (output.displacement_x, output.displacement_y),
            decision: output.decision_valid.then_some(decision),
            place: (!pixels.is_empty()).then_some(place),
            pixels,
        }
    }
}

/// Returns the outputs of the steps of a frame, by number of the step. Steps without outputs are
/// left out.
pub(crate) fn step_outputs(
    recipe: &SerialParameters,
    results: &[RegionResults],
) -> Vec<(i64, MeaningfulOutputs)> {
    let mut shown = Vec::new();
    let mut start = 0;
    for slot in 0..recipe.fold {
        let mut rotation = 0;
        for phase in recipe.phases() {
            match phase {
                ExpectedPhase::WithoutOutput(_) => {}
                ExpectedPhase::Rotation => {
                    shown.extend(rotation_outputs(recipe, results, slot, rotation, start));
                    rotation += 1;
                }
                ExpectedPhase::Unload | ExpectedPhase::UnloadMeans => {
                    shown.extend(unload_outputs(recipe, results, slot, phase, start));
                }
            }
            start += recipe.steps(phase);
        }
    }
    shown
}

/// Returns the lane and the region of every region of a slot.
fn served_regions(recipe: &SerialParameters, slot: i64) -> Vec<(i64, i64)> {
    let all = (0..recipe.lanes()).map(|lane| (lane, lane * recipe.fold + slot));
    all.filter(|&(_, region)| region < recipe.regions()).collect()
}

fn rotation_outputs(
    recipe: &SerialParameters,
    results: &[RegionResults],
    slot: i64,
    number: usize,
    start: i64,
) -> Vec<(i64, MeaningfulOutputs)> {
    let last = number == recipe.base.features.len();
    let score = |(lane, region): (i64, i64)| {
        let results = &results[region as usize];
        let decision = [results.srs, results.trs, results.is_active(), results.summary];
        let score = Some((number as u32, region as u32, results.scores[number]));
        // The ports have two's complements of as many bits as the radius needs.
        let displacement = |index: usize| {
            let feature = &recipe.base.features[index];
            let mask = if feature.radius > 1 { 7 } else { 3 };
            let (dx, dy) = if feature.name == "flow" { results.displacement } else { (0, 0) };
            (dx as u64 & mask, dy as u64 & mask)
        };
        (
            start + recipe.settling_steps() + lane,
            MeaningfulOutputs {
                score,
                displacement: number.checked_sub(1).map_or((0, 0), displacement),
                decision: last.then_some(decision),
                ..MeaningfulOutputs::default()
            },
        )
    };
    served_regions(recipe, slot).into_iter().map(score).collect()
}

fn unload_outputs(
    recipe: &SerialParameters,
    results: &[RegionResults],
    slot: i64,
    phase: ExpectedPhase,
    start: i64,
) -> Vec<(i64, MeaningfulOutputs)> {
    let round = recipe.round_steps(phase);
    let mut shown = Vec::new();
    for number in 0..recipe.steps(phase) / round {
        let position = forward_position(recipe, phase, number) as u32;
        let mut lane_pixels = Vec::new();
        for (lane, region) in served_regions(recipe, slot) {
            let results = &results[region as usize];
            let leaving = if phase == ExpectedPhase::Unload {
                results.sent_pixels()
            } else {
                results.sent_means()
            };
            let Some(&pixel) = leaving.get(number as usize) else { continue };
            if recipe.raster {
                let (pixels, place) = (vec![(0, pixel)], Some((position, 0, region as u32)));
                let step = start + number * round + 1 + lane;
                shown.push((
                    step,
                    MeaningfulOutputs { pixels, place, ..MeaningfulOutputs::default() },
                ));
            } else {
                lane_pixels.push((lane as usize, pixel));
            }
        }
        if !lane_pixels.is_empty() {
            let (pixels, place) = (lane_pixels, Some((position, slot as u32, 0)));
            let step = start + (number + 1) * round - 1;
            shown.push((step, MeaningfulOutputs { pixels, place, ..MeaningfulOutputs::default() }));
        }
    }
    shown
}

/// Returns the position of pixel or mean `number`. That of a mean is the position of the last pixel
/// of its block.
fn forward_position(recipe: &SerialParameters, phase: ExpectedPhase, number: i64) -> i64 {
    let Some(periphery) = recipe.base.periphery.filter(|_| phase == ExpectedPhase::UnloadMeans)
    else {
        return number;
    };
    let side = recipe.base.side / periphery.blocks;
    let block = |at: i64| {
        let (x, y) = (at % recipe.base.side, at / recipe.base.side);
        y / side * periphery.blocks + x / side
    };
    (0..recipe.base.region_pixels()).rfind(|&at| block(at) == number).unwrap()
}

/// The expected outputs by edge.
#[derive(Clone, Debug)]
pub(crate) struct ExpectedTimeline {
    shown: BTreeMap<i64, MeaningfulOutputs>,
    /// The first edge after which `ready_o` is 1 again.
    pub(crate) ready_from: i64,
    /// The edges that the last frame occupies, as far as they are known.
    pub(crate) occupied: RangeInclusive<i64>,
}

impl ExpectedTimeline {
    /// Makes the expectations before the first edge.
    pub(crate) fn new() -> Self {
        Self { shown: BTreeMap::new(), ready_from: 0, occupied: 0..=0 }
    }

    pub(crate) fn is_ready(&self, edge: i64) -> bool {
        edge >= self.ready_from
    }

    pub(crate) fn outputs_after(&self, edge: i64) -> MeaningfulOutputs {
        self.shown.get(&edge).cloned().unwrap_or_default()
    }

    /// Records a reset at this edge.
    pub(crate) fn reset(&mut self, edge: i64) {
        self.shown.split_off(&edge);
        self.ready_from = edge;
        self.occupied = 0..=0;
    }

    /// Records a pixel of a frame that is taken at this edge. With the last pixel come the expected
    /// results of the frame.
    pub(crate) fn take(
        &mut self,
        recipe: &SerialParameters,
        edge: i64,
        pixel: i64,
        results: Option<&[RegionResults]>,
    ) {
        let taken = edge + recipe.clocks_of_pixel(pixel) - 1;
        self.ready_from = taken;
        if pixel == 0 {
            self.occupied = edge..=i64::MAX;
        }
        if let Some(results) = results {
            self.ready_from = taken + 1 + recipe.steps_per_frame();
            self.occupied = *self.occupied.start()..=taken + recipe.steps_per_frame();
            let first = taken + 1 + recipe.read_latency();
            let outputs = step_outputs(recipe, results)
                .into_iter()
                .map(|(step, shown)| (first + step, shown));
            self.shown.extend(outputs);
        }
    }
}
