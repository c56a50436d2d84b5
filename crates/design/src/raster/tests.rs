// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the numbers of `docs/raster.md`, computed by hand, and of the configurations that the
//! organization accepts and refuses.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod stores;
mod summaries;

use super::*;
use crate::{
    ArrayStructure, Design, DesignConfig, FrameStoreKind, InterfaceKind, OrganizationConfig,
    OutputQualifier, Pipelining, PortDirection, PortRole, RasterConfig,
};

fn config(overrides: &[&str]) -> DesignConfig {
    DesignConfig::from_toml_with("[hardware]\norganization = \"raster\"\n", overrides).unwrap()
}

fn design(overrides: &[&str]) -> Design {
    config(overrides).validate().unwrap()
}

fn refusal(overrides: &[&str]) -> String {
    let config = DesignConfig::from_toml_with("[hardware]\norganization = \"raster\"\n", overrides);
    config.and_then(|config| config.validate()).unwrap_err().to_string()
}

#[test]
fn a_frame_of_full_hd_takes_what_the_page_says() {
    let design = design(&["frame.width=1920", "frame.height=1080"]);
    let timing = RasterTiming::from_design(design.as_raster().unwrap());
    assert_eq!((timing.row_words, timing.taken_words, timing.windows), (1920, 1920, 2));
    assert_eq!((timing.region_row_words, timing.region_words), (8, 64));
    assert_eq!((timing.store_latency, timing.decision_latency), (7, 11));
    assert_eq!((timing.buffer_rows, timing.second_pass), (2, None));
    assert_eq!((timing.words(), timing.tail_delay()), (2_073_600, 3_842));
    assert_eq!((timing.advances(), timing.flush_clocks()), (2_077_442, 3_842));
    assert_eq!(timing.clocks_per_frame(), 2_077_453);
    let answers = design.timing();
    assert_eq!(answers.clocks_per_frame(), 2_077_453);
    assert_eq!(answers.pixels_per_frame(), 2_073_600);
    let departure = answers.departure();
    assert_eq!((departure.take_clocks, departure.decision_clocks), (2_073_600, 3_853));
    // The first region of the last row is decided at 3842 - 1920 + 8 + 11 = 1941. Its words are on
    // the ports from 1946 on, and the 15,360 words of the row follow each other without a gap.
    assert_eq!(departure.forward_clocks, 1_946 + 15_360 - 1);
    assert_eq!((departure.decision_frames, departure.forward_frames), (0, 0));
    assert_eq!((departure.slot_clocks, departure.has_independent_units), (0, false));
}

/// The frame has 61x37 pixels: 8x5 regions of 8x8 pixels. Its rows have 16 words, all of which are
/// taken. The core adds three rows below.
#[test]
fn the_second_pass_of_a_ragged_frame() {
    let design = design(&[
        "frame.width=61",
        "frame.height=37",
        "hardware.pixels_per_clock=4",
        "hardware.pipelining=deep",
        "denoise.filter=none",
        "spatial=[{feature=\"variance\"},{feature=\"mad\"}]",
    ]);
    let timing = RasterTiming::from_design(design.as_raster().unwrap());
    assert_eq!((timing.row_words, timing.taken_words, timing.windows), (16, 16, 0));
    assert_eq!((timing.store_latency, timing.decision_latency), (4, 13));
    assert_eq!(timing.second_pass, Some(SecondPassTiming { after_store: 12, decision_latency: 6 }));
    assert_eq!((timing.buffer_rows, timing.region_words), (3, 16));
    assert_eq!((timing.advances(), timing.flush_clocks()), (640, 48));
    assert_eq!((timing.taken_words_per_frame(), timing.clocks_per_frame()), (37 * 16, 653));
    // The last word of the first region of the last row comes at T0 + 48 - 14, and its pass begins
    // 16 clocks later. The eight passes take 128 clocks, and the decision comes 6 clocks after the
    // last edge.
    let departure = design.timing().departure();
    assert_eq!(departure.decision_clocks, 34 + 16 + 127 + 6);
    assert_eq!(departure.forward_clocks, 183 + 6 + 15);
}

