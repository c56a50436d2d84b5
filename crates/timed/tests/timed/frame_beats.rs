// SPDX-License-Identifier: MIT OR Apache-2.0
//! The beats of a frame, and the pixels that a cut leaves of it.

use foveate_design::{Design, Hardware, PixelFeed, SerialDesign};
use foveate_model::{pad, region_stream};
use foveate_pixels::Frame;

pub(crate) fn frame_beats(design: &Design, frame: &Frame) -> Vec<Vec<u16>> {
    match design.hardware() {
        Hardware::Pipelined(_) => {
            let streams: Vec<_> =
                (0..design.regions()).map(|region| stream(design, frame, region)).collect();
            let places = 0..design.stream_pixels() as usize;
            places.map(|place| streams.iter().map(|stream| stream[place]).collect()).collect()
        }
        Hardware::Serial(own) => serial_beats(design.with_hardware(own), frame),
        Hardware::Raster(own) => {
            let size = own.pixels_per_clock;
            let words = (0..frame.height()).flat_map(|y| {
                let columns = (0..frame.width()).step_by(size as usize);
                columns.map(move |x| {
                    (x..x + size).map(|x| frame.get_clamped(x.into(), y.into())).collect()
                })
            });
            words.collect()
        }
    }
}

fn stream(design: &Design, frame: &Frame, region: u32) -> Vec<u16> {
    let mut stream = Vec::new();
    region_stream(design, frame, region, &mut stream);
    stream
}

fn serial_beats(design: SerialDesign<'_>, frame: &Frame) -> Vec<Vec<u16>> {
    match design.feed() {
        PixelFeed::Raster => {
            let padded = pad(design.camera(), frame).unwrap();
            padded.pixels().iter().map(|&pixel| vec![pixel]).collect()
        }
        PixelFeed::Parallel => {
            let empty = vec![0; design.stream_pixels() as usize];
            let slots = (0..design.fold()).flat_map(|slot| {
                let lanes =
                    (0..design.lanes()).map(|lane| match design.region_in_slot(lane, slot) {
                        Some(region) => stream(&design, frame, region),
                        None => empty.clone(),
                    });
                let lanes: Vec<_> = lanes.collect();
                let places = 0..design.stream_pixels() as usize;
                places
                    .map(|place| lanes.iter().map(|lane| lane[place]).collect())
                    .collect::<Vec<_>>()
            });
            slots.collect()
        }
    }
}

/// Returns true if a frame of which the last beats have another value is a frame again. Otherwise
/// it would be different in the halos of different regions, or in its padding.
pub(crate) fn can_be_cut(design: &Design) -> bool {
    let side = design.region_size();
    let is_whole = design.width().is_multiple_of(side) && design.height().is_multiple_of(side);
    match design.hardware() {
        Hardware::Pipelined(_) => is_whole && design.halo() == 0,
        Hardware::Serial(own) => match own.feed {
            PixelFeed::Parallel => is_whole && design.halo() == 0,
            PixelFeed::Raster => is_whole,
        },
        Hardware::Raster(_) => true,
    }
}

/// Returns the number of the beat that brings the pixel (x, y) of a frame that can be cut.
pub(crate) fn beat_of_pixel(design: &Design, x: u32, y: u32) -> u32 {
    let side = design.region_size();
    let (region, place) = (y / side * design.columns() + x / side, y % side * side + x % side);
    match design.hardware() {
        Hardware::Pipelined(_) => place,
        Hardware::Serial(own) => match own.feed {
            PixelFeed::Parallel => region % own.fold * side * side + place,
            PixelFeed::Raster => y * design.width() + x,
        },
        Hardware::Raster(own) => {
            y * design.width().div_ceil(own.pixels_per_clock) + x / own.pixels_per_clock
        }
    }
}
