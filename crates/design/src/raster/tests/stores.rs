// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the kinds of frame stores, and of a core without forwarding.

use super::{config, design, refusal};
use crate::raster::RasterTiming;
use crate::{Design, FrameStoreKind, OutputQualifier, PortDirection, PortRole};

const LAST_SENT: &str = "temporal.reference=last-sent";

#[test]
fn stores_without_a_second_port_and_cores_that_forward_nothing_need_the_previous_frame() {
    let reference = "cannot be combined with temporal.reference = \"last-sent\"";
    for store in ["single-port", "external"] {
        let key = format!("hardware.store={store}");
        assert_eq!(
            refusal(&[&key, LAST_SENT]),
            format!(
                "`hardware.store` = \"{store}\" {reference}; it also writes regions that leave \
                 while others come, for which such a store has no port; use \"block\" or \
                 \"ultra\", or reference = \"previous\""
            )
        );
        design(&[&key]);
    }
    assert_eq!(
        refusal(&["hardware.forward=false", LAST_SENT]),
        format!(
            "`hardware.forward` = false {reference}; its references are the pixels that leave; \
             leave the key out, or use reference = \"previous\""
        )
    );
    for key in ["hardware.store=block", "hardware.store=ultra", "hardware.forward=true"] {
        design(&[key, LAST_SENT]);
    }
    design(&["hardware.forward=false", "hardware.store=external"]);
}

#[test]
fn only_a_raster_core_has_the_keys() {
    for organization in ["pipelined", "serial"] {
        let other = format!("hardware.organization={organization}");
        for (key, value) in [("store", "\"external\""), ("forward", "false"), ("forward", "true")] {
            assert_eq!(
                refusal(&[&other, &format!("hardware.{key}={value}")]),
                format!(
                    "`hardware.{key}` = {value} cannot be combined with organization = \
                     \"{organization}\"; only the raster organization has this key; leave the key out, or \
                     use organization = \"raster\""
                )
            );
        }
        assert!(design(&[&other]).has_forwarding());
    }
    let error = crate::DesignConfig::from_toml_with("", &["hardware.forward=1"]).unwrap_err();
    assert_eq!(error.to_string(), "`hardware.forward`: 1 is not valid; it takes true or false");
}

#[test]
fn forwarding_is_the_default() {
    let plain = design(&[]);
    let named = design(&["hardware.forward=true"]);
    assert_eq!((named.fingerprint(), named.config()), (plain.fingerprint(), plain.config()));
    assert!(plain.has_forwarding() && plain.config().to_toml().contains("forward = true"));
    let alone = design(&["hardware.forward=false", "hardware.store=external"]);
    assert!(
        !alone.has_forwarding() && alone.as_raster().unwrap().store() == FrameStoreKind::External
    );
    assert_eq!(
        alone.config().hardware.description(),
        "raster, 1 pixel per clock, plain pipelining, external store, no forwarding"
    );
    let again = crate::DesignConfig::from_toml(&alone.config().to_toml()).unwrap();
    assert_eq!(again, alone.config());
    let prints: std::collections::BTreeSet<String> = ["block", "ultra", "single-port", "external"]
        .iter()
        .flat_map(|store| ["true", "false"].map(|forward| (store, forward)))
        .map(|(store, forward)| {
            let keys = [format!("hardware.store={store}"), format!("hardware.forward={forward}")];
            config(&keys.each_ref().map(String::as_str)).validate().unwrap().fingerprint()
        })
        .collect();
    assert_eq!(prints.len(), 8);
}

fn named(design: &Design, direction: PortDirection) -> Vec<(String, u32)> {
    let ports = design.rcm_ports();
    let own = ports.iter().filter(|port| port.direction == direction);
    own.map(|port| (port.name.clone(), port.bits())).collect()
}

/// Returns the ports of a core for 64x40 pixels in words of four pixels: 8x5 regions.
fn ports_of(more: &[&str], direction: PortDirection) -> Vec<(String, u32)> {
    let own = [
        "frame.width=64",
        "frame.height=40",
        "hardware.pixels_per_clock=4",
        "hardware.thresholds=constant",
    ];
    named(&design(&[&own, more].concat()), direction)
}

