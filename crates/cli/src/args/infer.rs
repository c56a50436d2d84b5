// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options for a network behind the camera. `infer` has all of them ([`InferArgs`]). Those
//! that say how a network is shown frames and how its outputs are read ([`VisionArgs`]) are
//! shared with other commands, which have an argument `network` and refuse the options without
//! it.

use super::DesignArgs;
use super::input::InputArgs;
use super::threads::ThreadArgs;
use crate::error::CliError;
use clap::{Args, ValueEnum};
use foveate_inference::{
    Computation, Detector, Framing, NOISE_LEVELS, PixelMapping, RecordOptions, TuningGoal,
    VisionOptions, parse_detector, parse_framing, parse_goal, parse_mean, parse_mode, parse_noise,
    parse_scale, read_accelerator,
};
use foveate_network::ExecutionMode;
use foveate_network::accelerator::Accelerator;
use std::num::NonZeroU32;
use std::path::PathBuf;

/// Run a network on what a camera sends, and count what its masks save, layer by layer
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate infer denoiser.onnx scene:street -o out --max-frames 8
          foveate infer denoiser.onnx scene:street -o out --max-frames 8 --mode truncate=0.01
          foveate infer denoiser.onnx scene:street -o out --max-frames 8 --accelerator eyeriss
          foveate infer denoiser.onnx scene:street -o out --max-frames 8 --outputs npy,png
          foveate infer denoiser.onnx scene:street scene:shake -o out --max-frames 8
          foveate infer denoiser.onnx scene:street -o out --max-frames 8 --whole-frames
          foveate infer yolox_nano.onnx --check
          foveate infer yolox_nano.onnx images.npy -o out
          foveate infer yolox_nano.onnx street.mp4 -o out --framing letterbox --scale 1/255 --detect yolox --every 25
          foveate infer resnet50.onnx street.mp4 -o out --resize 224x224 --mean 0.485,0.456,0.406 --scale 0.229,0.224,0.225")]
pub(crate) struct InferArgs {
    /// The network: an ONNX file whose input is [1, channels, height, width], with 1 or 3 channels,
    /// or [1, height, width, channels] with a Transpose to channels first behind it
    #[arg(value_name = "MODEL")]
    pub(crate) network: PathBuf,
    /// Clips and sets of images of one size, as for `foveate simulate`: image files together are
    /// one clip, every other input is a clip of its own. Or NumPy arrays (.npy), one for each input
    /// of the network in the order of the model: the network runs on them once, without a camera,
    /// and its outputs are written as arrays
    #[arg(value_name = "INPUT", required_unless_present = "check")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Check whether the network can be run, print all nodes that cannot, and end with exit code 1
    /// if there are any. A network that takes frames of any size is checked for 224x224 pixels, or
    /// for the size of --resize
    #[arg(long, conflicts_with_all = ["inputs", "output", "force", "quiet"])]
    pub(crate) check: bool,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR", required_unless_present = "check")]
    pub(crate) output: Option<PathBuf>,
    /// Computation of a frame: dense, everything; exact, all that depends on a changed region;
    /// compare, as exact, but without values that come out equal; truncate=T, as exact, but without
    /// changes of at most T; fixed, all that lies under changed regions
    #[arg(long, value_name = "MODE", default_value = "exact", value_parser = parse_mode)]
    pub(crate) mode: ExecutionMode,
    /// Choose a limit for every layer so that the outputs stay close to those of a whole
    /// computation, on the first half of the clips, rounded up, or on the first half of the frames
    /// of a single clip; then report the second half. The goal is agreement=P%, the same largest
    /// output in P % of the frames; cosine=C, between all outputs; psnr=D, in decibels; or
    /// variation=P%, an error of at most P % of the variation of the outputs over the frames
    #[arg(long, value_name = "GOAL", conflicts_with = "mode", value_parser = parse_goal)]
    pub(crate) tune: Option<TuningGoal>,
    /// Compute every frame whole, too, and print how far the outputs are from this computation.
    /// Always on with truncate, fixed and --tune
    #[arg(long)]
    pub(crate) reference: bool,
    /// Run the network on the original whole frames, too, and print how well its outputs for the
    /// receiver's frames agree with these outputs. Always on with --detect and --noise
    #[arg(long)]
    pub(crate) whole_frames: bool,
    /// Run the network on whole frames with Gaussian noise, too, and print its agreement under
    /// noise. The values are standard deviations in grey levels of 8 bits; 0 is no noise. At most
    /// 48 frames are used, spread evenly [default: 1,2,4, with --whole-frames]
    #[arg(long, value_name = "LEVELS", allow_negative_numbers = true, value_parser = NoiseLevels::parse)]
    noise: Option<NoiseLevels>,
    /// Run the network on one of this many frames of every clip, beginning with the first frame;
    /// the camera sees all frames
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) every: NonZeroU32,
    /// Ground-truth boxes for average precision, with --detect, in a format of `foveate analyze
    /// recall`: one file or folder for all clips, or one for each clip
    #[arg(long, value_name = "FILE", requires = "detect")]
    pub(crate) boxes: Vec<PathBuf>,
    /// Count what the frames would cost on an accelerator: systolic-ws, systolic-os, eyeriss, or a
    /// TOML file
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) accelerator: Option<String>,
    /// Write the outputs of every frame: npy, an array [frames, ...shape] of each output; png,
    /// pictures of each output with 1 or 3 channels and the size of the input, from 0 (black) to 1
    /// (white); separate both with a comma
    #[arg(long, value_enum, value_name = "FORMATS", value_delimiter = ',')]
    pub(crate) outputs: Vec<OutputFormat>,
    /// Replace the folder if it holds an inference
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) vision: VisionArgs,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    /// The options for reading the inputs. They are last, because clap lists later options under
    /// their heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

/// A file format of the outputs of a network.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum OutputFormat {
    Npy,
    Png,
}

/// The standard deviations of noise, as one value of the command line.
#[derive(Clone, Debug)]
struct NoiseLevels(Vec<f64>);

impl NoiseLevels {
    fn parse(text: &str) -> Result<Self, String> {
        parse_noise(text).map(Self)
    }
}

impl InferArgs {
    /// Returns the file formats in which the outputs are written.
    pub(crate) fn record_options(&self) -> RecordOptions {
        let has = |format| self.outputs.contains(&format);
        RecordOptions { arrays: has(OutputFormat::Npy), pictures: has(OutputFormat::Png) }
    }

    /// Returns the computation that is done for a frame.
    pub(crate) fn computation(&self) -> Computation {
        self.tune.map_or(Computation::Mode(self.mode), Computation::Tuned)
    }

    /// Returns the accelerator and its name, if one is given.
    pub(crate) fn accelerator(&self) -> Result<Option<(String, Accelerator)>, CliError> {
        Ok(self.accelerator.as_deref().map(read_accelerator).transpose()?)
    }

    /// Returns true if the network runs on whole frames, too.
    pub(crate) fn runs_on_whole_frames(&self) -> bool {
        self.whole_frames || self.noise.is_some() || self.vision.detect.is_some()
    }

    /// Returns the standard deviations of the noise on whole frames, in grey levels of 8 bits.
    pub(crate) fn noise_levels(&self) -> Vec<f64> {
        let own = self.noise.as_ref().map(|levels| levels.0.clone());
        own.unwrap_or_else(|| NOISE_LEVELS.to_vec())
    }

    /// Returns true if every frame is also computed whole.
    pub(crate) fn has_reference(&self) -> bool {
        self.reference || matches!(self.mode, ExecutionMode::Truncate(_) | ExecutionMode::Fixed)
    }
}

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
