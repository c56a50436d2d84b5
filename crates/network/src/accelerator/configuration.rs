// SPDX-License-Identifier: MIT OR Apache-2.0
//! The description of an accelerator ([`Accelerator`]), which is read from a TOML file. Files
//! of named accelerators come with the program, and state the source of every figure
//! ([`PRESETS`]).

use crate::accelerator::AcceleratorError;
use serde::Deserialize;

/// An accelerator: an array of multipliers, its buffers, and the energy of an access.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accelerator {
    /// The clock frequency in MHz.
    pub clock_mhz: f64,
    /// The number of bits of an input, a weight, or an output.
    pub value_bits: u32,
    /// The number of bits of an unfinished sum.
    pub sum_bits: u32,
    /// The rows and columns of a tile: the positions of an output that are computed together.
    pub tile: [u32; 2],
    /// The bytes that the DRAM delivers or takes per cycle; without this, the DRAM causes no wait.
    pub dram_bytes_per_cycle: Option<f64>,
    /// The array and its buffers.
    pub array: Dataflow,
    /// The energy of a multiplication and of each access.
    pub energy: AccessEnergies,
}

/// The dataflow of the array: the values that stay in the array while the others stream through.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "dataflow", rename_all = "kebab-case")]
pub enum Dataflow {
    /// Weights stay in the array.
    WeightStationary(SystolicArray),
    /// Sums stay in the array.
    OutputStationary(SystolicArray),
    /// Rows of weights, inputs and sums stay in the array, as on Eyeriss.
    RowStationary(RowStationaryArray),
}

/// A systolic array with three buffers.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SystolicArray {
    /// The number of rows of the array.
    pub rows: u64,
    /// The number of columns of the array.
    pub columns: u64,
    /// The size of the buffer of inputs in bytes.
    pub input_bytes: u64,
    /// The size of the buffer of weights in bytes.
    pub weight_bytes: u64,
    /// The size of the buffer of sums and outputs in bytes.
    pub output_bytes: u64,
}

/// An array of elements that each convolve rows, with one buffer for inputs and sums.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RowStationaryArray {
    /// The number of rows of the array.
    pub rows: u64,
    /// The number of columns of the array.
    pub columns: u64,
    /// The size of the buffer of inputs and sums in bytes.
    pub buffer_bytes: u64,
    /// The number of inputs that an element holds.
    pub element_inputs: u64,
    /// The number of weights that an element holds.
    pub element_weights: u64,
    /// The number of sums that an element holds.
    pub element_sums: u64,
    /// The number of inputs that enter the array per cycle.
    pub inputs_per_cycle: u64,
    /// The number of weights that enter the array per cycle.
    pub weights_per_cycle: u64,
    /// The number of sums that enter the array per cycle. As many can leave it in the same cycle.
    pub sums_per_cycle: u64,
    /// The objective by which the mapping of a layer is chosen.
    pub mapping: MappingObjective,
}

/// The objective of a mapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MappingObjective {
    /// The fewest accesses to the DRAM; of several such mappings, the one with the fewest cycles.
    LeastDram,
    /// The smallest product of energy and cycles.
    LeastEnergyDelay,
}

/// The energy of a multiplication with its addition, and of an access to a value of `value_bits`,
/// in picojoules.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccessEnergies {
    /// The energy of a multiplication with its addition.
    pub mac_pj: f64,
    /// The energy of an access to a register of an element of the array.
    pub register_pj: f64,
    /// The energy of a transfer from one element of the array to the next.
    pub array_pj: f64,
    /// The energy of an access to the buffer on the chip.
    pub buffer_pj: f64,
    /// The energy of an access to the memory outside the chip.
    pub dram_pj: f64,
}

/// Replaces a Rust type name at the end of a message by words that users know.
fn problem_in_words(problem: &str) -> String {
    let number = "expected a number";
    let whole_number = "expected a whole number from 1 on";
    let types =
        [("expected u64", whole_number), ("expected u32", whole_number), ("expected f64", number)];
    let replaced =
        types.iter().find_map(|(type_name, words)| Some((problem.strip_suffix(type_name)?, words)));
    replaced.map_or_else(|| problem.to_owned(), |(start, words)| format!("{start}{words}"))
}

impl Accelerator {
    /// Parses an accelerator.
    ///
    /// # Errors
    /// Fails if the text is not valid TOML, or if a key is unknown, missing, of the wrong type, or
    /// out of range.
    pub fn from_toml(text: &str) -> Result<Self, AcceleratorError> {
        let table: toml::Table = text.parse().map_err(|error: toml::de::Error| {
            AcceleratorError::InvalidToml(error.message().to_owned())
        })?;
        let accelerator: Self = serde_path_to_error::deserialize(toml::Value::Table(table))
            .map_err(|error| {
                let problem = problem_in_words(error.inner().message());
                AcceleratorError::InvalidKey { key: error.path().to_string(), problem }
            })?;
        accelerator.validate()?;
        Ok(accelerator)
    }

    /// Returns a preset by its name.
    ///
    /// # Errors
    /// Fails if there is no preset of that name; the message lists the existing ones.
    pub fn from_preset(name: &str) -> Result<Self, AcceleratorError> {
        Self::from_toml(AcceleratorPreset::find(name)?.toml)
    }

    /// Returns the duration of a number of cycles in seconds.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "a time")]
    pub fn seconds(&self, cycles: u64) -> f64 {
        cycles as f64 / (1e6 * self.clock_mhz)
    }

    /// Returns the number of elements of the array, which is the largest number of multiplications
    /// in a cycle.
    #[must_use]
    pub fn element_count(&self) -> u64 {
        match &self.array {
            Dataflow::WeightStationary(array) | Dataflow::OutputStationary(array) => {
                array.rows * array.columns
            }
            Dataflow::RowStationary(array) => array.rows * array.columns,
        }
    }

