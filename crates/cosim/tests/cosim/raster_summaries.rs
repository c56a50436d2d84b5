// SPDX-License-Identifier: MIT OR Apache-2.0
//! Raster cores whose irrelevant regions send their means: model against emitted RTL, and the
//! contents of their vectors.

use std::collections::BTreeMap;

use crate::common::vectors::{clock_records, pairs_of_decisions, port_value};
use crate::common::{check_agreement, directed_stimulus, has_simulators, in_parallel, in_turn};
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::{Design, DesignConfig, PortRole, ThresholdSource};
use foveate_tools::testing::sample;

fn design(keys: &[&str]) -> Design {
    let own = ["hardware.organization='raster'", "render.irrelevant='mean'"];
    DesignConfig::from_toml_with("", &[keys, &own[..]].concat()).unwrap().validate().unwrap()
}

/// Returns designs with blocks of one pixel and of sides that are no power of two, one to four
/// words per row of a block, and one to sixteen blocks. They include a second pass, raw pixels,
/// `last-sent` references, stores of all kinds, frames that do not fill their last regions, and few
/// waiting rows.
fn designs() -> Vec<Design> {
    [
        &["frame={width=16,height=16,pixel_bits=1}", "region.size=4", "periphery.blocks=4"][..],
        &[
            "frame={width=31,height=10}",
            "region.size=4",
            "hardware={pixels_per_clock=2,pipelining='deep'}",
            "temporal.reference='last-sent'",
            "render.payload='raw'",
        ],
        &[
            "frame={width=35,height=17}",
            "region.size=6",
            "denoise.filter='none'",
            "hardware={store='external',pipelining='deep'}",
            "temporal.level=2",
            "periphery.level=0",
        ],
        &[
            "frame={width=18,height=13}",
            "region={size=3,neighborhood='shared'}",
            "spatial=[{feature='mad'},{feature='variance'}]",
            "temporal={reference='last-sent',min_count=2}",
            "hardware.thresholds='constant'",
        ],
        &[
            "frame={width=62,height=5}",
            "region.size=4",
            "hardware={pixels_per_clock=4,store='single-port'}",
            "periphery.blocks=1",
            "denoise.filter='none'",
        ],
        &[
            "frame={width=32,height=8,pixel_bits=16}",
            "region.size=2",
            "hardware={pixels_per_clock=2,pipelining='deep'}",
            "periphery.blocks=1",
            "spatial=[{feature='variance',min_score=1}]",
            "temporal.min_count=1",
            "denoise.filter='none'",
            "render.payload='raw'",
        ],
        &[
            "frame={width=32,height=24}",
            "denoise.filter='none'",
            "temporal.reference='last-sent'",
            "periphery.level=1",
        ],
    ]
    .map(design)
    .to_vec()
}

#[test]
fn raster_cores_with_summaries_agree() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let designs: Vec<(usize, Design)> = sample(designs().into_iter().enumerate(), 5);
    let failures = in_parallel(&designs, |(number, design)| {
        let folder = output.path().join(design.fingerprint());
        let name = design.config().to_toml();
        let simulator = in_turn(&Simulator::ALL, *number);
        check_agreement(&name, design, simulator, directed_stimulus(CosimLevel::Full, 1), &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Summaries are sent after nothing, pixels, a summary and a lost summary. They stay only after a
/// summary that was sent.
#[test]
fn summaries_are_sent_and_stay_after_every_last_output() {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    enum LastOutput {
        Nothing,
        Pixels,
        Summary,
        LostSummary,
    }
    for design in designs() {
        let recording =
            directed_stimulus(CosimLevel::Full, 1).record(&design, &mut |_, _| {}).unwrap();
        let (inputs, outputs) = (recording.inputs(), recording.outputs());
        let mut last = BTreeMap::new();
        let mut seen = BTreeMap::<(LastOutput, bool), u64>::new();
        for (input, output) in clock_records(&recording) {
            let shown = |role| port_value(outputs, role, &output);
            if port_value(inputs, PortRole::Reset, &input) == 1 {
                last.clear();
                continue;
            }
            if shown(PortRole::LostValid) == 1 {
                let region = shown(PortRole::LostRegion);
                if last.get(&region) == Some(&LastOutput::Summary) {
                    last.insert(region, LastOutput::LostSummary);
                }
            }
            if shown(PortRole::DecisionValid) == 1 {
                let region = shown(PortRole::Region);
                let sends = shown(PortRole::Summary) == 1;
                let before = last.get(&region).copied().unwrap_or(LastOutput::Nothing);
                if shown(PortRole::Srs) == 0 {
                    *seen.entry((before, sends)).or_default() += 1;
                }
                if shown(PortRole::Active) == 1 {
                    last.insert(region, LastOutput::Pixels);
                } else if sends {
                    last.insert(region, LastOutput::Summary);
                }
            }
        }
        let told = format!("{seen:?}\n{}", design.config().to_toml());
        let count = |before, sends| seen.get(&(before, sends)).copied().unwrap_or_default();
        assert!(
            count(LastOutput::Summary, true) > 10 && count(LastOutput::Summary, false) > 10,
            "{told}"
        );
        for before in [LastOutput::Nothing, LastOutput::Pixels] {
            assert!(count(before, true) > 10 && count(before, false) == 0, "{told}");
        }
        // If frames wait for pending regions, nothing is lost; otherwise a lost summary is sent
        // again.
        let waits = design.timing().departure().buffered_rows.is_none();
        assert_eq!(count(LastOutput::LostSummary, true) > 5, !waits, "{told}");
        assert_eq!(count(LastOutput::LostSummary, false), 0, "{told}");
    }
}

/// A summary stays on the screen while its region is held. When the region is irrelevant again, it
/// sends nothing, or means that differ. Constant thresholds cannot be aimed at this case.
#[test]
fn summaries_stay_while_their_regions_are_held() {
    let plain = ["frame={width=16,height=15}", "region.size=4", "denoise.filter='none'"];
    for design in designs().into_iter().chain([design(&plain)]) {
        match design.threshold_source() {
            ThresholdSource::Constant => continue,
            ThresholdSource::Runtime => {}
        }
        let recording =
            directed_stimulus(CosimLevel::Full, 1).record(&design, &mut |_, _| {}).unwrap();
        let pairs = pairs_of_decisions(&recording);
        for pair in [("sent", "held"), ("kept", "held"), ("held", "kept"), ("held", "sent")] {
            assert!(pairs.contains(&pair), "{pair:?}: {pairs:?}\n{}", design.config().to_toml());
        }
    }
}
