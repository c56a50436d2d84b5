// SPDX-License-Identifier: MIT OR Apache-2.0
//! The quantized network of the project is compared with onnxruntime 1.31. Both files of `golden`
//! were written by `scripts/figures/quantize.py`.

use foveate_network::{ElementType, ExecutionMode, Executor, FrameSize, Mask, Network};
use std::path::Path;

#[test]
fn the_quantized_denoiser_is_that_of_onnxruntime() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser-int8.onnx"));
    let picture: Vec<f32> = include_bytes!("golden/denoiser-int8.picture")
        .iter()
        .map(|&pixel| f32::from(pixel) / 255.0)
        .collect();
    let right: Vec<f32> = include_bytes!("golden/denoiser-int8.output")
        .as_chunks()
        .0
        .iter()
        .map(|&bytes| f32::from_le_bytes(bytes))
        .collect();
    let network =
        Network::read(path, |path| std::fs::File::open(path), FrameSize { width: 48, height: 32 })
            .unwrap();
    let mut executor = Executor::new(&network, ExecutionMode::Dense);
    executor.step(&picture, &Mask::full(32, 48));
    let &[output] = network.outputs() else { panic!("one output") };
    assert_eq!(*executor.tensor(output).real_values(), right);
    // The tensors are the input, the quantized input, four quantized tensors of 12, 12, 12 and 1
    // channels, and the last two of floating-point values. The number of kept bytes must be their
    // real size.
    let elements: Vec<ElementType> =
        (0..=network.nodes().len()).map(|value| network.form(value).encoding().element).collect();
    assert_eq!(elements[0], ElementType::F32);
    assert_eq!(elements[1..6], [ElementType::U8; 5]);
    assert_eq!(elements[6..], [ElementType::F32; 2]);
    assert_eq!(network.kept_bytes(), 32 * 48 * (4 + 1 + 3 * 12 + 1 + 4 + 4));
    assert_eq!(network.nodes()[2].weight_bytes(), 12 * 12 * 9 + 12 + 12 * (4 + 4));
}
