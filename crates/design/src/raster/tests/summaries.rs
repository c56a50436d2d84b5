// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the additions of a periphery to a core, and of the keys that it can be combined with.

use super::{config, design, refusal};
use crate::raster::{RasterMemory, RasterTiming};
use crate::{OutputQualifier, PortDirection, PortRole};

const MEAN: &str = "render.irrelevant=mean";

#[test]
fn a_word_lies_in_one_block_and_means_have_to_leave() {
    let side = "a word must lie in one block of";
    for (more, message) in [
        (
            ["hardware.pixels_per_clock=4", "periphery.blocks=4"],
            format!(
                "`hardware.pixels_per_clock` = 4 cannot be combined with periphery.blocks = 4; \
                 {side} 2x2 pixels; use fewer pixels, or fewer blocks"
            ),
        ),
        (
            ["hardware.pixels_per_clock=2", "region.size=6"],
            format!(
                "`hardware.pixels_per_clock` = 2 cannot be combined with periphery.blocks = 2; \
                 {side} 3x3 pixels; use fewer pixels, or fewer blocks"
            ),
        ),
        (
            ["hardware.pixels_per_clock=1", "hardware.forward=false"],
            "`hardware.forward` = false cannot be combined with render.irrelevant = \"mean\"; the \
             screen shows only what leaves the core; leave the key out, or set another \
             render.irrelevant"
                .to_owned(),
        ),
    ] {
        assert_eq!(refusal(&[MEAN, more[0], more[1]]), message);
    }
    for (pixels, blocks) in [(1, 4), (2, 4), (4, 2), (4, 1)] {
        let keys = [
            format!("hardware.pixels_per_clock={pixels}"),
            format!("periphery.blocks={blocks}"),
            "hardware.store=external".to_owned(),
        ];
        let [first, second, third] = keys.each_ref().map(String::as_str);
        design(&[MEAN, first, second, third]);
    }
}

/// The periphery adds a threshold, a flag of the decision and a flag of the words. All other ports
/// are the same.
#[test]
fn ports_tell_means_from_pixels() {
    let own = [
        (
            "summary_level_i",
            PortDirection::Input,
            PortRole::SummaryLevel,
            OutputQualifier::Always,
            8,
        ),
        ("summary_o", PortDirection::Output, PortRole::Summary, OutputQualifier::Always, 1),
        (
            "forward_summary_o",
            PortDirection::Output,
            PortRole::ForwardSummary,
            OutputQualifier::WhileSet(PortRole::ForwardValid),
            1,
        ),
    ];
    let ports = design(&[MEAN]).rcm_ports();
    for (name, direction, role, qualifier, bits) in own {
        let port = ports.iter().find(|port| port.name == name).unwrap();
        assert_eq!((port.direction, port.role, port.bits()), (direction, role, bits));
        assert_eq!(port.qualifier, qualifier);
    }
    let named = |design: &crate::Design| -> Vec<String> {
        design.rcm_ports().into_iter().map(|port| port.name).collect()
    };
    let mut others = named(&design(&[MEAN]));
    others.retain(|name| own.iter().all(|(new, ..)| name != new));
    assert_eq!(others, named(&design(&[])));
    let constant = named(&design(&[MEAN, "hardware.thresholds=constant"]));
    assert!(!constant.contains(&"summary_level_i".to_owned()));
}

#[test]
fn numbers_are_those_without_but_for_low_frames_which_wait() {
    let timing = |more: &[&str]| RasterTiming::from_design(design(more).as_raster().unwrap());
    for more in [&["hardware.pipelining=deep"][..], &["spatial=[{feature=\"mad\"}]"], &[]] {
        let with = timing(&[&[MEAN], more].concat());
        assert_eq!(with.summary_words, Some(4));
        assert_eq!(RasterTiming { summary_words: None, ..with }, timing(more));
    }
    let waits = |height: u32, feature: &str| {
        let keys = [format!("frame.height={height}"), format!("spatial.0.feature={feature}")];
        timing(&[MEAN, &keys[0], &keys[1]]).waits_for_pending
    };
    assert!(waits(16, "edge") && !waits(24, "edge"));
    let mad = |height: &str| timing(&[MEAN, height, "spatial=[{feature=\"mad\"}]"]);
    assert!(mad("frame.height=24").waits_for_pending && !mad("frame.height=32").waits_for_pending);
    for (blocks, words) in [(1, 1), (2, 4), (4, 16)] {
        let answers = design(&[MEAN, &format!("periphery.blocks={blocks}")]).timing();
        assert!(answers.figures().contains(&("summary_words", words)));
    }
    let without = design(&[]).timing();
    assert!(without.figures().iter().all(|(name, _)| *name != "summary_words"));
}

/// A summary never takes the readout longer than the pixels of a region, so the bound on stalls
/// holds.
#[test]
fn a_summary_has_no_more_words_than_a_region() {
    let sizes = [2, 3, 4, 6, 8, 12, 16];
    let all = sizes.iter().flat_map(|&size| {
        [1, 2, 4].into_iter().flat_map(move |blocks| [1, 2, 4].map(|pixels| (size, blocks, pixels)))
    });
    let mut taken = 0;
    for (size, blocks, pixels) in all {
        let keys = [
            format!("region.size={size}"),
            format!("periphery.blocks={blocks}"),
            format!("hardware.pixels_per_clock={pixels}"),
        ];
        let [size, blocks, pixels] = keys.each_ref().map(String::as_str);
        let least = ["temporal.min_count=1", "spatial.0.min_score=1"];
        let overrides = [&[MEAN, size, blocks, pixels][..], &least].concat();
        if let Ok(design) = config(&overrides).validate() {
            let timing = RasterTiming::from_design(design.as_raster().unwrap());
            let words = timing.summary_words.unwrap();
            assert!(words.max(2) <= timing.region_words, "{overrides:?}");
            taken += 1;
        }
    }
    assert_eq!(taken, 36);
}

/// The frame has 64x64 pixels in regions of 8x8. Sums of 4x4 pixels have 12 bits, and a queue entry
/// stores whether the region sends means.
#[test]
fn memories_of_means() {
    let of = |more: &[&str]| {
        let frame = ["frame.width=64", "frame.height=64"];
        let memories =
            RasterMemory::all_memories(design(&[&frame, more].concat()).as_raster().unwrap());
        memories.iter().map(|memory| (memory.words, memory.bits)).collect::<Vec<_>>()
    };
    let plain = of(&[]);
    let (queue, others) = plain.split_last().unwrap();
    let means = [(16, 13), (8 * 2 * 4, 8), (64 * 4, 8), (64, 1), (64, 1)];
    assert_eq!(of(&[MEAN]), [others, &[(queue.0, queue.1 + 1)], &means].concat());
    let mad = "spatial=[{feature=\"mad\"}]";
    let (with, without) = (of(&[MEAN, mad]), of(&[mad]));
    assert_eq!(with[without.len() - 1], (32, without.last().unwrap().1 + 2));
    assert_eq!(with[without.len()..], [(16, 13), (8 * 4 * 4, 8), (64 * 4, 8), (64, 1), (64, 1)]);
}
