// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the time of computing a part of a frame against that of the whole frame, for growing
//! shares of regions of 8x8 positions at random places, on one thread:
//!
//!     cargo run --release -p foveate-network --example break_even -- networks/denoiser.onnx
//!
//! Scattered regions are the worst case, because they share the fewest inputs.

#![allow(clippy::print_stdout, reason = "what it is for")]

use foveate_network::{ExecutionMode, Executor, FrameSize, Mask, Network};
use std::path::Path;
use std::time::{Duration, Instant};

/// The frames of each measurement; the fastest one counts.
const FRAMES: usize = 12;
/// The frame sizes that are tried for a network.
const SIZES: [(usize, usize); 4] = [(640, 360), (224, 224), (640, 384), (28, 28)];

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let path = std::env::args().nth(1).expect("a network, as an ONNX file");
    let read = |&(width, height)| {
        Network::read(
            Path::new(&path),
            |path| std::fs::File::open(path),
            FrameSize { width, height },
        )
        .ok()
    };
    let network = SIZES.iter().find_map(read).expect("a network for one of the usual sizes");
    let (height, width) = (network.input().height(), network.input().width());
    println!("{path}, {width}x{height}\n");
    println!("| regions | blocks computed | time | time per block |");
    println!("| ---: | ---: | ---: | ---: |");
    for percent in [2, 5, 10, 20, 30, 40, 60, 80, 100] {
        let mask = Mask::from_fn(height, width, |x, y| region(x / 8, y / 8) < percent);
        let (blocks, time) = measure(&network, &mask);
        println!(
            "| {percent} % | {:.0} % | {:.0} % | {:.2} |",
            100.0 * blocks,
            100.0 * time,
            time / blocks
        );
    }
}

/// Returns a pseudo-random number from 0 to 99.
fn region(x: usize, y: usize) -> usize {
    let mixed = (x * 0x9e37_79b9 + y * 0x85eb_ca6b) & 0xffff_ffff;
    (((mixed ^ (mixed >> 15)) * 0xc2b2_ae35) >> 12) % 100
}

/// Returns the share of blocks that a part computes, weighted by their products, and its share of
/// the time.
fn measure(network: &Network, mask: &Mask) -> (f64, f64) {
    let input = network.input();
    let picture = vec![0.5; input.element_count()];
    let whole = Mask::full(input.height(), input.width());
    let mut executor = Executor::new(network, ExecutionMode::Exact);
    executor.step(&picture, &whole);
    let (mut part_time, mut whole_time) = (Duration::MAX, Duration::MAX);
    let (mut part_products, mut whole_products) = (0.0, 0.0);
    for _ in 0..FRAMES {
        let (products, time) = step(network, &mut executor, &picture, mask);
        (part_products, part_time) = (products, part_time.min(time));
        let (products, time) = step(network, &mut executor, &picture, &whole);
        (whole_products, whole_time) = (products, whole_time.min(time));
    }
    (part_products / whole_products, part_time.as_secs_f64() / whole_time.as_secs_f64())
}

/// Returns the number of products that are computed for a frame, and the time.
#[allow(clippy::cast_precision_loss, reason = "shares are shown as percents")]
fn step(
    network: &Network,
    executor: &mut Executor<'_>,
    picture: &[f32],
    changed: &Mask,
) -> (f64, Duration) {
    let start = Instant::now();
    let work = executor.step(picture, changed);
    let time = start.elapsed();
    let products = work.iter().enumerate().map(|(node, work)| {
        let form = network.form(node + 1);
        let places = form.height() * form.width();
        network.macs(node) as f64 * work.scheduled_positions as f64 / places as f64
    });
    (products.sum(), time)
}
