// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `infer`.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use foveate_accelerator::Accelerator;
use foveate_inference::{
    Computed, Goal, NOISE_LEVELS, Record, parse_goal, parse_mode, parse_noise, read_accelerator,
};
use foveate_network::Mode;

use super::DesignArgs;
use super::input::InputArgs;
use super::threads::ThreadArgs;
use super::viewing::ViewingArgs;
use crate::error::CliError;

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
    /// The network: an ONNX file whose input is [1, channels, height, width], with 1 or 3 channels, or
    /// [1, height, width, channels] with a Transpose to channels first behind it
    #[arg(value_name = "MODEL")]
    pub(crate) network: PathBuf,
    /// Clips and sets of images of one size, as of `foveate simulate`: image files together are one clip, every
    /// other input is one of its own. Or NumPy arrays (.npy), one for each input of the network in the order of the
    /// model: it runs on them once, without a camera, and its outputs are written as arrays
    #[arg(value_name = "INPUT", required_unless_present = "check")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Say whether the network can be run, with all nodes that cannot, and end with 1 if there are such. A network
    /// that takes frames of any size is looked at for 224x224 pixels, or those of --resize
    #[arg(long, conflicts_with_all = ["inputs", "output", "force", "quiet"])]
    pub(crate) check: bool,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR", required_unless_present = "check")]
    pub(crate) output: Option<PathBuf>,
    /// What is computed for a frame: dense, everything; exact, what depends on a changed region; compare,
    /// the same without what came out equal; truncate=T, the same without changes of at most T; fixed, what
    /// lies under changed regions
    #[arg(long, value_name = "MODE", default_value = "exact", value_parser = parse_mode)]
    pub(crate) mode: Mode,
    /// Choose a limit for every layer on the first half of the clips, rounded up, or of the frames of the only
    /// clip, so that the outputs stay close to those of a whole computation, and report the second half: agreement=P%, in P % of frames the largest output is
    /// the same; cosine=C, between all outputs; psnr=D, in decibels; variation=P%, the error is at most P % of
    /// how the outputs vary over the frames
    #[arg(long, value_name = "GOAL", conflicts_with = "mode", value_parser = parse_goal)]
    pub(crate) tune: Option<Goal>,
    /// Compute every frame whole, too, and print how far the outputs are from it. Always on with truncate, fixed
    /// and --tune
    #[arg(long)]
    pub(crate) reference: bool,
    /// Run the network on the whole frames, too, as they are before the camera, and print how much of what it says there it says of
    /// what the receiver sees. Always on with --detect and --noise
    #[arg(long)]
    pub(crate) whole_frames: bool,
    /// Whole frames are shown to the network with Gaussian noise of these standard deviations, too, in grey levels of 8 bits, and what it
    /// keeps under noise is printed; at most 48 frames are, spread evenly. 0 is none [default: 1,2,4, with --whole-frames]
    #[arg(long, value_name = "LEVELS", allow_negative_numbers = true, value_parser = NoiseLevels::parse)]
    noise: Option<NoiseLevels>,
    /// The network sees one of so many frames of every clip, the first one first; the camera sees all
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) every: NonZeroU32,
    /// With --detect: ground-truth boxes for average precision, as of `foveate analyze recall`: one file or folder for all clips, or one for each
    #[arg(long, value_name = "FILE", requires = "detect")]
    pub(crate) boxes: Vec<PathBuf>,
    /// Count what the frames would cost on an accelerator: systolic-ws, systolic-os, eyeriss, or a TOML file
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) accelerator: Option<String>,
    /// Write the outputs of every frame: npy, an array [frames, ...shape] of each; png, pictures of those with 1
    /// or 3 channels and the size of the input, from 0 (black) to 1 (white); separate both with a comma
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
    pub(crate) viewing: ViewingArgs,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    /// Last, because what follows would be listed under its heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

/// How outputs are written.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum OutputFormat {
    Npy,
    Png,
}

/// Standard deviations of noise: one value of the command line.
#[derive(Clone, Debug)]
struct NoiseLevels(Vec<f64>);

impl NoiseLevels {
    fn parse(text: &str) -> Result<Self, String> {
        parse_noise(text).map(Self)
    }
}

impl InferArgs {
    /// What is written of the outputs.
    pub(crate) fn record(&self) -> Record {
        let has = |format| self.outputs.contains(&format);
        Record { arrays: has(OutputFormat::Npy), pictures: has(OutputFormat::Png) }
    }

    /// What is computed for a frame.
    pub(crate) fn computed(&self) -> Computed {
        self.tune.map_or(Computed::Mode(self.mode), Computed::Tuned)
    }

    /// The accelerator with its name.
    pub(crate) fn accelerator(&self) -> Result<Option<(String, Accelerator)>, CliError> {
        Ok(self.accelerator.as_deref().map(read_accelerator).transpose()?)
    }

    /// Whether the network runs on whole frames, too.
    pub(crate) fn sight(&self) -> bool {
        self.whole_frames || self.noise.is_some() || self.viewing.detect.is_some()
    }

    /// Standard deviations of the noise on whole frames.
    pub(crate) fn noise(&self) -> Vec<f64> {
        let own = self.noise.as_ref().map(|levels| levels.0.clone());
        own.unwrap_or_else(|| NOISE_LEVELS.to_vec())
    }

    /// Whether a whole computation runs beside.
    pub(crate) fn has_reference(&self) -> bool {
        self.reference || matches!(self.mode, Mode::Truncate(_) | Mode::Fixed)
    }
}
