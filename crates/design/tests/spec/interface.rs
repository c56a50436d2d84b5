// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the streams and controls of an interface contain every port exactly once.

use foveate_design::{
    BeatRegion, CoreInterface, CoreStream, Design, DesignConfig, OutputQualifier, Port,
    PortDirection, PortRole, StreamRole,
};
use std::collections::BTreeSet;

const DESIGNS: [&str; 12] = [
    "organization='pipelined'",
    "organization='pipelined',sync=true",
    "organization='pipelined',thresholds='constant'",
    "organization='serial'",
    "organization='serial',fold=4,sync=true",
    "organization='serial',feed='raster'",
    "organization='serial',feed='raster',fold=4,thresholds='constant'",
    "organization='raster'",
    "organization='raster',sync=true,pixels_per_clock=2",
    "organization='raster',forward=false",
    "organization='raster',store='external'",
    "organization='raster',store='external',forward=false,thresholds='constant'",
];

fn design(hardware: &str) -> Design {
    let overrides = [
        format!("hardware={{{hardware}}}"),
        "region.neighborhood='shared'".to_owned(),
        "frame={width=32,height=24}".to_owned(),
    ];
    DesignConfig::from_toml_with("", &overrides).unwrap().validate().unwrap()
}

/// Returns the interfaces of both modules, `rpu` and `rcm`, of every design.
fn interfaces() -> impl Iterator<Item = (&'static str, Design, CoreInterface)> {
    DESIGNS.iter().flat_map(|&hardware| {
        let design = design(hardware);
        let both = [design.rpu_interface(), design.rcm_interface()];
        both.map(|interface| (hardware, design.clone(), interface))
    })
}

fn beat_ports(stream: &CoreStream) -> impl Iterator<Item = &Port> {
    stream.start.iter().chain(&stream.payload)
}

#[test]
fn every_port_is_there_once_and_goes_where_its_stream_says() {
    for (hardware, _, interface) in interfaces() {
        let ports = interface.ports();
        let names: BTreeSet<&str> = ports.iter().map(|port| port.name.as_str()).collect();
        assert_eq!(names.len(), ports.len(), "{hardware}");
        let mut counted = 2 + interface.controls.len();
        for stream in &interface.streams {
            let (with, against) = match stream.direction {
                PortDirection::Input => (PortDirection::Input, PortDirection::Output),
                PortDirection::Output => (PortDirection::Output, PortDirection::Input),
            };
            let is = |direction| move |port: &Port| port.direction == direction;
            assert!(is(with)(&stream.valid) && beat_ports(stream).all(is(with)), "{hardware}");
            assert!(stream.ready.iter().all(is(against)), "{hardware}");
            assert!(stream.status.iter().all(is(PortDirection::Output)), "{hardware}");
            counted += 1 + beat_ports(stream).count() + stream.status.len();
            counted += usize::from(stream.ready.is_some());
        }
        assert_eq!(counted, ports.len(), "{hardware}");
        assert!(interface.controls.iter().all(|port| port.direction == PortDirection::Input));
    }
}

/// An output that does not always have a meaning has one with the beat that it is a part of. The
/// region of a decision may be on a port of the stream of scores.
#[test]
fn payload_means_something_with_its_own_beat() {
    for (hardware, _, interface) in interfaces() {
        for stream in &interface.streams {
            for port in beat_ports(stream) {
                match port.qualifier {
                    OutputQualifier::Always => {}
                    OutputQualifier::WhileSet(role) => {
                        assert_eq!(role, stream.valid.role, "{hardware}");
                    }
                }
            }
            let others = stream.ready.iter().chain(&stream.status);
            assert!(others.chain([&stream.valid]).all(|p| p.qualifier == OutputQualifier::Always));
            let has = |role| stream.payload.iter().any(|port| port.role == role);
            assert!(stream.last.is_none_or(has), "{hardware}");
            let named = match stream.region {
                BeatRegion::None | BeatRegion::Lane => continue,
                BeatRegion::Slot(role) | BeatRegion::Number(role) => role,
            };
            let scores = interface.stream(StreamRole::Scores);
            let beside =
                scores.is_some_and(|scores| scores.payload.iter().any(|p| p.role == named));
            assert!(has(named) || beside, "{hardware}: {named:?}");
        }
    }
}

/// The streams of each organization, by the contract.
#[test]
fn streams_are_those_of_the_organization() {
    use StreamRole::{
        Decisions, ForwardedPixels, LostRegions, Pixels, References, Scores, StoredWords,
    };
    let roles = |hardware: &str| -> Vec<StreamRole> {
        design(hardware).rcm_interface().streams.iter().map(|stream| stream.role).collect()
    };
    assert_eq!(roles("organization='pipelined'"), [Pixels, Decisions, ForwardedPixels]);
    assert_eq!(roles("organization='serial'"), [Pixels, Scores, Decisions, ForwardedPixels]);
    assert_eq!(roles("organization='raster'"), [Pixels, Decisions, ForwardedPixels, LostRegions]);
    assert_eq!(
        roles("organization='raster',store='external',forward=false"),
        [Pixels, References, StoredWords, Decisions]
    );
    let ready = |hardware, role| {
        let interface = design(hardware).rcm_interface();
        interface.stream(role).unwrap().ready.as_ref().map(|port| port.name.clone())
    };
    assert_eq!(ready("organization='pipelined'", Pixels), None);
    assert_eq!(ready("organization='serial'", Pixels).unwrap(), "ready_o");
    assert_eq!(ready("organization='serial'", ForwardedPixels), None);
    assert_eq!(ready("organization='raster'", ForwardedPixels).unwrap(), "forward_ready_i");
}

#[test]
fn a_port_is_of_one_stream_and_controls_are_of_none() {
    for (hardware, design, interface) in interfaces() {
        for stream in &interface.streams {
            for port in beat_ports(stream).chain([&stream.valid]).chain(&stream.status) {
                let found = interface.stream_with_port(port.role).unwrap();
                assert_eq!(found.role, stream.role, "{hardware}: {}", port.name);
            }
        }
        for port in &interface.controls {
            assert!(interface.stream_with_port(port.role).is_none(), "{hardware}: {}", port.name);
        }
        let thresholds = |port: &&Port| port.role != PortRole::Border;
        let expected = match design.threshold_source() {
            foveate_design::ThresholdSource::Runtime => 4,
            foveate_design::ThresholdSource::Constant => 0,
        };
        assert_eq!(interface.controls.iter().filter(thresholds).count(), expected, "{hardware}");
    }
}
