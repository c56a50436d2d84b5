// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of frames of one size to the input size of a network.

use std::fmt;

use crate::error::NetworkError;
use crate::network::Network;
use crate::reader::FrameSize;

/// The grey of the rows and columns that a letterbox adds, as a share of white. Detectors are
/// usually trained with 114 of 255.
const PADDING: f32 = 114.0 / 255.0;

/// The way in which frames get the size of a network's input. Sizes are width and height in pixels;
/// without a size, the network's own is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Framing {
    /// Frames have the size of the input.
    #[default]
    Same,
    /// Frames are scaled with their aspect ratio and placed in the upper left corner. The rest of
    /// the input is grey.
    Letterbox(Option<(u32, u32)>),
    /// Frames are scaled to the size of the input, along each axis separately.
    Stretch(Option<(u32, u32)>),
}

/// Parses a framing as users write it: `same`, `letterbox`, `letterbox=416x416`, `stretch` or
/// `stretch=416x416`.
///
/// # Errors
/// Fails if the text is no framing; the message tells what is expected.
pub fn parse_framing(text: &str) -> Result<Framing, String> {
    let (name, size) = text.split_once('=').map_or((text, None), |(name, size)| (name, Some(size)));
    let side = |side: &str| side.parse().ok().filter(|side| (1..=16_384).contains(side));
    let size = match size {
        None => Some(None),
        Some(size) => {
            let sides = size.split_once('x');
            sides.and_then(|(width, height)| Some(Some((side(width)?, side(height)?))))
        }
    };
    match (name, size) {
        ("same", Some(None)) => Ok(Framing::Same),
        ("letterbox", Some(size)) => Ok(Framing::Letterbox(size)),
        ("stretch", Some(size)) => Ok(Framing::Stretch(size)),
        _ => Err("expected same, letterbox or stretch, the last two with or without a size of 1x1 to 16384x16384, \
                  for example letterbox=416x416"
            .to_owned()),
    }
}

impl fmt::Display for Framing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, size) = match self {
            Self::Same => ("same", None),
            Self::Letterbox(size) => ("letterbox", *size),
            Self::Stretch(size) => ("stretch", *size),
        };
        match size {
            None => f.write_str(name),
            Some((width, height)) => write!(f, "{name}={width}x{height}"),
        }
    }
}

impl serde::Serialize for Framing {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Framing {
    /// The requested size of the input; `None` is the network's own.
    pub(super) fn input_size(self, frame: (u32, u32)) -> Option<(u32, u32)> {
        match self {
            Self::Same => Some(frame),
            Self::Letterbox(size) | Self::Stretch(size) => size,
        }
    }

    /// Returns the scaling from frames of a size to an input of another size, or `None` for
    /// [`Framing::Same`].
    pub(super) fn scaling(self, frame: (u32, u32), input: (u32, u32)) -> Option<FrameScaling> {
        let scaled_size = match self {
            Self::Same => return None,
            Self::Stretch(_) => input,
            Self::Letterbox(_) => fitted_size(frame, input),
        };
        Some(FrameScaling::new(frame, scaled_size, input))
    }

    /// Reads a network for frames of this size, and returns it with the scaling to its input.
    /// `read` gets the size that the input must have; `None` is the network's own.
    ///
    /// # Errors
    /// Fails if the network cannot be read, or if it takes frames of any size and no size is
    /// requested.
    pub(super) fn read_network(
        self,
        read: impl FnOnce(Option<FrameSize>) -> Result<Network, NetworkError>,
        frame: (u32, u32),
    ) -> Result<(Network, Option<FrameScaling>), NetworkError> {
        let pixels = |(width, height): (u32, u32)| FrameSize {
            width: width as usize,
            height: height as usize,
        };
        let network = read(self.input_size(frame).map(pixels))?;
        let side = |side: usize| u32::try_from(side).expect("an input is smaller than 2^28 values");
        let input = (side(network.input().width()), side(network.input().height()));
        let scaling = self.scaling(frame, input);
        Ok((network, scaling))
    }
}

/// Returns the largest size within another that has the aspect ratio of a frame.
fn fitted_size((width, height): (u32, u32), (most_x, most_y): (u32, u32)) -> (u32, u32) {
    let (x, y) = (f64::from(most_x) / f64::from(width), f64::from(most_y) / f64::from(height));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the input")]
    let side = |side: u32, most: u32| ((f64::from(side) * x.min(y)).round() as u32).clamp(1, most);
    (side(width, most_x), side(height, most_y))
}

/// The two pixels of the frame between which a pixel of the input lies, along one axis.
#[derive(Clone, Copy, Debug)]
struct BilinearTap {
    first: usize,
    second: usize,
    /// The weight of the second pixel.
    weight: f32,
}

/// The source of each pixel of an input, by bilinear interpolation between the centers of pixels of
/// the frame.
#[derive(Clone, Debug)]
pub(super) struct FrameScaling {
    columns: Vec<BilinearTap>,
    rows: Vec<BilinearTap>,
    width: usize,
    input_width: usize,
    /// The pixels of the frame per pixel of the input, along x and y.
    scale: (f64, f64),
}

impl FrameScaling {
    fn new(frame: (u32, u32), scaled_size: (u32, u32), input: (u32, u32)) -> Self {
        let scale = |frame: u32, scaled_size: u32| f64::from(frame) / f64::from(scaled_size);
        let scale = (scale(frame.0, scaled_size.0), scale(frame.1, scaled_size.1));
        Self {
            columns: axis_taps(frame.0, scaled_size.0, scale.0),
            rows: axis_taps(frame.1, scaled_size.1, scale.1),
            width: frame.0 as usize,
            input_width: input.0 as usize,
            scale,
        }
    }

