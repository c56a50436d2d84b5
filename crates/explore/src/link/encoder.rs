// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip that goes through a codec and back ([`ClipEncoder`]): the bytes of every frame, as
//! ffprobe finds them in the stream, and the [`Quality`] of the decoded frames.
//!
//! The options of ffmpeg make a [`Codec`] as comparable as possible. Frames are grey. A
//! constant quantizer and one thread give the same bytes for the same frames. There are no B
//! frames and no look-ahead, so that a frame leaves before the next one comes. Supplemental
//! messages (SEI) are removed from the stream.

use crate::link::error::scratch_error;
use crate::link::{GreyFootage, LinkError};
use foveate_measure::FrameSimilarity;
use foveate_media::RunMonitor;
use foveate_tools::{Invocation, ProgramReader, Tool, ToolError, Toolchain};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The frame rate that the encoders are given. With a constant quantizer it does not change any
/// frame.
const FRAME_RATE: &str = "30";

/// A clip after encoding and decoding.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedClip {
    /// The bytes of every frame.
    pub packets: Vec<u64>,
    /// The quality of the decoded frames.
    pub quality: Quality,
}

/// An encoder of one clip with one codec. It encodes each quantizer once.
pub struct ClipEncoder<'a> {
    tools: &'a Toolchain,
    footage: &'a GreyFootage,
    codec: Codec,
    effort: EncoderPreset,
    /// The path of the stream, next to the footage.
    stream: PathBuf,
    known: BTreeMap<u32, EncodedClip>,
    /// The monitor of the run, which counts every decoded frame.
    monitor: &'a RunMonitor<'a>,
}

impl<'a> ClipEncoder<'a> {
    /// Creates an encoder that has encoded nothing. `monitor` counts every decoded frame.
    #[must_use]
    pub fn new(
        tools: &'a Toolchain,
        footage: &'a GreyFootage,
        (codec, effort): (Codec, EncoderPreset),
        monitor: &'a RunMonitor<'a>,
    ) -> Self {
        let stream = footage.path.with_extension(codec.format());
        Self { tools, footage, codec, effort, stream, known: BTreeMap::new(), monitor }
    }

    /// Returns the clip after encoding with this quantizer.
    ///
    /// # Errors
    /// Fails if ffmpeg fails or loses frames, or if the run is to stop.
    pub fn encode_with(&mut self, quantizer: u32) -> Result<&EncodedClip, LinkError> {
        if !self.known.contains_key(&quantizer) {
            let encoded = self.encode(quantizer)?;
            self.known.insert(quantizer, encoded);
        }
        Ok(&self.known[&quantizer])
    }

    /// Returns the results so far, by quantizer.
    #[must_use]
    pub fn encoded_clips(&self) -> &BTreeMap<u32, EncodedClip> {
        &self.known
    }

    /// Returns the path of the stream of the last quantizer.
    #[must_use]
    pub fn stream_path(&self) -> &Path {
        &self.stream
    }

    fn encode(&self, quantizer: u32) -> Result<EncodedClip, LinkError> {
        self.monitor.check()?;
        let size = format!("{}x{}", self.footage.width, self.footage.height);
        let encode = self
            .tools
            .invocation(Tool::Ffmpeg)?
            .args(["-hide_banner", "-nostdin", "-loglevel", "error", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "gray", "-video_size", &size])
            .args(["-framerate", FRAME_RATE, "-i"])
            .arg(&self.footage.path)
            .args(self.codec.options(quantizer, self.effort))
            .args(["-f", self.codec.format()])
            .arg(&self.stream);
        self.tools.run_checked(&encode).map_err(|error| self.encoder_error(error))?;
        Ok(EncodedClip {
            packets: self.packet_sizes(quantizer)?,
            quality: self.decoded_quality(quantizer)?,
        })
    }

    /// Converts an error of ffmpeg to an error in one line, if the encoder printed a reason.
    fn encoder_error(&self, error: ToolError) -> LinkError {
        let (encoder, codec) = (self.codec.encoder(), self.codec.name());
        let ToolError::Failed { full, .. } = &error else { return error.into() };
        let own = |line: &str| {
            let (speaker, said) = line.split_once("] ")?;
            speaker
                .strip_prefix('[')?
                .starts_with(encoder)
                .then(|| said.trim_end_matches('.').to_owned())
        };
        let Some(said) = full.lines().find_map(own) else { return error.into() };
        let GreyFootage { clip, width, height, .. } = self.footage;
        LinkError::EncoderRefused {
            encoder,
            codec,
            clip: clip.clone(),
            width: *width,
            height: *height,
            message: said,
        }
    }

