// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the seconds of a frame in tract, the best of some runs: `tract-dense MODEL.onnx 1 CHANNELS HEIGHT WIDTH`, for scripts/figures/bench_networks.py.

use std::time::Instant;
use tract_onnx::prelude::*;

fn main() -> TractResult<()> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("a model");
    let shape: Vec<usize> = arguments.map(|length| length.parse().expect("a length")).collect();
    let model = tract_onnx::onnx()
        .model_for_path(path)?
        .with_input_fact(0, f32::fact(&shape).into())?
        .into_optimized()?
        .into_runnable()?;
    let values: Vec<f32> =
        (0..shape.iter().product::<usize>()).map(|at| (at % 251) as f32 / 251.0).collect();
    let picture = Tensor::from_shape(&shape, &values)?;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        model.run(tvec!(picture.clone().into()))?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{best}");
    Ok(())
}
