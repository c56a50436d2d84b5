// SPDX-License-Identifier: MIT OR Apache-2.0
//! Properties that hold for every layer, accelerator and mask.

use crate::by_hand;
use crate::oracle::{
    SimulatedCounts, needed_inputs, output_stationary, round_up_to_tiles, weight_stationary,
};
use crate::random::{LayerCase, accelerator, layer_case, masks};
use foveate_network::accelerator::{Accelerator, Dataflow, LayerCost, MemoryAccesses};
use proptest::prelude::*;
use std::collections::BTreeSet;

type PositionSet = BTreeSet<[u64; 2]>;

fn masked(accelerator: &Accelerator, case: &LayerCase, mask: &PositionSet) -> LayerCost {
    let plan = accelerator.plan(case.layer()).unwrap();
    plan.masked_cost(|x, y| mask.contains(&[y as u64, x as u64]))
}

/// Returns the positions of the mask that are inside the output, rounded up to tiles.
fn computed(accelerator: &Accelerator, case: &LayerCase, mask: &PositionSet) -> PositionSet {
    let [height, width] = case.outputs;
    let inside = mask.iter().copied().filter(|&[y, x]| y < height && x < width).collect();
    round_up_to_tiles(&inside, case.outputs, accelerator.tile.map(u64::from))
}

fn totals(cost: &LayerCost) -> Vec<f64> {
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let counts = [
        cost.cycles,
        cost.array_cycles,
        cost.dram_cycles,
        cost.macs,
        cost.register.access_count(),
        cost.array.access_count(),
        cost.buffer.access_count(),
        cost.dram.access_count(),
    ]
    .map(|count| count as f64);
    let energy = &cost.energy;
    let energies = [energy.mac, energy.register, energy.array, energy.buffer, energy.dram];
    [&counts[..], &energies].concat()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_full_mask_costs_the_whole_and_an_empty_one_nothing(case in layer_case(), accelerator in accelerator()) {
        let plan = accelerator.plan(case.layer()).unwrap();
        prop_assert_eq!(plan.masked_cost(|_, _| true), plan.whole_cost());
        prop_assert_eq!(plan.masked_cost(|_, _| false), LayerCost::default());
    }

    #[test]
    fn fewer_positions_never_cost_more(case in layer_case(), accelerator in accelerator(), masks in masks()) {
        let [small, large] = masks.map(|mask| totals(&masked(&accelerator, &case, &mask)));
        for (small, large) in small.iter().zip(&large) {
            prop_assert!(small <= large, "{small} and {large}");
        }
    }

    #[test]
    fn counts_are_those_of_the_computed_positions(case in layer_case(), accelerator in accelerator(), masks in masks()) {
        let [mask, _] = masks;
        let cost = masked(&accelerator, &case, &mask);
        let computed = computed(&accelerator, &case, &mask);
        let positions = case.images * computed.len() as u64;
        let per_position = case.groups * case.channels[1] * case.inner();
        prop_assert_eq!(cost.macs, positions * per_position);
        prop_assert_eq!(cost.dram.outputs, positions * case.groups * case.channels[1]);
        // All weights are fetched a whole number of times, and inputs at least once.
        prop_assert_eq!(cost.dram.weights % per_position, 0);
        prop_assert_eq!(cost.dram.weights > 0, positions > 0);
        let input_positions = needed_inputs(&computed, case.axes, case.inputs).len() as u64;
        prop_assert!(cost.dram.inputs >= case.images * case.groups * case.channels[0] * input_positions);
        prop_assert_eq!(cost.cycles, cost.array_cycles.max(cost.dram_cycles));
        let share = cost.utilization(&accelerator);
        prop_assert!((0.0..=1.0).contains(&share), "{share}");
    }

    #[test]
    fn systolic_arrays_cost_what_a_simulation_of_every_clock_counts(case in layer_case(), masks in masks(), sides in [1..6_u64, 1..6_u64]) {
        type ArrayOracle = fn([u64; 2], u64, u64, u64) -> SimulatedCounts;
        let array = by_hand::systolic(sides[0], sides[1]);
        let both: [(Dataflow, ArrayOracle); 2] = [
            (Dataflow::WeightStationary(array.clone()), weight_stationary),
            (Dataflow::OutputStationary(array), output_stationary),
        ];
        for (dataflow, simulate) in both {
            let accelerator = by_hand::accelerator(dataflow);
            let computed = computed(&accelerator, &case, &masks[0]);
            let cost = masked(&accelerator, &case, &masks[0]);
            let positions = case.images * computed.len() as u64;
            if positions == 0 {
                continue;
            }
            let simulated = simulate(sides, positions, case.inner(), case.channels[1]);
            prop_assert_eq!(cost.array_cycles, case.groups * simulated.clocks);
            prop_assert_eq!(cost.macs, case.groups * simulated.macs);
            // The buffer holds everything, so it is filled once.
            let inputs = case.images * case.groups * case.channels[0] * needed_inputs(&computed, case.axes, case.inputs).len() as u64;
            let weights = case.groups * case.channels[1] * case.inner();
            prop_assert_eq!(cost.dram, MemoryAccesses { inputs, weights, sums: 0, outputs: positions * case.groups * case.channels[1] });
            prop_assert_eq!(cost.buffer.inputs, inputs + case.groups * simulated.inputs);
            prop_assert_eq!(cost.buffer.weights, weights + case.groups * simulated.weights);
        }
    }
}
