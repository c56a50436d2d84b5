// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small networks are compared with torch. `scripts/figures/golden_networks.py` wrote the files,
//! and has compared torch with onnxruntime.

use foveate_network::{ExecutionMode, Executor, FrameSize, Mask, Network};
use std::path::Path;

/// The tolerance as a share of the largest output. Sums are added in another order, and
/// exponentials are computed differently.
const TOLERANCE: f32 = 4e-6;

/// The name, width and height of each network.
const NETWORKS: [(&str, usize, usize); 13] = [
    ("activations", 9, 7),
    ("attention", 7, 6),
    ("convolutions", 19, 13),
    ("head", 8, 6),
    ("inverted", 18, 21),
    ("lenet", 20, 20),
    ("moves", 7, 6),
    ("norms", 7, 6),
    ("pools", 14, 11),
    ("residual", 37, 30),
    ("resizes", 7, 5),
    ("shapes", 10, 9),
    ("transposed", 7, 5),
];

fn values(path: &Path) -> Vec<f32> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

#[test]
fn outputs_are_those_of_torch() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/network/golden");
    for (name, width, height) in NETWORKS {
        let path = folder.join(format!("{name}.onnx"));
        let network =
            Network::read(&path, |path| std::fs::File::open(path), FrameSize { width, height })
                .unwrap();
        let mut executor = Executor::new(&network, ExecutionMode::Dense);
        executor.step(&values(&path.with_extension("input")), &Mask::full(height, width));
        let found: Vec<f32> = network
            .outputs()
            .iter()
            .flat_map(|&output| executor.tensor(output).real_values().into_owned())
            .collect();
        let wanted = values(&path.with_extension("output"));
        assert_eq!(found.len(), wanted.len(), "{name}");
        let largest = wanted.iter().fold(0.0f32, |largest, value| largest.max(value.abs()));
        for (at, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            assert!(
                (found - wanted).abs() <= TOLERANCE * largest,
                "{name}, value {at}: {found} instead of {wanted}"
            );
        }
    }
}
