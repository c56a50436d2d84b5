// SPDX-License-Identifier: MIT OR Apache-2.0
//! The size and the pixel format of raw video.

use crate::MAX_SIDE;
use crate::samples::SampleLayout;

/// The size and the pixel format of raw video, which has no header. The formats have the names that
/// ffmpeg gives them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawLayout {
    width: u32,
    height: u32,
    format: RawFormat,
}

/// The order of the samples of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SampleOrder {
    /// One sample per pixel.
    Grey,
    /// A plane of luma, then those of colours, for each of which a block of so many columns and
    /// rows has a sample.
    Planes { columns: u64, rows: u64 },
    /// Luma and colours in turn, two bytes per pixel; the luma is at this place of the two.
    Pairs { luma: usize },
    /// So many bytes per pixel, with red, green and blue at these places.
    Colours { bytes: usize, places: [usize; 3] },
}

/// A pixel format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct RawFormat {
    name: &'static str,
    order: SampleOrder,
    depth: u32,
    is_big_endian: bool,
}

const fn format(name: &'static str, order: SampleOrder, depth: u32) -> RawFormat {
    RawFormat { name, order, depth, is_big_endian: false }
}

const fn big_endian(name: &'static str, depth: u32) -> RawFormat {
    RawFormat { name, order: SampleOrder::Grey, depth, is_big_endian: true }
}

const fn colours(name: &'static str, bytes: usize, places: [usize; 3]) -> RawFormat {
    format(name, SampleOrder::Colours { bytes, places }, 8)
}

const PLANES_420: SampleOrder = SampleOrder::Planes { columns: 2, rows: 2 };
const PLANES_422: SampleOrder = SampleOrder::Planes { columns: 2, rows: 1 };
const PLANES_444: SampleOrder = SampleOrder::Planes { columns: 1, rows: 1 };

const FORMATS: [RawFormat; 24] = [
    format("gray", SampleOrder::Grey, 8),
    format("gray10le", SampleOrder::Grey, 10),
    format("gray12le", SampleOrder::Grey, 12),
    format("gray14le", SampleOrder::Grey, 14),
    format("gray16le", SampleOrder::Grey, 16),
    big_endian("gray10be", 10),
    big_endian("gray12be", 12),
    big_endian("gray14be", 14),
    big_endian("gray16be", 16),
    format("yuv420p", PLANES_420, 8),
    format("yuv422p", PLANES_422, 8),
    format("yuv444p", PLANES_444, 8),
    format("yuv420p10le", PLANES_420, 10),
    format("yuv422p10le", PLANES_422, 10),
    format("yuv444p10le", PLANES_444, 10),
    format("yuv420p12le", PLANES_420, 12),
    // The samples of both colours lie in one plane, which has as many as two planes.
    format("nv12", PLANES_420, 8),
    format("nv21", PLANES_420, 8),
    format("yuyv422", SampleOrder::Pairs { luma: 0 }, 8),
    format("uyvy422", SampleOrder::Pairs { luma: 1 }, 8),
    colours("rgb24", 3, [0, 1, 2]),
    colours("bgr24", 3, [2, 1, 0]),
    colours("rgba", 4, [0, 1, 2]),
    colours("bgra", 4, [2, 1, 0]),
];

