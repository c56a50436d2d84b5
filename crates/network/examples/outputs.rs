// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network once, and then over frames of which a part changes, for
//! `scripts/figures/compare_networks.py`:
//!
//!     outputs NETWORK WIDTHxHEIGHT PICTURE OUTPUTS
//!
//! PICTURE holds the values of the input as 32-bit floating-point values in little-endian order.
//! The values of all outputs are written to OUTPUTS, one output after the other. The program prints
//! whether the exact modes have the bits of a dense computation and where they first differ, the
//! time of a complete frame in milliseconds on one thread, and the share of all multiplications
//! that the changed frames needed.

#![allow(clippy::print_stdout, reason = "what it is for")]

use foveate_network::{ExecutionMode, Executor, FrameSize, Mask, Network};
use std::path::Path;
use std::time::{Duration, Instant};

/// The number of changed frames.
const CHANGED: usize = 3;
/// The number of frames that are timed.
const TIMED: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [network, size, picture, outputs] = arguments.as_slice() else {
        return Err("outputs NETWORK WIDTHxHEIGHT PICTURE OUTPUTS".into());
    };
    let (width, height) = size.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
    let frames = FrameSize { width: width.parse()?, height: height.parse()? };
    let network = Network::read(Path::new(network), |path| std::fs::File::open(path), frames)?;
    let bytes = std::fs::read(picture)?;
    let picture: Vec<f32> =
        bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    let whole = Mask::full(frames.height, frames.width);
    let mut dense = Executor::new(&network, ExecutionMode::Dense);
    dense.step(&picture, &whole);
    let values = network
        .outputs()
        .iter()
        .flat_map(|&output| dense.tensor(output).real_values().into_owned());
    std::fs::write(outputs, values.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())?;
    let mut best = Duration::MAX;
    for _ in 0..TIMED {
        let start = Instant::now();
        dense.step(&picture, &whole);
        best = best.min(start.elapsed());
    }
    let (mut needed, mut all) = (0.0, 0.0);
    for mode in [ExecutionMode::Exact, ExecutionMode::Compare] {
        let (share, odd) = changed(&network, mode, &picture);
        if mode == ExecutionMode::Exact {
            (needed, all) = share;
        }
        println!("{mode:?} {}", odd.unwrap_or_else(|| "same".to_owned()));
    }
    println!("time {:.3}", 1e3 * best.as_secs_f64());
    println!("needed {:.4}", if all > 0.0 { needed / all } else { 0.0 });
    println!("nodes {}", network.nodes().len());
    Ok(())
}

/// Returns the products that the changed frames needed and those of dense computations, with a
/// description of the first tensor that differs from a dense computation.
#[allow(clippy::cast_precision_loss, reason = "shares")]
fn changed(
    network: &Network,
    mode: ExecutionMode,
    picture: &[f32],
) -> ((f64, f64), Option<String>) {
    let (height, width) = (network.input().height(), network.input().width());
    let (mut dense, mut part) =
        (Executor::new(network, ExecutionMode::Dense), Executor::new(network, mode));
    let mut picture = picture.to_vec();
    let (mut needed, mut all) = (0.0, 0.0);
    for number in 0..=CHANGED {
        let (left, top) = (number * width / (CHANGED + 2), number * height / (CHANGED + 1));
        let is = |x: usize, y: usize| {
            number > 0 && (left..left + 12).contains(&x) && (top..top + 12).contains(&y)
        };
        let mask = Mask::from_fn(height, width, is);
        for (at, value) in picture.iter_mut().enumerate() {
            if is(at % width, at / width % height) && at % 3 != 0 {
                *value = 1.5 - *value;
            }
        }
        dense.step(&picture, &mask);
        let work = part.step(&picture, &mask).to_vec();
        for (node, work) in work.iter().enumerate().filter(|_| number > 0) {
            let macs = network.macs(node) as f64;
            needed += macs * work.needed_positions as f64
                / network.form(node + 1).position_count() as f64;
            all += macs;
        }
        for value in 0..=network.nodes().len() {
            if !dense.tensor(value).differing_positions(part.tensor(value)).is_empty() {
                let kind = value.checked_sub(1).map(|node| &network.nodes()[node]);
                let name = kind.map_or("picture", |node| node.name());
                return ((needed, all), Some(format!("differs in picture {number} at `{name}`")));
            }
        }
    }
    ((needed, all), None)
}
