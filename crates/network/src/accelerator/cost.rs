// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cost of a layer: cycles, accesses, energy. Costs of layers and frames can be added.

use crate::accelerator::Accelerator;
use serde::Serialize;
use std::iter::Sum;
use std::ops::{Add, AddAssign};

/// The accesses to one level of the memory, each to one value. A read counts as one, and a write
/// counts as one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MemoryAccesses {
    /// The accesses to inputs of the layer.
    pub inputs: u64,
    /// The accesses to weights.
    pub weights: u64,
    /// The accesses to unfinished sums, which have `sum_bits`.
    pub sums: u64,
    /// The accesses to outputs of the layer.
    pub outputs: u64,
}

impl MemoryAccesses {
    /// Returns the number of all accesses.
    #[must_use]
    pub fn access_count(&self) -> u64 {
        self.inputs + self.weights + self.sums + self.outputs
    }
}

/// The cost of one or more layers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LayerCost {
    /// The cycles until all layers are done, one after the other. A layer takes the longer of
    /// `array_cycles` and `dram_cycles`, because array and DRAM work in parallel.
    pub cycles: u64,
    /// The cycles in which the array is busy, including those that fill and drain it.
    pub array_cycles: u64,
    /// The cycles in which the DRAM is busy; 0 if it causes no wait.
    pub dram_cycles: u64,
    /// The multiplications of the computed positions.
    pub macs: u64,
    /// The accesses to registers in the array.
    pub register: MemoryAccesses,
    /// The transfers into an element of the array from a neighbouring element or, in a
    /// row-stationary array, from the network.
    pub array: MemoryAccesses,
    /// The accesses to the buffer on the chip.
    pub buffer: MemoryAccesses,
    /// The accesses to the memory outside the chip.
    pub dram: MemoryAccesses,
    /// The energy.
    pub energy: EnergyCost,
}

/// The energy in picojoules, without clock, control and leakage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyCost {
    /// The energy of the multiplications and additions.
    pub mac: f64,
    /// The energy of the registers in the array.
    pub register: f64,
    /// The energy of transfers in the array.
    pub array: f64,
    /// The energy of the buffer.
    pub buffer: f64,
    /// The energy of the DRAM.
    pub dram: f64,
}

impl EnergyCost {
    /// Returns the energy of the chip, without the DRAM.
    #[must_use]
    pub fn chip(&self) -> f64 {
        self.mac + self.register + self.array + self.buffer
    }

    /// Returns the energy of the chip and the DRAM.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.chip() + self.dram
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LayerCounts {
    pub(crate) array_cycles: u64,
    pub(crate) macs: u64,
    pub(crate) register: MemoryAccesses,
    pub(crate) array: MemoryAccesses,
    pub(crate) buffer: MemoryAccesses,
    pub(crate) dram: MemoryAccesses,
}

impl LayerCost {
    /// Returns the share of the array's multipliers that are used while the array is busy; 0 if it
    /// is never busy.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "a share")]
    pub fn utilization(&self, accelerator: &Accelerator) -> f64 {
        if self.array_cycles == 0 {
            return 0.0;
        }
        self.macs as f64 / (self.array_cycles as f64 * accelerator.element_count() as f64)
    }

    pub(crate) fn from_counts(counts: &LayerCounts, accelerator: &Accelerator) -> Self {
        let dram_cycles = dram_cycles(&counts.dram, accelerator);
        Self {
            cycles: counts.array_cycles.max(dram_cycles),
            array_cycles: counts.array_cycles,
            dram_cycles,
            macs: counts.macs,
            register: counts.register,
            array: counts.array,
            buffer: counts.buffer,
            dram: counts.dram,
            energy: energy(counts, accelerator),
        }
    }
}

/// Returns the cycles in which the DRAM moves these values.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a time, rounded up to a cycle"
)]
fn dram_cycles(dram: &MemoryAccesses, accelerator: &Accelerator) -> u64 {
    let values = dram.inputs + dram.weights + dram.outputs;
    let bytes = accelerator.value_bytes(values) + accelerator.sum_bytes(dram.sums);
    accelerator.dram_bytes_per_cycle.map_or(0, |rate| (bytes as f64 / rate).ceil() as u64)
}

#[allow(clippy::cast_precision_loss, reason = "an energy")]
fn energy(counts: &LayerCounts, accelerator: &Accelerator) -> EnergyCost {
    let table = &accelerator.energy;
    // The energy of an access grows in proportion to the bits of the value.
    let sum_to_value_bits = f64::from(accelerator.sum_bits) / f64::from(accelerator.value_bits);
    let level_energy = |traffic: &MemoryAccesses, access: f64| {
        let values = (traffic.inputs + traffic.weights + traffic.outputs) as f64;
        access * (values + sum_to_value_bits * traffic.sums as f64)
    };
    EnergyCost {
        mac: table.mac_pj * counts.macs as f64,
        register: level_energy(&counts.register, table.register_pj),
        array: level_energy(&counts.array, table.array_pj),
        buffer: level_energy(&counts.buffer, table.buffer_pj),
        dram: level_energy(&counts.dram, table.dram_pj),
    }
}

impl AddAssign for MemoryAccesses {
    fn add_assign(&mut self, other: Self) {
        self.inputs += other.inputs;
        self.weights += other.weights;
        self.sums += other.sums;
        self.outputs += other.outputs;
    }
}

impl AddAssign for EnergyCost {
    fn add_assign(&mut self, other: Self) {
        self.mac += other.mac;
        self.register += other.register;
        self.array += other.array;
        self.buffer += other.buffer;
        self.dram += other.dram;
    }
}

impl AddAssign for LayerCost {
    fn add_assign(&mut self, other: Self) {
        self.cycles += other.cycles;
        self.array_cycles += other.array_cycles;
        self.dram_cycles += other.dram_cycles;
        self.macs += other.macs;
        self.register += other.register;
        self.array += other.array;
        self.buffer += other.buffer;
        self.dram += other.dram;
        self.energy += other.energy;
    }
}

impl Add for LayerCost {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sum for LayerCost {
    fn sum<I: Iterator<Item = Self>>(costs: I) -> Self {
        costs.fold(Self::default(), Add::add)
    }
}
