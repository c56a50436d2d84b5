// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of lanes with arbitrary streams, whose halos belong to no frame. The outputs of the serial
//! array must be those of the pipelined array.

use foveate_model::{CoreInput, PipelinedRcm, ThresholdInputs};
use proptest::prelude::*;

use super::bench::{ResultSource, SerialBench, SerialStimulus, SerialTraffic, by_port};
use super::expected_outputs::RegionResults;
use super::serial_parameters::{SerialParameters, arbitrary_serial_parameters};
use crate::frames::SeededRandom;

/// Returns streams by frame, region and position. Every frame keeps some pixels of the frame
/// before.
fn streams(recipe: &SerialParameters, frames: usize, seed: u64) -> Vec<Vec<Vec<u16>>> {
    let mut random = SeededRandom(seed);
    let top = recipe.base.pixel_max() + 1;
    let places = (recipe.base.side + 2 * recipe.halo()).pow(2) as usize;
    let mut now = vec![vec![0u16; places]; (recipe.lanes() * recipe.fold) as usize];
    let mut all = Vec::new();
    for _ in 0..frames {
        let (kept, spread) = (random.below(101), 1 + random.below(top));
        for pixel in now.iter_mut().flatten() {
            if random.below(100) >= kept {
                *pixel = random.below(spread) as u16;
            }
        }
        all.push(now.clone());
    }
    all
}

/// Returns the results of the pipelined array for every frame and region.
fn pipelined_facts(
    recipe: &SerialParameters,
    streams: &[Vec<Vec<u16>>],
) -> Vec<Vec<RegionResults>> {
    let design = recipe.base.design();
    let thresholds = ThresholdInputs::from_camera(&design);
    let (regions, places) = (design.regions() as usize, streams[0][0].len());
    let mut facts = vec![Vec::new(); regions];
    let mut leaving = vec![Vec::new(); regions];
    let mut rcm = PipelinedRcm::new(design.as_pipelined().unwrap());
    // Black frames behind the last one push its results out.
    for clock in 0..(streams.len() + 3) * places {
        let at = |region: usize| {
            streams.get(clock / places).map_or(0, |frame| frame[region][clock % places])
        };
        let pixels: Vec<u16> = (0..regions).map(at).collect();
        let (pixels, thresholds) = (&pixels[..], &thresholds);
        let input = CoreInput { valid: true, ..CoreInput::idle(pixels, thresholds) };
        for (region, output) in rcm.step(&input).iter().enumerate() {
            if output.decision_valid {
                let count = std::iter::once(output.temporal_count.into());
                let scores = count.chain(output.scores).take(1 + recipe.base.features.len());
                facts[region].push(RegionResults {
                    scores: scores.collect(),
                    srs: output.srs,
                    trs: output.trs,
                    displacement: (0, 0),
                    summary: output.summary,
                    payload: Vec::new(),
                    means: Vec::new(),
                });
            }
            if output.forward_valid {
                leaving[region].push(output.forward_pixel);
            }
        }
    }
    for (facts, leaving) in facts.iter_mut().zip(leaving) {
        let mut leaving = leaving.into_iter();
        for facts in facts.iter_mut() {
            let (payload, means) = sent_lengths(recipe, facts);
            facts.payload = leaving.by_ref().take(payload).collect();
            facts.means = leaving.by_ref().take(means).collect();
        }
    }
    (0..streams.len()).map(|frame| facts.iter().map(|of| of[frame].clone()).collect()).collect()
}

/// Returns the number of pixels and the number of means that leave of a region.
fn sent_lengths(recipe: &SerialParameters, results: &RegionResults) -> (usize, usize) {
    let pixels = if results.is_active() { recipe.base.region_pixels() } else { 0 };
    let means = if results.summary { recipe.mean_count() } else { 0 };
    (pixels as usize, means as usize)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(300)))]

    #[test]
    fn any_streams_are_decided_as_by_the_pipelined_array(
        mut recipe in arbitrary_serial_parameters()
            .prop_filter("a pipelined design", |recipe| recipe.base.config().validate().is_ok()),
        frames in 1usize..4,
        seed in any::<u64>(),
    ) {
        recipe.raster = false;
        let streams = streams(&recipe, frames, seed);
        let job = |(frame, facts): (&Vec<Vec<u16>>, Vec<RegionResults>)| SerialStimulus {
            pixels: by_port(&recipe, frame),
            thresholds: ThresholdInputs::from_camera(&recipe.design()).into(),
            expected: ResultSource::Given(facts),
        };
        let jobs: Vec<SerialStimulus> = streams.iter().zip(pipelined_facts(&recipe, &streams)).map(job).collect();
        prop_assert_eq!(SerialBench::new(&recipe, SerialTraffic::DENSE).run(&jobs), Ok(()));
    }
}
