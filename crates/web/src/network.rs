// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network beside a camera: what it says of whole frames, and of what the receiver sees, as `foveate infer` computes it.

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

/// Side of the regions in which a picture is taken over. The network computes all of it anyway.
const REGION: u32 = 16;

/// How a network is to be shown frames, in the words of the command line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wishes {
    /// Name of the file, for messages.
    pub name: String,
    /// As of `--framing`.
    pub framing: String,
    /// As of `--mean`; what is usual where it is left out.
    pub mean: Option<String>,
    /// As of `--scale`; what is usual where it is left out.
    pub scale: Option<String>,
    /// As of `--detect`, or empty for none; what is likely where it is left out.
    pub detect: Option<String>,
}

/// The network of a page: its file, and what was made of it.
#[derive(Debug, Default)]
pub struct NetworkDesk {
    file: Option<Vec<u8>>,
    network: Option<LiveNetwork>,
}

/// A network that looks at frames of one size and depth.
#[derive(Debug)]
struct LiveNetwork {
    witness: Witness,
    frames: Frames,
    /// Bits of a pixel.
    bits: u32,
}

/// What a network says of a whole frame and of what the receiver sees.
#[derive(Clone, Debug, Serialize)]
pub struct Looked {
    /// In one number, as of `foveate infer`.
    pub agreement: f64,
    /// How far the outputs are from those of the whole frame, as a share of these.
    pub relative_rms: f64,
    /// How many were found, kept and added, if detections are read.
    pub found: Option<Found>,
    /// Those of the whole frame.
    pub whole: Vec<Seen>,
    /// Those in what the receiver sees.
    pub seen: Vec<Seen>,
    /// Of outputs that are one class.
    pub classes: Option<ClassKept>,
    /// The class of the whole frame and of what the receiver sees, of the first such output.
    pub class: Option<[usize; 2]>,
    /// Share of the places with the same class, of outputs that have one at every place.
    pub same_places: Option<f64>,
}

/// A detection.
#[derive(Clone, Debug, Serialize)]
pub struct Seen {
    /// Number of its class.
    pub class: usize,
    /// How sure the network is, 0 to 1.
    pub score: f32,
    /// Left, upper, right and lower side in pixels of the frame.
    pub rect: [f64; 4],
    /// Whether the other picture has it, too.
    pub both: bool,
}

impl NetworkDesk {
    /// Takes a file over. The network before it is gone.
    ///
    /// # Errors
    /// When it is too large.
    pub fn take(&mut self, file: Vec<u8>) -> Result<(), WebError> {
        *self = Self::default();
        if file.len() > MAX_NETWORK_FILE {
            return Err(WebError::NetworkFile { given: file.len(), most: MAX_NETWORK_FILE });
        }
        self.file = Some(file);
        Ok(())
    }

    /// Makes the network of the file for frames of that size and depth. `wishes` are those of [`Wishes`] as JSON. Says what it is.
    ///
    /// # Errors
    /// When there is no file, it is no network that can be computed, or it cannot be shown frames or read as wished.
    pub fn open(&mut self, wishes: &[u8], size: (u32, u32), bits: u32) -> Result<Value, WebError> {
        self.network = None;
        let file = self.file.as_ref().ok_or(WebError::NoNetwork)?;
        let wishes: Wishes = serde_json::from_slice(wishes)
            .map_err(|error| WebError::Wish { what: "wishes", problem: error.to_string() })?;
        let (network, told) = LiveNetwork::open(file, &wishes, size, bits)?;
        self.network = Some(network);
        Ok(told)
    }

    /// What the network says of a frame and of what the receiver sees of it, which follow each other in `planes`: a byte per pixel up to 8 bits,
    /// else two, the lower first.
    ///
    /// # Errors
    /// When there is no network, or the bytes are not two such frames.
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

    /// What the network says of both.
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
        // Of one executor, which is made for every frame: between frames its tensors take no memory.
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

/// One value, or several behind commas.
fn values(text: &str, parse: fn(&str) -> Result<f32, String>) -> Result<Vec<f32>, String> {
    let value = |word: &str| parse(word.trim()).map_err(|problem| format!("`{word}`: {problem}"));
    text.split(',').map(value).collect()
}

/// What a network is, and what it may be.
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

/// The options of `foveate infer` that do the same.
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
