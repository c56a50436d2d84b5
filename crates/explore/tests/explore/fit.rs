// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fits over scenes: the cheapest design that meets the limits, and a clear answer if none does.

use std::path::{Path, PathBuf};

use foveate_design::{Design, DesignConfig};
use foveate_emit::Top;
use foveate_engine::Engine;
use foveate_estimate::{EstimateJob, estimate};
use foveate_explore::{
    ConstraintCheck, Constraints, CostObjective, ExploreError, FitRequest, FitResult, NetworkGoal,
    Synthesizer, fit,
};
use foveate_inference::{Framing, PixelMapping, VisionOptions};
use foveate_media::{
    InputError, InputOptions, PlaybackError, RunHooks, SilentHooks, open, testing::RecordingHooks,
};
use foveate_tools::{
    Cache, Tool, Toolchain,
    testing::{require_tools, takes_whole_lists},
};

/// The number of frames of most fits: with fewer, a part of them has too few regions to decide.
const FRAMES: u32 = 30;

fn run(
    frames: u32,
    constraints: &Constraints,
    most: usize,
    hooks: &dyn RunHooks,
) -> Result<FitResult, ExploreError> {
    run_with(&[], frames, constraints, Some(1_000_000), most, hooks)
}

fn run_with(
    boxes: &[PathBuf],
    frames: u32,
    constraints: &Constraints,
    clock_hz: Option<u64>,
    most: usize,
    hooks: &dyn RunHooks,
) -> Result<FitResult, ExploreError> {
    let task = "[frame]\nwidth = 32\nheight = 24\n[temporal]\nreference = \"last-sent\"\n";
    fit(
        &FitRequest {
            task: &DesignConfig::from_toml(task).unwrap(),
            inputs: &[PathBuf::from("scene:street")],
            input: &InputOptions { frames: Some(frames), ..InputOptions::default() },
            constraints,
            clock_hz,
            disturbance: None,
            target_active: None,
            boxes,
            cheapest: CostObjective::Area,
            process: None,
            network: None,
            synthesizer: &Synthesizer {
                toolchain: Toolchain::system(),
                cache: Cache::from_env().unwrap(),
            },
            max_designs: most,
        },
        hooks,
    )
}

/// Fits the cheapest design to the denoiser on frames of 48x32 pixels; the network sees `frames`
/// frames of each part.
fn fit_to_denoiser(
    input: &Path,
    frames: u32,
    min_agreement: f64,
    cheapest: CostObjective,
    max_bytes: Option<f64>,
) -> FitResult {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
    let mapping = PixelMapping { mean: vec![0.0], scale: vec![1.0] };
    let vision_options = VisionOptions { framing: Framing::Same, mapping, detector: None };
    let task = "[frame]\nwidth = 48\nheight = 32\n[temporal]\nreference = \"last-sent\"\n";
    let request = FitRequest {
        task: &DesignConfig::from_toml(task).unwrap(),
        inputs: &[input.to_owned()],
        input: &InputOptions { frames: Some(4 * frames), ..InputOptions::default() },
        constraints: &Constraints { max_bytes, ..Constraints::default() },
        clock_hz: Some(1_000_000),
        disturbance: None,
        target_active: None,
        boxes: &[],
        cheapest,
        process: None,
        network: Some(NetworkGoal {
            path: Path::new(path),
            vision_options: &vision_options,
            min_agreement,
            frames: frames.into(),
        }),
        synthesizer: &Synthesizer {
            toolchain: Toolchain::system(),
            cache: Cache::from_env().unwrap(),
        },
        max_designs: 1,
    };
    fit(&request, &SilentHooks).unwrap()
}

/// The denoiser's outputs behind the camera must be near those of whole frames, with as few bytes
/// as possible. If no camera reaches that, the fit says so.
#[test]
fn a_network_cannot_tell_the_design_from_whole_frames() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let fitted = |min_agreement, cheapest, max_bytes| {
        fit_to_denoiser(Path::new("scene:street"), 3, min_agreement, cheapest, max_bytes)
    };
    let found = fitted(0.9, CostObjective::Bytes, None);
    let network = found.network.as_ref().unwrap();
    assert!(found.feasible && network.fitted.expected >= 0.9, "{network:?}");
    assert!(network.confirmed.expected >= 0.9, "{network:?}");
    let frames = [network.fitted, network.confirmed, network.held_out].map(|agreed| agreed.frames);
    assert_eq!(frames, [3, 2, 3]);
    assert_eq!(network.bytes_per_whole_frame, 48.0 * 32.0);
    assert!(found.design.bytes_per_frame.0 < 48.0 * 32.0, "{:?}", found.design.bytes_per_frame);
    let held = found.design.held_out_held.iter().find(|held| held.name == "min-agreement").unwrap();
    assert_eq!((held.value, held.limit), (network.held_out.share, 0.9));
    // More agreement costs more bytes.
    let near = fitted(0.97, CostObjective::Bytes, None);
    assert!(near.design.bytes_per_frame.0 > found.design.bytes_per_frame.0);
    let agreed = near.network.as_ref().unwrap().fitted;
    assert!(agreed.share > agreed.expected && agreed.expected >= 0.97, "{agreed:?}");
    assert!(near.why.iter().any(|line| line.contains(": agreement ")), "{:?}", near.why);
    if !takes_whole_lists() {
        return;
    }
    // The limit of 8 bytes leaves room for little more than two bits for each of 24 regions.
    let none = fitted(0.9, CostObjective::Area, Some(8.0));
    assert!(!none.feasible);
    let held = |name| none.design.fitted_held.iter().find(|held| held.name == name).unwrap().holds;
    assert!(!held("max-bytes") || !held("min-agreement"), "{:?}", none.design.fitted_held);
}

