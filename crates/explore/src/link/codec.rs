// SPDX-License-Identifier: MIT OR Apache-2.0
//! The codecs that are compared, and their options for ffmpeg. Frames are grey. A constant
//! quantizer and one thread give the same bytes for the same frames. There are no B frames and no
//! look-ahead, so that a frame leaves before the next one comes. Supplemental messages (SEI) are
//! removed from the stream.

use std::ops::RangeInclusive;

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
