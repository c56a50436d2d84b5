// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network behind a camera: its outputs for whole frames and for the receiver's screen, compared
//! as `foveate infer` does.

use std::path::Path;

use foveate_frame::Plane;
use foveate_network::Network;
use foveate_network::sight::{
    ClassKept, Detection, Detector, Found, Frames, Mapping, Pairs, Sums, Usual, Viewing, Witness,
    largest, parse_detector, parse_framing, parse_mean, parse_scale,
};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::WebError;
use crate::desk::check_size;
use crate::limits::{MAX_NETWORK_BYTES, MAX_NETWORK_FILE};

/// The side of the regions in which a frame is converted. The network computes all of it anyway.
const REGION: u32 = 16;

/// The settings for showing frames to a network, in the words of the command line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wishes {
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
pub struct NetworkDesk {
    file: Option<Vec<u8>>,
    network: Option<LiveNetwork>,
}

/// A network for frames of one size and depth.
#[derive(Debug)]
struct LiveNetwork {
    witness: Witness,
    frames: Frames,
    /// The bits of a pixel.
    bits: u32,
}

/// The outputs of a network for a whole frame and for the receiver's screen, compared.
#[derive(Clone, Debug, Serialize)]
pub struct Looked {
    /// The agreement as one number, as `foveate infer` computes it.
    pub agreement: f64,
    /// The distance of the outputs from those of the whole frame, as a share of these.
    pub relative_rms: f64,
    /// The numbers of detections that were found, kept and added, if detections are read.
    pub found: Option<Found>,
    /// The detections in the whole frame.
    pub whole: Vec<Seen>,
    /// The detections in the receiver's screen.
    pub seen: Vec<Seen>,
    /// The agreement of outputs that are one class.
    pub classes: Option<ClassKept>,
    /// The classes of the whole frame and of the receiver's screen, from the first such output.
    pub class: Option<[usize; 2]>,
    /// The share of the places with the same class, for outputs that have a class at every place.
    pub same_places: Option<f64>,
}

/// A detection in a frame.
#[derive(Clone, Debug, Serialize)]
pub struct Seen {
    /// The number of its class.
    pub class: usize,
    /// The score of the detection, 0 to 1.
    pub score: f32,
    /// The left, upper, right and lower side, in pixels of the frame.
    pub rect: [f64; 4],
    /// True if the other frame has this detection, too.
    pub both: bool,
}

impl NetworkDesk {
    /// Takes the file of a network. The previous network is dropped.
    ///
    /// # Errors
    /// Fails if the file is too large.
    pub fn take(&mut self, file: Vec<u8>) -> Result<(), WebError> {
        *self = Self::default();
        if file.len() > MAX_NETWORK_FILE {
            return Err(WebError::NetworkFile { given: file.len(), most: MAX_NETWORK_FILE });
        }
        self.file = Some(file);
        Ok(())
    }

    /// Makes the network of the file for frames of this size and depth. `wishes` is a [`Wishes`] as
    /// JSON. Returns the facts about the network.
    ///
    /// # Errors
    /// Fails if there is no file, if it is no network that can be computed, or if the settings do
    /// not fit the network.
    pub fn open(&mut self, wishes: &[u8], size: (u32, u32), bits: u32) -> Result<Value, WebError> {
        self.network = None;
        let file = self.file.as_ref().ok_or(WebError::NoNetwork)?;
        let wishes: Wishes = serde_json::from_slice(wishes)
            .map_err(|error| WebError::Wish { what: "wishes", problem: error.to_string() })?;
        let (network, told) = LiveNetwork::open(file, &wishes, size, bits)?;
        self.network = Some(network);
        Ok(told)
    }

    /// Runs the network on a frame and on the receiver's screen for it, which follow each other in
    /// `planes`. Pixels of up to 8 bits have one byte each; deeper pixels have two, the lower
    /// first.
    ///
    /// # Errors
    /// Fails if there is no network, or if the bytes are not two such frames.
    pub fn look(&self, planes: &[u8]) -> Result<Looked, WebError> {
        self.network.as_ref().ok_or(WebError::NoNetwork)?.look(planes)
    }
}

impl LiveNetwork {
    fn open(
        file: &[u8],
        wishes: &Wishes,
        (width, height): (u32, u32),
        bits: u32,
    ) -> Result<(Self, Value), WebError> {
        check_size(width, height)?;
        if !(1..=16).contains(&bits) {
            return Err(WebError::Bits { bits });
        }
        let wrong = |what| move |problem| WebError::Wish { what, problem };
        let framing = parse_framing(&wishes.framing).map_err(wrong("framing"))?;
        let mapping = Mapping { mean: vec![0.0], scale: vec![1.0] };
        let viewing = Viewing { framing, mapping, detector: None };
        let path = Path::new(&wishes.name);
        let witness = Witness::parse(file, path, (width, height), &viewing)?;
        let (needed, most) = (witness.network().kept_bytes(), MAX_NETWORK_BYTES);
        if needed > most {
            return Err(WebError::NetworkMemory { needed, most });
        }
        let usual = witness.usual();
        let mean = wishes.mean.as_deref().unwrap_or(usual.mean);
        let scale = wishes.scale.as_deref().unwrap_or(usual.scale);
        let mapping = Mapping {
            mean: values(mean, parse_mean).map_err(wrong("mean"))?,
            scale: values(scale, parse_scale).map_err(wrong("scale"))?,
        };
        let detector = match wishes.detect.as_deref() {
            None => usual.detector(),
            Some("") => None,
            Some(text) => Some(parse_detector(text).map_err(wrong("detections"))?),
        };
        let witness = witness.viewed(mapping, detector)?;
        let detector = witness.detector();
        let mut told = facts(witness.network(), &usual, detector);
        told["classes"] = json!(witness.classes());
        told["options"] = json!(options(&framing.to_string(), mean, scale, detector));
        (told["framing"], told["mean"], told["scale"]) =
            (json!(framing), json!(mean), json!(scale));
        let frames = Frames { width, height, pixel_max: (1 << bits) - 1, region: REGION };
        Ok((Self { witness, frames, bits }, told))
    }

