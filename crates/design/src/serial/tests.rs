// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the numbers of `docs/serial.md`, computed by hand, and of properties of every design.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::*;
use crate::{DesignConfig, LaneMemoryKind, OutputQualifier, PixelFeed};
use SerialPhase::{
    CompareRaw as Compare, ComputeMeans, CopyReference, DenoiseAndCompare, FeaturePass,
    RepeatBorder, RotateCount, RotateScore, UnloadMeans, UnloadPixels,
};
use foveate_camera::{FeatureKind, Neighborhood};

fn design(overrides: &[&str]) -> Design {
    let serial = "[hardware]\norganization = \"serial\"\n";
    DesignConfig::from_toml_with(serial, overrides).unwrap().validate().unwrap()
}

fn timing(design: &Design) -> SerialTiming {
    SerialTiming::from_design(design.as_serial().unwrap())
}

#[test]
fn the_papers_frame_takes_7905_clocks() {
    let design = design(&[]);
    let (timing, array) = (timing(&design), design.as_serial().unwrap());
    assert_eq!((array.lanes(), array.fold(), array.feed()), (784, 1, PixelFeed::Parallel));
    let edge = FeatureKind::Edge;
    let phases = [
        (DenoiseAndCompare, 64 * 83),
        (RotateCount, 784),
        (FeaturePass(edge), 14 * 64),
        (RotateScore(edge), 784),
        (UnloadPixels, 64),
    ];
    assert_eq!(timing.phases(), phases);
    assert_eq!((timing.slot_steps(), timing.steps()), (7_840, 7_840));
    assert_eq!((timing.load_pixels(), timing.load_clocks()), (64, 64));
    assert_eq!((timing.edges_to_step(0), timing.edges_to_ready()), (1, 7_841));
    assert_eq!(timing.clocks_per_frame(), 7_905);
    assert_eq!(design.timing().clocks_per_frame(), 7_905);
    // Decisions come with the last rotation, after 5,312 + 784 + 896 + 784 steps.
    let departure = design.timing().departure();
    assert_eq!((departure.decision_clocks, departure.forward_clocks), (7_776, 7_840));
    assert_eq!((departure.take_clocks, departure.slot_clocks), (64, 7_840));
    assert_eq!((departure.decision_frames, departure.forward_frames), (0, 0));
}

/// The frame has 24x16 pixels: 3x2 regions of 8x8 in two lanes of three slots. The halo is 2, the
/// stream has 12x12 pixels, and the denoised square has 10x10. A slot of 144 + 100 + 64 words of 8
/// bits takes 512 words, so the lane takes 8 * 24 = 192 LUTs, and its memory is block memory.
#[test]
fn every_phase_of_a_raster_fold_with_all_features() {
    let design = design(&[
        "frame.width=24",
        "frame.height=16",
        "hardware.fold=3",
        "hardware.feed=raster",
        "region.neighborhood=shared",
        "temporal.reference=last-sent",
        "spatial=[{feature=\"variance\"},{feature=\"corner\"},{feature=\"mad\",mean_fraction_bits=6}]",
    ]);
    let timing = timing(&design);
    let (variance, corner, mad) = (FeatureKind::Variance, FeatureKind::Corner, FeatureKind::Mad);
    let phases = [
        (DenoiseAndCompare, 100 * 85),
        (RepeatBorder, 4 * 10 * 3),
        (RotateCount, 2),
        // The binary form of n = 64 has one 1. The largest sum, 64 * 255 = 16,320, has 14 bits, and
        // 64 has 7 bits.
        (FeaturePass(variance), 64 + 8 * 64 + 28 + 8 + 7 + 2),
        (RotateScore(variance), 2),
        (FeaturePass(corner), 36 * 64),
        (RotateScore(corner), 2),
        (FeaturePass(mad), 128 + 8 + 12 + 3),
        (RotateScore(mad), 2),
        (CopyReference, 64 * 3),
        (UnloadPixels, 64 * 3),
    ];
    assert_eq!(timing.phases(), phases);
    assert_eq!((timing.slot_steps(), timing.steps()), (12_088, 36_264));
    assert_eq!((timing.load_pixels(), timing.load_clocks()), (384, 6 * 144));
    assert_eq!((timing.read_latency(), timing.edges_to_step(5)), (1, 7));
    assert_eq!(timing.clocks_per_frame(), 864 + 36_264 + 1);
    let memory = design.as_serial().unwrap().lane_memory();
    let area = |kind| memory.area(kind).map(|area| (area.base, area.side));
    assert_eq!(area(SlotAreaKind::Raw), Some((0, 12)));
    assert_eq!(area(SlotAreaKind::Denoised), Some((144, 10)));
    assert_eq!(area(SlotAreaKind::Reference), Some((244, 8)));
    assert_eq!((memory.slot_words, memory.depth, memory.address_bits), (512, 1536, 11));
    assert_eq!((memory.luts, memory.kind), (192, LaneMemoryKind::Block));
}

