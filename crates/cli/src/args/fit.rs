// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `foveate fit`, and the parsing of percentages.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use foveate_explore::{Constraints, CostObjective, Disturbance, NetworkGoal};
use foveate_inference::VisionOptions;

use super::check::{ClockFrequency, FramesPerSecond};
use super::infer::VisionArgs;
use super::input::InputArgs;
use super::process::ProcessArgs;
use super::threads::ThreadArgs;
use super::{DesignArgs, at_least_one};
use crate::error::CliError;

/// Find the cheapest design that meets limits on your clips
///
/// The configuration is the task of the camera. An ideal camera performs the task in floating point
/// over whole frames, and candidates are compared with it. The first half of every clip is used to
/// choose a design, and the second half to report on it. The search covers region size, features,
/// thresholds, pixel bits, windows, denoising, reference, organization, feed and fold. The exit
/// code is 1 if no design meets the limits, if the choice misses them on the second half, or if a
/// clip was not read to its end; the nearest design is still written.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples: foveate fit street.mp4 --min-fps 120 --max-flips 1% --max-lut 100
          foveate fit scene:street --target-active 20% -o camera.toml
          foveate fit a.mp4 b.mp4 --resize 640x360 --min-psnr 30 --max-bytes 10000
          foveate fit street.mp4 --preset fovea --network yolox_nano.onnx --framing letterbox --scale 1/255 --detect yolox --min-agreement 95%
          foveate fit scene:street --cheapest energy --max-mm2 20 --liberty"
)]
pub(crate) struct FitArgs {
    /// Clips, as for `foveate simulate`; several scenes are allowed
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// File for the configuration that was found, for `foveate generate --config`
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    /// Synthesize at most this many designs, the most promising first; if none meets all limits,
    /// synthesize up to 16 more to find the nearest one
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = at_least_one())]
    pub(crate) max_syntheses: u32,
    /// Ground-truth boxes for --min-recall, in a format of `foveate analyze recall`
    #[arg(long, value_name = "FILE", requires = "min_recall")]
    pub(crate) boxes: Vec<PathBuf>,
    /// Show the designs a disturbed clip, while the ideal camera sees the clip as it is:
    /// noise=LEVELS, jpeg=QUALITY, flicker=LEVELS, gain=PERCENT, saturation=FACTOR, shake=PIXELS or
    /// still=LEVELS (the first frame, with noise)
    #[arg(long, value_name = "KIND=VALUE", conflicts_with = "network")]
    pub(crate) disturb: Option<Disturbance>,
    /// Cost that the search minimizes; by default bytes with --network, and area without it
    #[arg(long, value_enum, value_name = "COST")]
    cheapest: Option<DesignCost>,
    #[command(flatten)]
    pub(crate) constraints: ConstraintArgs,
    #[command(flatten)]
    pub(crate) process: ProcessArgs,
    #[command(flatten)]
    pub(crate) network: NetworkArgs,
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

impl FitArgs {
    /// Returns the cost that the search minimizes.
    ///
    /// # Errors
    /// Fails if the cost is not known without another option.
    pub(crate) fn cheapest(&self) -> Result<CostObjective, CliError> {
        let (has_network, has_process) =
            (self.network.network.is_some(), self.process.liberty.is_some());
        match self.cheapest {
            None if has_network => Ok(CostObjective::Bytes),
            None | Some(DesignCost::Area) => Ok(CostObjective::Area),
            Some(DesignCost::Bytes) if has_network => Ok(CostObjective::Bytes),
            Some(DesignCost::Bytes) => Err(CliError::Usage(
                "--cheapest bytes needs --network, whose agreement says which bytes are needed"
                    .to_owned(),
            )),
            Some(DesignCost::Mm2) if has_process => Ok(CostObjective::Mm2),
            Some(DesignCost::Energy) if has_process => Ok(CostObjective::Energy),
            Some(cost @ (DesignCost::Mm2 | DesignCost::Energy)) => {
                let name = if cost == DesignCost::Mm2 { "mm2" } else { "energy" };
                Err(CliError::Usage(format!(
                    "--cheapest {name} needs --liberty, the cells of a process"
                )))
            }
        }
    }
}

/// The options of a network whose outputs must be nearly the same behind the camera as for whole
/// frames.
#[derive(Args, Debug)]
#[command(next_help_heading = "Network")]
pub(crate) struct NetworkArgs {
    /// Find the cheapest camera behind which this network, an ONNX file as for `foveate infer`,
    /// gives nearly the same outputs as for whole frames. The search covers the rendering of
    /// irrelevant regions, thresholds, features, region size, denoising, reference and pixel bits
    #[arg(long, value_name = "MODEL")]
    pub(crate) network: Option<PathBuf>,
    /// Smallest agreement between the outputs of the network behind the camera and its outputs for
    /// whole frames. For detections it is the smaller of the share that is kept and the share that
    /// is right; for classes it is the share of frames, or of places, with the same class;
    /// otherwise it is 100% minus the relative RMS error of the outputs
    #[arg(long, value_name = "PERCENT", default_value = "95%", value_parser = percent, requires = "network")]
    pub(crate) min_agreement: f64,
    /// Number of frames, spread evenly over all clips, on which the network runs in each of three
    /// parts: the first two thirds of the first halves, for the search; the rest of the first
    /// halves, to confirm its result; and the second halves, for the report
    #[arg(long, value_name = "FRAMES", default_value_t = 48, value_parser = at_least_one(), requires = "network")]
    pub(crate) look_at: u32,
    #[command(flatten)]
    pub(crate) vision: VisionArgs,
}

