// SPDX-License-Identifier: MIT OR Apache-2.0
//! Accelerators as files: presets are valid, and every mistake has a message of one clear line.

use foveate_network::accelerator::{
    Accelerator, AcceleratorError, KernelWindow, Layer, PRESETS, TensorShape,
};

#[test]
fn every_preset_is_valid_and_found_by_its_name() {
    for preset in PRESETS {
        let accelerator = Accelerator::from_preset(preset.name).unwrap();
        assert_eq!(accelerator, Accelerator::from_toml(preset.toml).unwrap(), "{}", preset.name);
    }
    let message = Accelerator::from_preset("t\npu").unwrap_err().to_string();
    assert_eq!(
        message,
        "unknown accelerator `t\\npu`; presets are systolic-ws, systolic-os, eyeriss"
    );
}

/// The preset, the replaced text, its replacement, and a part of the expected message.
const MISTAKES: &[(&str, &str, &str, &str)] = &[
    ("systolic-ws", "[array]", "[array", "not valid TOML"),
    ("systolic-ws", "clock_mhz = 400", "", "missing field `clock_mhz`"),
    ("systolic-ws", "clock_mhz", "clock", "unknown field `clock`"),
    ("systolic-ws", "clock_mhz = 400", "clock_mhz = 0", "`clock_mhz` = 0 is out of range"),
    ("systolic-ws", "clock_mhz = 400", "clock_mhz = nan", "`clock_mhz` = NaN is out of range"),
    ("systolic-ws", "clock_mhz = 400", "clock_mhz = \"fast\"", "`clock_mhz`: invalid type"),
    ("systolic-ws", "value_bits = 8", "value_bits = 65", "`value_bits` = 65 is out of range"),
    ("systolic-ws", "sum_bits = 32", "sum_bits = -1", "`sum_bits`: invalid value"),
    ("systolic-ws", "tile = [1, 8]", "tile = [0, 8]", "`tile` = 0 is out of range"),
    ("systolic-ws", "tile = [1, 8]", "tile = [8]", "`tile`: invalid length 1"),
    ("systolic-ws", "per_cycle = 16", "per_cycle = -2", "`dram_bytes_per_cycle` = -2 is out"),
    (
        "systolic-ws",
        "\"weight-stationary\"",
        "\"input-stationary\"",
        "`array.dataflow`: unknown variant",
    ),
    ("systolic-ws", "dataflow = \"weight-stationary\"", "", "`array`: missing field `dataflow`"),
    ("systolic-ws", "rows = 16", "rows = 0", "`array.rows` = 0 is out of range"),
    (
        "systolic-ws",
        "rows = 16",
        "rows = -3",
        "invalid value: integer `-3`, expected a whole number from 1 on",
    ),
    ("eyeriss", "rows = 12", "rows = 1.5", "`1.5`, expected a whole number from 1 on"),
    ("systolic-ws", "sum_bits = 32", "sum_bits = -1", "expected a whole number from 1 on"),
    ("systolic-ws", "clock_mhz = 400", "clock_mhz = true", "`true`, expected a number"),
    ("systolic-ws", "rows = 16", "rows = 99999", "the valid range is 1 to 1024"),
    ("systolic-ws", "rows = 16", "row = 16", "`array`: unknown field `row`"),
    ("systolic-os", "weight_bytes = 65536", "weight_bytes = 0", "`array.weight_bytes` = 0 is out"),
    ("systolic-os", "dram_pj = 60.0", "dram_pj = -1.0", "`energy.dram_pj` = -1 is out of range"),
    ("systolic-os", "dram_pj = 60.0", "dram_pj = inf", "`energy.dram_pj` = inf is out of range"),
    ("systolic-os", "[energy]", "[power]", "unknown field `power`"),
    (
        "eyeriss",
        "rows = 12",
        "rows = 129",
        "`array.rows` = 129 is out of range; the valid range is 1 to 128",
    ),
    ("eyeriss", "element_sums = 16", "element_sums = 0", "`array.element_sums` = 0 is out"),
    ("eyeriss", "element_weights = 192", "element_weights = 5", "at least `array.element_inputs`"),
    (
        "eyeriss",
        "mapping = \"least-dram\"",
        "mapping = \"best\"",
        "`array`: unknown variant `best`",
    ),
];

#[test]
fn every_mistake_has_one_line_that_names_it() {
    for (preset, from, to, expected) in MISTAKES {
        let text = PRESETS.iter().find(|known| known.name == *preset).unwrap().toml;
        assert!(text.contains(from), "{preset} holds `{from}`");
        let message = Accelerator::from_toml(&text.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(message.contains(expected), "`{to}`: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

#[test]
fn layers_that_contradict_themselves_are_refused() {
    let shape = |channels, height, width| TensorShape { channels, height, width };
    let window = [KernelWindow::of(3, 1, 1); 2];
    let assert_refused = |layer: Result<Layer, AcceleratorError>, expected: &str| {
        assert_eq!(layer.unwrap_err().to_string(), expected);
    };
    let convolution = |inputs, outputs, groups| Layer::convolution(inputs, outputs, window, groups);
    assert_refused(
        convolution(shape(0, 4, 4), shape(4, 4, 4), 1),
        "the layer's number of input channels is 0, but must be 1 to 1048576",
    );
    assert_refused(
        convolution(shape(6, 4, 4), shape(4, 4, 4), 4),
        "the layer's number of input channels is 6, but must be a multiple of 4, the number of groups",
    );
    assert_refused(
        convolution(shape(4, 4, 4), shape(4, 1 << 20, 1 << 20), 1),
        "the layer's number of output positions is 1099511627776, but must be 1 to 268435456",
    );
    assert_refused(
        convolution(shape(1 << 20, 1 << 14, 1 << 14), shape(1 << 20, 1, 1), 1),
        "the layer's number of multiplications is 2656331146614175432704, but must be at most 1000000000000000, counted as if the layer were dense",
    );
    assert_refused(
        Layer::product(1, 1, 1).unwrap().with_images(0),
        "the layer's number of images is 0, but must be 1 to 1024",
    );
}

#[test]
fn a_buffer_that_is_too_small_is_named_with_the_needed_size() {
    let text = PRESETS[2].toml.replace("buffer_bytes = 102400", "buffer_bytes = 20");
    let accelerator = Accelerator::from_toml(&text).unwrap();
    let shape = TensorShape { channels: 1, height: 8, width: 8 };
    let layer = Layer::convolution(shape, shape, [KernelWindow::of(3, 1, 1); 2], 1).unwrap();
    let message = accelerator.plan(layer).unwrap_err().to_string();
    // The smallest strip has one row: three rows of inputs and one of sums, with 16 bits each.
    assert_eq!(
        message,
        "`array.buffer_bytes` = 20 is too small for this layer; its smallest pass needs 64 bytes"
    );
}

#[test]
fn an_accelerator_that_was_changed_is_checked_again() {
    let accelerator = Accelerator { tile: [0, 1], ..Accelerator::from_preset("eyeriss").unwrap() };
    let message = accelerator.plan(Layer::product(1, 1, 1).unwrap()).unwrap_err().to_string();
    assert_eq!(
        message,
        "accelerator, `tile` = 0 is out of range; the valid range is 1 to 65536 for each side"
    );
}
