// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `link`.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use foveate_link::{Codec, EncoderPreset};

use super::check::parse_decimal_or_none;
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

/// The rate of a link in bits per second, 1..=10^12.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinkRate(pub(crate) u64);

impl LinkRate {
    const MAX: u64 = 1_000_000_000_000;

    fn parse(text: &str) -> Result<Self, String> {
        let plain = text.strip_suffix("/s").unwrap_or(text);
        let split = plain.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(plain.len());
        let (number, unit) = plain.split_at(split);
        let unit = match unit.to_ascii_lowercase().as_str() {
            "bit" => Some(1),
            "kbit" => Some(1000),
            "mbit" => Some(1_000_000),
            "gbit" => Some(1_000_000_000),
            _ => None,
        };
        let rate = unit.and_then(|unit| Some(parse_decimal_or_none(number)?.ceil_times(unit)));
        rate.and_then(|rate| u64::try_from(rate).ok())
            .filter(|rate| (1..=Self::MAX).contains(rate))
            .map(Self)
            .ok_or_else(|| "expected 1bit to 1000Gbit per second, for example 100Mbit".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_units() {
        let rate = |text| LinkRate::parse(text).map(|rate| rate.0);
        assert_eq!(rate("100Mbit"), Ok(100_000_000));
        assert_eq!(rate("1.5Gbit/s"), Ok(1_500_000_000));
        assert_eq!((rate("9bit"), rate("64kbit")), (Ok(9), Ok(64_000)));
        for wrong in ["", "100", "Mbit", "0Mbit", "-1Mbit", "5MB", "1001Gbit", "100Mbit/h"] {
            assert!(rate(wrong).is_err(), "{wrong}");
        }
    }
}
