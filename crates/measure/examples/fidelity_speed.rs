// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the time of comparing a frame in milliseconds:
//! `cargo run --release -p foveate-fidelity --example fidelity_speed`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a measurement at a terminal")]

use std::time::Instant;

use foveate_camera::CameraConfig;
use foveate_engine::Engine;
use foveate_ideal::IdealCamera;
use foveate_measure::{CandidateFrame, Fidelity, FrameOrder};
use foveate_pixels::{ByteFrame, Scene, SceneParameters};

fn main() {
    for (width, height) in [(1280, 720), (1920, 1080)] {
        for (side, bits) in [(8, 8), (32, 8), (3, 8), (8, 6), (8, 12)] {
            let mut config = CameraConfig::default();
            (config.frame.width, config.frame.height) = (Some(width), Some(height));
            config.frame.pixel_bits = bits.max(8);
            let ideal = config.validate().unwrap();
            config.region.size = side;
            config.frame.pixel_bits = bits;
            let camera = config.validate().unwrap();
            let size =
                SceneParameters { width, height, bits: bits.max(8), region_size: 8, frames: 2 };
            let own = Scene::Street.frames(size);
            let other = Scene::Street.frames(SceneParameters { bits, ..size });
            let mut reference = IdealCamera::new(&ideal);
            let mut engine = Engine::new(&camera);
            let mut fidelity = Fidelity::new(&ideal, &camera).unwrap();
            let mut best = f64::INFINITY;
            for (own, other) in own.zip(other) {
                let input = ByteFrame::from(&own);
                let ideal_outcome = reference.step(&input).unwrap();
                let outcome = engine.step(&other).unwrap().clone();
                let denoised = engine.rendered().to_words();
                for _ in 0..10 {
                    let start = Instant::now();
                    let candidate = CandidateFrame {
                        outcome: &outcome,
                        screen: engine.rendered(),
                        denoised: &denoised,
                    };
                    fidelity.add(&input, ideal_outcome, candidate, FrameOrder::Later).unwrap();
                    best = best.min(start.elapsed().as_secs_f64());
                }
            }
            println!(
                "{width}x{height}, ideal N 8 of {:>2} bits, candidate N {side:>2} of {bits:>2} bits {:6.2} ms",
                bits.max(8),
                best * 1e3
            );
        }
    }
}
