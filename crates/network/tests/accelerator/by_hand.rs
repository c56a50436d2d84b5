// SPDX-License-Identifier: MIT OR Apache-2.0
//! Costs that are computed by hand.

use foveate_network::accelerator::{
    Accelerator, Dataflow, KernelWindow, Layer, LayerCost, MappingObjective, MemoryAccesses,
    RowStationaryArray, SystolicArray, TensorShape,
};

const EVERYTHING: u64 = 1 << 30;

pub(crate) fn systolic(rows: u64, columns: u64) -> SystolicArray {
    SystolicArray {
        rows,
        columns,
        input_bytes: EVERYTHING,
        weight_bytes: EVERYTHING,
        output_bytes: EVERYTHING,
    }
}

/// Returns an accelerator with values of 8 bits and sums of 16. A MAC costs 1 pJ, and the other
/// accesses cost 2, 3, 4 and 5 pJ.
pub(crate) fn accelerator(array: Dataflow) -> Accelerator {
    let text = "clock_mhz = 1\nvalue_bits = 8\nsum_bits = 16\ntile = [1, 1]\n\
        [array]\ndataflow = \"weight-stationary\"\nrows = 1\ncolumns = 1\ninput_bytes = 1\nweight_bytes = 1\noutput_bytes = 1\n\
        [energy]\nmac_pj = 1\nregister_pj = 2\narray_pj = 3\nbuffer_pj = 4\ndram_pj = 5\n";
    Accelerator { array, ..Accelerator::from_toml(text).unwrap() }
}

/// Returns a layer of 3 x 3 inputs, 2 x 2 taps and 2 filters, which has 4 positions and 4 inputs
/// per sum.
fn small() -> Layer {
    let inputs = TensorShape { channels: 1, height: 3, width: 3 };
    let outputs = TensorShape { channels: 2, height: 2, width: 2 };
    Layer::convolution(inputs, outputs, [KernelWindow::of(2, 1, 0); 2], 1).unwrap()
}

fn traffic(inputs: u64, weights: u64, sums: u64, outputs: u64) -> MemoryAccesses {
    MemoryAccesses { inputs, weights, sums, outputs }
}

#[track_caller]
fn assert_energy(cost: &LayerCost, [mac, register, array, buffer, dram]: [f64; 5]) {
    let found = &cost.energy;
    let all = [found.mac, found.register, found.array, found.buffer, found.dram];
    assert_eq!(all.map(f64::to_bits), [mac, register, array, buffer, dram].map(f64::to_bits));
    assert!((found.total() - found.chip() - found.dram).abs() < 1e-9);
}

#[test]
fn a_weight_stationary_layer_has_the_cost_computed_by_hand() {
    let accelerator = accelerator(Dataflow::WeightStationary(systolic(2, 2)));
    let plan = accelerator.plan(small()).unwrap();
    let cost = plan.whole_cost();
    // There are two folds of 2 x 2 + 2 + 4 - 2 cycles.
    assert_eq!((cost.cycles, cost.array_cycles, cost.dram_cycles, cost.macs), (16, 16, 0, 32));
    assert_eq!(cost.dram, traffic(9, 8, 0, 8));
    // Each position streams its 4 inputs. The sums of the first fold are written and read.
    assert_eq!(cost.buffer, traffic(9 + 16, 8 + 8, 8 + 8, 8 + 8));
    assert_eq!(cost.register, traffic(0, 8 + 32, 0, 0));
    assert_eq!(cost.array, traffic(32, 0, 32, 0));
    // Sums have twice the bits of a value.
    assert_energy(&cost, [32.0, 2.0 * 40.0, 3.0 * (32.0 + 64.0), 4.0 * (57.0 + 32.0), 5.0 * 25.0]);
    assert!((cost.utilization(&accelerator) - 32.0 / 64.0).abs() < 1e-12);

    let one_position = plan.masked_cost(|x, y| (x, y) == (1, 0));
    assert_eq!((one_position.cycles, one_position.macs), (2 * 5, 8));
    // All weights are fetched, and the 4 inputs in the window.
    assert_eq!(one_position.dram, traffic(4, 8, 0, 2));
    assert_eq!(plan.masked_cost(|_, _| false), LayerCost::default());
}

