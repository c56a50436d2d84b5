// SPDX-License-Identifier: MIT OR Apache-2.0
//! Functions that read a recording.

use foveate_cosim::{RecordField, RecordLayout, Recording};
use foveate_design::PortRole;
use std::collections::{BTreeMap, BTreeSet};

pub(crate) fn field_of_role(layout: &RecordLayout, role: PortRole) -> &RecordField {
    layout.fields().iter().find(|field| field.port.role == role).unwrap()
}

/// Returns the input and the expected output records, clock by clock.
pub(crate) fn clock_records(recording: &Recording) -> Vec<(Vec<u8>, Vec<u8>)> {
    let inputs = std::fs::read(recording.inputs_path()).unwrap();
    let outputs = std::fs::read(recording.expected_path()).unwrap();
    let inputs = inputs.chunks_exact(recording.inputs().record_bytes());
    let outputs = outputs.chunks_exact(recording.outputs().record_bytes());
    assert_eq!(inputs.len() as u64, recording.clocks());
    assert_eq!(outputs.len() as u64, recording.clocks());
    inputs.zip(outputs).map(|(a, b)| (a.to_vec(), b.to_vec())).collect()
}

/// Returns the value of a port with one lane, or 0 if there is no such port.
pub(crate) fn port_value(layout: &RecordLayout, role: PortRole, record: &[u8]) -> u64 {
    layout.fields().iter().find(|field| field.port.role == role).map_or(0, |f| f.get(record, 0))
}

/// Returns the pairs of successive decisions of a region; the first decision after a reset is
/// paired with `reset`. If all regions are decided at once, only the first region counts.
pub(crate) fn pairs_of_decisions(recording: &Recording) -> BTreeSet<(&'static str, &'static str)> {
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let (mut before, mut found) = (BTreeMap::new(), BTreeSet::new());
    for (input, output) in clock_records(recording) {
        if port_value(inputs, PortRole::Reset, &input) == 1 {
            before.clear();
        }
        let is = |role| port_value(outputs, role, &output) == 1;
        if is(PortRole::DecisionValid) {
            let now = match (is(PortRole::Active), is(PortRole::Srs), is(PortRole::Summary)) {
                (true, _, _) => "active",
                (false, true, _) => "held",
                (false, false, true) => "sent",
                (false, false, false) => "kept",
            };
            let region = port_value(outputs, PortRole::Region, &output);
            found.insert((before.insert(region, now).unwrap_or("reset"), now));
        }
    }
    found
}
