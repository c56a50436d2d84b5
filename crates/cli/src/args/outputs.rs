// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options that say what a run writes: for `simulate` and `decode` alike
//! ([`ReceiverOutputArgs`]), and for `simulate` alone ([`OutputArgs`]). The other types are the
//! choices of these options.

use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Args, Command, Error, ValueEnum};
use foveate_camera::Decimal;
use foveate_simulator::{EventTableOptions, OverlayStyle, PixelEventOptions, RunOptions};
use std::ffi::OsStr;

/// The options for what `simulate` and `decode` write in addition to arrays, frames.csv and
/// summary.json.
#[derive(Args, Debug)]
#[command(next_help_heading = "Outputs")]
pub(crate) struct ReceiverOutputArgs {
    /// Format of the rendered frames, which the receiver's screen shows: numbered pictures, a
    /// lossless video (FFV1), or a video for any player (H.264); video needs ffmpeg
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = RenderedFormat::Png)]
    pub(crate) rendered: RenderedFormat,
    /// The same as --rendered none
    #[arg(long, conflicts_with = "rendered")]
    pub(crate) no_rendered: bool,
    /// Write the original frames with what is sent bright, what is not sent dark, and means tinted;
    /// `decode` has no original frames and uses the rendered ones
    #[arg(long, value_enum, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "png")]
    pub(crate) overlay: Option<PictureFormat>,
    /// Write the overlay with a colour and outlines for each decision, to tune thresholds: sent,
    /// relevant but unchanged, changed but irrelevant
    #[arg(long, value_enum, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "png", conflicts_with = "overlay")]
    pub(crate) overlay_outlines: Option<PictureFormat>,
    /// Write a map of every score
    #[arg(long, value_enum, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "png")]
    pub(crate) heatmap: Option<PictureFormat>,
    /// Write a table with one row per region and frame; separate several formats with commas
    #[arg(long, value_enum, value_name = "FORMATS", value_delimiter = ',')]
    pub(crate) events: Vec<EventFormat>,
    /// Rows of the table to keep
    #[arg(long, value_enum, value_name = "WHICH", requires = "events")]
    pub(crate) only: Option<EventFilter>,
}

