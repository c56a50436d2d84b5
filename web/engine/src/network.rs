// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network behind a camera: its outputs for whole frames and for the receiver's screen, compared
//! as `foveate infer` does.

use std::path::Path;

use foveate_network::{
    Network,
    vision::{
        AgreementSums, ClassAgreement, Detection, DetectionCounts, DetectionPairs, Detector,
        FrameFormat, NetworkDefaults, PixelMapping, VisionNetwork, VisionOptions, index_of_largest,
        parse_detector, parse_framing, parse_mean, parse_scale,
    },
};
use foveate_pixels::FramePixels;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::limits::{MAX_NETWORK_BYTES, MAX_NETWORK_FILE};
use crate::WebError;
use crate::page_cameras::check_size;

/// The side of the regions in which a frame is converted. The network computes all of it anyway.
const REGION_SIDE: u32 = 16;

/// The settings for showing frames to a network, in the words of the command line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkSettings {
    /// The name of the file, for messages.
    pub name: String,
    /// The value of `--framing`.
    pub framing: String,
    /// The value of `--mean`; the usual value of the network if it is left out.
    pub mean: Option<String>,
    /// The value of `--scale`; the usual value of the network if it is left out.
    pub scale: Option<String>,
    /// The value of `--detect`, or an empty text for no detections; the likely format of the
    /// network if it is left out.
    pub detect: Option<String>,
}

/// The network of a page: its file, and the opened network.
#[derive(Debug, Default)]
pub struct PageNetwork {
    file: Option<Vec<u8>>,
    network: Option<OpenNetwork>,
}

/// A network for frames of one size and depth.
#[derive(Debug)]
struct OpenNetwork {
    vision_network: VisionNetwork,
    frames: FrameFormat,
    /// The bits of a pixel.
    bits: u32,
}

/// The outputs of a network for a whole frame and for the receiver's screen, compared.
#[derive(Clone, Debug, Serialize)]
pub struct NetworkComparison {
    /// The agreement as one number, as `foveate infer` computes it.
    pub agreement: f64,
    /// The distance of the outputs from those of the whole frame, as a share of these.
    pub relative_rms: f64,
    /// The numbers of detections that were found, kept and added, if detections are read.
    pub found: Option<DetectionCounts>,
    /// The detections in the whole frame.
    pub whole: Vec<FrameDetection>,
    /// The detections in the receiver's screen.
    pub seen: Vec<FrameDetection>,
    /// The agreement of outputs that are one class.
    pub classes: Option<ClassAgreement>,
    /// The classes of the whole frame and of the receiver's screen, from the first such output.
    pub class: Option<[usize; 2]>,
    /// The share of the places with the same class, for outputs that have a class at every place.
    pub same_places: Option<f64>,
}

/// A detection in a frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameDetection {
    /// The number of its class.
    pub class: usize,
    /// The score of the detection, 0 to 1.
    pub score: f32,
    /// The left, upper, right and lower side, in pixels of the frame.
    pub rect: [f64; 4],
    /// True if the other frame has this detection, too.
    pub both: bool,
}

impl PageNetwork {
    /// Takes the file of a network. The previous network is dropped.
    ///
    /// # Errors
    /// Fails if the file is too large.
    pub fn set_file(&mut self, file: Vec<u8>) -> Result<(), WebError> {
        *self = Self::default();
        if file.len() > MAX_NETWORK_FILE {
            return Err(WebError::NetworkFile { given: file.len(), most: MAX_NETWORK_FILE });
        }
        self.file = Some(file);
        Ok(())
    }