/// The frame has 50x20 pixels in words of two pixels: 7x3 regions. The core makes three words of a
/// row and four rows.
#[test]
fn a_frame_takes_its_words_and_what_the_core_adds() {
    let overrides = [
        "frame.width=50",
        "frame.height=20",
        "hardware.pixels_per_clock=2",
        "spatial=[{feature=\"variance\"}]",
    ];
    let timing = RasterTiming::from_design(design(&overrides).as_raster().unwrap());
    assert_eq!((timing.row_words, timing.taken_words, timing.windows), (28, 25, 1));
    assert_eq!((timing.store_latency, timing.decision_latency), (6, 13));
    assert_eq!((timing.advances(), timing.flush_clocks()), (24 * 28 + 29, 3 + 4 * 28 + 29));
    let departure = design(&overrides).timing().departure();
    assert_eq!((departure.take_clocks, departure.decision_clocks), (19 * 28 + 25, 144 + 13));
    assert_eq!(timing.clocks_per_frame(), 557 + 144 + 13);
    assert_eq!(timing.edges_to_ready(), 157);
}

/// A source must leave rows between frames: 3,853 clocks are a little more than two rows of 1,920
/// clocks, so three rows. For the ragged frame, 157 clocks less the 3 clocks of the last row need
/// six rows of 28 clocks. A sink may stall for less than a row.
#[test]
fn a_source_leaves_rows_between_frames_and_a_sink_may_stall_for_less_than_a_row() {
    let full_hd = RasterTiming::from_design(
        design(&["frame.width=1920", "frame.height=1080"]).as_raster().unwrap(),
    );
    assert_eq!((full_hd.blank_rows(), full_hd.max_stall_clocks()), (3, 1920 - 8 - 4 - 3));
    assert_eq!(full_hd.clocks_to_decision(), 3_842 + 11);
    let ragged = RasterTiming::from_design(
        design(&[
            "frame.width=50",
            "frame.height=20",
            "hardware.pixels_per_clock=2",
            "spatial=[{feature=\"variance\"}]",
        ])
        .as_raster()
        .unwrap(),
    );
    assert_eq!((ragged.blank_rows(), ragged.max_stall_clocks()), (6, 28 - 4 - 7 - 3));
    let mad = |more: &[&str]| {
        let features = "spatial=[{feature=\"mad\"},{feature=\"variance\"}]";
        let frame = ["frame.width=64", "frame.height=32", features];
        RasterTiming::from_design(design(&[&frame, more].concat()).as_raster().unwrap())
            .max_stall_clocks()
    };
    assert_eq!(mad(&[]), 9 * 64 - 72 - 17);
    assert_eq!(mad(&["hardware.pipelining=deep"]), 9 * 64 - 72 - 21);
}

/// The row is the shortest one, with four regions. With two rows in the buffer, `deep` and
/// `variance`, a sink that never stalls would lose regions.
#[test]
fn a_row_that_is_too_short_for_the_readout_has_a_third_row_in_the_buffer() {
    let numbers = |feature: &str, pipelining: &str, width: u32, more: &str| {
        let frame = [
            &*format!("frame.width={width}"),
            "frame.height=32",
            "region.size=4",
            &*format!("spatial=[{{feature=\"{feature}\"}}]"),
            &*format!("hardware.pipelining={pipelining}"),
            more,
        ];
        let timing = RasterTiming::from_design(design(&frame).as_raster().unwrap());
        (timing.buffer_rows, timing.max_stall_clocks())
    };
    let forward = "hardware.forward=true";
    assert_eq!(numbers("surface", "deep", 16, forward), (2, 0));
    assert_eq!(numbers("variance", "deep", 16, forward), (3, 4 * 16 - 1));
    assert_eq!(numbers("variance", "deep", 20, forward), (2, 3));
    assert_eq!(numbers("variance", "plain", 16, forward), (2, 2));
    assert_eq!(numbers("variance", "deep", 16, "hardware.forward=false"), (0, 0));
}

