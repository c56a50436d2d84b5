// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the cycle-level model shows the outputs of the schedule and the oracle after every
//! edge.

use foveate_camera::RegionClass;
use foveate_design::PipelinedTiming;
use foveate_model::{
    ClassMapInputs, CoreInput, PipelinedRcm, RpuOutput, ThresholdInputs, ZoneInputs, region_stream,
};
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::frames::{SeededRandom, arbitrary_scripts, make_clip};
use crate::oracle::{OracleOutcome, oracle_history, oracle_history_with_maps};
use crate::parameters::{DesignParameters, arbitrary_parameters};
use crate::port_thresholds::PortThresholds;
use crate::schedule::{ExpectedOutput, expected_outputs, tail_delay, tail_steps};

/// The pattern of pixels and gaps of a stream.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapPattern {
    /// Percentage of clocks inside a frame without a pixel.
    inside: i64,
    /// Longest gap between frames in clocks.
    between: i64,
    seed: u64,
}

pub(crate) fn gaps() -> impl Strategy<Value = GapPattern> {
    let inside = prop_oneof![Just(0), Just(0), 1i64..80];
    let between = prop_oneof![Just(0), 0i64..30];
    (inside, between, any::<u64>()).prop_map(|(inside, between, seed)| GapPattern {
        inside,
        between,
        seed,
    })
}

/// Returns the edges that take each pixel of each frame.
fn stream_edges(recipe: &DesignParameters, gaps: GapPattern, frames: usize) -> Vec<Vec<usize>> {
    let pixels = recipe.design().stream_pixels();
    let mut random = SeededRandom(gaps.seed);
    let mut edge = 0;
    let mut edges = Vec::new();
    for _ in 0..frames {
        edge += random.below(gaps.between + 1) as usize;
        let mut frame = Vec::new();
        for _ in 0..pixels {
            while random.below(100) < gaps.inside {
                edge += 1;
            }
            frame.push(edge);
            edge += 1;
        }
        edges.push(frame);
    }
    edges
}

type ClassesByEdge = Vec<Vec<RegionClass>>;

/// Streams a clip, and returns the outputs of every region after every edge. A design with zones
/// gets classes at each edge.
fn run(
    recipe: &DesignParameters,
    rcm: &mut PipelinedRcm,
    clip: &[Frame],
    edges: &[Vec<usize>],
    clocks: usize,
    classes: Option<&ClassesByEdge>,
) -> Vec<Vec<RpuOutput>> {
    let design = recipe.design();
    let thresholds = PortThresholds::of_camera(&design);
    let streams: Vec<Vec<Vec<u16>>> = clip
        .iter()
        .map(|frame| {
            let stream = |region| {
                let mut pixels = Vec::new();
                region_stream(&design, frame, region, &mut pixels);
                pixels
            };
            (0..design.regions()).map(stream).collect()
        })
        .collect();
    let mut taken = edges
        .iter()
        .enumerate()
        .flat_map(|(frame, edges)| {
            edges.iter().enumerate().map(move |(place, &edge)| (edge, frame, place))
        })
        .peekable();
    let mut shown = Vec::new();
    for clock in 0..clocks {
        let now = taken.next_if(|&(edge, ..)| edge == clock);
        // Without a valid pixel the port holds an arbitrary value.
        let idle = vec![(clock * 7) as u16 & (u16::MAX >> (16 - recipe.bits)); streams[0].len()];
        let pixels = now.map_or(idle, |(_, frame, place)| {
            streams[frame].iter().map(|stream| stream[place]).collect()
        });
        let zones = classes.map(|classes| ZoneInputs {
            classes: &classes[clock],
            ..thresholds.zone_inputs(ClassMapInputs::default())
        });
        let valid = now.is_some();
        let input = CoreInput { valid, zones, ..CoreInput::idle(&pixels, &thresholds.own) };
        shown.push(rcm.step(&input).to_vec());
    }
    shown
}

fn observed_output(recipe: &DesignParameters, output: &RpuOutput) -> ExpectedOutput {
    assert_eq!(output.active, output.srs && output.trs);
    assert!(output.forward_valid || output.forward_pixel == 0);
    assert!(output.scores[recipe.features.len()..].iter().all(|&score| score == 0));
    ExpectedOutput {
        valid: output.decision_valid,
        srs: output.srs,
        trs: output.trs,
        scores: output.scores[..recipe.features.len()].iter().map(|&s| s as i64).collect(),
        temporal_count: output.temporal_count.into(),
        summary: output.summary,
        forward: output.forward_valid.then(|| output.forward_pixel.into()),
    }
}

/// Checks a clip whose frames follow each other without a gap.
pub(crate) fn check_dense(recipe: &DesignParameters, rcm: &mut PipelinedRcm, clip: &[Frame]) {
    check(recipe, rcm, clip, GapPattern { inside: 0, between: 0, seed: 0 });
}

fn check(recipe: &DesignParameters, rcm: &mut PipelinedRcm, clip: &[Frame], gaps: GapPattern) {
    let edges = stream_edges(recipe, gaps, clip.len());
    let clocks = clocks_of_stream(recipe, &edges);
    let shown = run(recipe, rcm, clip, &edges, clocks, None);
    let history = oracle_history(recipe, clip);
    assert_ports(recipe, &history, &edges, &shown);
    if gaps.inside == 0 && gaps.between == 0 {
        check_latency(recipe, &history, &shown);
    }
}