#[test]
fn an_output_stationary_layer_has_the_cost_computed_by_hand() {
    let accelerator = accelerator(Dataflow::OutputStationary(systolic(2, 2)));
    let plan = accelerator.plan(small()).unwrap();
    let cost = plan.whole_cost();
    // There are two folds of 4 + 2 + 2 - 2 cycles.
    assert_eq!((cost.array_cycles, cost.macs), (12, 32));
    assert_eq!(cost.dram, traffic(9, 8, 0, 8));
    assert_eq!(cost.buffer, traffic(9 + 16, 8 + 2 * 8, 0, 16));
    assert_eq!(cost.register, traffic(0, 0, 64, 0));
    assert_eq!(cost.array, traffic(32, 32, 0, 0));
    // Three positions need two folds, two need one.
    assert_eq!(plan.masked_cost(|x, y| x + y > 0).array_cycles, 12);
    assert_eq!(plan.masked_cost(|_, y| y > 0).array_cycles, 6);
}

#[test]
fn a_mask_is_rounded_up_to_tiles() {
    let mut accelerator = accelerator(Dataflow::WeightStationary(systolic(2, 2)));
    accelerator.tile = [2, 1];
    let plan = accelerator.plan(small()).unwrap();
    let one_position = plan.masked_cost(|x, y| (x, y) == (1, 0));
    assert_eq!(one_position, plan.masked_cost(|x, _| x == 1));
    // Both positions of the column are computed: they depend on 3 x 2 inputs.
    assert_eq!((one_position.macs, one_position.dram.inputs), (16, 6));
}

#[test]
fn values_that_do_not_fit_a_buffer_are_fetched_again() {
    let large_buffers = systolic(2, 1);
    let cost_with = |array: SystolicArray| {
        let accelerator = accelerator(Dataflow::WeightStationary(array));
        accelerator.plan(small()).unwrap().whole_cost()
    };
    // Inputs do not fit, so they are fetched once for each of the two filters, or the positions are
    // cut with all filters for each part. All sums fit, so there is only one part.
    assert_eq!(
        cost_with(SystolicArray { input_bytes: 8, ..large_buffers.clone() }).dram,
        traffic(18, 8, 0, 8)
    );
    // Two sums of 16 bits fit: two parts of two positions, each with 2 x 2 + 1 - 2 cycles of
    // filling, in 2 x 2 folds.
    let cut = cost_with(SystolicArray { output_bytes: 4, ..large_buffers.clone() });
    assert_eq!(cut.array_cycles, 4 * (2 * 3 + 4));
    assert_eq!(cut.buffer.weights, 8 + 2 * 8);
    assert_eq!(cut.dram, traffic(9, 8, 0, 8));
    // The weights of one filter do not fit either, so they are fetched again for the second part.
    let cut = cost_with(SystolicArray { output_bytes: 4, weight_bytes: 3, ..large_buffers });
    assert_eq!(cut.dram, traffic(9, 16, 0, 8));
}

/// The channels have two parts. The positions have two parts, too, which depend on 5 of 9 inputs on
/// average.
#[test]
fn the_order_with_less_traffic_is_used() {
    let dram_accesses = |input_bytes, weight_bytes| {
        let array = SystolicArray { input_bytes, weight_bytes, ..systolic(2, 1) };
        let accelerator = accelerator(Dataflow::OutputStationary(array));
        accelerator.plan(small()).unwrap().whole_cost().dram
    };
    // The inputs of a part and the weights of a filter fit: fetching inputs once and weights twice
    // is less than the reverse.
    assert_eq!(dram_accesses(8, 4), traffic(9, 16, 0, 8));
    // All weights fit, so everything is fetched once.
    assert_eq!(dram_accesses(5, 8), traffic(9, 8, 0, 8));
    // The inputs of a part do not fit: inputs are fetched twice, and the weights of a filter once.
    assert_eq!(dram_accesses(4, 4), traffic(18, 8, 0, 8));
}

#[test]
fn a_layer_takes_the_longer_time_of_array_and_dram() {
    let mut accelerator = accelerator(Dataflow::WeightStationary(systolic(2, 2)));
    accelerator.dram_bytes_per_cycle = Some(1.5);
    let cost = accelerator.plan(small()).unwrap().whole_cost();
    // The DRAM moves 25 bytes.
    assert_eq!((cost.cycles, cost.array_cycles, cost.dram_cycles), (17, 16, 17));
    let both = cost + cost;
    assert_eq!((both.cycles, both.dram.inputs, both.buffer.sums), (34, 18, 32));
    assert!((accelerator.seconds(34) - 34e-6).abs() < 1e-12);
}