/// The frame has 64x64 pixels, with edges and a median. The memories hold the frame store, two rows
/// of regions, two rows of pixels for each of two windows, the counts, and the queue.
#[test]
fn memories_of_the_paper_on_a_small_frame() {
    let of = |more: &[&str]| {
        let frame = ["frame.width=64", "frame.height=64"];
        let memories =
            RasterMemory::all_memories(design(&[&frame, more].concat()).as_raster().unwrap());
        memories.iter().map(|memory| (memory.words, memory.bits)).collect::<Vec<_>>()
    };
    // A queue entry has 3 bits of the row of regions, 6 of the region number, 10 of the address in
    // the buffer, and 1 of the frame number.
    let plain = [(4096, 8), (1024, 8), (64, 16), (64, 16), (8, 12), (16, 20)];
    assert_eq!(of(&[]), plain);
    let sent = of(&["temporal.reference=last-sent", "render.payload=raw"]);
    let raw = [(4096, 8), (1024, 8), (1024, 8), (64, 16), (64, 16), (64, 8), (8, 12)];
    // A queue entry has 13 more bits: the address in the frame store and a flag.
    assert_eq!(sent, [&raw[..], &[(16, 33), (64, 1), (64, 1)]].concat());
    // A frame with few rows of regions has more bits of the frame number.
    for (height, bits) in [(24, 18 + 1), (16, 17 + 1), (8, 16 + 2)] {
        let low = RasterMemory::all_memories(
            design(&["frame.width=64", &format!("frame.height={height}")]).as_raster().unwrap(),
        );
        assert_eq!(low.last().map(|memory| memory.bits), Some(bits), "{height}");
    }
    let total: u64 = RasterMemory::all_memories(
        design(&["frame.width=64", "frame.height=64"]).as_raster().unwrap(),
    )
    .iter()
    .map(RasterMemory::total_bits)
    .sum();
    assert_eq!(total, 32_768 + 8_192 + 2 * 1_024 + 96 + 320);
}

/// The frame has 64x64 pixels. With `surface` there are four sums of 14 bits for each of the eight
/// columns of regions. With `mad` and `segment` there are one copy of the pixels and one queue,
/// whose entries have the mean of 8 bits, the address of 11, and the count of changed pixels.
#[test]
fn memories_of_surface_and_of_a_second_pass() {
    let of = |features: &str| {
        let keys = ["frame.width=64", "frame.height=64", "denoise.filter=none", features];
        let memories = RasterMemory::all_memories(design(&keys).as_raster().unwrap());
        memories.iter().map(|memory| (memory.words, memory.bits)).collect::<Vec<_>>()
    };
    let surface = [(4096, 8), (1024, 8), (64, 16), (8, 6), (8, 56), (16, 20)];
    assert_eq!(of("spatial=[{feature=\"surface\"}]"), surface);
    let both = "spatial=[{feature=\"segment\"},{feature=\"mad\"}]";
    let second_pass = [(4096, 8), (1536, 8), (1536, 8), (8, 6), (8, 14), (32, 21), (32, 26)];
    assert_eq!(of(both), second_pass);
}

#[test]
fn latencies_follow_filter_features_and_pipelining() {
    let latencies = |filter: &str, feature: &str, pipelining: &str| {
        let timing = RasterTiming::from_design(
            design(&[
                &format!("denoise.filter={filter}"),
                &format!("spatial=[{{feature=\"{feature}\"}}]"),
                &format!("hardware.pipelining={pipelining}"),
            ])
            .as_raster()
            .unwrap(),
        );
        (timing.store_latency, timing.decision_latency)
    };
    for (filter, feature, plain, deep) in [
        ("none", "mad", (2, 6), (4, 10)),
        ("none", "corner", (3, 7), (7, 13)),
        ("median3x3", "mad", (6, 10), (13, 19)),
        ("median3x3", "edge", (7, 11), (16, 22)),
        ("none", "variance", (2, 9), (4, 13)),
        ("none", "segment", (2, 6), (4, 10)),
        ("none", "surface", (3, 9), (7, 15)),
        ("switching3x3", "surface", (7, 13), (16, 24)),
        ("binomial3x3", "edge", (7, 11), (16, 22)),
    ] {
        assert_eq!(latencies(filter, feature, "plain"), plain, "{filter} {feature}");
        assert_eq!(latencies(filter, feature, "deep"), deep, "{filter} {feature}");
    }
}

