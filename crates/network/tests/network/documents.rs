// SPDX-License-Identifier: MIT OR Apache-2.0
//! The documentation lists the supported operators, and the networks of the project can be read.

use foveate_network::{FrameSize, Network, operators};
use std::path::Path;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn the_page_lists_the_operators() {
    let page = std::fs::read_to_string(root().join("docs/guides/infer.md")).unwrap();
    let paragraph = page
        .split("These operators are supported:")
        .nth(1)
        .unwrap()
        .trim()
        .split("\n\n")
        .next()
        .unwrap();
    let listed: Vec<&str> = paragraph.split('`').skip(1).step_by(2).collect();
    assert_eq!(listed, operators().collect::<Vec<_>>());
    assert!(listed.is_sorted(), "by the alphabet: {listed:?}");
}

#[test]
fn the_denoiser_takes_frames_of_any_size() {
    for (width, height) in [(224, 224), (31, 17)] {
        let network = Network::read(
            &root().join("networks/denoiser.onnx"),
            |path| std::fs::File::open(path),
            FrameSize { width, height },
        )
        .unwrap();
        let &[output] = network.outputs() else { panic!("one output") };
        assert_eq!(network.form(output).shape(), [1, 1, height, width]);
    }
}
