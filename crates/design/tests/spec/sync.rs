// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `hardware.sync`: the positions of its ports, and designs without it.

use foveate_design::{
    ArrayStructure, Design, DesignConfig, PRESETS, Port, PortDirection, PortRole,
};

const ORGANIZATIONS: [&str; 4] = [
    "organization='pipelined'",
    "organization='serial',fold=4",
    "organization='serial',feed='raster'",
    "organization='raster'",
];

fn design(hardware: &str) -> Design {
    let hardware = format!("hardware={{{hardware}}}");
    DesignConfig::from_toml_with("", &[hardware]).unwrap().validate().unwrap()
}

fn names(ports: &[Port]) -> Vec<&str> {
    ports.iter().map(|port| port.name.as_str()).collect()
}

#[test]
fn its_ports_stand_in_front_of_the_array_and_nothing_else_changes() {
    for organization in ORGANIZATIONS {
        let with = design(&format!("{organization},sync=true"));
        let without = design(organization);
        let (ports, plain) = (with.rcm_ports(), without.rcm_ports());
        let place = |role| ports.iter().position(|port| port.role == role).unwrap();
        assert_eq!(place(PortRole::StartOfFrame), place(PortRole::Valid) + 1, "{organization}");
        let (sof, error) =
            (&ports[place(PortRole::StartOfFrame)], &ports[place(PortRole::SyncError)]);
        assert_eq!(
            (sof.name.as_str(), sof.bits(), sof.direction),
            ("sof_i", 1, PortDirection::Input)
        );
        assert_eq!((error.name.as_str(), error.bits()), ("sync_error_o", 1));
        assert_eq!(error.direction, PortDirection::Output);
        let first_output = ports.iter().position(|port| port.direction == PortDirection::Output);
        let inputs = ports.iter().filter(|port| port.direction == PortDirection::Input).count();
        assert_eq!(first_output, Some(inputs), "inputs first: {organization}");
        let others: Vec<&str> = names(&ports)
            .into_iter()
            .filter(|name| !["sof_i", "sync_error_o"].contains(name))
            .collect();
        assert_eq!(others, names(&plain), "{organization}");

        let finds_frames = match with.unit().array {
            ArrayStructure::RpuCopies => false,
            // A lone lane or core is an array, so it has the ports.
            ArrayStructure::SharedLogic => true,
        };
        let unit = with.rpu_ports();
        assert_eq!(names(&unit).contains(&"sof_i"), finds_frames, "{organization}");
        assert_eq!(names(&unit).contains(&"sync_error_o"), finds_frames, "{organization}");

        assert!(with.has_frame_sync() && !without.has_frame_sync());
        assert_eq!(with.timing(), without.timing(), "no clock changes");
        assert!(with.config().hardware.description().ends_with("frame sync"));
        assert!(!without.config().hardware.description().contains("frame sync"));
    }
}

#[test]
fn designs_are_without_it_by_default() {
    for organization in ORGANIZATIONS {
        let (plain, off) = (design(organization), design(&format!("{organization},sync=false")));
        assert_eq!(plain, off);
        assert!(off.config().to_toml().contains("sync = false\n"), "{organization}");
        let with = design(&format!("{organization},sync=true"));
        assert_ne!(with.fingerprint(), plain.fingerprint());
        assert!(with.config().to_toml().contains("sync = true\n"));
    }
}

#[test]
fn only_the_preset_for_video_has_it() {
    for preset in PRESETS {
        let design = preset.config().unwrap().validate().unwrap();
        assert_eq!(design.has_frame_sync(), preset.name == "raster", "{}", preset.name);
    }
}

#[test]
fn what_is_no_truth_value_is_refused() {
    let error = DesignConfig::from_toml("[hardware]\nsync = 1\n").unwrap_err().to_string();
    assert_eq!(error, "`hardware.sync`: 1 is not valid; it takes true or false");
}