#[test]
fn only_small_frames_of_last_sent_wait() {
    let waits = |rows: u32, reference: &str, feature: &str| {
        let design = design(&[
            &format!("frame.height={}", rows * 8),
            &format!("temporal.reference={reference}"),
            &format!("spatial=[{{feature=\"{feature}\"}}]"),
        ]);
        RasterTiming::from_design(design.as_raster().unwrap()).waits_for_pending
    };
    assert!(waits(2, "last-sent", "edge") && !waits(3, "last-sent", "edge"));
    assert!(waits(3, "last-sent", "mad") && !waits(4, "last-sent", "mad"));
    assert!(!waits(2, "previous", "edge"));
}

#[test]
fn keys_are_filled_in_and_only_here() {
    let plain = design(&[]);
    let hardware = plain.config().hardware;
    let own = RasterConfig {
        pixels_per_clock: Some(1),
        store: Some(FrameStoreKind::Block),
        forward: Some(true),
        interface: Some(InterfaceKind::Ports),
    };
    assert_eq!(hardware.organization, OrganizationConfig::Raster(own));
    assert_eq!(hardware.pipelining, Pipelining::Plain);
    assert_eq!(hardware.description(), "raster, 1 pixel per clock, plain pipelining, block store");
    let named = design(&["hardware.pixels_per_clock=1", "hardware.store=block"]);
    assert_eq!(named.fingerprint(), plain.fingerprint());
    let others = ["pixels_per_clock=2", "pipelining=deep", "store=ultra"]
        .map(|key| design(&[&format!("hardware.{key}")]));
    assert!(others.iter().all(|other| other.fingerprint() != plain.fingerprint()));
    assert_eq!(others[2].as_raster().unwrap().store(), FrameStoreKind::Ultra);

    for organization in ["pipelined", "serial"] {
        let other = [&format!("hardware.organization={organization}")];
        let toml = config(&other.map(String::as_str)).validate().unwrap().config().to_toml();
        assert!(!toml.contains("pixels_per_clock") && !toml.contains("store"), "{toml}");
        for (key, value) in [("pixels_per_clock", "2"), ("store", "\"block\"")] {
            let key = format!("hardware.{key}={value}");
            let (name, _) = key.split_once('=').unwrap();
            assert_eq!(
                refusal(&[other[0], &key]),
                format!(
                    "`{name}` = {value} cannot be combined with organization = \
                     \"{organization}\"; only the raster organization has this key; leave the key out, or \
                     use organization = \"raster\""
                )
            );
        }
        assert_eq!(
            refusal(&[other[0], "hardware.interface=axi"]),
            format!(
                "`hardware.interface` = \"axi\" cannot be combined with organization = \
                 \"{organization}\"; only the raster organization has this key; leave the key out, or use \
                 organization = \"raster\""
            )
        );
    }
}

#[test]
fn what_only_lanes_have_is_refused() {
    let alone = "only the serial organization has this key; leave the key out, or use organization = \"serial\"";
    for (key, remedy) in [
        ("hardware.fold=2", "only the serial organization shares lanes; use 1"),
        ("hardware.feed=\"raster\"", alone),
        ("hardware.memory=\"block\"", alone),
    ] {
        let (name, value) = key.split_once('=').unwrap();
        assert_eq!(
            refusal(&[key]),
            format!(
                "`{name}` = {value} cannot be combined with organization = \"raster\"; {remedy}"
            )
        );
    }
}

#[test]
fn frames_that_the_core_cannot_take_are_refused() {
    for (overrides, message) in [
        (
            vec!["hardware.pixels_per_clock=3"],
            "`hardware.pixels_per_clock` = 3 is out of range; the valid range is 1, 2 or 4",
        ),
        (
            vec!["hardware.pixels_per_clock=4", "region.size=6"],
            "`hardware.pixels_per_clock` = 4 cannot be combined with organization = \"raster\"; \
             it must divide region.size = 6; use fewer pixels",
        ),
        (
            vec!["frame.width=8193"],
            "`frame.width` = 8193 is out of range; the valid range is 1..=8192 for organization = \
             \"raster\"; use a narrower frame, or \"serial\"",
        ),
        (
            vec!["frame.width=24"],
            "`frame.width` = 24 cannot be combined with organization = \"raster\"; a row must have \
             at least 4 regions and 16 words of 1 pixels; use frames of at least 25 pixels, or \
             smaller regions",
        ),
        (
            vec!["frame.width=28", "region.size=4", "hardware.pixels_per_clock=2"],
            "`frame.width` = 28 cannot be combined with organization = \"raster\"; a row must have \
             at least 4 regions and 16 words of 2 pixels; use frames of at least 29 pixels, or \
             smaller regions",
        ),
    ] {
        assert_eq!(refusal(&overrides), message);
    }
    design(&["frame.width=25"]);
    design(&["frame.width=8192"]);
    design(&["frame.width=29", "region.size=4", "hardware.pixels_per_clock=2"]);
}