#[test]
fn a_store_outside_has_two_streams() {
    let more = ["hardware.store=external"];
    let inputs = [
        ("clk_i", 1),
        ("rst_i", 1),
        ("valid_i", 1),
        ("pixel_i", 32),
        ("reference_valid_i", 1),
        ("reference_pixel_i", 32),
        ("forward_ready_i", 1),
    ];
    let own = |list: &[(&str, u32)]| -> Vec<(String, u32)> {
        list.iter().map(|&(name, bits)| (name.to_owned(), bits)).collect()
    };
    assert_eq!(ports_of(&more, PortDirection::Input), own(&inputs));
    let outputs = [
        ("ready_o", 1),
        ("reference_ready_o", 1),
        ("underrun_o", 1),
        ("store_valid_o", 1),
        ("store_pixel_o", 32),
        ("store_last_o", 1),
        ("decision_valid_o", 1),
        ("region_o", 6),
        ("srs_o", 1),
        ("trs_o", 1),
        ("active_o", 1),
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
    assert_eq!(ports_of(&more, PortDirection::Output), own(&outputs));
    for port in design(&more).rcm_ports() {
        let is_stored = matches!(port.role, PortRole::StorePixel | PortRole::StoreLast);
        let with_store = port.qualifier == OutputQualifier::WhileSet(PortRole::StoreValid);
        assert_eq!(is_stored, with_store, "{}", port.name);
        let is_streamed = port.name.starts_with("reference") || port.name == "underrun_o";
        assert!(!is_streamed || port.qualifier == OutputQualifier::Always, "{}", port.name);
    }
    // The ports do not depend on the kind of a store inside of the core.
    for direction in [PortDirection::Input, PortDirection::Output] {
        let block = ports_of(&[], direction);
        for store in ["ultra", "single-port"] {
            assert_eq!(ports_of(&[&format!("hardware.store={store}")], direction), block);
        }
    }
}

#[test]
fn without_forwarding_decisions_are_all_that_leaves() {
    let more = ["hardware.forward=false"];
    for direction in [PortDirection::Input, PortDirection::Output] {
        let mut whole = ports_of(&[], direction);
        whole.retain(|(name, _)| !name.starts_with("forward_") && !name.starts_with("lost_"));
        assert_eq!(ports_of(&more, direction), whole);
    }
    assert_eq!(ports_of(&more, PortDirection::Output).len(), 8);
}

/// A core without forwarding has the numbers of a core with forwarding, except those of the buffer
/// and of the last word.
#[test]
fn numbers_follow_the_store_and_forwarding() {
    let timing = |more: &[&str]| RasterTiming::from_design(design(more).as_raster().unwrap());
    let plain = timing(&[]);
    for store in ["ultra", "single-port", "external"] {
        assert_eq!(timing(&[&format!("hardware.store={store}")]), plain);
    }
    let alone = timing(&["hardware.forward=false"]);
    assert_eq!(alone, RasterTiming { buffer_rows: 0, has_forwarding: false, ..plain });
    let mad = "spatial=[{feature=\"mad\"}]";
    assert_eq!(timing(&["hardware.forward=false", mad]).buffer_rows, 3);
    // The lookup latency is S - 1, and S - 2 in a deep core.
    assert_eq!((plain.store_latency, plain.lookup_latency), (7, 6));
    let deep = timing(&["hardware.pipelining=deep"]);
    assert_eq!((deep.store_latency, deep.lookup_latency), (16, 14));
    let least = timing(&["denoise.filter=none", mad]);
    assert_eq!((least.store_latency, least.lookup_latency), (2, 1));

    let answers = design(&["hardware.forward=false"]).timing();
    let departure = answers.departure();
    assert_eq!(departure.forward_clocks, departure.decision_clocks);
    let leaves = answers.descriptions().iter().find(|(heading, _)| *heading == "pixels leave");
    assert_eq!(
        leaves.map(|(_, text)| text.as_str()),
        Some("never: only decisions leave this core")
    );
}

#[test]
fn the_lone_core_keeps_its_store() {
    let lone = design(&["hardware.store=external", "hardware.forward=false"]).lone_unit();
    assert!(
        !lone.has_forwarding() && lone.as_raster().unwrap().store() == FrameStoreKind::External
    );
}
