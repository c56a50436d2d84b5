// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion from 8-bit grey, which a browser has, to pixels of P bits and back.

use foveate_pixels::{FramePixels, convert_depth};

/// The pixel value of every 8-bit grey in a camera of P bits.
#[derive(Clone, Debug)]
pub(crate) struct DepthConversion {
    bits: u32,
    pixels: [u16; 256],
}

/// Pixels of P bits, as the engine takes them.
#[derive(Clone, Debug)]
pub(crate) enum CameraPixels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

impl DepthConversion {
    pub(crate) fn new(bits: u32) -> Self {
        let mut grey = 0..=u8::MAX;
        let pixel = |()| convert_depth(grey.next().unwrap_or_default().into(), 8, bits);
        Self { bits, pixels: [(); 256].map(pixel) }
    }

    /// Returns an empty buffer of the type that the depth needs.
    pub(crate) fn empty_pixels(&self) -> CameraPixels {
        if self.bits <= 8 {
            CameraPixels::Bytes(Vec::new())
        } else {
            CameraPixels::Words(Vec::new())
        }
    }

    /// Converts 8-bit grey to pixels of the camera.
    pub(crate) fn to_camera(&self, grey: &[u8], pixels: &mut CameraPixels) {
        match pixels {
            CameraPixels::Bytes(bytes) => {
                bytes.clear();
                if self.bits == 8 {
                    bytes.extend_from_slice(grey);
                } else {
                    bytes.extend(grey.iter().map(|&grey| low_byte(self.pixels[usize::from(grey)])));
                }
            }
            CameraPixels::Words(words) => {
                words.clear();
                words.extend(grey.iter().map(|&grey| self.pixels[usize::from(grey)]));
            }
        }
    }

    /// Converts pixels of the camera to 8-bit grey.
    pub(crate) fn to_grey(&self, pixels: FramePixels<'_>, grey: &mut Vec<u8>) {
        grey.clear();
        pixels.append_grey(self.bits, grey);
    }
}

impl CameraPixels {
    pub(crate) fn plane(&self) -> FramePixels<'_> {
        match self {
            Self::Bytes(pixels) => FramePixels::Bytes(pixels),
            Self::Words(pixels) => FramePixels::Words(pixels),
        }
    }
}

/// Returns the low byte of a pixel of up to 8 bits.
fn low_byte(pixel: u16) -> u8 {
    pixel.to_le_bytes()[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_grey_comes_back_as_far_as_the_bits_hold_it() {
        let all: Vec<u8> = (0..=u8::MAX).collect();
        for bits in 1..=16 {
            let depth = DepthConversion::new(bits);
            let mut pixels = depth.empty_pixels();
            depth.to_camera(&all, &mut pixels);
            let expected = (0..256).map(|grey| convert_depth(grey, 8, bits));
            assert!(pixels.plane().to_words().into_iter().eq(expected), "{bits} bits");
            let mut shown = Vec::new();
            depth.to_grey(pixels.plane(), &mut shown);
            if bits >= 8 {
                assert_eq!(shown, all, "{bits} bits");
            } else {
                let cut = |grey: u8| convert_depth(u16::from(grey) >> (8 - bits), bits, 8);
                assert!(shown.iter().zip(&all).all(|(&a, &b)| u16::from(a) == cut(b)));
            }
        }
    }
}