/// The frames that cameras are searched by do not change. Later a square moves, and a camera that
/// does not see a change of its size is not confirmed.
#[test]
fn a_camera_that_only_the_searched_frames_agree_with_is_not_confirmed() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for number in 0..36_usize {
        let square = number.checked_sub(12).map(|since| 3 * since % 40);
        let pixel = |x: usize, y: usize| {
            let inside =
                square.is_some_and(|left| (left..left + 8).contains(&x) && (10..18).contains(&y));
            if inside { 170 } else { [60, 65, 70, 75, 80][(x / 4 + y / 4) % 5] }
        };
        let pixels = (0..32).flat_map(|y| (0..48).map(move |x| (x, y)));
        let file =
            [b"P5\n48 32\n255\n".to_vec(), pixels.map(|(x, y)| pixel(x, y)).collect()].concat();
        std::fs::write(dir.path().join(format!("{number:02}.pgm")), file).unwrap();
    }
    let found = fit_to_denoiser(dir.path(), 9, 0.9, CostObjective::Bytes, None);
    let network = found.network.as_ref().unwrap();
    assert!(found.feasible && network.confirmed.expected >= 0.9, "{network:?}");
    assert!(network.held_out.share >= 0.9, "{network:?}");
    let is_told = |line: &String| line.starts_with("later frames did not confirm ");
    assert!(found.why.iter().any(is_told), "{:?}", found.why);
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
    let found = run(FRAMES, &constraints, 2, &SilentHooks).unwrap();
    assert_eq!(found.frames, (15, 15));
    assert!(found.feasible && found.binding.is_empty(), "{:?}", found.design.fitted_held);
    let design = &found.design;
    assert!(design.fitted.action_flips == 0.0 && design.silicon.unit.lut_total_packed <= 200);
    assert_eq!(design.fitted.frames, 15);
    assert_eq!(design.held_out.frames, 15);
    assert!(design.speed.unwrap().frames_per_second >= 50.0);
    // The written configuration is the design that was measured.
    let read = DesignConfig::from_toml(&design.toml).unwrap().validate().unwrap();
    assert_eq!(read.timing().clocks_per_frame(), design.clocks_per_frame);
    assert_eq!(found.borne_out, design.held_out_held.iter().all(|held| held.holds));
    assert!(found.why.iter().any(|line| line.contains("regions")), "{:?}", found.why);
    // A raster core has no unit of 200 LUTs, and the reasons say so.
    let raster = found.why.iter().find(|line| line.starts_with("raster, 1 pixel per clock"));
    assert!(raster.is_some_and(|line| line.contains("LUTs of a unit")), "{:?}", found.why);
}

/// The rate is checked at the low end of the clock of the netlist.
#[test]
#[ignore = "two designs are synthesized; scripts/release.sh whole runs it"]
fn without_a_clock_the_rate_is_that_of_the_synthesized_design() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let min_fps = 2000.0;
    let constraints = Constraints { min_fps: Some(min_fps), ..Constraints::default() };
    let found = run_with(&[], FRAMES, &constraints, None, 1, &SilentHooks).unwrap();
    let design = &found.design;
    let chosen = design.config.validate().unwrap();
    let tools = (Toolchain::system(), Cache::from_env().unwrap());
    let report = estimate(&tools.0, &tools.1, &EstimateJob::for_design(&chosen, Top::Rcm)).unwrap();
    let clock = report.clock.unwrap();
    let clocks = |design: &Design| u32::try_from(design.timing().clocks_per_frame()).unwrap();
    let rate = |design: &Design| clock.low_mhz * 1e6 / f64::from(clocks(design));
    assert!(found.feasible && rate(&chosen) >= min_fps, "{found:?}");
    let held = design.fitted_held.iter().find(|held| held.name == "min-fps").unwrap();
    assert_eq!((held.value, held.clock_mhz), (rate(&chosen), Some(clock.low_mhz)));
    assert_eq!(design.speed.unwrap().clock_mhz, clock.mhz);

    let impossible = Constraints { min_fps: Some(1e8), ..Constraints::default() };
    let found = run_with(&[], FRAMES, &impossible, None, 1, &SilentHooks).unwrap();
    assert!(!found.feasible && found.binding == ["min-fps"], "{:?}", found.binding);
}

