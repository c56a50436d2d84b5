// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random layers, accelerators and masks.

use crate::by_hand;
use crate::oracle::AxisWindow;
use foveate_network::accelerator::{
    Accelerator, Dataflow, KernelWindow, Layer, MappingObjective, RowStationaryArray,
    SystolicArray, TensorShape,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// A layer with the numbers that it was made from.
#[derive(Clone, Debug)]
pub(crate) struct LayerCase {
    pub(crate) inputs: [u64; 2],
    pub(crate) outputs: [u64; 2],
    pub(crate) axes: [AxisWindow; 2],
    pub(crate) groups: u64,
    /// The number of input and output channels of a group.
    pub(crate) channels: [u64; 2],
    pub(crate) images: u64,
}

impl LayerCase {
    pub(crate) fn layer(&self) -> Layer {
        let shape = |channels: u64, [height, width]: [u64; 2]| TensorShape {
            channels: channels * self.groups,
            height,
            width,
        };
        let windows = self.axes.map(|[kernel, stride, dilation, before]| KernelWindow {
            kernel,
            stride,
            dilation,
            padding_before: before,
        });
        let (inputs, outputs) =
            (shape(self.channels[0], self.inputs), shape(self.channels[1], self.outputs));
        let layer = Layer::convolution(inputs, outputs, windows, self.groups).unwrap();
        layer.with_images(self.images).unwrap()
    }

    /// Returns the number of inputs of a sum.
    pub(crate) fn inner(&self) -> u64 {
        self.channels[0] * self.axes[0][0] * self.axes[1][0]
    }
}

fn axis() -> impl Strategy<Value = (u64, AxisWindow)> {
    (1..10_u64, 1..4_u64, 1..3_u64, 1..3_u64, 0..3_u64).prop_map(
        |(outputs, kernel, stride, dilation, before)| (outputs, [kernel, stride, dilation, before]),
    )
}

pub(crate) fn layer_case() -> impl Strategy<Value = LayerCase> {
    ([axis(), axis()], [1..12_u64, 1..12_u64], 1..4_u64, [1..6_u64, 1..6_u64], 1..4_u64).prop_map(
        |([down, across], inputs, groups, channels, images)| LayerCase {
            inputs,
            outputs: [down.0, across.0],
            axes: [down.1, across.1],
            groups,
            channels,
            images,
        },
    )
}

/// Makes a mask and a larger one that includes it, both as sets of row and column.
pub(crate) fn masks() -> impl Strategy<Value = [BTreeSet<[u64; 2]>; 2]> {
    let places = || proptest::collection::btree_set([0..10_u64, 0..10_u64], 0..30);
    (places(), places()).prop_map(|(small, more)| {
        let large = small.union(&more).copied().collect();
        [small, large]
    })
}

fn systolic() -> impl Strategy<Value = SystolicArray> {
    (1..6_u64, 1..6_u64, 1..400_u64, 1..200_u64, 1..200_u64).prop_map(
        |(rows, columns, input_bytes, weight_bytes, output_bytes)| SystolicArray {
            rows,
            columns,
            input_bytes,
            weight_bytes,
            output_bytes,
        },
    )
}

fn row_stationary() -> impl Strategy<Value = RowStationaryArray> {
    let sides = [1..6_u64, 1..6_u64];
    let element = [1..7_u64, 7..20_u64, 1..5_u64];
    let rates = [1..4_u64, 1..4_u64, 1..4_u64];
    let objective =
        prop_oneof![Just(MappingObjective::LeastDram), Just(MappingObjective::LeastEnergyDelay)];
    (sides, 1000..3000_u64, element, rates, objective).prop_map(
        |([rows, columns], buffer_bytes, element, rates, mapping)| RowStationaryArray {
            rows,
            columns,
            buffer_bytes,
            element_inputs: element[0],
            element_weights: element[1],
            element_sums: element[2],
            inputs_per_cycle: rates[0],
            weights_per_cycle: rates[1],
            sums_per_cycle: rates[2],
            mapping,
        },
    )
}

pub(crate) fn accelerator() -> impl Strategy<Value = Accelerator> {
    let array = prop_oneof![
        systolic().prop_map(Dataflow::WeightStationary),
        systolic().prop_map(Dataflow::OutputStationary),
        row_stationary().prop_map(Dataflow::RowStationary),
    ];
    let rate = proptest::option::of(0.5..4.0_f64);
    (array, [1..4_u32, 1..4_u32], rate).prop_map(|(array, tile, rate)| Accelerator {
        tile,
        dram_bytes_per_cycle: rate,
        ..by_hand::accelerator(array)
    })
}
