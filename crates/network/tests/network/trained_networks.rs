// SPDX-License-Identifier: MIT OR Apache-2.0
//! Trained networks of other projects, in the folder that the environment variable FOVEATE_DATA
//! names, are read, and a part has the bits of a dense computation. The networks are compared with
//! onnxruntime by `scripts/figures/compare_networks.py`.

use crate::exactness::{first_difference, masked_clip};
use foveate_network::{ExecutionMode, FrameSize, Network};
use foveate_tools::testing::data_folder;

/// The name, width and height of each network.
const NETWORKS: [(&str, usize, usize); 7] = [
    ("FastestDet", 352, 352),
    ("RFB-320", 320, 240),
    ("SqueezeNet_fp16", 224, 224),
    ("deeplab_nchw", 513, 513),
    ("prisma_nchw", 256, 256),
    ("yolox_nano", 416, 416),
    ("yunet_n_320_320", 320, 320),
];

#[test]
fn trained_networks_run() {
    let Some(folder) = data_folder() else { return };
    for (name, width, height) in NETWORKS {
        let path = folder.join("networks").join(format!("{name}.onnx"));
        let network =
            Network::read(&path, |path| std::fs::File::open(path), FrameSize { width, height })
                .unwrap_or_else(|error| panic!("{name}: {error}"));
        let frames = masked_clip(3, [height, width], &[vec![(width / 3, height / 2, 12)]]);
        assert_eq!(first_difference(&network, ExecutionMode::Exact, &frames), None, "{name}");
    }
}
