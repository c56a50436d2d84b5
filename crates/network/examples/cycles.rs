// SPDX-License-Identifier: MIT OR Apache-2.0
//! Prints the cycles of layers on a systolic array, for `scripts/figures/compare_scalesim.py`.
//!
//! `cycles ws|os ROWS COLUMNS TOPOLOGY.csv` reads a topology in the format of SCALE-Sim (name,
//! input height and width with padding, kernel height and width, channels, filters, stride; a name
//! with `DP` marks a depthwise layer). It prints a line `name,cycles` for each layer, with cycles
//! counted as in SCALE-Sim. The buffers hold everything, so no layer is cut.

use foveate_network::accelerator::{
    Accelerator, Dataflow, KernelWindow, Layer, SystolicArray, TensorShape,
};

type CyclesError = Box<dyn std::error::Error>;

#[allow(clippy::print_stdout, reason = "a program")]
fn main() -> Result<(), CyclesError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [dataflow, rows, columns, path] = arguments.as_slice() else {
        return Err("usage: cycles ws|os ROWS COLUMNS TOPOLOGY.csv".into());
    };
    let accelerator = accelerator(dataflow, rows.parse()?, columns.parse()?)?;
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_path(path)?;
    for record in reader.records() {
        let record = record?;
        let name = record.get(0).ok_or("a line without a name")?;
        let plan = accelerator.plan(layer(name, &record)?)?;
        println!("{name},{}", plan.whole_cost().array_cycles - run_count(name, &record)?);
    }
    Ok(())
}

fn accelerator(dataflow: &str, rows: u64, columns: u64) -> Result<Accelerator, CyclesError> {
    const EVERYTHING: u64 = 1 << 40;
    let array = SystolicArray {
        rows,
        columns,
        input_bytes: EVERYTHING,
        weight_bytes: EVERYTHING,
        output_bytes: EVERYTHING,
    };
    let (name, array) = match dataflow {
        "ws" => ("systolic-ws", Dataflow::WeightStationary(array)),
        "os" => ("systolic-os", Dataflow::OutputStationary(array)),
        other => return Err(format!("`{other}` is no dataflow; there are ws and os").into()),
    };
    Ok(Accelerator { array, ..Accelerator::from_preset(name)? })
}

/// Returns the number of layers that SCALE-Sim makes of one: it runs each channel of a depthwise
/// layer as a layer. For each it prints the number of the last cycle, counted from 0, which is one
/// less than the number of cycles.
fn run_count(name: &str, record: &csv::StringRecord) -> Result<u64, CyclesError> {
    if is_depthwise(name) { number(name, record, 5) } else { Ok(1) }
}

fn is_depthwise(name: &str) -> bool {
    name.contains("DP")
}

fn number(name: &str, record: &csv::StringRecord, at: usize) -> Result<u64, CyclesError> {
    let text = record.get(at).ok_or_else(|| format!("{name}: column {at} is missing"))?;
    Ok(text.parse().map_err(|error| format!("{name}: `{text}`: {error}"))?)
}

/// Parses a layer of the topology. SCALE-Sim's rows have no padding: the output has the positions
/// at which the kernel fits.
fn layer(name: &str, record: &csv::StringRecord) -> Result<Layer, CyclesError> {
    let number = |at: usize| number(name, record, at);
    let (inputs, kernel) = ([number(1)?, number(2)?], [number(3)?, number(4)?]);
    let (channels, filters, stride) = (number(5)?, number(6)?, number(7)?);
    let output_length = |at: usize| -> Result<u64, CyclesError> {
        let room = inputs[at].checked_sub(kernel[at]);
        Ok(room.ok_or_else(|| format!("{name}: the kernel is larger than the input"))? / stride + 1)
    };
    let groups = if is_depthwise(name) { channels } else { 1 };
    let inputs_shape = TensorShape { channels, height: inputs[0], width: inputs[1] };
    let outputs = TensorShape {
        channels: filters * groups,
        height: output_length(0)?,
        width: output_length(1)?,
    };
    let windows = kernel.map(|kernel| KernelWindow::of(kernel, stride, 0));
    Ok(Layer::convolution(inputs_shape, outputs, windows, groups)?)
}