    /// Runs the network on both frames and compares the outputs.
    fn look(&self, planes: &[u8]) -> Result<Looked, WebError> {
        let each = if self.bits <= 8 { 1 } else { 2 };
        let length = self.frames.width as usize * self.frames.height as usize * each;
        let Frames { width, height, pixel_max, .. } = self.frames;
        if planes.len() != 2 * length {
            let (given, needed) = (planes.len(), 2 * length);
            return Err(WebError::FrameLength { given, needed, each, width, height });
        }
        let words: Vec<u16>;
        let (whole, seen) = if each == 1 {
            let (whole, seen) = planes.split_at(length);
            (Plane::Bytes(whole), Plane::Bytes(seen))
        } else {
            words =
                planes.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
            let (whole, seen) = words.split_at(length / 2);
            (Plane::Words(whole), Plane::Words(seen))
        };
        if [whole, seen].iter().any(|plane| largest_pixel(*plane) > pixel_max) {
            return Err(WebError::PixelBits { bits: self.bits });
        }
        // One executor runs both frames. It is made for every call, so that its tensors take no
        // memory between calls.
        let mut looking = self.witness.look_at(self.frames);
        let [whole, seen] = [whole, seen].map(|plane| {
            looking.run(plane);
            looking.findings()
        });
        let pairs = self.witness.pairs(&whole, &seen);
        let sums = Sums::of(&whole, &seen, pairs.as_ref());
        let is_class = |shape: &[usize]| matches!(shape, [1, n] | [1, n, 1, 1] if *n > 1);
        let outputs = whole.outputs.iter().zip(&seen.outputs);
        let class = outputs.clone().find(|(whole, _)| is_class(&whole.shape));
        let class = class.filter(|_| pairs.is_none());
        let Pairs { whole: of_whole, seen: of_seen } = pairs.unwrap_or_default();
        Ok(Looked {
            agreement: sums.agreement(),
            relative_rms: sums.distance.relative(),
            found: sums.found(),
            whole: of_whole.into_iter().map(told).collect(),
            seen: of_seen.into_iter().map(told).collect(),
            classes: sums.classes(),
            class: class.map(|(whole, seen)| [largest(&whole.values), largest(&seen.values)]),
            same_places: sums.places(),
        })
    }
}

fn largest_pixel(plane: Plane<'_>) -> u32 {
    match plane {
        Plane::Bytes(pixels) => pixels.iter().copied().max().unwrap_or(0).into(),
        Plane::Words(pixels) => pixels.iter().copied().max().unwrap_or(0).into(),
    }
}

fn told((detection, both): (Detection, bool)) -> Seen {
    let Detection { class, score, rect } = detection;
    Seen { class, score, rect: [rect.x0, rect.y0, rect.x1, rect.y1], both }
}

/// Parses one value, or several that are separated by commas.
fn values(text: &str, parse: fn(&str) -> Result<f32, String>) -> Result<Vec<f32>, String> {
    let value = |word: &str| parse(word.trim()).map_err(|problem| format!("`{word}`: {problem}"));
    text.split(',').map(value).collect()
}

/// Returns the facts about a network, and the formats that its outputs may have.
fn facts(network: &Network, usual: &Usual, detector: Option<&Detector>) -> Value {
    let input = network.input();
    let outputs = network.outputs().iter().zip(network.output_names());
    let outputs =
        outputs.map(|(&value, name)| json!({ "name": name, "shape": network.form(value).shape() }));
    let macs = network.total_macs();
    json!({
        "input": { "width": input.width(), "height": input.height(), "channels": input.shape()[1] },
        "outputs": outputs.collect::<Vec<_>>(),
        "macs": macs,
        "fits": usual.fits.iter().map(|head| head.name()).collect::<Vec<_>>(),
        "likely": usual.head.map(|head| head.name()),
        "head": detector.map(|detector| detector.head.name()),
        "score": detector.map(|detector| detector.score),
        "overlap": detector.map(|detector| detector.overlap),
    })
}

/// Returns the options of `foveate infer` with the same meaning.
fn options(framing: &str, mean: &str, scale: &str, detector: Option<&Detector>) -> String {
    let mut options = format!("--framing {framing}");
    for (name, value, default) in [("mean", mean, "0"), ("scale", scale, "1")] {
        if value != default {
            options += &format!(" --{name} {}", value.replace(' ', ""));
        }
    }
    options += &detector.map_or(" --whole-frames".to_owned(), |it| format!(" --detect {it}"));
    options
}