/// The options for what only `simulate` writes.
#[derive(Args, Debug)]
#[command(next_help_heading = "Outputs")]
pub(crate) struct OutputArgs {
    #[command(flatten)]
    pub(crate) receiver: ReceiverOutputArgs,
    /// Write what the camera sends as a stream of packets, packets.bin, which `foveate decode`
    /// reads; on request with the scores of all regions
    #[arg(long, value_enum, value_name = "CONTENT", num_args = 0..=1, require_equals = true, default_missing_value = "plain")]
    pub(crate) packets: Option<PacketContent>,
    /// Write ordinary (x, y, t, p) events of the same frames; separate several formats with commas
    #[arg(long, value_parser = PixelEventFormatParser, value_name = "FORMATS", value_delimiter = ',', num_args = 0..=1, require_equals = true, default_missing_value = "npz")]
    pub(crate) pixel_events: Vec<PixelEventFormat>,
    /// Change of a pixel that makes a pixel event: in grey levels [default: temporal.level + 1], or
    /// in natural logarithms with --log [default: 0.2]
    #[arg(long, value_name = "C", allow_negative_numbers = true, value_parser = parse_decimal, requires = "pixel_events")]
    pub(crate) contrast: Option<Decimal>,
    /// Make pixel events from logarithmic pixel values instead of linear ones
    #[arg(long, requires = "pixel_events")]
    pub(crate) log: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum RenderedFormat {
    Png,
    /// Lossless video
    #[value(alias = "video")]
    Mkv,
    /// Video for any player
    Mp4,
    None,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum PictureFormat {
    Png,
    /// Lossless video
    #[value(alias = "video")]
    Mkv,
    /// Video for any player
    Mp4,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum EventFormat {
    Csv,
    Parquet,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum EventFilter {
    /// Only regions that send pixels or means
    Active,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum PacketContent {
    /// Decisions, displacements, pixels and means
    Plain,
    /// The scores of all regions, too
    Scores,
}

impl OutputArgs {
    pub(crate) fn options(&self) -> RunOptions {
        RunOptions {
            pixel_events: PixelEventOptions {
                npz: self.pixel_events.contains(&PixelEventFormat::Npz),
                csv: self.pixel_events.contains(&PixelEventFormat::Csv),
                evt2: self.pixel_events.contains(&PixelEventFormat::Evt2),
                evt3: self.pixel_events.contains(&PixelEventFormat::Evt3),
                aedat4: self.pixel_events.contains(&PixelEventFormat::Aedat4),
                contrast: self.contrast,
                is_logarithmic: self.log,
            },
            packets: self.packets.map(|content| match content {
                PacketContent::Plain => foveate_simulator::PacketContent::Plain,
                PacketContent::Scores => foveate_simulator::PacketContent::WithScores,
            }),
            ..self.receiver.options()
        }
    }
}

impl ReceiverOutputArgs {
    pub(crate) fn options(&self) -> RunOptions {
        let medium = |pictures| match pictures {
            PictureFormat::Png => foveate_simulator::PictureFormat::Png,
            PictureFormat::Mkv => foveate_simulator::PictureFormat::Mkv,
            PictureFormat::Mp4 => foveate_simulator::PictureFormat::Mp4,
        };
        let rendered = match self.rendered {
            _ if self.no_rendered => None,
            RenderedFormat::None => None,
            RenderedFormat::Png => Some(foveate_simulator::PictureFormat::Png),
            RenderedFormat::Mkv => Some(foveate_simulator::PictureFormat::Mkv),
            RenderedFormat::Mp4 => Some(foveate_simulator::PictureFormat::Mp4),
        };
        RunOptions {
            rendered,
            overlay: self.overlay.or(self.overlay_outlines).map(medium),
            overlay_style: match self.overlay_outlines {
                Some(_) => OverlayStyle::Outlines,
                None => OverlayStyle::Sent,
            },
            heatmap: self.heatmap.map(medium),
            events: EventTableOptions {
                csv: self.events.contains(&EventFormat::Csv),
                parquet: self.events.contains(&EventFormat::Parquet),
                only_active: self.only == Some(EventFilter::Active),
            },
            ..RunOptions::default()
        }
    }
}

fn parse_decimal(text: &str) -> Result<Decimal, String> {
    let value = text.parse().ok().and_then(Decimal::from_f64);
    value.ok_or_else(|| "expected a number with at most nine digits after the point".to_owned())
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum PixelEventFormat {
    /// Compressed arrays of NumPy, with the fields of tonic
    Npz,
    Csv,
    /// EVT 2.0, for frames of at most 2048x2048 pixels
    Evt2,
    /// EVT 3.0, for frames of at most 2048x2048 pixels
    Evt3,
    /// AEDAT4, compressed with LZ4
    Aedat4,
}

/// Reads the name of a format. HDF5 is refused with the way to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelEventFormatParser;

impl TypedValueParser for PixelEventFormatParser {
    type Value = PixelEventFormat;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<PixelEventFormat, Error> {
        let is_hdf5 = |name: &&str| value.eq_ignore_ascii_case(name);
        if let Some(name) = ["hdf5", "h5", "dsec"].iter().find(|name| is_hdf5(name)) {
            let message = format!(
                "the command writes no HDF5, so --pixel-events={name} is not possible; write npz, and `write_dsec` of \
                 the Python package makes a file like those of DSEC of its events\n"
            );
            return Err(Error::raw(ErrorKind::ValueValidation, message).with_cmd(command));
        }
        EnumValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let values = PixelEventFormat::value_variants().iter();
        Some(Box::new(values.filter_map(ValueEnum::to_possible_value)))
    }
}