#[test]
fn a_layer_without_products_costs_only_transfers() {
    let accelerator = accelerator(Dataflow::WeightStationary(systolic(2, 2)));
    let inputs = TensorShape { channels: 3, height: 4, width: 4 };
    let outputs = TensorShape { channels: 3, height: 2, width: 2 };
    let layer = Layer::transfer(inputs, outputs, [KernelWindow::of(2, 2, 0); 2]).unwrap();
    let plan = accelerator.plan(layer).unwrap();
    let cost = plan.whole_cost();
    assert_eq!((cost.array_cycles, cost.macs), (0, 0));
    assert_eq!((cost.dram, cost.buffer), (traffic(48, 0, 0, 12), traffic(96, 0, 0, 24)));
    assert_eq!(plan.masked_cost(|x, y| x + y == 0).dram, traffic(12, 0, 0, 3));
}

fn row_stationary() -> RowStationaryArray {
    RowStationaryArray {
        rows: 2,
        columns: 2,
        buffer_bytes: 1 << 20,
        element_inputs: 2,
        element_weights: 4,
        element_sums: 2,
        inputs_per_cycle: 1,
        weights_per_cycle: 4,
        sums_per_cycle: 4,
        mapping: MappingObjective::LeastDram,
    }
}

#[test]
fn a_row_stationary_layer_has_the_cost_computed_by_hand() {
    let accelerator = accelerator(Dataflow::RowStationary(row_stationary()));
    let plan = accelerator.plan(small()).unwrap();
    let cost = plan.whole_cost();
    // There is one strip of both rows, with both filters in each element. 2 cycles bring 8 weights.
    // Then 9 inputs take 9 cycles, longer than the 2 x 2 x 2 multiplications of an element.
    assert_eq!((cost.array_cycles, cost.macs), (2 + 9, 32));
    assert_eq!(cost.dram, traffic(9, 8, 0, 8));
    assert_eq!(cost.buffer, traffic(9 + 9, 8 + 8, 0, 8 + 8));
    assert_eq!(cost.register, traffic(32, 32, 64, 0));
    // The 4 elements get 4 weights each, and a sum passes through 2 elements.
    assert_eq!(cost.array, traffic(8, 16, 16, 0));

    // The strip stays, its longest row has one position, and that depends on 2 x 3 inputs: 6
    // cycles.
    let one_column = plan.masked_cost(|x, _| x == 0);
    assert_eq!((one_column.array_cycles, one_column.dram), (2 + 6, traffic(6, 8, 0, 4)));
}

#[test]
fn rows_without_a_computed_position_are_left_out() {
    let array = RowStationaryArray { columns: 1, ..row_stationary() };
    let accelerator = accelerator(Dataflow::RowStationary(array));
    let plan = accelerator.plan(small()).unwrap();
    // The strips have one row each: 2 cycles for the weights, and 8 multiplications in an element,
    // longer than 6 inputs.
    assert_eq!(plan.whole_cost().array_cycles, 2 * (2 + 8));
    assert_eq!(plan.whole_cost().dram, traffic(12, 16, 0, 8));
    let upper = plan.masked_cost(|_, y| y == 0);
    assert_eq!((upper.array_cycles, upper.dram), (10, traffic(6, 8, 0, 4)));
}

#[test]
fn images_share_weights_where_the_buffer_holds_their_sums() {
    let accelerator = accelerator(Dataflow::RowStationary(row_stationary()));
    let together = accelerator.plan(small().with_images(2).unwrap()).unwrap().whole_cost();
    assert_eq!((together.array_cycles, together.dram), (2 + 2 * 9, traffic(18, 8, 0, 16)));
    // An image has 9 inputs of 8 bits and 8 sums of 16 bits.
    let array = RowStationaryArray { buffer_bytes: 49, ..row_stationary() };
    let accelerator = self::accelerator(Dataflow::RowStationary(array));
    let apart = accelerator.plan(small().with_images(2).unwrap()).unwrap().whole_cost();
    assert_eq!((apart.array_cycles, apart.dram), (2 * (2 + 9), traffic(18, 16, 0, 16)));
}