    /// Returns the number of bytes of a number of values, rounded up.
    pub(crate) fn value_bytes(&self, values: u64) -> u64 {
        (values * u64::from(self.value_bits)).div_ceil(8)
    }

    /// Returns the number of bytes of a number of sums, rounded up.
    pub(crate) fn sum_bytes(&self, sums: u64) -> u64 {
        (sums * u64::from(self.sum_bits)).div_ceil(8)
    }

    pub(crate) fn validate(&self) -> Result<(), AcceleratorError> {
        check_range("value_bits", self.value_bits.into(), 1..=64, "1 to 64")?;
        check_range("sum_bits", self.sum_bits.into(), 1..=64, "1 to 64")?;
        for side in self.tile {
            check_range("tile", side.into(), 1..=65_536, "1 to 65536 for each side")?;
        }
        check_positive("clock_mhz", self.clock_mhz)?;
        if let Some(rate) = self.dram_bytes_per_cycle {
            check_positive("dram_bytes_per_cycle", rate)?;
        }
        self.energy.validate()?;
        match &self.array {
            Dataflow::WeightStationary(array) | Dataflow::OutputStationary(array) => {
                array.validate()
            }
            Dataflow::RowStationary(array) => array.validate(),
        }
    }
}

impl SystolicArray {
    fn validate(&self) -> Result<(), AcceleratorError> {
        check_side("array.rows", self.rows)?;
        check_side("array.columns", self.columns)?;
        check_bytes("array.input_bytes", self.input_bytes)?;
        check_bytes("array.weight_bytes", self.weight_bytes)?;
        check_bytes("array.output_bytes", self.output_bytes)
    }
}

impl RowStationaryArray {
    fn validate(&self) -> Result<(), AcceleratorError> {
        // A larger array has so many mappings that the search takes too long.
        check_range("array.rows", self.rows, 1..=128, "1 to 128 if row-stationary")?;
        check_range("array.columns", self.columns, 1..=128, "1 to 128 if row-stationary")?;
        check_bytes("array.buffer_bytes", self.buffer_bytes)?;
        check_side("array.element_inputs", self.element_inputs)?;
        check_side("array.element_weights", self.element_weights)?;
        check_side("array.element_sums", self.element_sums)?;
        if self.element_weights < self.element_inputs {
            return Err(AcceleratorError::OutOfRange {
                key: "array.element_weights",
                value: self.element_weights.to_string(),
                valid: "at least `array.element_inputs`, because every input in an element meets a weight",
            });
        }
        check_side("array.inputs_per_cycle", self.inputs_per_cycle)?;
        check_side("array.weights_per_cycle", self.weights_per_cycle)?;
        check_side("array.sums_per_cycle", self.sums_per_cycle)
    }
}

impl AccessEnergies {
    fn validate(&self) -> Result<(), AcceleratorError> {
        let all = [
            ("energy.mac_pj", self.mac_pj),
            ("energy.register_pj", self.register_pj),
            ("energy.array_pj", self.array_pj),
            ("energy.buffer_pj", self.buffer_pj),
            ("energy.dram_pj", self.dram_pj),
        ];
        let valid = |value: f64| (0.0..=1e9).contains(&value);
        match all.into_iter().find(|&(_, value)| !valid(value)) {
            None => Ok(()),
            Some((key, value)) => {
                let valid = "0 to 1e9 picojoules";
                Err(AcceleratorError::OutOfRange { key, value: value.to_string(), valid })
            }
        }
    }
}

fn check_range(
    key: &'static str,
    value: u64,
    range: std::ops::RangeInclusive<u64>,
    valid: &'static str,
) -> Result<(), AcceleratorError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(AcceleratorError::OutOfRange { key, value: value.to_string(), valid })
}

fn check_side(key: &'static str, value: u64) -> Result<(), AcceleratorError> {
    check_range(key, value, 1..=1024, "1 to 1024")
}

fn check_bytes(key: &'static str, value: u64) -> Result<(), AcceleratorError> {
    check_range(key, value, 1..=1 << 40, "1 to 2^40 bytes")
}

fn check_positive(key: &'static str, value: f64) -> Result<(), AcceleratorError> {
    if (1e-6..=1e9).contains(&value) {
        return Ok(());
    }
    Err(AcceleratorError::OutOfRange { key, value: value.to_string(), valid: "1e-6 to 1e9" })
}

/// A named accelerator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AcceleratorPreset {
    /// The name on the command line.
    pub name: &'static str,
    /// A description in one line.
    pub summary: &'static str,
    /// The text of its file, which a user can start from.
    pub toml: &'static str,
}

/// All presets.
pub const PRESETS: &[AcceleratorPreset] = &[
    AcceleratorPreset {
        name: "systolic-ws",
        summary: "16 x 16 weight-stationary systolic array, 8 bits",
        toml: include_str!("../../presets/systolic-ws.toml"),
    },
    AcceleratorPreset {
        name: "systolic-os",
        summary: "16 x 16 output-stationary systolic array, 8 bits",
        toml: include_str!("../../presets/systolic-os.toml"),
    },
    AcceleratorPreset {
        name: "eyeriss",
        summary: "12 x 14 row-stationary array like Eyeriss, 16 bits",
        toml: include_str!("../../presets/eyeriss.toml"),
    },
];

impl AcceleratorPreset {
    /// Returns the preset of that name.
    ///
    /// # Errors
    /// Fails if there is no such preset; the message lists the existing ones.
    pub fn find(name: &str) -> Result<&'static Self, AcceleratorError> {
        PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| {
            AcceleratorError::UnknownPreset {
                name: name.to_owned(),
                known: PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", "),
            }
        })
    }
}