    /// Returns the bytes of every frame.
    fn packet_sizes(&self, quantizer: u32) -> Result<Vec<u64>, LinkError> {
        let ask = self
            .tools
            .invocation(Tool::Ffprobe)?
            .args(["-v", "error", "-show_entries", "packet=size", "-of", "csv=p=0"])
            .args(["-f", self.codec.format()])
            .arg(&self.stream);
        let text = self.tools.run_checked(&ask)?.stdout;
        let text = String::from_utf8_lossy(&text);
        let sizes = text.lines().map(|line| line.trim_end_matches(',').parse());
        let sizes: Result<Vec<u64>, _> = sizes.collect();
        let sizes =
            sizes.map_err(|error| self.lost_frames_error(quantizer, 0, error.to_string()))?;
        self.check_frame_count(quantizer, sizes.len() as u64, "of ffprobe's packets")?;
        Ok(sizes)
    }

    /// Returns the quality of the decoded frames.
    fn decoded_quality(&self, quantizer: u32) -> Result<Quality, LinkError> {
        let mut decoder = ProgramReader::start(&self.decoder_command()?, &self.tools.interrupt())?;
        let path = &self.footage.path;
        let original = File::open(path).map_err(scratch_error("read", path))?;
        let mut original = BufReader::new(original);
        let (width, height) = (self.footage.width, self.footage.height);
        let mut likeness = FrameSimilarity::new(width, height);
        let mut pixels = [0, 1].map(|_| vec![0; width as usize * height as usize]);
        let [seen, expected] = &mut pixels;
        while decoder.read_exact(seen).is_ok() && likeness.frames() < self.footage.frames {
            self.monitor.add_frame();
            self.monitor.check()?;
            original.read_exact(expected).map_err(scratch_error("read", path))?;
            likeness.add(seen, expected)?;
        }
        let said = decoder.next_line()?.unwrap_or_else(|| "ffmpeg said nothing".to_owned());
        self.check_frame_count(quantizer, likeness.frames(), &said)?;
        Ok(Quality::from_likeness(&likeness))
    }

    fn decoder_command(&self) -> Result<Invocation, LinkError> {
        let ffmpeg = self.tools.find(Tool::Ffmpeg)?;
        // The option had another name before ffmpeg 5.1. Builds between releases have no version.
        let renamed = ffmpeg.version.as_ref().is_none_or(|version| version.is_at_least(5, 1));
        Ok(Invocation::new(ffmpeg.path)
            .args(["-hide_banner", "-nostdin", "-loglevel", "error"])
            .args(["-f", self.codec.format(), "-i"])
            .arg(&self.stream)
            .args(["-vf", "extractplanes=y"])
            .args([if renamed { "-fps_mode" } else { "-vsync" }, "passthrough"])
            .args(["-f", "rawvideo", "pipe:1"]))
    }

    fn check_frame_count(&self, quantizer: u32, found: u64, said: &str) -> Result<(), LinkError> {
        match found == self.footage.frames {
            true => Ok(()),
            false => Err(self.lost_frames_error(quantizer, found, said.to_owned())),
        }
    }

    fn lost_frames_error(&self, quantizer: u32, found: u64, said: String) -> LinkError {
        let (clip, expected) = (self.footage.clip.clone(), self.footage.frames);
        LinkError::LostFrames {
            codec: self.codec.name(),
            quantizer,
            clip,
            found,
            expected,
            message: said,
        }
    }
}

/// Checks that ffmpeg has the encoders of all codecs.
///
/// # Errors
/// Fails if ffmpeg is missing or lacks an encoder.
pub fn check_encoders(tools: &Toolchain, codecs: &[Codec]) -> Result<(), LinkError> {
    let ask = tools.invocation(Tool::Ffmpeg)?.args(["-hide_banner", "-encoders"]);
    let listed = tools.run_checked(&ask)?.stdout;
    let listed = String::from_utf8_lossy(&listed);
    let names: Vec<_> = listed.lines().map(|line| line.split_whitespace().nth(1)).collect();
    match codecs.iter().find(|codec| !names.contains(&Some(codec.encoder()))) {
        None => Ok(()),
        Some(codec) => Err(LinkError::NoEncoder { encoder: codec.encoder(), codec: codec.name() }),
    }
}

/// A codec, and the frames that its frames may refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// Motion JPEG; every frame stands alone. The encoder has no grey format, so two empty colour
    /// planes are added.
    Mjpeg,
    /// H.264; every frame stands alone.
    H264Intra,
    /// H.264; every frame but the first may refer to earlier frames.
    H264,
    /// H.265; every frame stands alone.
    H265Intra,
    /// H.265; every frame but the first may refer to earlier frames.
    H265,
}

