// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the speed of the model of the paper's array (784 lanes) over random frames, in clocks
//! and frames per second: `cargo run --release -p foveate-model --example serial_speed`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a measurement")]
#![allow(clippy::cast_precision_loss, reason = "printed with one digit")]

use std::time::{Duration, Instant};

use foveate_design::{Design, DesignConfig};
use foveate_model::{CoreInput, SerialRcm, ThresholdInputs};

const MEASUREMENT_TIME: Duration = Duration::from_secs(3);

fn design(feed: &str) -> Design {
    let toml = format!("[hardware]\norganization = \"serial\"\nfeed = \"{feed}\"\n");
    DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
}

/// A small random generator (xorshift). The values of the pixels do not matter, only that they
/// differ.
fn next_pixel(state: &mut u64) -> u16 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    u16::try_from(*state & 0xff).unwrap()
}

fn measure(feed: &str, skips: bool) {
    let design = design(feed);
    let thresholds = ThresholdInputs::from_camera(&design);
    let mut rcm = SerialRcm::new(design.as_serial().unwrap());
    let ports = rcm.output().forward_valid.len();
    let frame = 224 * 224 / ports;
    let mut state = 1;
    let pixels: Vec<u16> = (0..8 * 224 * 224).map(|_| next_pixel(&mut state)).collect();
    let (mut clocks, mut frames) = (0u64, 0u32);
    let start = Instant::now();
    while start.elapsed() < MEASUREMENT_TIME {
        for place in 0..frame {
            let at = (frames as usize % 8 * frame + place) * ports;
            let pixels = &pixels[at..at + ports];
            rcm.step(&CoreInput { valid: true, ..CoreInput::idle(pixels, &thresholds) });
            clocks += 1;
        }
        let working = rcm.clocks_until_ready();
        clocks += working;
        if skips {
            rcm.skip(working);
        } else {
            let pixels = &pixels[..ports];
            let idle = CoreInput::idle(pixels, &thresholds);
            (0..working).for_each(|_| {
                std::hint::black_box(rcm.step(&idle));
            });
        }
        frames += 1;
    }
    let seconds = start.elapsed().as_secs_f64();
    let how = if skips { "work skipped" } else { "every clock" };
    let million = clocks as f64 / seconds / 1e6;
    println!(
        "{feed:8} {how:12} {million:8.1} M clocks/s {:8.0} frames/s",
        f64::from(frames) / seconds
    );
}

fn main() {
    for feed in ["parallel", "raster"] {
        for skips in [false, true] {
            measure(feed, skips);
        }
    }
}