#[test]
fn without_denoising_the_reference_is_compared_by_itself() {
    let steps = |reference: &str, fold: &str| {
        let design =
            design(&["denoise.filter=none", reference, fold, "frame.width=8", "frame.height=80"]);
        (timing(&design).phases().to_vec(), design.as_serial().unwrap().lane_memory())
    };
    let edge = (FeaturePass(FeatureKind::Edge), 14 * 64);
    let rotation = (RotateScore(FeatureKind::Edge), 10);
    let (phases, memory) = steps("temporal.reference=previous", "hardware.fold=1");
    assert_eq!(phases, [(Compare, 192), (RotateCount, 10), edge, rotation, (UnloadPixels, 64)]);
    assert_eq!(
        (memory.slot_words, memory.luts, memory.kind),
        (128, 16, LaneMemoryKind::Distributed)
    );
    let (phases, _) = steps("temporal.reference=last-sent", "hardware.fold=1");
    assert_eq!((phases[0], phases[4]), ((Compare, 192), (CopyReference, 128)));
    // Eight slots of 128 words take 128 LUTs, and nine take 144.
    let (phases, memory) = steps("temporal.reference=previous", "hardware.fold=8");
    assert_eq!(
        (phases[0], memory.luts, memory.kind),
        ((Compare, 192), 128, LaneMemoryKind::Distributed)
    );
    let (phases, memory) = steps("temporal.reference=previous", "hardware.fold=9");
    assert_eq!((phases[0], memory.luts, memory.kind), ((Compare, 256), 144, LaneMemoryKind::Block));
    let (phases, _) = steps("temporal.reference=last-sent", "hardware.fold=9");
    assert_eq!((phases[0], phases[4]), ((Compare, 192), (CopyReference, 192)));
}

/// The expected numbers are computed by hand from `docs/serial.md`: a deep array needs a clock more
/// for each of 64 medians and for each of two rotations, and Q depends on memory and features.
#[test]
fn a_deep_array_waits_for_its_registers() {
    let of = |more: &[&str]| timing(&design(&[&["hardware.pipelining=deep"], more].concat()));
    let (plain, deep) = (timing(&design(&[])), of(&[]));
    assert_eq!((plain.read_latency(), plain.settling_steps()), (0, 0));
    assert_eq!((deep.read_latency(), deep.settling_steps()), (1, 1));
    assert_eq!(deep.clocks_per_frame(), plain.clocks_per_frame() + 64 + 2);
    assert_eq!(deep.edges_to_step(0), plain.edges_to_step(0) + 1);
    assert_eq!(deep.edges_to_ready(), 1 + deep.steps());
    let latency = |more: &[&str]| of(more).read_latency();
    assert_eq!(latency(&["hardware.memory=block"]), 2);
    for sums in ["mad", "variance"] {
        let feature = format!("spatial=[{{feature='{sums}'}}]");
        assert_eq!(latency(&[&feature]), 2);
        assert_eq!(latency(&["hardware.memory=block", &feature]), 3);
        assert_eq!(of(&[&feature]).settling_steps(), 1);
    }
}

