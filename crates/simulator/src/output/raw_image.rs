// SPDX-License-Identifier: MIT OR Apache-2.0
//! A picture in memory, before it is written as a PNG or a video frame.

use super::canvas::PictureCanvas;
use super::sink::SinkFrame;
use foveate_pixels::{FramePixels, convert_depth, display_depth};

/// The sample format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SampleFormat {
    Grey8,
    /// Words in the byte order of the machine.
    Grey16,
    Rgb8,
}

/// A picture as bytes.
pub(super) struct RawImage {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) samples: SampleFormat,
    pub(super) bytes: Vec<u8>,
}

impl From<PictureCanvas> for RawImage {
    fn from(canvas: PictureCanvas) -> Self {
        let PictureCanvas { width, height, rgb } = canvas;
        Self { width, height, samples: SampleFormat::Rgb8, bytes: rgb }
    }
}

impl RawImage {
    /// Makes a picture of the screen, at the depth of [`display_depth`]. It reuses the memory of
    /// `bytes`.
    pub(super) fn of_screen(sink_frame: &SinkFrame<'_>, mut bytes: Vec<u8>) -> Self {
        let bits = sink_frame.camera.pixel_bits();
        let depth = display_depth(bits);
        let shown = |value: u16| convert_depth(value, bits, depth);
        bytes.clear();
        let samples = match sink_frame.screen {
            FramePixels::Bytes(pixels) if bits == depth => {
                bytes.extend_from_slice(pixels);
                SampleFormat::Grey8
            }
            FramePixels::Bytes(pixels) => {
                bytes.extend(pixels.iter().map(|&value| to_byte(shown(value.into()))));
                SampleFormat::Grey8
            }
            FramePixels::Words(pixels) => {
                bytes.extend(pixels.iter().flat_map(|&value| shown(value).to_ne_bytes()));
                SampleFormat::Grey16
            }
        };
        Self {
            width: sink_frame.camera.width(),
            height: sink_frame.camera.height(),
            samples,
            bytes,
        }
    }
}

/// Converts an 8-bit value to a byte.
pub(super) fn to_byte(value: u16) -> u8 {
    u8::try_from(value).expect("it has 8 bits")
}
