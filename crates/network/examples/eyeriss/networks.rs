// SPDX-License-Identifier: MIT OR Apache-2.0
//! The convolutions of AlexNet and VGG-16, and the measurements on Eyeriss by Chen et al., JSSC
//! 2017.

use foveate_network::accelerator::{AcceleratorError, KernelWindow, Layer, TensorShape};

/// A network and the measurements of its convolutions.
pub(crate) struct PublishedNetwork {
    pub(crate) name: &'static str,
    /// The number of images that ran together.
    pub(crate) images: u64,
    pub(crate) frames_per_second: f64,
    /// The accesses to the DRAM per multiplication, with compression of zeros on the way to and
    /// from the DRAM.
    pub(crate) accesses_per_mac: f64,
    /// The power of the chip, without the DRAM.
    pub(crate) milliwatts: f64,
    pub(crate) layers: Vec<(String, Layer)>,
}

pub(crate) fn alexnet() -> Result<PublishedNetwork, AcceleratorError> {
    let layers = [
        ("conv1", 3, 227, 96, 55, KernelWindow::of(11, 4, 0), 1),
        ("conv2", 96, 27, 256, 27, KernelWindow::of(5, 1, 2), 2),
        ("conv3", 256, 13, 384, 13, KernelWindow::of(3, 1, 1), 1),
        ("conv4", 384, 13, 384, 13, KernelWindow::of(3, 1, 1), 2),
        ("conv5", 384, 13, 256, 13, KernelWindow::of(3, 1, 1), 2),
    ];
    let layer = |(name, channels, side, filters, to, window, groups): (&str, _, _, _, _, _, _)| {
        let inputs = TensorShape { channels, height: side, width: side };
        let outputs = TensorShape { channels: filters, height: to, width: to };
        let layer = Layer::convolution(inputs, outputs, [window; 2], groups)?.with_images(4)?;
        Ok((name.to_owned(), layer))
    };
    Ok(PublishedNetwork {
        name: "AlexNet",
        images: 4,
        frames_per_second: 35.0,
        accesses_per_mac: 0.0029,
        milliwatts: 278.0,
        layers: layers.into_iter().map(layer).collect::<Result<_, AcceleratorError>>()?,
    })
}

pub(crate) fn vgg16() -> Result<PublishedNetwork, AcceleratorError> {
    let stages = [(224, 64, 2), (112, 128, 2), (56, 256, 3), (28, 512, 3), (14, 512, 3)];
    let mut channels = 3;
    let mut layers = Vec::new();
    for (stage, (side, filters, count)) in (1..).zip(stages) {
        for at in 1..=count {
            let inputs = TensorShape { channels, height: side, width: side };
            let outputs = TensorShape { channels: filters, ..inputs };
            let layer = Layer::convolution(inputs, outputs, [KernelWindow::of(3, 1, 1); 2], 1)?;
            layers.push((format!("conv{stage}_{at}"), layer.with_images(3)?));
            channels = filters;
        }
    }
    Ok(PublishedNetwork {
        name: "VGG-16",
        images: 3,
        frames_per_second: 0.7,
        accesses_per_mac: 0.0035,
        milliwatts: 236.0,
        layers,
    })
}
