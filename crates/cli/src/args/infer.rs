// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `infer`.

use std::path::PathBuf;

use clap::Args;
use foveate_inference::Mapping;
use foveate_network::Mode;

use super::DesignArgs;
use super::input::InputArgs;

/// Run a network on what a camera sends, and count what its masks save, layer by layer
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate infer denoiser.onnx scene:street -o out --max-frames 8
          foveate infer denoiser.onnx scene:street -o out --max-frames 8 --mode truncate=0.01
          foveate infer resnet50.onnx street.mp4 -o out --resize 224x224 --mean 0.485,0.456,0.406 --scale 0.229,0.224,0.225")]
pub(crate) struct InferArgs {
    /// The network: an ONNX file whose input is [1, channels, height, width], with 1 or 3 channels
    #[arg(value_name = "MODEL")]
    pub(crate) network: PathBuf,
    /// A clip or a set of images, as of `foveate simulate`
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// What is computed for a frame: dense, everything; exact, what depends on a changed region; compare,
    /// the same without what came out equal; truncate=T, the same without changes of at most T; fixed, what
    /// lies under changed regions
    #[arg(long, value_name = "MODE", default_value = "exact", value_parser = parse_mode)]
    pub(crate) mode: Mode,
    /// Compute every frame whole, too, and print how far the outputs are from it. Always on with truncate and
    /// fixed
    #[arg(long)]
    pub(crate) reference: bool,
    /// Subtract this from pixels of 0 to 1: one value, or one per channel
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "0", allow_negative_numbers = true, value_parser = finite)]
    pub(crate) mean: Vec<f32>,
    /// Then divide by this: one value, or one per channel
    #[arg(long, value_name = "VALUES", value_delimiter = ',', default_value = "1", value_parser = positive)]
    pub(crate) scale: Vec<f32>,
    /// Replace the folder if it holds an inference
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Last, because what follows would be listed under its heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

impl InferArgs {
    /// How pixels become inputs.
    pub(crate) fn mapping(&self) -> Mapping {
        Mapping { mean: self.mean.clone(), scale: self.scale.clone() }
    }

    /// Whether a whole computation runs beside.
    pub(crate) fn has_reference(&self) -> bool {
        self.reference || matches!(self.mode, Mode::Truncate(_) | Mode::Fixed)
    }
}

fn parse_mode(text: &str) -> Result<Mode, String> {
    let wrong =
        || "expected dense, exact, compare, truncate=T with T of at least 0, or fixed".to_owned();
    Ok(match text.split_once('=') {
        None => match text {
            "dense" => Mode::Dense,
            "exact" => Mode::Exact,
            "compare" => Mode::Compare,
            "fixed" => Mode::Fixed,
            _ => return Err(wrong()),
        },
        Some(("truncate", limit)) => {
            let limit = limit.parse().ok().filter(|limit: &f32| limit.is_finite() && *limit >= 0.0);
            Mode::Truncate(limit.ok_or_else(wrong)?)
        }
        Some(_) => return Err(wrong()),
    })
}

fn finite(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|value: &f32| value.is_finite())
        .ok_or_else(|| "expected a number".to_owned())
}

fn positive(text: &str) -> Result<f32, String> {
    finite(text)
        .ok()
        .filter(|&value| value > 0.0)
        .ok_or_else(|| "expected a number above 0".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_those_of_the_summary() {
        assert_eq!(parse_mode("truncate=0.25"), Ok(Mode::Truncate(0.25)));
        assert_eq!(parse_mode("compare"), Ok(Mode::Compare));
        for wrong in
            ["", "sparse", "truncate", "truncate=", "truncate=-1", "truncate=nan", "exact=1"]
        {
            assert!(parse_mode(wrong).is_err(), "{wrong}");
        }
    }
}