/// The expected numbers are computed by hand from `docs/serial.md`. The largest sum of 64 pixels,
/// 16,320, has 14 bits, and 16,352, with half of 64, has 14 bits, too.
#[test]
fn surface_and_segment_use_the_second_word_bit_by_bit() {
    let of = |kind: &str, more: &[&str]| {
        let feature = format!("spatial=[{{feature='{kind}'}}]");
        let design = design(&[&["denoise.filter=none", &feature][..], more].concat());
        let (timing, widths) = (timing(&design), design.as_serial().unwrap().lane_widths());
        let registers = (widths.accumulator, widths.second, widths.scale, widths.chain);
        (timing.phases()[2].1, timing.read_latency(), registers)
    };
    assert_eq!(of("surface", &[]), (512 + 154 + 5, 0, (15, 14, 14, 14)));
    assert_eq!(of("segment", &[]), (256 + 32 + 9, 0, (15, 8, 14, 7)));
    // 25 pixels and 24 others are counted in one word. The largest sum plus 12 is 6,387.
    assert_eq!(of("segment", &["region.size=5"]).2, (14, 8, 12, 6));
    let deep = |kind| of(kind, &["hardware.pipelining=deep"]).1;
    assert_eq!((deep("surface"), deep("segment")), (2, 1));
}

/// The expected numbers are computed by hand from `docs/serial.md`, for 8 bits and 64 pixels.
#[test]
fn each_filter_has_its_own_steps() {
    let of = |filter: &str, reference: &str| {
        let (filter, reference) =
            (format!("denoise.filter={filter}"), format!("temporal.reference={reference}"));
        let design = design(&[&filter, &reference]);
        (timing(&design).phases()[0], design.as_serial().unwrap().lane_widths().accumulator)
    };
    let phase = |steps: u64, bits: u32| ((DenoiseAndCompare, 64 * steps), bits);
    assert_eq!(of("median3x3", "previous"), phase(83, 11));
    assert_eq!(of("switching3x3", "previous"), phase(102, 11));
    assert_eq!(of("switching3x3", "last-sent"), phase(103, 11));
    assert_eq!(of("binomial3x3", "previous"), phase(51, 13));
    assert_eq!(of("binomial3x3", "last-sent"), phase(51, 13));
}

/// The expected numbers are computed by hand from `docs/serial.md`: a region of 64 pixels has four
/// blocks of 16 pixels, a region of 25 pixels has one block. The arrays have 784 or 5 lanes.
#[test]
fn means_pass_the_ports_once_and_leave_once() {
    let own = |more: &[&str]| {
        let timing = timing(&design(&[&["render.irrelevant=mean"], more].concat()));
        let phases: Vec<_> = timing.phases().iter().map(|&(phase, _)| phase).collect();
        let edge = FeatureKind::Edge;
        let (count, score) = (RotateCount, RotateScore(edge));
        assert_eq!(
            phases,
            [
                DenoiseAndCompare,
                count,
                ComputeMeans,
                FeaturePass(edge),
                score,
                UnloadPixels,
                UnloadMeans
            ]
        );
        (timing.phases()[2].1, timing.phases()[6].1, timing)
    };
    let (means, unload, four) = own(&[]);
    assert_eq!((means, unload), (4 * (18 + 784), 4 * (784 + 2)));
    assert_eq!(four.clocks_per_frame(), 7_905 + 3_208 + 3_144);
    // A deep array with block memory has Q = 2.
    let (means, unload, _) = own(&["hardware.pipelining=deep", "hardware.memory=block"]);
    assert_eq!((means, unload), (4 * (18 + 1 + 784), 4 * (784 + 4)));
    let (means, unload, _) = own(&["hardware.feed=raster", "periphery.blocks=1"]);
    assert_eq!((means, unload), (66 + 784, 785));
    let small = ["region.size=5", "frame.width=49", "frame.height=5", "hardware.fold=2"];
    let (means, unload, one) = own(&small);
    assert_eq!((means, unload), (27 + 5, 7));
    // The decision comes with the last score, before pixels and means leave.
    let departure = one.to_design_timing().departure;
    assert_eq!(departure.forward_clocks - departure.decision_clocks, 25 + 7);
}

