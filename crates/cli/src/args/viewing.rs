// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a network is shown frames, and how its outputs are read. Every command that takes this has an argument `network`, and
//! refuses it where that is not given.

use clap::Args;
use foveate_inference::{
    Detector, Framing, Mapping, Viewing, parse_detector, parse_framing, parse_mean, parse_scale,
};

/// How a network is shown frames, and how its outputs are read.
#[derive(Args, Debug)]
pub(crate) struct ViewingArgs {
    /// How frames get the size of the network's input: same, they have it; letterbox, scaled as a whole into the upper left, the
    /// rest grey; stretch, each side for itself. Networks that take any size need one, as in letterbox=416x416
    #[arg(long, value_name = "WAY", default_value = "same", value_parser = parse_framing, requires = "network")]
    pub(crate) framing: Framing,
    /// Subtract this from pixels of 0 to 1: one value, or one per channel, each a number or a quotient
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "0", allow_negative_numbers = true, value_parser = parse_mean, requires = "network")]
    pub(crate) mean: Vec<f32>,
    /// Then divide by this: one value, or one per channel; 1/255 makes pixels of 0 to 255
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "1", allow_negative_numbers = true, value_parser = parse_scale, requires = "network")]
    pub(crate) scale: Vec<f32>,
    /// Compare detections, in a format of outputs: yolox, yolov5 (and v7), yolov8 (and 11), ssd, yunet or
    /// fastestdet, and which of them count, as in yolox,score=0.3,overlap=0.45,classes=0+2,height=80: a score of at least 0.3, of those
    /// of a class that overlap by more than 0.45 the surest, these classes, objects of at least 80 pixels
    #[arg(long, value_name = "FORMAT", value_parser = parse_detector, requires = "network")]
    pub(crate) detect: Option<Detector>,
}

impl ViewingArgs {
    pub(crate) fn viewing(&self) -> Viewing {
        let mapping = Mapping { mean: self.mean.clone(), scale: self.scale.clone() };
        Viewing { framing: self.framing, mapping, detector: self.detect.clone() }
    }
}