    /// The grey around the frame, as a share of white.
    pub(super) fn padding() -> f32 {
        PADDING
    }

    /// The pixels of the frame per pixel of the input, along x and y.
    pub(super) fn scale(&self) -> (f64, f64) {
        self.scale
    }

    /// Calls `visit` for every pixel of the input that depends on a region for which `is_selected`
    /// holds, with its column and row, its index and its grey level. `is_selected` gets the column
    /// and the row of a region; regions have `side` x `side` pixels.
    pub(super) fn for_each_pixel_of_regions(
        &self,
        frame: &[u16],
        side: usize,
        is_selected: impl Fn(usize, usize) -> bool,
        mut visit: impl FnMut((usize, usize), usize, f32),
    ) {
        for (y, row) in self.rows.iter().enumerate() {
            let [upper, lower] = [row.first, row.second].map(|y| &frame[y * self.width..]);
            let regions = [row.first / side, row.second / side];
            for (x, column) in self.columns.iter().enumerate() {
                let [left, right] = [column.first / side, column.second / side];
                let is_dependent =
                    regions.iter().any(|&row| is_selected(left, row) || is_selected(right, row));
                if !is_dependent {
                    continue;
                }
                let interpolate = |line: &[u16]| {
                    let (first, second) =
                        (f32::from(line[column.first]), f32::from(line[column.second]));
                    first + (second - first) * column.weight
                };
                let (upper, lower) = (interpolate(upper), interpolate(lower));
                visit((x, y), y * self.input_width + x, upper + (lower - upper) * row.weight);
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place within the frame"
)]
fn axis_taps(frame: u32, outputs: u32, scale: f64) -> Vec<BilinearTap> {
    let last = f64::from(frame - 1);
    let tap = |at: u32| {
        let position = ((f64::from(at) + 0.5) * scale - 0.5).clamp(0.0, last);
        let first = position.floor();
        let second = (first + 1.0).min(last);
        BilinearTap {
            first: first as usize,
            second: second as usize,
            weight: (position - first) as f32,
        }
    };
    (0..outputs).map(tap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_pixels(scaling: &FrameScaling, frame: &[u16], count: usize) -> Vec<Option<f32>> {
        let mut found = vec![None; count];
        scaling.for_each_pixel_of_regions(
            frame,
            4,
            |_, _| true,
            |_, at, grey| found[at] = Some(grey),
        );
        found
    }

    #[test]
    fn framings_are_read_as_they_are_written() {
        for text in ["same", "letterbox", "stretch", "letterbox=416x416", "stretch=320x240"] {
            assert_eq!(parse_framing(text).unwrap().to_string(), text);
        }
        for wrong in ["", "same=4x4", "letterbox=", "letterbox=416", "stretch=0x4", "fill"] {
            assert!(parse_framing(wrong).unwrap_err().contains("letterbox=416x416"), "{wrong}");
        }
    }

    #[test]
    fn pixels_lie_between_those_of_the_frame() {
        let scaling = Framing::Stretch(None).scaling((4, 2), (2, 2)).unwrap();
        let frame = [0, 2, 10, 20, 4, 6, 30, 40];
        assert_eq!(all_pixels(&scaling, &frame, 4), [1.0, 15.0, 5.0, 35.0].map(Some));
        // The input is larger. Pixels beyond the outer centers of the frame have the values of
        // these.
        let scaling = Framing::Stretch(None).scaling((2, 1), (4, 1)).unwrap();
        assert_eq!(all_pixels(&scaling, &[0, 100], 4), [0.0, 25.0, 75.0, 100.0].map(Some));
        assert_eq!(scaling.scale(), (0.5, 1.0));
    }

    #[test]
    fn a_letterbox_keeps_the_shape_and_leaves_the_rest() {
        let scaling = Framing::Letterbox(None).scaling((1280, 720), (416, 416)).unwrap();
        assert_eq!((scaling.columns.len(), scaling.rows.len()), (416, 234));
        let scaling = Framing::Letterbox(None).scaling((8, 4), (4, 4)).unwrap();
        let found = all_pixels(&scaling, &[7; 32], 16);
        assert!(found[..8].iter().all(|grey| *grey == Some(7.0)));
        assert!(found[8..].iter().all(Option::is_none));
    }

    /// A pixel of the input that changes when a region changes must be visited.
    #[test]
    fn every_pixel_that_depends_on_a_region_is_visited() {
        let scaling = Framing::Stretch(None).scaling((12, 8), (7, 5)).unwrap();
        let before = [50; 96];
        for (column, row) in (0..3).flat_map(|column| [(column, 0), (column, 1)]) {
            let mut after = before;
            for (at, pixel) in after.iter_mut().enumerate() {
                if (at % 12 / 4, at / 12 / 4) == (column, row) {
                    *pixel = 90;
                }
            }
            let mut is_visited = [false; 35];
            let is_changed = |x, y| (x, y) == (column, row);
            scaling
                .for_each_pixel_of_regions(&after, 4, is_changed, |_, at, _| is_visited[at] = true);
            let [old, new] = [before, after].map(|frame| all_pixels(&scaling, &frame, 35));
            for at in 0..35 {
                assert!(is_visited[at] || old[at] == new[at], "{column}, {row}: {at}");
            }
            assert!(is_visited.iter().any(|is_visited| !is_visited));
        }
    }
}