/// The largest sum of 16 pixels of 8 bits plus half of their number is 4,088, which has 12 bits.
/// For 64 pixels the sum is 16,352 with 14 bits, and for 25 pixels 6,387 with 13 bits.
#[test]
fn what_a_lane_drops_of_a_sum_need_not_pass() {
    let own = |more: &[&str]| {
        let design = design(&[&["render.irrelevant=mean"], more].concat());
        let design = design.as_serial().unwrap();
        let sums = design.block_mean_division().unwrap();
        let widths = design.lane_widths();
        (sums, (widths.accumulator, widths.chain))
    };
    let (four, widths) = own(&[]);
    assert_eq!(
        four,
        BlockMeanDivision { sum_bits: 12, dropped_bits: 4, passing_bits: 8, factor: 1, shift: 0 }
    );
    assert_eq!(widths, (12, 8));
    let (one, widths) = own(&["periphery.blocks=1"]);
    assert_eq!((one.sum_bits, one.dropped_bits, one.passing_bits), (14, 6, 8));
    assert_eq!(widths, (14, 8));
    // With `mad` the lane moves whole sums for a score, so it drops no bits.
    let (all, widths) = own(&["spatial=[{feature=\"mad\"}]"]);
    assert_eq!(
        all,
        BlockMeanDivision { sum_bits: 12, dropped_bits: 0, passing_bits: 12, factor: 1, shift: 4 }
    );
    let none = design(&["spatial=[{feature=\"mad\"}]"]).as_serial().unwrap().lane_widths();
    assert_eq!(widths, (none.accumulator, none.chain));
    // 25 pixels are not a power of two, so a multiplication is needed.
    let (odd, widths) = own(&["region.size=5"]);
    assert_eq!((odd.sum_bits, odd.dropped_bits, odd.passing_bits), (13, 0, 13));
    assert_eq!(widths, (13, 13));
    let exact = |sum: u64| (sum * odd.factor) >> odd.shift;
    assert_eq!([24, 25, 6387].map(exact), [0, 1, 255]);
    assert_eq!(design(&[]).as_serial().unwrap().block_mean_division(), None);
}

#[test]
fn the_configuration_may_name_the_memory() {
    let of = |overrides: &[&str]| {
        let design = design(overrides);
        (design.as_serial().unwrap().lane_memory(), timing(&design))
    };
    let (ruled, plain) = of(&[]);
    assert_eq!(
        (ruled.kind, ruled.choice),
        (LaneMemoryKind::Distributed, MemoryChoice::LutLimit(128))
    );
    let (same, steps) = of(&["hardware.memory=distributed"]);
    assert_eq!((same.kind, same.choice), (LaneMemoryKind::Distributed, MemoryChoice::Configured));
    assert_eq!(steps, plain);
    // The 64 medians wait one clock each for the words that they replace.
    let (block, steps) = of(&["hardware.memory=block"]);
    assert_eq!((block.kind, block.choice), (LaneMemoryKind::Block, MemoryChoice::Configured));
    assert_eq!((steps.read_latency(), steps.steps()), (1, plain.steps() + 64));
    assert_eq!(block.kind.read_latency(), 1);
    // Nine slots of 128 words exceed the limit. The choice of the configuration holds for every
    // fold.
    let folded = ["frame.width=8", "frame.height=80", "hardware.fold=9"];
    let (ruled, slow) = of(&folded);
    let (named, steps) = of(&[&folded[..], &["hardware.memory=distributed"]].concat());
    assert_eq!((ruled.kind, named.kind), (LaneMemoryKind::Block, LaneMemoryKind::Distributed));
    assert_eq!((ruled.luts, named.luts), (144, 144));
    assert_eq!(steps.steps(), slow.steps() - 9 * 64);
    let design = design(&["hardware.memory=block"]);
    let folded = design.with_fold(2).unwrap().as_serial().unwrap().lane_memory();
    let lane = design.lone_unit();
    let single = lane.as_serial().unwrap().lane_memory();
    assert_eq!((folded.kind, single.kind), (block.kind, block.kind));
}

