// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table on masks to which `docs/accelerators.md` links, in Markdown.

use foveate_network::accelerator::{
    Accelerator, KernelWindow, Layer, LayerCost, PRESETS, TensorShape,
};
use std::fmt::Write;

/// Three layers of ResNet-18 for 224 x 224 pixels: name, channels in and out, and side.
const LAYERS: [(&str, u64, u64); 3] =
    [("conv2_x", 64, 56), ("conv4_x", 256, 14), ("conv5_x", 512, 7)];

/// The sides of the squares, in sevenths of the side of the layer.
const SQUARES: [u64; 2] = [1, 3];

/// Returns the share of each cost that remains, for each preset, layer and square.
pub(crate) fn shares_table() -> Result<String, Box<dyn std::error::Error>> {
    let mut table =
        "| accelerator | layer | needed, % | MACs, % | cycles, % | DRAM accesses, % | energy, % |\n\
                     | --- | --- | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    for preset in PRESETS {
        let accelerator = Accelerator::from_preset(preset.name)?;
        for (name, channels, side) in LAYERS {
            let shape = TensorShape { channels, height: side, width: side };
            let layer = Layer::convolution(shape, shape, [KernelWindow::of(3, 1, 1); 2], 1)?;
            let plan = accelerator.plan(layer)?;
            let whole = plan.whole_cost();
            for sevenths in SQUARES {
                // The square is in the middle of the layer.
                let (from, to) = ((7 - sevenths) / 2 * side / 7, (7 + sevenths) / 2 * side / 7);
                let square = from..to;
                let part = plan.masked_cost(|x, y| {
                    square.contains(&(x as u64)) && square.contains(&(y as u64))
                });
                let shares =
                    percentages(&part, &whole).map(|share| format!("{share:.1}")).join(" | ");
                let needed = 100 * sevenths * sevenths / 49;
                writeln!(table, "| {} | {name} | {needed} | {shares} |", preset.name)?;
            }
        }
    }
    Ok(table)
}

/// Returns the percentages of multiplications, cycles, accesses to the DRAM, and energy.
#[allow(clippy::cast_precision_loss, reason = "shares")]
fn percentages(part: &LayerCost, whole: &LayerCost) -> [f64; 4] {
    let figures = |cost: &LayerCost| {
        [cost.macs as f64, cost.cycles as f64, cost.dram.access_count() as f64, cost.energy.total()]
    };
    let (part, whole) = (figures(part), figures(whole));
    std::array::from_fn(|figure| 100.0 * part[figure] / whole[figure])
}
