// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the cycle-level models over random pixels:
//! `cargo run --release -p foveate-model --example cycle_speed [PART OF A NAME] [SCALE]`.
//! A scale multiplies the number of clocks, so that a profiler has enough samples.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a measurement")]
#![allow(clippy::cast_precision_loss, reason = "printed with one digit")]

use std::time::Instant;

use foveate_design::{Design, DesignConfig, Hardware};
use foveate_model::{CoreInput, ThresholdInputs, rcm_model};

/// The designs: a name, the number of clocks, and the keys.
const DESIGNS: [(&str, u64, &str); 6] = [
    ("pipelined", 2_000, ""),
    ("pipelined-shared", 2_000, "region.neighborhood = 'shared'"),
    (
        "pipelined-features",
        2_000,
        "spatial = [{ feature = 'edge' }, { feature = 'corner' }, { feature = 'mad' }]",
    ),
    (
        "raster",
        1_300_000,
        "frame = { width = 640, height = 480 }\nhardware.organization = 'raster'",
    ),
    (
        "raster-words",
        320_000,
        "frame = { width = 640, height = 480 }\n\
         hardware = { organization = 'raster', pixels_per_clock = 4 }",
    ),
    (
        "raster-means",
        1_300_000,
        "frame = { width = 640, height = 480 }\ntemporal.reference = 'last-sent'\n\
         render.irrelevant = 'mean'\nhardware.organization = 'raster'",
    ),
];

/// Makes pixels with a small random generator (xorshift). Their values do not matter, only that
/// they differ.
fn random_pixels(count: usize) -> Vec<u16> {
    let mut state = 1_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        u16::try_from(state & 0xff).unwrap()
    };
    (0..count).map(|_| next()).collect()
}

fn measure(name: &str, clocks: u64, design: &Design) {
    let port_pixels = match design.hardware() {
        Hardware::Pipelined(_) => design.regions(),
        Hardware::Raster(own) => design.with_hardware(own).pixels_per_clock(),
        Hardware::Serial(own) => design.with_hardware(own).lanes(),
    };
    let port_pixels = usize::try_from(port_pixels).unwrap();
    let pixels = random_pixels(port_pixels << 11);
    let mut words = pixels.chunks_exact(port_pixels).cycle();
    let thresholds = ThresholdInputs::from_camera(design);
    let mut rcm = rcm_model(design);
    let start = Instant::now();
    for _ in 0..clocks {
        let valid = rcm.is_ready();
        let word = words.next().unwrap();
        rcm.clock(&CoreInput { valid, ..CoreInput::idle(word, &thresholds) });
    }
    let clock = start.elapsed().as_secs_f64() * 1e9 / clocks as f64;
    let pixel = clock / port_pixels as f64;
    println!("{name:20} {clock:10.1} ns per clock, {pixel:6.1} ns per pixel of the port");
}

fn main() {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    let scale = std::env::args().nth(2).map_or(1, |scale| scale.parse().unwrap());
    for (name, clocks, toml) in DESIGNS.into_iter().filter(|(name, ..)| name.contains(&wanted)) {
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        measure(name, clocks * scale, &design);
    }
}