/// Checks every port of a design with zones after every edge. The class of a frame is on `zone_i`
/// at the first edge at which the stage before the tail steps, and at all other edges `zone_i` has
/// random values.
pub(crate) fn check_with_maps(
    recipe: &DesignParameters,
    clip: &[Frame],
    maps: &[Vec<u8>],
    gaps: GapPattern,
) {
    let edges = stream_edges(recipe, gaps, clip.len());
    let clocks = clocks_of_stream(recipe, &edges);
    let mut random = SeededRandom(gaps.seed);
    let mut any_class = || RegionClass::from_code(random.below(4) as u8).unwrap();
    let regions = recipe.design().regions() as usize;
    let mut classes: ClassesByEdge =
        (0..clocks).map(|_| (0..regions).map(|_| any_class()).collect()).collect();
    for (steps, map) in tail_steps(recipe, &edges).iter().zip(maps) {
        let of_code = |&code: &u8| RegionClass::from_code(code).unwrap();
        classes[steps[0] - tail_delay(recipe)] = map.iter().map(of_code).collect();
    }
    let mut rcm = PipelinedRcm::new(recipe.design().as_pipelined().unwrap());
    let shown = run(recipe, &mut rcm, clip, &edges, clocks, Some(&classes));
    assert_ports(recipe, &oracle_history_with_maps(recipe, maps, clip), &edges, &shown);
}

/// Returns the clocks from the first edge until all decisions of a stream are made.
fn clocks_of_stream(recipe: &DesignParameters, edges: &[Vec<usize>]) -> usize {
    let timing = PipelinedTiming::from_design(recipe.design().as_pipelined().unwrap());
    edges.iter().flatten().max().unwrap() + timing.decision_latency as usize + 5
}

/// Checks every port of every region after every edge.
fn assert_ports(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    edges: &[Vec<usize>],
    shown: &[Vec<RpuOutput>],
) {
    let steps = tail_steps(recipe, edges);
    let clocks = shown.len();
    for region in 0..recipe.design().regions() as usize {
        let expected = expected_outputs(recipe, history, &steps, region, clocks);
        for (edge, (shown, expected)) in shown.iter().zip(&expected).enumerate() {
            let observed = observed_output(recipe, &shown[region]);
            assert_eq!(&observed, expected, "region {region} after edge {edge}");
        }
    }
}

/// Checks that without gaps the decisions and the last pixels of a stream are on the ports exactly
/// at the clocks of `PipelinedTiming` and `DepartureTiming`.
fn check_latency(recipe: &DesignParameters, history: &[OracleOutcome], shown: &[Vec<RpuOutput>]) {
    let design = recipe.design();
    let timing = PipelinedTiming::from_design(design.as_pipelined().unwrap());
    let end_of_frame = |frame: usize| (frame + 1) * timing.cycles_per_frame as usize - 1;
    let valid: Vec<usize> =
        (0..shown.len()).filter(|&edge| shown[edge][0].decision_valid).collect();
    let expected: Vec<usize> = (timing.decision_frames as usize..history.len())
        .map(|frame| end_of_frame(frame) + timing.decision_latency as usize)
        .collect();
    assert_eq!(valid, expected);
    let departure = design.timing().departure();
    assert_eq!(departure.take_clocks, timing.cycles_per_frame.into());
    for (later, outcome) in (departure.forward_frames as usize..history.len()).zip(history) {
        let edge = end_of_frame(later) + departure.forward_clocks as usize;
        for (output, region) in shown[edge].iter().zip(&outcome.regions) {
            assert_eq!(output.forward_valid, ["forward", "summarize"].contains(&region.action));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(1000)))]

    #[test]
    fn every_port_after_every_edge(recipe in arbitrary_parameters(), script in arbitrary_scripts(6), gaps in gaps()) {
        let mut rcm = PipelinedRcm::new(recipe.design().as_pipelined().unwrap());
        check(&recipe, &mut rcm, &make_clip(&recipe, &script), gaps);
    }

    #[test]
    fn a_reset_at_any_edge_forgets_everything(
        recipe in arbitrary_parameters(),
        before in arbitrary_scripts(3),
        after in arbitrary_scripts(4),
        gaps in gaps(),
        cut in any::<u64>(),
        held in 1usize..3,
    ) {
        let design = recipe.design();
        let mut rcm = PipelinedRcm::new(design.as_pipelined().unwrap());
        let clip_before = make_clip(&recipe, &before);
        let edges = stream_edges(&recipe, gaps, before.len());
        let end = edges.iter().flatten().max().unwrap() + 20;
        run(&recipe, &mut rcm, &clip_before, &edges, cut as usize % end, None);
        let pixels = vec![1; design.regions() as usize];
        for edge in 0..held {
            // A pixel at an edge with reset is not taken.
            let thresholds = &ThresholdInputs::from_camera(&design);
            let valid = edge == 0;
            let input = CoreInput { reset: true, valid, ..CoreInput::idle(&pixels, thresholds) };
            let outputs = rcm.step(&input);
            prop_assert!(outputs.iter().all(|output| *output == RpuOutput::default()));
        }
        check(&recipe, &mut rcm, &make_clip(&recipe, &after), gaps);
    }
}
