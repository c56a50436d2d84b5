// SPDX-License-Identifier: MIT OR Apache-2.0
//! The negative control: every level with clocks must detect one false bit in its expected outputs,
//! and changed frames.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use foveate_design::{Design, DesignConfig, Preset};
use foveate_pixels::Frame;
use foveate_tools::{Cache, Tool, Toolchain, testing::require_tools};

use super::benchmark_report::LevelRow;
use super::netlist_level::ExternalTools;
use super::pass_timer::PassTimer;
use super::unpacked_inputs::{UnpackedInputs, random_frames};
use super::{functional_levels, netlist_level};
use crate::level::CosimLevel;
use crate::recording::Recording;
use crate::stimulus::Stimulus;

struct ControlCase {
    design: Design,
    frames: Vec<Frame>,
    recording: Recording,
    vectors: UnpackedInputs,
}

impl ControlCase {
    fn new(preset: &str) -> Self {
        Self::with_overrides(preset, &["frame={width=16,height=16}"])
    }

    fn with_overrides(preset: &str, overrides: &[&str]) -> Self {
        let text = Preset::find(preset).unwrap().toml;
        let design = DesignConfig::from_toml_with(text, overrides).unwrap().validate().unwrap();
        let frames = random_frames(&design, 1, 3).unwrap();
        let stimulus = Stimulus {
            level: CosimLevel::Full,
            seed: 1,
            rounds: 0,
            frames: frames.clone(),
            sufficient_clocks: None,
        };
        let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
        let vectors = UnpackedInputs::read(&design, &recording).unwrap();
        Self { design, frames, recording, vectors }
    }

    /// Flips the first bit of an output that is compared at every clock, in the middle of the run.
    fn flip_expected_bit(&self) {
        let path = self.recording.expected_path();
        let mut bytes = std::fs::read(&path).unwrap();
        let layout = self.recording.outputs();
        let always = |at: &usize| {
            let record = bytes[at * layout.record_bytes()..][..layout.record_bytes()].to_vec();
            let mut other = record.clone();
            other[0] ^= 1;
            layout.differing_values(&record, &other) == 1
        };
        let middle = usize::try_from(self.recording.clocks()).unwrap() / 2;
        let at = (middle..).find(always).unwrap();
        bytes[at * layout.record_bytes()] ^= 1;
        std::fs::write(path, bytes).unwrap();
    }

    fn cycle_level_differences(&self, frames: &[Frame], timer: PassTimer<'_>) -> u64 {
        let row = functional_levels::run_cycle_level(
            &self.design,
            frames,
            &self.recording,
            &self.vectors,
            timer,
        );
        differing(&row.unwrap())
    }

    fn rtl_differences(&self, timer: PassTimer<'_>) -> Option<u64> {
        let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
        let tools = ExternalTools { toolchain: &toolchain, cache: &cache };
        require_tools(&[Tool::Verilator, Tool::Cxx]).then(|| {
            let row =
                netlist_level::run_rtl(&self.design, &self.recording, &self.vectors, tools, timer);
            differing(&row.unwrap())
        })
    }
}

fn differing(row: &LevelRow) -> u64 {
    row.measured.as_ref().unwrap().differing
}

#[test]
fn one_false_bit_is_noticed_at_every_level_with_clocks() {
    let cancel = AtomicBool::new(false);
    let timer = PassTimer { min_time: Duration::ZERO, cancel: &cancel };
    for preset in ["paper", "serial"] {
        let case = ControlCase::new(preset);
        assert_eq!(case.cycle_level_differences(&case.frames, timer), 0, "{preset}");
        let mut other = case.frames.clone();
        other.swap(0, 1);
        assert!(case.cycle_level_differences(&other, timer) > 0, "{preset}: other frames");
        case.flip_expected_bit();
        assert!(case.cycle_level_differences(&case.frames, timer) > 0, "{preset}");
        assert_eq!(case.rtl_differences(timer).unwrap_or(1), 1, "{preset}");
    }
}

/// A raster core takes words of two pixels, while earlier ones leave.
#[test]
fn one_false_bit_of_a_raster_core_is_noticed() {
    let cancel = AtomicBool::new(false);
    let timer = PassTimer { min_time: Duration::ZERO, cancel: &cancel };
    let hardware = "hardware={organization=\"raster\",pixels_per_clock=2}";
    let case = ControlCase::with_overrides("paper", &["frame={width=39,height=30}", hardware]);
    assert_eq!(case.cycle_level_differences(&case.frames, timer), 0);
    let mut other = case.frames.clone();
    other.swap(0, 1);
    assert!(case.cycle_level_differences(&other, timer) > 0, "other frames");
    case.flip_expected_bit();
    assert!(case.cycle_level_differences(&case.frames, timer) > 0);
    assert_eq!(case.rtl_differences(timer).unwrap_or(1), 1);
}