#[test]
#[ignore = "a design is synthesized; scripts/release.sh whole runs it"]
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
    let found = run(FRAMES, &constraints, 1, &SilentHooks).unwrap();
    assert!(!found.feasible);
    assert_eq!(found.binding, ["max-lut"]);
    let broken: Vec<_> = found.design.fitted_held.iter().filter(|held| !held.holds).collect();
    assert!(matches!(broken.as_slice(), [held] if held.name == "max-lut"), "{broken:?}");
}

#[test]
fn a_clip_must_have_halves_and_a_run_can_be_stopped() {
    let short = run(3, &Constraints::default(), 1, &SilentHooks).unwrap_err();
    let ExploreError::Playback(short) = short else { panic!("{short}") };
    assert!(
        matches!(short.as_input(), Some(InputError::TooFewFrames { frames: 3, .. })),
        "{short}"
    );
    let stopped =
        run(8, &Constraints::default(), 1, &RecordingHooks::cancelling_after(0)).unwrap_err();
    assert!(matches!(stopped, ExploreError::Playback(PlaybackError::Interrupted)), "{stopped}");
}

/// Two objects in every frame: squares of 8 pixels in the lower corners, which are sometimes sent.
const BOXES: [[u32; 2]; 2] = [[0, 16], [24, 16]];

/// Returns the recall of a design, counted over frames of the clip without its first frame.
fn counted(design: &Design, frames: std::ops::Range<usize>) -> f64 {
    let options = InputOptions { frames: Some(FRAMES), ..InputOptions::default() };
    let mut source = open(&["scene:street"], design.camera().config(), &options).unwrap();
    let mut engine = Engine::new(design);
    let (mut all, mut sent) = (0.0, 0.0);
    for number in 0..frames.end {
        let frame = source.next_frame().unwrap().unwrap();
        let active = &engine.step_byte_frame(&frame.frame).unwrap().active;
        for [x, y] in BOXES.into_iter().filter(|_| number > 0 && frames.contains(&number)) {
            let side = design.region_size();
            let inside = |at: &u32| {
                let (column, row) = (at % design.columns() * side, at / design.columns() * side);
                (x..x + 8).contains(&column) && (y..y + 8).contains(&row)
            };
            let regions: Vec<u32> = (0..design.regions()).filter(inside).collect();
            let yes = regions.iter().filter(|&&region| active[region as usize]).count();
            all += 1.0;
            sent += f64::from(u8::from(2 * yes >= regions.len()));
        }
    }
    sent / all
}

#[test]
fn objects_are_counted_and_bind_where_they_are_lost() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let rows = |frames: std::ops::RangeInclusive<u32>| -> String {
        let row = |frame, [x, y]: [u32; 2]| format!("{frame},{x},{},{},8,8,1,1,1\n", x + 1, y + 1);
        frames.flat_map(|frame| BOXES.map(|at| row(frame, at))).collect()
    };
    let boxes = [dir.path().join("gt.txt")];
    let fitted = |text: String, share: f64| {
        std::fs::write(&boxes[0], text).unwrap();
        let (max_flips, min_recall) = (Some(0.0), Some(share));
        let constraints = Constraints { max_flips, min_recall, ..Constraints::default() };
        run_with(&boxes, FRAMES, &constraints, Some(1_000_000), 1, &SilentHooks)
    };
    let found = fitted(rows(1..=FRAMES), 0.01).unwrap();
    let recall = |held: &[ConstraintCheck]| {
        held.iter().find(|held| held.name == "min-recall").unwrap().value
    };
    let design = found.design.config.validate().unwrap();
    // The limit must hold in the searched part, and in the rest of the first half.
    let parts = [counted(&design, 0..10), counted(&design, 10..15)];
    assert_eq!(recall(&found.design.fitted_held), parts[0].min(parts[1]));
    assert_eq!(recall(&found.design.held_out_held), counted(&design, 15..30));
    assert!((0.01..1.0).contains(&recall(&found.design.fitted_held)), "it would show nothing");
    let lost = fitted(rows(1..=FRAMES), 1.0).unwrap();
    assert!(!lost.feasible && lost.binding == ["min-recall"], "{:?}", lost.binding);
    // Frame 0 does not count, so the first half has no objects; boxes of other frames do not fit.
    for (text, part) in
        [(rows(1..=1), "first half"), (rows(16..=30), "first half"), (rows(31..=31), "frame 31")]
    {
        let refused = fitted(text, 0.5).unwrap_err().to_string();
        assert!(refused.contains(part), "{part}: {refused}");
    }
}
