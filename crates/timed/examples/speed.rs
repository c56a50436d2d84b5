// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the timed model and the cycle models on one thread, over the same frames: a moving
//! pattern with noise, or dense random pixels as in `foveate bench`.
//!
//! `cargo run --release -p foveate-timed --example speed [PART OF A NAME]`
#![allow(clippy::print_stdout, clippy::expect_used, clippy::unwrap_used, reason = "an example")]
#![allow(clippy::cast_precision_loss, reason = "rates have three digits")]

#[allow(dead_code, reason = "tests use the rest")]
#[path = "../tests/timed/frame_beats.rs"]
mod frame_beats;

use std::time::{Duration, Instant};

use foveate_design::{Design, DesignConfig};
use foveate_engine::Engine;
use foveate_model::{CoreInput, CycleModel, ThresholdInputs, rcm_model};
use foveate_pixels::{ByteFrame, Frame};
use foveate_timed::{FrameDelivery, RateSink, ReadySink, Sink, TimedModel};
use frame_beats::frame_beats;

/// The designs: a name, and the keys.
const DESIGNS: [(&str, &str); 5] = [
    ("pipelined 224x224", ""),
    ("serial 224x224", "hardware.organization = 'serial'"),
    ("raster 640x480", "frame = { width = 640, height = 480 }\nhardware.organization = 'raster'"),
    (
        "raster 1920x1080",
        "frame = { width = 1920, height = 1080 }\nhardware.organization = 'raster'",
    ),
    (
        "raster 640x480, last-sent, mean",
        "frame = { width = 640, height = 480 }\ntemporal.reference = 'last-sent'\n\
         render.irrelevant = 'mean'\nhardware.organization = 'raster'",
    ),
];
/// The number of different frames.
const FRAMES: u32 = 8;
/// The number of measurements of each model. The best counts.
const ROUNDS: u32 = 3;
/// The time for each measurement.
const TIME: Duration = Duration::from_millis(700);

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    for (name, toml) in DESIGNS.into_iter().filter(|(name, _)| name.contains(&wanted)) {
        let config = DesignConfig::from_toml(toml).expect("valid keys");
        let design = config.validate().expect("a valid design");
        for (content, is_random) in [("pattern", false), ("random", true)] {
            let frames = frames(&design, is_random);
            // All models are measured in turn, because the load of the machine changes.
            let rates = (0..ROUNDS).map(|_| {
                [
                    timed_rate(&design, &frames, Box::new(ReadySink)),
                    // This sink takes nine words of ten clocks.
                    timed_rate(&design, &frames, Box::new(RateSink::new(9, 10))),
                    engine_rate(&design, &frames),
                    cycle_rate(&design, &frames),
                ]
            });
            let best = |best: [f64; 4], next: [f64; 4]| {
                std::array::from_fn(|place| best[place].max(next[place]))
            };
            let [timed, stalled, engine, cycle] = rates.fold([0.0; 4], best);
            let clocks = design.timing().clocks_per_frame() as f64;
            println!(
                "{name}, {content}: timed {timed:.0} frames/s, {:.1} M clocks/s; slow sink \
                 {stalled:.0} frames/s; engine alone {engine:.0} frames/s; cycle model {cycle:.1} \
                 frames/s, {:.2} M clocks/s; {:.0} times",
                timed * clocks / 1e6,
                cycle * clocks / 1e6,
                timed / cycle
            );
        }
    }
}

fn frames(design: &Design, is_random: bool) -> Vec<Frame> {
    let mut state = 1_u32;
    let frame = |shift: u32| {
        Frame::from_fn(design.width(), design.height(), design.pixel_bits(), |x, y| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = u16::from(state.to_le_bytes()[3]);
            let pattern = if ((x + shift) / 40 + y / 40).is_multiple_of(2) { 60 } else { 180 };
            if is_random { noise } else { pattern + noise % 8 }
        })
    };
    (0..FRAMES).map(frame).collect::<Result<_, _>>().expect("valid frames")
}

/// Returns the frames per second of the timed model.
fn timed_rate(design: &Design, frames: &[Frame], sink: Box<dyn Sink>) -> f64 {
    let frames: Vec<ByteFrame> = frames.iter().map(ByteFrame::from).collect();
    let mut model = TimedModel::new(design, sink);
    let (mut taken, mut transactions) = (0_u32, 0_u64);
    let start = Instant::now();
    while start.elapsed() < TIME {
        for frame in &frames {
            let delivery = FrameDelivery::whole(frame.borrowed_pixels());
            model.step(&delivery, &mut |_| transactions += 1).expect("a frame of the design");
            taken += 1;
        }
    }
    f64::from(taken) / start.elapsed().as_secs_f64()
}

/// Returns the frames per second of the engine alone.
fn engine_rate(design: &Design, frames: &[Frame]) -> f64 {
    let frames: Vec<ByteFrame> = frames.iter().map(ByteFrame::from).collect();
    let (mut engine, mut taken) = (Engine::new(design), 0_u32);
    let start = Instant::now();
    while start.elapsed() < TIME {
        for frame in &frames {
            engine.step_byte_frame(frame).expect("a frame of the design");
            taken += 1;
        }
    }
    f64::from(taken) / start.elapsed().as_secs_f64()
}

/// Returns the frames per second of the cycle model.
fn cycle_rate(design: &Design, frames: &[Frame]) -> f64 {
    let thresholds = ThresholdInputs::from_camera(design);
    let frames: Vec<_> = frames.iter().map(|frame| frame_beats(design, frame)).collect();
    let mut model = rcm_model(design);
    let mut taken = 0_u32;
    let start = Instant::now();
    while start.elapsed() < TIME {
        play(&frames[(taken % FRAMES) as usize], &thresholds, &mut *model);
        taken += 1;
    }
    f64::from(taken) / start.elapsed().as_secs_f64()
}

fn play(beats: &[Vec<u16>], thresholds: &ThresholdInputs, model: &mut dyn CycleModel) {
    for (place, beat) in beats.iter().enumerate() {
        while !model.is_ready() {
            model.skip_quiet_clocks();
            model.clock(&CoreInput::idle(beat, thresholds));
        }
        model.clock(&CoreInput { sof: place == 0, ..CoreInput::valid(beat, thresholds) });
    }
}
