// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the time per frame of the ideal camera in milliseconds:
//! `cargo run --release -p foveate-ideal --example ideal_speed`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a measurement at a terminal")]

use std::time::Instant;

use foveate_camera::{CameraConfig, FeatureKind, SpatialConfig};
use foveate_ideal::IdealCamera;
use foveate_pixels::ByteFrame;

fn main() {
    for (width, height) in [(1280_u32, 720_u32), (1920, 1080)] {
        for features in [&[FeatureKind::Edge][..], FeatureKind::ALL] {
            let mut config = CameraConfig::default();
            (config.frame.width, config.frame.height) = (Some(width), Some(height));
            config.spatial = features.iter().map(|&kind| SpatialConfig::new(kind)).collect();
            let mut camera = IdealCamera::new(&config.validate().unwrap());
            let frames: Vec<ByteFrame> = (0..4).map(|shift| frame(width, height, shift)).collect();
            let mut best = f64::INFINITY;
            for frame in frames.iter().cycle().take(20) {
                let start = Instant::now();
                camera.step(frame).unwrap();
                best = best.min(start.elapsed().as_secs_f64());
            }
            let names: Vec<&str> = features.iter().map(|kind| kind.name()).collect();
            println!("{width}x{height} {:<28} {:6.1} ms", names.join("+"), best * 1e3);
        }
    }
}

fn frame(width: u32, height: u32, shift: u32) -> ByteFrame {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = pixels
        .map(|(x, y)| {
            let noise = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)) >> 29;
            let pattern = if ((x + shift) / 40 + y / 40).is_multiple_of(2) { 60 } else { 180 };
            u8::try_from(pattern + noise).unwrap()
        })
        .collect();
    ByteFrame::from_bytes(width, height, 8, pixels).unwrap()
}