#[test]
fn the_widths_of_the_ports_hold_their_numbers() {
    let wide = design(&["hardware.fold=3", "spatial=[{feature=\"edge\"},{feature=\"variance\"}]"]);
    let wide = wide.as_serial().unwrap();
    assert_eq!(
        (wide.lanes(), wide.region_bits(), wide.lane_bits(), wide.slot_bits()),
        (262, 10, 9, 2)
    );
    assert_eq!((wide.score_count(), wide.score_index_bits()), (3, 2));
    assert_eq!(wide.max_score_bits(), wide.features()[1].score_bits());
    assert_eq!((wide.region_in_slot(261, 0), wide.region_in_slot(261, 1)), (Some(783), None));
    let one = design(&["frame.width=8", "frame.height=8"]);
    let one = one.as_serial().unwrap();
    assert_eq!((one.region_bits(), one.lane_bits(), one.slot_bits()), (1, 1, 1));
    assert_eq!((one.score_index_bits(), one.max_score_bits()), (1, 7));
}

/// Returns name, width and number of lanes of every output, and whether it has a value per lane.
fn outputs(ports: &[crate::Port]) -> Vec<(&str, u32, u32, bool)> {
    let outputs = ports.iter().filter(|port| port.direction == crate::PortDirection::Output);
    outputs.map(|port| (port.name.as_str(), port.width, port.lanes, port.per_lane)).collect()
}

const RESULTS: [(&str, u32, u32, bool); 9] = [
    ("ready_o", 1, 1, false),
    ("score_valid_o", 1, 1, false),
    ("score_index_o", 1, 1, false),
    ("region_o", 10, 1, false),
    ("score_o", 7, 1, false),
    ("decision_valid_o", 1, 1, false),
    ("srs_o", 1, 1, false),
    ("trs_o", 1, 1, false),
    ("active_o", 1, 1, false),
];

