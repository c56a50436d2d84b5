// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `link`.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use foveate_explore::link::{Codec, EncoderPreset, LinkRate};

use super::input::InputArgs;
use super::{ClockFrequency, DesignArgs};

/// Compare what a camera sends over a link with pixel events, raw frames, MJPEG, H.264 and H.265 at
/// equal quality
#[derive(Args, Debug)]
#[command(
    after_help = "Examples: foveate link scene:street -o out --max-frames 10 --codecs mjpeg,h264
          foveate link street.mp4 -o out --link 10Mbit --codecs h264 --set spatial.0.min_score=0"
)]
pub(crate) struct LinkArgs {
    /// Clips, as for `foveate simulate`; several scenes are allowed. Each gets a table of its own
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a comparison
    #[arg(long)]
    pub(crate) force: bool,
    /// Rate of the link in bits per second, for example 100Mbit or 1.5Gbit
    #[arg(long, value_name = "RATE", default_value = "100Mbit", value_parser = LinkRate::parse)]
    pub(crate) link: LinkRate,
    /// Clock of the array, for example 50MHz; `foveate estimate` says what clock to expect. Without
    /// it, times leave out the array's clocks, whose number is printed
    #[arg(long, value_name = "FREQUENCY", value_parser = ClockFrequency::parse)]
    pub(crate) clock: Option<ClockFrequency>,
    /// Codecs to compare with
    #[arg(long, value_enum, value_name = "LIST", value_delimiter = ',', default_values = ["mjpeg", "h264-intra", "h264", "h265-intra", "h265"])]
    pub(crate) codecs: Vec<CodecChoice>,
    /// Preset of x264 and x265. The time of encoding counts as 0, whatever the preset
    #[arg(long, value_enum, value_name = "PRESET", default_value = "veryfast")]
    pub(crate) effort: EffortChoice,
    /// Print the report as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no tables
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// The options for reading the inputs. They are last, because clap lists later options under
    /// their heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

/// A codec as a value of the command line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CodecChoice(pub(crate) Codec);

impl ValueEnum for CodecChoice {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [CodecChoice; Codec::ALL.len()] = {
            let mut all = [CodecChoice(Codec::Mjpeg); Codec::ALL.len()];
            let mut at = 0;
            while at < all.len() {
                all[at] = CodecChoice(Codec::ALL[at]);
                at += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self.0 {
            Codec::Mjpeg => "Motion JPEG",
            Codec::H264Intra => "H.264, every frame by itself",
            Codec::H264 => "H.264, low delay: frames refer to those before them",
            Codec::H265Intra => "H.265, every frame by itself",
            Codec::H265 => "H.265, low delay",
        };
        Some(PossibleValue::new(self.0.name()).help(help))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum EffortChoice {
    Veryfast,
    Medium,
}

impl EffortChoice {
    pub(crate) fn effort(self) -> EncoderPreset {
        match self {
            Self::Veryfast => EncoderPreset::Veryfast,
            Self::Medium => EncoderPreset::Medium,
        }
    }
}