/// The cost by which designs are compared.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum DesignCost {
    /// The bytes that leave the camera, with --network
    Bytes,
    /// The share of the FPGA of a VCU118
    Area,
    /// The area of the array in the cells of --liberty
    Mm2,
    /// The power of the array in the cells of --liberty, at --min-fps
    Energy,
}

impl NetworkArgs {
    /// Returns the goal of the search with a network, if a network is given.
    pub(crate) fn goal<'a>(&'a self, vision_options: &'a VisionOptions) -> Option<NetworkGoal<'a>> {
        let path = self.network.as_deref()?;
        let (min_agreement, frames) = (self.min_agreement, self.look_at.into());
        Some(NetworkGoal { path, vision_options, min_agreement, frames })
    }
}

/// The limits that a design must meet.
#[derive(Args, Debug)]
#[command(next_help_heading = "Limits")]
pub(crate) struct ConstraintArgs {
    /// Frames per second that the array must reach, at --clock or at the low end of its estimated
    /// clock
    #[arg(long, value_name = "RATE", default_value = "30", value_parser = FramesPerSecond::parse)]
    pub(crate) min_fps: FramesPerSecond,
    /// Clock of the array; without it, the clock of each design is estimated from its netlist. With
    /// --liberty, a design has at most the highest clock in these cells
    #[arg(long, value_name = "FREQUENCY", value_parser = ClockFrequency::parse)]
    pub(crate) clock: Option<ClockFrequency>,
    /// First set the thresholds so that this share of the regions is active
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub(crate) target_active: Option<f64>,
    /// Largest share of the regions whose decision may differ from that of the ideal camera; 1%
    /// unless --network is given
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub(crate) max_flips: Option<f64>,
    /// Largest share of the ideal camera's active regions that the design may miss, without the
    /// first frame of every clip; 10% unless --network is given
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub(crate) max_missed: Option<f64>,
    /// Largest share of the design's active regions that are not active in the ideal camera,
    /// without the first frame of every clip; 10% unless --network is given
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub(crate) max_false_alarms: Option<f64>,
    /// Smallest PSNR of the rendered frames against those of the ideal camera, in dB
    #[arg(long, value_name = "DB", value_parser = decibels)]
    pub(crate) min_psnr: Option<f64>,
    /// A relevant region may be stale for at most this many frames in a row
    #[arg(long, value_name = "FRAMES")]
    pub(crate) max_stale_frames: Option<u64>,
    /// At most this many bytes per frame may leave the array
    #[arg(long, value_name = "BYTES", value_parser = at_least_one())]
    pub(crate) max_bytes: Option<u32>,
    /// Smallest share of the ground-truth objects of --boxes that have at least half of their
    /// regions active
    #[arg(long, value_name = "PERCENT", value_parser = percent, requires = "boxes")]
    pub(crate) min_recall: Option<f64>,
    /// At most this many LUTs of one RPU or lane
    #[arg(long, value_name = "N")]
    pub(crate) max_lut: Option<u64>,
    /// At most this many flip-flops of one RPU or lane
    #[arg(long, value_name = "N")]
    pub(crate) max_ff: Option<u64>,
    /// At most this many LUTs of the array
    #[arg(long, value_name = "N")]
    pub(crate) max_array_lut: Option<u64>,
    /// At most this many RAMB36 of the array
    #[arg(long, value_name = "N")]
    pub(crate) max_bram: Option<u64>,
    /// Largest area of the array in the cells of --liberty, in square millimetres
    #[arg(long, value_name = "MM2", value_parser = above_zero, requires = "liberty")]
    pub(crate) max_mm2: Option<f64>,
    /// Largest power of the array in the cells of --liberty in milliwatts, at --min-fps in the
    /// busiest stretch of the clips
    #[arg(long, value_name = "MW", value_parser = above_zero, requires = "liberty")]
    pub(crate) max_mw: Option<f64>,
}

impl ConstraintArgs {
    /// Returns the limits. With a network the configuration is only a start, so that decisions have
    /// no limit unless one is given.
    pub(crate) fn constraints(&self, with_network: bool) -> Constraints {
        let by_default = |share: f64| (!with_network).then_some(share);
        Constraints {
            max_flips: self.max_flips.or(by_default(0.01)),
            max_missed: self.max_missed.or(by_default(0.1)),
            max_false_alarms: self.max_false_alarms.or(by_default(0.1)),
            min_psnr: self.min_psnr,
            max_stale_frames: self.max_stale_frames,
            max_bytes: self.max_bytes.map(f64::from),
            min_recall: self.min_recall,
            min_fps: Some(self.min_fps.per_second()),
            max_lut: self.max_lut,
            max_ff: self.max_ff,
            max_array_lut: self.max_array_lut,
            max_bram: self.max_bram,
            max_mm2: self.max_mm2,
            max_mw: self.max_mw,
        }
    }
}

/// Parses a percentage such as `1%` or `0.5%` into a share. The sign is required, because a number
/// without it could be either.
fn percent(text: &str) -> Result<f64, String> {
    text.strip_suffix('%')
        .and_then(|number| number.trim().parse::<f64>().ok())
        .filter(|percent| (0.0..=100.0).contains(percent))
        .map(|percent| percent / 100.0)
        .ok_or_else(|| "expected 0% to 100%, with the sign, for example 1%".to_owned())
}

fn above_zero(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|value| value.is_finite() && *value > 0.0)
        .ok_or_else(|| "expected a number above 0, for example 12.5".to_owned())
}

fn decibels(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|value| (0.0..=200.0).contains(value))
        .ok_or_else(|| "expected decibels, for example 30".to_owned())
}
