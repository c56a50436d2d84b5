// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cycles that SCALE-Sim has printed.

use crate::by_hand::{accelerator, systolic};
use foveate_network::accelerator::{Dataflow, KernelWindow, Layer, TensorShape};

/// The first layer of AlexNet on 32 x 32 has 36 folds of 3,119 cycles. The last of them has number
/// 112,283 in SCALE-Sim's trace.
#[test]
fn the_cycles_match_the_golden_trace_of_scale_sim() {
    let accelerator = accelerator(Dataflow::WeightStationary(systolic(32, 32)));
    let inputs = TensorShape { channels: 3, height: 227, width: 227 };
    let outputs = TensorShape { channels: 96, height: 55, width: 55 };
    let layer = Layer::convolution(inputs, outputs, [KernelWindow::of(11, 4, 0); 2], 1).unwrap();
    let cost = accelerator.plan(layer).unwrap().whole_cost();
    assert_eq!(cost.array_cycles, 36 * 3119);
    assert_eq!(cost.array_cycles - 1, 112_283);
    assert_eq!(cost.macs, 105_415_200);
}

/// The numbers of the last cycle on 32 x 32, as SCALE-Sim 3.0.0 printed them in
/// `scripts/figures/compare_scalesim.py`: side of the input with padding, kernel, input channels,
/// filters, groups, weight-stationary, output-stationary.
const SCALE_SIM: &[(u64, u64, u64, u64, u64, u64, u64)] = &[
    (31, 5, 48, 128, 1, 125_095, 116_103),
    (15, 3, 256, 384, 1, 227_231, 170_351),
    (58, 3, 64, 64, 1, 116_279, 125_047),
    (30, 3, 128, 128, 1, 126_431, 121_399),
    (16, 3, 256, 256, 1, 167_039, 132_495),
    (1, 1, 512, 1000, 1, 48_639, 18_367),
    // SCALE-Sim runs each of the 8 channels separately.
    (16, 3, 8, 8, 8, 2_312, 3_968),
];

#[test]
fn the_cycles_match_the_prints_of_scale_sim() {
    for &(side, kernel, channels, filters, groups, ws, os) in SCALE_SIM {
        let inputs = TensorShape { channels, height: side, width: side };
        let side_of_output = side - kernel + 1;
        let outputs =
            TensorShape { channels: filters, height: side_of_output, width: side_of_output };
        let windows = [KernelWindow::of(kernel, 1, 0); 2];
        let layer = Layer::convolution(inputs, outputs, windows, groups).unwrap();
        let last_cycle = |dataflow: Dataflow| {
            let accelerator = accelerator(dataflow);
            accelerator.plan(layer.clone()).unwrap().whole_cost().array_cycles - groups
        };
        assert_eq!(
            last_cycle(Dataflow::WeightStationary(systolic(32, 32))),
            ws,
            "{side} {channels}"
        );
        assert_eq!(
            last_cycle(Dataflow::OutputStationary(systolic(32, 32))),
            os,
            "{side} {channels}"
        );
    }
}