#[test]
fn ports_follow_feed_and_fold() {
    let parallel = design(&["hardware.fold=4"]).rcm_ports();
    let forward = [
        ("forward_valid_o", 1, 196, true),
        ("forward_pixel_o", 8, 196, true),
        ("forward_position_o", 6, 1, false),
        ("forward_slot_o", 2, 1, false),
    ];
    assert_eq!(outputs(&parallel), [&RESULTS[..], &forward].concat());
    let pixel = parallel.iter().find(|port| port.name == "pixel_i").unwrap();
    assert_eq!((pixel.lanes, pixel.per_lane, pixel.bits()), (196, true, 1568));
    let unfolded = design(&[]).rcm_ports();
    assert!(unfolded.iter().all(|port| port.name != "forward_slot_o"));

    let raster = design(&["hardware.fold=4", "hardware.feed=raster"]).rcm_ports();
    let forward = [
        ("forward_valid_o", 1, 1, false),
        ("forward_pixel_o", 8, 1, false),
        ("forward_position_o", 6, 1, false),
        ("forward_region_o", 10, 1, false),
    ];
    assert_eq!(outputs(&raster), [&RESULTS[..], &forward].concat());
    for port in parallel.iter().chain(&raster) {
        let qualifier = match port.name.as_str() {
            "score_index_o" | "region_o" | "score_o" => {
                OutputQualifier::WhileSet(crate::PortRole::ScoreValid)
            }
            "forward_pixel_o" | "forward_position_o" | "forward_slot_o" | "forward_region_o" => {
                OutputQualifier::WhileSet(crate::PortRole::ForwardValid)
            }
            _ => OutputQualifier::Always,
        };
        assert_eq!(port.qualifier, qualifier, "{}", port.name);
    }
    for (feed, forward) in [("parallel", &parallel), ("raster", &raster)] {
        let feed = format!("hardware.feed={feed}");
        let means = design(&["hardware.fold=4", &feed, "render.irrelevant=mean"]).rcm_ports();
        let mut expected = outputs(forward);
        expected.insert(9, ("summary_o", 1, 1, false));
        assert_eq!(outputs(&means), expected);
        assert_eq!(means.iter().filter(|port| port.name == "summary_level_i").count(), 1);
    }
    let thresholds = |ports: Vec<crate::Port>| -> Vec<_> {
        let own =
            ports.into_iter().filter(|p| p.name.ends_with("level_i") || p.name.ends_with("min_i"));
        own.collect()
    };
    let pipelined = DesignConfig::default().validate().unwrap();
    assert_eq!(thresholds(raster), thresholds(pipelined.rcm_ports()));
}

#[test]
fn flow_copies_its_reference_and_has_ports_for_displacements() {
    let flow = |radius| design(&[&format!("spatial=[{{feature=\"flow\",radius={radius}}}]")]);
    let ports = flow(1).rcm_ports();
    let ports = outputs(&ports);
    let place = ports.iter().position(|(name, ..)| *name == "score_o").unwrap();
    let added = [("displacement_x_o", 2, 1, false), ("displacement_y_o", 2, 1, false)];
    assert_eq!(ports[place + 1..][..2], added);
    assert_eq!(outputs(&flow(3).rcm_ports())[place + 1].1, 3);
    let steps = |radius| {
        let design = flow(radius);
        let timing = SerialTiming::from_design(design.as_serial().unwrap());
        let is_own =
            |(phase, _): &&(SerialPhase, u64)| matches!(phase, FeaturePass(_) | CopyReference);
        timing.phases().iter().filter(is_own).map(|&(_, steps)| steps).collect::<Vec<_>>()
    };
    assert_eq!([steps(1), steps(2), steps(3)], [[1474, 128], [3680, 128], [6738, 128]]);
    let memory = flow(1).as_serial().unwrap().lane_memory();
    let kinds: Vec<_> = memory.areas.iter().map(|area| area.kind).collect();
    use super::SlotAreaKind::{Denoised, Raw, Reference};
    assert_eq!(kinds, [Raw, Denoised, Reference]);
}

#[test]
fn one_rpu_is_the_array_of_one_lane() {
    let design = design(&["hardware.fold=3", "region.neighborhood=shared"]);
    let one = design.as_serial().unwrap().single_lane_design();
    assert_eq!(
        (one.width(), one.height(), one.regions(), one.as_serial().unwrap().lanes()),
        (24, 8, 3, 1)
    );
    assert_eq!(one.config().validate().unwrap(), one);
    assert_eq!(design.rpu_ports(), one.rcm_ports());
    assert_eq!(one.rpu_ports(), one.rcm_ports());
    assert_eq!(outputs(&design.rpu_ports())[3], ("region_o", 2, 1, false));
}

/// Returns c(x) by the definition in docs/serial.md: the number of pairs of a region column and a
/// position in its window.
fn count_places(design: &Design, at: u32, regions: u32) -> u32 {
    let (side, halo) = (i64::from(design.region_size()), i64::from(design.halo()));
    let end = i64::from(regions) * side - 1;
    let windows = (0..i64::from(regions)).flat_map(|r| r * side - halo..(r + 1) * side + halo);
    windows.map(|x| u32::from(x.clamp(0, end) == i64::from(at))).sum()
}

