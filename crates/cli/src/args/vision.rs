// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options that say how a network is shown frames and how its outputs are read. Every command
//! with these options has an argument `network`, and refuses the options if it is not given.

use clap::Args;
use foveate_inference::{
    Detector, Framing, PixelMapping, VisionOptions, parse_detector, parse_framing, parse_mean,
    parse_scale,
};

/// The options that say how a network is shown frames and how its outputs are read.
#[derive(Args, Debug)]
pub(crate) struct VisionArgs {
    /// Fit of frames to the size of the network's input: same, no change; letterbox, scaled as a
    /// whole into the upper left, the rest grey; stretch, width and height scaled separately.
    /// Networks that take any size need a size here, as in letterbox=416x416
    #[arg(long, value_name = "WAY", default_value = "same", value_parser = parse_framing, requires = "network")]
    pub(crate) framing: Framing,
    /// Subtract this from pixels that range from 0 to 1: one value, or one per channel, each a
    /// number or a quotient
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "0", allow_negative_numbers = true, value_parser = parse_mean, requires = "network")]
    pub(crate) mean: Vec<f32>,
    /// Divide by this after --mean: one value, or one per channel; 1/255 makes pixels that range
    /// from 0 to 255
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "1", allow_negative_numbers = true, value_parser = parse_scale, requires = "network")]
    pub(crate) scale: Vec<f32>,
    /// Compare detections. The value is a format of outputs: yolox, yolov5 (and v7), yolov8 (and
    /// 11), ssd, yunet or fastestdet. It may also say which detections count, as in
    /// yolox,score=0.3,overlap=0.45,classes=0+2,height=80: those with a score of at least 0.3; of
    /// those of one class that overlap by more than 0.45 only the surest; only these classes; only
    /// objects at least 80 pixels high
    #[arg(long, value_name = "FORMAT", value_parser = parse_detector, requires = "network")]
    pub(crate) detect: Option<Detector>,
}

impl VisionArgs {
    pub(crate) fn options(&self) -> VisionOptions {
        let mapping = PixelMapping { mean: self.mean.clone(), scale: self.scale.clone() };
        VisionOptions { framing: self.framing, mapping, detector: self.detect.clone() }
    }
}
