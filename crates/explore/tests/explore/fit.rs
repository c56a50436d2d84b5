// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fitting over scenes: the cheapest design that holds, honest when none does.

use std::path::PathBuf;

use foveate_design::Config;
use foveate_explore::{
    Constraints, ExploreError, Fit, FitRequest, Hooks, Progress, Synthesizer, fit,
};
use foveate_footage::InputOptions;
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::{Cache, Tool, Toolchain};

struct Quiet;

impl Hooks for Quiet {
    fn progress(&self, _: Progress) {}

    fn cancelled(&self) -> bool {
        false
    }
}

struct Cancelled;

impl Hooks for Cancelled {
    fn progress(&self, _: Progress) {}

    fn cancelled(&self) -> bool {
        true
    }
}

fn run(frames: u32, constraints: &Constraints, hooks: &dyn Hooks) -> Result<Fit, ExploreError> {
    let task = "[frame]\nwidth = 32\nheight = 24\n[temporal]\nreference = \"last-sent\"\n";
    fit(
        &FitRequest {
            task: &Config::from_toml(task).unwrap(),
            inputs: &[PathBuf::from("scene:street")],
            input: &InputOptions { frames: Some(frames), ..InputOptions::default() },
            constraints,
            clock_hz: 1_000_000,
            target_active: None,
            synthesizer: &Synthesizer {
                toolchain: Toolchain::system(),
                cache: Cache::from_env().unwrap(),
            },
            most: 2,
        },
        hooks,
    )
}

#[test]
fn the_design_holds_what_was_asked_and_is_one() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let constraints = Constraints {
        max_flips: Some(0.0),
        min_fps: Some(50.0),
        max_lut: Some(200),
        ..Constraints::default()
    };
    let found = run(8, &constraints, &Quiet).unwrap();
    assert_eq!(found.frames, (4, 4));
    assert!(found.feasible && found.binding.is_empty(), "{:?}", found.design.fitted_held);
    let design = &found.design;
    assert!(design.fitted.action_flips == 0.0 && design.silicon.unit.lut_total_packed <= 200);
    assert_eq!(design.fitted.frames, 4);
    assert_eq!(design.held_out.frames, 4);
    assert!(design.frames_per_second >= 50.0);
    // What is written is the design that was measured.
    let read = Config::from_toml(&design.toml).unwrap().validate().unwrap();
    assert_eq!(read.timing().clocks_per_frame(), design.clocks_per_frame);
    assert_eq!(found.borne_out, design.held_out_held.iter().all(|held| held.holds));
    assert!(found.why.iter().any(|line| line.contains("regions")), "{:?}", found.why);
}

#[test]
fn where_nothing_holds_it_says_what_binds() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let constraints = Constraints {
        max_flips: Some(0.0),
        min_fps: Some(50.0),
        max_lut: Some(1),
        ..Constraints::default()
    };
    let found = run(8, &constraints, &Quiet).unwrap();
    assert!(!found.feasible);
    assert_eq!(found.binding, ["max-lut"]);
    let broken: Vec<_> = found.design.fitted_held.iter().filter(|held| !held.holds).collect();
    assert!(matches!(broken.as_slice(), [held] if held.name == "max-lut"), "{broken:?}");
}

#[test]
fn a_clip_must_have_halves_and_a_run_can_be_stopped() {
    let short = run(3, &Constraints::default(), &Quiet).unwrap_err();
    assert!(matches!(short, ExploreError::Short { frames: 3, .. }), "{short}");
    let stopped = run(8, &Constraints::default(), &Cancelled).unwrap_err();
    assert!(matches!(stopped, ExploreError::Cancelled), "{stopped}");
}