impl RawLayout {
    /// Parses a layout such as `640x480,gray16le`.
    ///
    /// # Errors
    /// Fails if the text is not a size and a pixel format that is read, with a text that says what
    /// is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (size, name) = text
            .split_once(',')
            .ok_or("expected a size and a pixel format, for example 640x480,gray16le")?;
        let is_number = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        let side = |part: &str| {
            part.parse().ok().filter(|side| is_number(part) && (1..=MAX_SIDE).contains(side))
        };
        let size = size.split_once('x').and_then(|(width, height)| side(width).zip(side(height)));
        let (width, height) = size.ok_or_else(|| {
            format!("the size is WIDTHxHEIGHT, each 1 to {MAX_SIDE}, for example 640x480,gray16le")
        })?;
        let found = FORMATS.into_iter().find(|format| format.name == name);
        let format = found.ok_or_else(|| {
            let names = FORMATS.map(|format| format.name).join(", ");
            format!("the pixel format `{name}` is not read; the formats are {names}")
        })?;
        if matches!(format.order, SampleOrder::Pairs { .. }) && !width.is_multiple_of(2) {
            return Err(format!("frames in {name} have an even width, not {width}"));
        }
        Ok(Self { width, height, format })
    }

    /// Returns true if the pixels are single samples, as those of a mosaic.
    pub(crate) fn is_grey(self) -> bool {
        self.format.order == SampleOrder::Grey
    }

    /// Returns true if the pixels are luma and colours of video, so that their luma may have a
    /// narrow range.
    pub(crate) fn has_video_luma(self) -> bool {
        match self.format.order {
            SampleOrder::Grey | SampleOrder::Colours { .. } => false,
            SampleOrder::Planes { .. } | SampleOrder::Pairs { .. } => true,
        }
    }

    /// Returns true if both sides have at least `side` pixels.
    pub(crate) fn has_sides(self, side: usize) -> bool {
        self.width.min(self.height) as usize >= side
    }

    pub(crate) fn frame_bytes(self) -> u64 {
        self.first_bytes() as u64 + self.other_bytes()
    }

    /// Returns the number of bytes that hold the luma or the colours from which luma is computed.
    pub(crate) fn first_bytes(self) -> usize {
        let per_pixel = match self.format.order {
            SampleOrder::Grey | SampleOrder::Planes { .. } => self.sample_bytes(),
            SampleOrder::Pairs { .. } => 2,
            SampleOrder::Colours { bytes, .. } => bytes,
        };
        self.width as usize * self.height as usize * per_pixel
    }

    /// Returns the number of bytes behind them, which are not needed.
    pub(crate) fn other_bytes(self) -> u64 {
        match self.format.order {
            SampleOrder::Planes { columns, rows } => {
                let (width, height) = (u64::from(self.width), u64::from(self.height));
                2 * width.div_ceil(columns) * height.div_ceil(rows) * self.sample_bytes() as u64
            }
            SampleOrder::Grey | SampleOrder::Pairs { .. } | SampleOrder::Colours { .. } => 0,
        }
    }

    fn sample_bytes(self) -> usize {
        if self.format.depth > 8 { 2 } else { 1 }
    }

    /// Returns the layout of the samples that [`sorted`](Self::sorted) leaves. Luma of video with
    /// colours is expanded if `is_full`.
    pub(crate) fn samples(self, is_full: bool) -> SampleLayout {
        SampleLayout {
            is_colour: !self.is_grey() && !self.has_video_luma(),
            is_big_endian: self.format.is_big_endian,
            is_expanded: is_full && self.has_video_luma(),
            ..SampleLayout::luma(self.width, self.height, self.format.depth)
        }
    }

    /// Returns the luma of a frame, or its red, green and blue, without the samples between them.
    pub(crate) fn sorted(self, mut bytes: Vec<u8>) -> Vec<u8> {
        let pixels = self.width as usize * self.height as usize;
        match self.format.order {
            SampleOrder::Grey | SampleOrder::Planes { .. } => {}
            SampleOrder::Pairs { luma } => {
                for pixel in 0..pixels {
                    bytes[pixel] = bytes[2 * pixel + luma];
                }
                bytes.truncate(pixels);
            }
            SampleOrder::Colours { bytes: stride, places } => {
                for pixel in 0..pixels {
                    let colours = places.map(|place| bytes[stride * pixel + place]);
                    bytes[3 * pixel..3 * pixel + 3].copy_from_slice(&colours);
                }
                bytes.truncate(3 * pixels);
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_are_read_as_people_write_them() {
        let layout = RawLayout::parse("640x480,gray16le").unwrap();
        assert_eq!((layout.width, layout.height, layout.format.depth), (640, 480, 16));
        for (text, problem) in [
            ("640x480", "a size and a pixel format"),
            ("640,gray", "the size is WIDTHxHEIGHT"),
            ("0x480,gray", "each 1 to 16384"),
            ("640x480,grey", "`grey` is not read; the formats are gray, gray10le"),
            ("641x480,yuyv422", "an even width, not 641"),
        ] {
            let error = RawLayout::parse(text).unwrap_err();
            assert!(error.contains(problem), "{text}: {error}");
        }
    }

    #[test]
    fn frames_have_the_bytes_of_all_planes() {
        for (text, bytes) in [
            ("5x3,gray", 15),
            ("5x3,gray10le", 30),
            ("5x3,yuv420p", 15 + 2 * 3 * 2),
            ("5x3,nv12", 15 + 2 * 3 * 2),
            ("5x3,yuv422p10le", 30 + 2 * 3 * 3 * 2),
            ("5x3,yuv444p", 45),
            ("6x3,uyvy422", 36),
            ("5x3,bgra", 60),
        ] {
            assert_eq!(RawLayout::parse(text).unwrap().frame_bytes(), bytes, "{text}");
        }
    }
}