/// Each entry is the name and the width of a port. The condition under which a port has a meaning
/// is checked below.
#[test]
fn ports_stand_in_the_order_of_the_page() {
    let design = design(&[
        "frame.width=64",
        "frame.height=40",
        "hardware.pixels_per_clock=4",
        "spatial=[{feature=\"corner\"},{feature=\"edge\"}]",
    ]);
    let ports = design.rcm_ports();
    let named = |direction| -> Vec<(&str, u32)> {
        let own = ports.iter().filter(|port| port.direction == direction);
        own.map(|port| (port.name.as_str(), port.bits())).collect()
    };
    let inputs = [
        ("clk_i", 1),
        ("rst_i", 1),
        ("valid_i", 1),
        ("pixel_i", 32),
        ("forward_ready_i", 1),
        ("corner_level_i", 8),
        ("corner_min_i", 7),
        ("edge_level_i", 11),
        ("edge_min_i", 7),
        ("temporal_level_i", 8),
        ("temporal_min_i", 7),
    ];
    assert_eq!(named(PortDirection::Input), inputs);
    let outputs = [
        ("ready_o", 1),
        ("decision_valid_o", 1),
        ("region_o", 6),
        ("srs_o", 1),
        ("trs_o", 1),
        ("active_o", 1),
        ("corner_score_o", 7),
        ("edge_score_o", 7),
        ("temporal_count_o", 7),
        ("forward_valid_o", 1),
        ("forward_region_o", 6),
        ("forward_position_o", 6),
        ("forward_pixel_o", 32),
        ("forward_first_o", 1),
        ("forward_last_o", 1),
        ("forward_abort_o", 1),
        ("forward_frame_o", 8),
        ("lost_o", 1),
        ("lost_count_o", 16),
        ("lost_valid_o", 1),
        ("lost_region_o", 6),
        ("lost_frame_o", 8),
    ];
    assert_eq!(named(PortDirection::Output), outputs);
    for port in &ports {
        let qualifier = match port.name.as_str() {
            "region_o" | "corner_score_o" | "edge_score_o" | "temporal_count_o" => {
                OutputQualifier::WhileSet(PortRole::DecisionValid)
            }
            "forward_ready_i" | "forward_valid_o" => OutputQualifier::Always,
            name if name.starts_with("forward_") => {
                OutputQualifier::WhileSet(PortRole::ForwardValid)
            }
            "lost_region_o" | "lost_frame_o" => OutputQualifier::WhileSet(PortRole::LostValid),
            _ => OutputQualifier::Always,
        };
        assert_eq!((port.qualifier, port.lanes), (qualifier, 1), "{}", port.name);
    }
}

#[test]
fn one_core_serves_all_regions_and_the_lone_one_the_smallest_frame() {
    let unit = design(&[]).unit();
    assert_eq!((unit.name, unit.module, unit.count), ("core", "raster_core", 1));
    assert_eq!((unit.regions, unit.array), (784, ArrayStructure::SharedLogic));
    for (size, pixels, columns) in
        [(8, 1, 4), (8, 4, 8), (2, 1, 8), (2, 2, 16), (64, 4, 4), (12, 4, 6), (5, 1, 4)]
    {
        let design = design(&[
            &format!("region.size={size}"),
            &format!("hardware.pixels_per_clock={pixels}"),
            "temporal.min_count=1",
            "spatial.0.min_score=1",
            "frame.width=1000",
        ]);
        let lone = design.lone_unit();
        assert_eq!((lone.columns(), lone.rows()), (columns, 3), "{size} {pixels}");
        assert_eq!((lone.width(), lone.height()), (columns * size, 3 * size));
        assert!(RasterTiming::from_design(lone.as_raster().unwrap()).row_words >= 16);
        assert_eq!(lone.lone_unit(), lone);
        assert_eq!(design.rpu_ports(), lone.rcm_ports());
    }
}