#[test]
fn every_window_is_filled_once() {
    for neighborhood in Neighborhood::ALL {
        for (filter, feature) in
            [("median3x3", "edge"), ("median3x3", "mad"), ("none", "corner"), ("none", "variance")]
        {
            for side in [4u32, 5, 8, 13] {
                for (columns, rows) in [(1, 1), (2, 1), (1, 3), (4, 3)] {
                    let design = design(&[
                        &format!("region.neighborhood={neighborhood}"),
                        &format!("denoise.filter={filter}"),
                        &format!("spatial=[{{feature=\"{feature}\"}}]"),
                        &format!("region.size={side}"),
                        &format!("frame.width={}", columns * side),
                        // A ragged frame has the counts of the padded frame.
                        &format!("frame.height={}", rows * side - 1),
                        "hardware.feed=raster",
                    ]);
                    let array = design.as_serial().unwrap();
                    let mut places = 0;
                    for y in 0..rows * side {
                        assert_eq!(array.row_places(y), count_places(&design, y, rows));
                        for x in 0..columns * side {
                            assert_eq!(array.column_places(x), count_places(&design, x, columns));
                            places += u64::from(array.column_places(x) * array.row_places(y));
                        }
                    }
                    let windows = u64::from(design.regions() * design.stream_pixels());
                    assert_eq!(places, windows, "{neighborhood} {filter} {feature} {side}");
                    assert_eq!(timing(&design).load_clocks(), windows);
                }
            }
        }
    }
}

#[test]
fn the_largest_fold_is_the_last_that_is_fast_enough() {
    for feed in ["parallel", "raster"] {
        for neighborhood in ["isolated", "shared"] {
            let feed = format!("hardware.feed={feed}");
            let region = format!("region.neighborhood={neighborhood}");
            let design = design(&["frame.width=100", "frame.height=40", &feed, &region]);
            let clocks: Vec<u64> = (1..=design.regions())
                .map(|fold| timing(&design.with_fold(fold).unwrap()).clocks_per_frame())
                .collect();
            assert_eq!(clocks.iter().min(), clocks.first(), "fold 1 is the fastest");
            for limit in clocks.iter().flat_map(|&clocks| [clocks - 1, clocks, clocks + 1]) {
                let last = clocks.iter().rposition(|&clocks| clocks <= limit);
                let expected = last.map(|place| u32::try_from(place + 1).unwrap());
                assert_eq!(design.largest_fold(limit), expected, "{limit}");
            }
        }
    }
    let design = design(&[]);
    for fold in [0, 785] {
        let refusal = design.with_fold(fold).unwrap_err().to_string();
        assert!(refusal.starts_with(&format!("`hardware.fold` = {fold} is out of")), "{refusal}");
    }
    let folded = design.with_fold(784).unwrap();
    assert_eq!(folded.config().validate().unwrap(), folded);
}

