// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pipelined arrays.

use std::collections::BTreeSet;

use foveate_design::{Design, PipelinedTiming};
use foveate_timed::CoreTiming;
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::comparison::{
    PlantedFault, cases, check, event_kinds, found_faults, recordings, with_any_sync,
};
use crate::parameters::arbitrary_parameters;
use crate::traffic::traffic;

fn designs() -> impl Strategy<Value = Design> {
    with_any_sync(arbitrary_parameters().prop_map(|recipe| recipe.design()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(120)))]

    #[test]
    fn every_transaction_of_a_pipelined_array_has_its_clock(
        design in designs(),
        (seed, script) in scripts(),
        traffic in traffic(),
    ) {
        check(&design, traffic, &clip(&design, seed, &script));
    }
}

#[test]
fn random_traffic_of_pipelined_arrays_shows_every_kind_of_event() {
    let expected = ["decision", "error", "mean", "pixels", "reset", "summary"];
    assert_eq!(event_kinds(&recordings(designs(), 40)), BTreeSet::from(expected));
}

#[test]
fn the_comparison_finds_every_wrong_number_of_a_pipelined_array() {
    let recordings = recordings(designs(), 40);
    let faults: [PlantedFault<PipelinedTiming>; 5] = [
        ("a late tail", |timing| timing.tail_delay += 1),
        ("an early tail", |timing| timing.tail_delay = timing.tail_delay.saturating_sub(1)),
        ("a late median", |timing| timing.filter_registers += 1),
        ("an early median", |timing| timing.filter_registers -= 1),
        ("no second pass", |timing| timing.decision_frames = 0),
    ];
    for (name, plant) in faults {
        let faulty = |design: &Design| {
            let mut timing = PipelinedTiming::from_design(design.as_pipelined().unwrap());
            plant(&mut timing);
            CoreTiming::Pipelined(timing)
        };
        assert!(found_faults(&recordings, faulty) > 0, "{name}");
    }
}