    /// Makes the network of the file for frames of this size and depth. `wishes` is a
    /// [`NetworkSettings`] as JSON. Returns the facts about the network.
    ///
    /// # Errors
    /// Fails if there is no file, if it is no network that can be computed, or if the settings do
    /// not fit the network.
    pub fn open(&mut self, wishes: &[u8], size: (u32, u32), bits: u32) -> Result<Value, WebError> {
        self.network = None;
        let file = self.file.as_ref().ok_or(WebError::NoNetwork)?;
        let wishes: NetworkSettings = serde_json::from_slice(wishes)
            .map_err(|error| WebError::Setting { what: "wishes", problem: error.to_string() })?;
        let (network, told) = OpenNetwork::open(file, &wishes, size, bits)?;
        self.network = Some(network);
        Ok(told)
    }

    /// Runs the network on a frame and on the receiver's screen for it, which follow each other in
    /// `planes`. Pixels of up to 8 bits have one byte each; deeper pixels have two, the lower
    /// first.
    ///
    /// # Errors
    /// Fails if there is no network, or if the bytes are not two such frames.
    pub fn compare(&self, planes: &[u8]) -> Result<NetworkComparison, WebError> {
        self.network.as_ref().ok_or(WebError::NoNetwork)?.compare_frames(planes)
    }
}

impl OpenNetwork {
    fn open(
        file: &[u8],
        wishes: &NetworkSettings,
        (width, height): (u32, u32),
        bits: u32,
    ) -> Result<(Self, Value), WebError> {
        check_size(width, height)?;
        if !(1..=16).contains(&bits) {
            return Err(WebError::PixelDepth { bits });
        }
        let wrong = |what| move |problem| WebError::Setting { what, problem };
        let framing = parse_framing(&wishes.framing).map_err(wrong("framing"))?;
        let mapping = PixelMapping { mean: vec![0.0], scale: vec![1.0] };
        let vision_options = VisionOptions { framing, mapping, detector: None };
        let path = Path::new(&wishes.name);
        let vision_network = VisionNetwork::parse(file, path, (width, height), &vision_options)?;
        let (needed, most) = (vision_network.network().kept_bytes(), MAX_NETWORK_BYTES);
        if needed > most {
            return Err(WebError::NetworkMemory { needed, most });
        }
        let usual = vision_network.guess_defaults();
        let mean = wishes.mean.as_deref().unwrap_or(usual.mean);
        let scale = wishes.scale.as_deref().unwrap_or(usual.scale);
        let mapping = PixelMapping {
            mean: parse_values(mean, parse_mean).map_err(wrong("mean"))?,
            scale: parse_values(scale, parse_scale).map_err(wrong("scale"))?,
        };
        let detector = match wishes.detect.as_deref() {
            None => usual.detector(),
            Some("") => None,
            Some(text) => Some(parse_detector(text).map_err(wrong("detections"))?),
        };
        let vision_network = vision_network.with_mapping_and_detector(mapping, detector)?;
        let detector = vision_network.detector();
        let mut told = network_facts(vision_network.network(), &usual, detector);
        told["classes"] = json!(vision_network.class_count());
        told["options"] = json!(command_options(&framing.to_string(), mean, scale, detector));
        (told["framing"], told["mean"], told["scale"]) =
            (json!(framing), json!(mean), json!(scale));
        let frames =
            FrameFormat { width, height, pixel_max: (1 << bits) - 1, region_side: REGION_SIDE };
        Ok((Self { vision_network, frames, bits }, told))
    }