/// The frame has 784 regions. A slot has 128 words of 8 bits, and a RAMB18 holds 2,048 of them,
/// which is 16 slots. So each of 47 lanes of 17 slots takes two RAMB18, and each of 49 lanes of 16
/// slots takes one. Each of two lanes of 392 slots takes 24.5, rounded up. 98 lanes of 8 slots have
/// distributed memory.
#[test]
fn frugal_folds_have_fewer_lanes_or_fewer_block_rams() {
    let single = design(&["hardware.feed=raster"]);
    let clocks = |fold: u32| timing(&single.with_fold(fold).unwrap()).clocks_per_frame();
    assert_eq!(single.pareto_folds(clocks(17)), [17, 16, 8]);
    // With a clock less, 17 slots are too slow, and 47 lanes with fewer slots do not exist.
    assert_eq!(single.pareto_folds(clocks(17) - 1), [16, 8]);
    // The candidates are two lanes of 392 slots (448 slots are allowed), seven lanes of 112, and
    // one lane of 784, which fills its blocks.
    assert_eq!(single.pareto_folds(clocks(448)), [392, 112, 8]);
    assert_eq!(single.pareto_folds(clocks(784)), [784, 8]);
    assert_eq!(single.pareto_folds(clocks(1)), [1]);
    assert!(single.pareto_folds(clocks(1) - 1).is_empty());
    let blocks =
        |fold: u32| single.with_fold(fold).unwrap().as_serial().unwrap().lane_memory().blocks;
    assert_eq!([16, 17, 32, 33, 392, 784].map(blocks), [1, 2, 2, 3, 25, 49]);
    // Words of 4 bits are twice as many as words of 9 bits. Words of 12 bits take words of 18 bits,
    // or of 9 and 4.
    let of_bits =
        |bits: &str, fold: &str| design(&[bits, fold]).as_serial().unwrap().lane_memory().blocks;
    assert_eq!(of_bits("frame.pixel_bits=4", "hardware.fold=32"), 1);
    assert_eq!(of_bits("frame.pixel_bits=12", "hardware.fold=16"), 2);
    assert!(DesignConfig::default().validate().unwrap().pareto_folds(u64::MAX).is_empty());
}

/// No fold that is fast enough has fewer lanes and no more block RAMs than a fold in the list, or
/// fewer block RAMs and no more lanes.
#[test]
fn no_fold_beats_the_frugal() {
    let single = design(&["frame.width=100", "frame.height=40", "hardware.memory=block"]);
    let all: Vec<_> = (1..=single.regions()).map(|fold| single.with_fold(fold).unwrap()).collect();
    let cost = |design: &Design| {
        let array = design.as_serial().unwrap();
        let lanes = u64::from(array.lanes());
        (lanes, lanes * array.lane_memory().blocks)
    };
    for limit in all.iter().map(|design| timing(design).clocks_per_frame()) {
        let frugal = single.pareto_folds(limit);
        let frugal: Vec<_> = frugal.iter().map(|&fold| &all[fold as usize - 1]).collect();
        assert!(frugal.iter().all(|design| timing(design).clocks_per_frame() <= limit));
        let costs: Vec<_> = frugal.iter().map(|design| cost(design)).collect();
        assert!(costs.is_sorted_by(|one, next| one.0 < next.0 && one.1 > next.1), "{costs:?}");
        for other in all.iter().filter(|design| timing(design).clocks_per_frame() <= limit) {
            let (lanes, blocks) = cost(other);
            assert!(costs.iter().any(|own| own.0 <= lanes && own.1 <= blocks), "{limit}");
        }
    }
}

/// A method that derives one design from another validates it like a configuration file.
#[test]
fn a_pipelined_design_has_no_other_fold() {
    let design = DesignConfig::default().validate().unwrap();
    assert_eq!(design.with_fold(1).unwrap(), design);
    let refusal = design.with_fold(2).unwrap_err().to_string();
    assert_eq!(
        refusal,
        "`hardware.fold` = 2 cannot be combined with organization = \"pipelined\"; only the serial \
         organization shares lanes; use 1"
    );
    assert_eq!(design.largest_fold(u64::MAX), None);
}

/// The frame of the lone lane is wider than a configuration allows, and still makes a design.
#[test]
fn one_lane_may_have_more_regions_than_a_row() {
    let design = design(&["frame.width=8192", "frame.height=8192", "hardware.fold=1048576"]);
    let lane = design.lone_unit();
    assert_eq!(
        (lane.width(), lane.as_serial().unwrap().lanes(), lane.regions()),
        (8 << 20, 1, 1 << 20)
    );
    assert_eq!(lane.features(), design.features());
    assert!(lane.config().validate().is_err());
}