/// The preset of x264 and x265, which sets their work for a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderPreset {
    /// The preset `veryfast`.
    Veryfast,
    /// The preset `medium`.
    Medium,
}

impl EncoderPreset {
    /// Returns the name of the preset.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Veryfast => "veryfast",
            Self::Medium => "medium",
        }
    }
}

impl Codec {
    /// All codecs.
    pub const ALL: [Self; 5] =
        [Self::Mjpeg, Self::H264Intra, Self::H264, Self::H265Intra, Self::H265];

    /// Returns the name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mjpeg => "mjpeg",
            Self::H264Intra => "h264-intra",
            Self::H264 => "h264",
            Self::H265Intra => "h265-intra",
            Self::H265 => "h265",
        }
    }

    /// Returns the name of ffmpeg's encoder.
    #[must_use]
    pub fn encoder(self) -> &'static str {
        match self {
            Self::Mjpeg => "mjpeg",
            Self::H264Intra | Self::H264 => "libx264",
            Self::H265Intra | Self::H265 => "libx265",
        }
    }

    /// Returns ffmpeg's name of the stream format.
    pub(crate) fn format(self) -> &'static str {
        match self {
            Self::Mjpeg => "mjpeg",
            Self::H264Intra | Self::H264 => "h264",
            Self::H265Intra | Self::H265 => "hevc",
        }
    }

    /// Returns the range of quantizers; the first is the finest.
    #[must_use]
    pub fn quantizers(self) -> RangeInclusive<u32> {
        match self {
            Self::Mjpeg => 1..=31,
            Self::H264Intra | Self::H264 | Self::H265Intra | Self::H265 => 0..=51,
        }
    }

    pub(crate) fn curve_quantizers(self) -> &'static [u32] {
        match self {
            Self::Mjpeg => &[1, 2, 4, 8, 16, 31],
            Self::H264Intra | Self::H264 | Self::H265Intra | Self::H265 => {
                &[10, 18, 24, 30, 36, 42, 51]
            }
        }
    }

    /// Returns ffmpeg's options for this codec.
    pub(crate) fn options(self, quantizer: u32, effort: EncoderPreset) -> Vec<String> {
        let preset = effort.name();
        let text = match self {
            Self::Mjpeg => {
                format!("-c:v mjpeg -pix_fmt yuvj420p -threads 1 -qmin 1 -q:v {quantizer}")
            }
            Self::H264Intra | Self::H264 => format!(
                "-c:v libx264 -pix_fmt gray -threads 1 -preset {preset} -tune zerolatency -bf 0 -psy 0 \
                 -qp {quantizer} -g {} -bsf:v filter_units=remove_types=6",
                if self == Self::H264 { "1000000" } else { "1" },
            ),
            Self::H265Intra | Self::H265 => format!(
                "-c:v libx265 -pix_fmt gray -preset {preset} -tune zerolatency -x265-params \
                 log-level=error:pools=none:frame-threads=1:info=0:bframes=0:psy-rd=0:psy-rdoq=0:\
                 qp={quantizer}:keyint={} -bsf:v filter_units=remove_types=39",
                if self == Self::H265 { "-1" } else { "1" },
            ),
        };
        text.split_whitespace().map(str::to_owned).collect()
    }
}

/// The PSNR and SSIM over the frames of a clip, rounded to four digits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// The PSNR in dB; `None` if every pixel is equal.
    pub psnr: Option<f64>,
    /// The SSIM, at most 1.
    pub ssim: f64,
}

impl Quality {
    pub(crate) const IDENTICAL: Self = Self { psnr: None, ssim: 1.0 };

    pub(crate) fn from_likeness(likeness: &FrameSimilarity) -> Self {
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        Self { psnr: likeness.psnr().map(rounded), ssim: rounded(likeness.ssim()) }
    }

    /// Returns whether the PSNR is at least that of `other`.
    pub(crate) fn reaches_psnr_of(self, other: Self) -> bool {
        self.psnr.unwrap_or(f64::INFINITY) >= other.psnr.unwrap_or(f64::INFINITY)
    }

    /// Returns whether the SSIM is at least that of `other`.
    pub(crate) fn reaches_ssim_of(self, other: Self) -> bool {
        self.ssim >= other.ssim
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_plain_ones_refer_to_other_frames() {
        let options = |codec: Codec| codec.options(30, EncoderPreset::Medium).join(" ");
        assert!(options(Codec::H264).contains("-g 1000000"));
        assert!(options(Codec::H264Intra).contains("-g 1 "));
        assert!(options(Codec::H265).contains("qp=30:keyint=-1 "));
        assert!(options(Codec::H265Intra).contains("qp=30:keyint=1 "));
        assert!(options(Codec::Mjpeg).ends_with("-q:v 30"));
    }
}