    /// Runs the network on both frames and compares the outputs.
    fn compare_frames(&self, planes: &[u8]) -> Result<NetworkComparison, WebError> {
        let each = if self.bits <= 8 { 1 } else { 2 };
        let length = self.frames.width as usize * self.frames.height as usize * each;
        let FrameFormat { width, height, pixel_max, .. } = self.frames;
        if planes.len() != 2 * length {
            let (given, needed) = (planes.len(), 2 * length);
            return Err(WebError::FrameLength { given, needed, each, width, height });
        }
        let words: Vec<u16>;
        let (whole, seen) = if each == 1 {
            let (whole, seen) = planes.split_at(length);
            (FramePixels::Bytes(whole), FramePixels::Bytes(seen))
        } else {
            words =
                planes.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
            let (whole, seen) = words.split_at(length / 2);
            (FramePixels::Words(whole), FramePixels::Words(seen))
        };
        if [whole, seen].iter().any(|plane| largest_pixel(*plane) > pixel_max) {
            return Err(WebError::PixelTooLarge { bits: self.bits });
        }
        // One executor runs both frames. It is made for every call, so that its tensors take no
        // memory between calls.
        let mut looking = self.vision_network.start_run(self.frames);
        let [whole, seen] = [whole, seen].map(|plane| {
            looking.run(plane);
            looking.findings()
        });
        let pairs = self.vision_network.match_detections(&whole, &seen);
        let sums = AgreementSums::from_frame(&whole, &seen, pairs.as_ref());
        let is_class = |shape: &[usize]| matches!(shape, [1, n] | [1, n, 1, 1] if *n > 1);
        let outputs = whole.outputs.iter().zip(&seen.outputs);
        let class = outputs.clone().find(|(whole, _)| is_class(&whole.shape));
        let class = class.filter(|_| pairs.is_none());
        let DetectionPairs { whole: of_whole, seen: of_seen } = pairs.unwrap_or_default();
        Ok(NetworkComparison {
            agreement: sums.agreement(),
            relative_rms: sums.distance.relative_rms(),
            found: sums.total_counts(),
            whole: of_whole.into_iter().map(frame_detection).collect(),
            seen: of_seen.into_iter().map(frame_detection).collect(),
            classes: sums.class_agreement(),
            class: class.map(|(whole, seen)| {
                [index_of_largest(&whole.values), index_of_largest(&seen.values)]
            }),
            same_places: sums.position_share(),
        })
    }
}

fn largest_pixel(plane: FramePixels<'_>) -> u32 {
    match plane {
        FramePixels::Bytes(pixels) => pixels.iter().copied().max().unwrap_or(0).into(),
        FramePixels::Words(pixels) => pixels.iter().copied().max().unwrap_or(0).into(),
    }
}

fn frame_detection((detection, both): (Detection, bool)) -> FrameDetection {
    let Detection { class, score, rect } = detection;
    FrameDetection { class, score, rect: [rect.x0, rect.y0, rect.x1, rect.y1], both }
}

/// Parses one value, or several that are separated by commas.
fn parse_values(text: &str, parse: fn(&str) -> Result<f32, String>) -> Result<Vec<f32>, String> {
    let value = |word: &str| parse(word.trim()).map_err(|problem| format!("`{word}`: {problem}"));
    text.split(',').map(value).collect()
}

/// Returns the facts about a network, and the formats that its outputs may have.
fn network_facts(network: &Network, usual: &NetworkDefaults, detector: Option<&Detector>) -> Value {
    let input = network.input();
    let outputs = network.outputs().iter().zip(network.output_names());
    let outputs =
        outputs.map(|(&value, name)| json!({ "name": name, "shape": network.form(value).shape() }));
    let macs = network.total_macs();
    json!({
        "input": { "width": input.width(), "height": input.height(), "channels": input.shape()[1] },
        "outputs": outputs.collect::<Vec<_>>(),
        "macs": macs,
        "fits": usual.matching_formats.iter().map(|head| head.name()).collect::<Vec<_>>(),
        "likely": usual.format.map(|head| head.name()),
        "head": detector.map(|detector| detector.format.name()),
        "score": detector.map(|detector| detector.score),
        "overlap": detector.map(|detector| detector.overlap),
    })
}

/// Returns the options of `foveate infer` with the same meaning.
fn command_options(framing: &str, mean: &str, scale: &str, detector: Option<&Detector>) -> String {
    let mut options = format!("--framing {framing}");
    for (name, value, default) in [("mean", mean, "0"), ("scale", scale, "1")] {
        if value != default {
            options += &format!(" --{name} {}", value.replace(' ', ""));
        }
    }
    options += &detector.map_or(" --whole-frames".to_owned(), |it| format!(" --detect {it}"));
    options
}
