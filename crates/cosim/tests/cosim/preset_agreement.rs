// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL for a few designs at every level, in both simulators.
#![allow(clippy::print_stdout, reason = "helpers of tests")]

use crate::common::{cosimulate, design};
use foveate_cosim::{CosimLevel, Simulator, Stimulus};
use foveate_design::{Design, DesignConfig, Organization, PRESETS};
use foveate_pixels::{Scene, SceneParameters};
use foveate_tools::testing::{require_tools, sample};

fn assert_agreement(design: &Design, simulator: Simulator, stimulus: Stimulus, what: &str) {
    if !require_tools(simulator.tools()) {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let replay = output.path().join("replay");
    let report = cosimulate(design, simulator, stimulus, &replay, |_| {}).unwrap();
    assert!(report.passed(), "{what}: {report}");
    println!("{what}: {report}; seconds: {:?}", report.seconds);
}

#[test]
fn every_preset_agrees_at_rpu_level_in_both_simulators() {
    let runs =
        PRESETS.iter().flat_map(|preset| Simulator::ALL.map(|simulator| (preset, simulator)));
    // Nine is odd, so the simulators take turns.
    for (preset, simulator) in sample(runs, 9) {
        let scene = Scene::find("street").unwrap();
        let config = preset.config().unwrap();
        // Every organization takes four regions side by side. Icarus is slow, and every round
        // plays all sequences. So Icarus plays only the street for organizations with many
        // clocks per frame.
        let (rows, rounds) = match (simulator, config.hardware.organization.kind()) {
            (Simulator::Verilator, _) => (3, Stimulus::default().rounds),
            (Simulator::Iverilog, Organization::Pipelined) => (1, 1),
            (Simulator::Iverilog, _) => (1, 0),
        };
        let design = design(&config, (4, rows));
        let (width, height) = (32, 8 * rows);
        let size = SceneParameters { width, height, bits: 8, region_size: 8, frames: 4 };
        let frames = scene.frames(size).collect();
        let stimulus = Stimulus { frames, rounds, ..Stimulus::default() };
        assert_agreement(&design, simulator, stimulus, preset.name);
    }
}

#[test]
fn arrays_agree_on_three_grids() {
    let presets = [
        ("paper", Simulator::Iverilog),
        ("seamless", Simulator::Verilator),
        ("mad", Simulator::Verilator),
        ("fovea", Simulator::Verilator),
    ];
    for (preset, simulator) in sample(presets, 4) {
        let preset = PRESETS.iter().find(|p| p.name == preset).unwrap();
        let design = design(&preset.config().unwrap(), (4, 3));
        for (columns, rows) in [(2, 2), (3, 1), (1, 1)] {
            let level = CosimLevel::Rcm { columns, rows };
            let stimulus = Stimulus { level, rounds: 1, ..Stimulus::default() };
            assert_agreement(&design, simulator, stimulus, preset.name);
        }
    }
}

/// The paper's 28x28 regions, on the street: `cargo test -p foveate-cosim --test cosim whole_array
/// -- --ignored`. The C++ takes 100 s of processor time to build, the model and the simulation a
/// few seconds each. So it is not part of the normal run.
#[test]
#[ignore = "takes minutes to build"]
fn the_whole_array_of_the_paper_agrees() {
    let design = DesignConfig::default().validate().unwrap();
    let scene = Scene::find("street").unwrap();
    let size = SceneParameters { width: 224, height: 224, bits: 8, region_size: 8, frames: 4 };
    let frames = scene.frames(size).collect();
    let stimulus = Stimulus { level: CosimLevel::Full, rounds: 1, frames, ..Stimulus::default() };
    assert_agreement(&design, Simulator::Verilator, stimulus, "full");
}
