// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the time of a complete frame by kinds of operators, on one thread:
//!
//!     cargo run --release -p foveate-network --example times -- NETWORK WIDTHxHEIGHT
//!
//! The program prints the time of mode `dense`, that of mode `exact` if every pixel has changed,
//! and that of each kind of operator in mode `dense`, all in milliseconds. The best of several
//! frames counts.

#![allow(clippy::print_stdout, reason = "what it is for")]

use foveate_network::{ExecutionMode, Executor, FrameSize, Mask, Network, ProductKind};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// The time for which frames are computed.
const BUDGET: Duration = Duration::from_secs(1);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [network, size] = arguments.as_slice() else {
        return Err("times NETWORK WIDTHxHEIGHT".into());
    };
    let (width, height) = size.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
    let frames = FrameSize { width: width.parse()?, height: height.parse()? };
    let network = Network::read(Path::new(network), |path| std::fs::File::open(path), frames)?;
    let (picture, whole) =
        (vec![0.5; network.input().element_count()], Mask::full(frames.height, frames.width));
    let mut dense = Executor::new(&network, ExecutionMode::Dense);
    let mut exact = Executor::new(&network, ExecutionMode::Exact);
    let mut best = [Duration::MAX; 2];
    let mut nodes = vec![Duration::MAX; network.nodes().len()];
    let begin = Instant::now();
    while begin.elapsed() < BUDGET {
        for (executor, best) in [&mut dense, &mut exact].into_iter().zip(&mut best) {
            let start = Instant::now();
            executor.step(&picture, &whole);
            *best = start.elapsed().min(*best);
        }
        for (node, best) in nodes.iter_mut().enumerate() {
            *best = dense.operator_time(node).min(*best);
        }
    }
    println!("dense {:.3}\nexact {:.3}", milliseconds(best[0]), milliseconds(best[1]));
    let mut kinds = BTreeMap::<String, OperatorTotals>::new();
    for (node, &time) in nodes.iter().enumerate() {
        let kind = kinds.entry(describe(&network, node)).or_default();
        kind.time += time;
        kind.nodes += 1;
        kind.macs += network.macs(node);
    }
    let mut kinds: Vec<(String, OperatorTotals)> = kinds.into_iter().collect();
    kinds.sort_by_key(|(_, kind)| std::cmp::Reverse(kind.time));
    for (name, kind) in kinds {
        println!(
            "{:9.3} {:4} {:6.1} GMAC/s  {name}",
            milliseconds(kind.time),
            kind.nodes,
            kind.speed()
        );
    }
    Ok(())
}

/// The totals of the nodes of a kind.
#[derive(Default)]
struct OperatorTotals {
    time: Duration,
    nodes: usize,
    macs: u64,
}

impl OperatorTotals {
    /// The speed in 10^9 multiply-accumulate operations per second.
    #[allow(clippy::cast_precision_loss, reason = "shown with one digit behind the point")]
    fn speed(&self) -> f64 {
        self.macs as f64 / self.time.as_secs_f64() / 1e9
    }
}

/// Returns the operator of a node, with the window if it is a convolution.
fn describe(network: &Network, node: usize) -> String {
    let node = &network.nodes()[node];
    match node.products() {
        ProductKind::Convolution { rows, columns, groups } => {
            let groups = if groups > 1 { ", groups" } else { "" };
            let (kind, stride) = (node.operator_name(), rows.stride);
            format!("{kind} {}x{}, stride {stride}{groups}", rows.kernel, columns.kernel)
        }
        _ => node.operator_name().to_owned(),
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}
