// SPDX-License-Identifier: MIT OR Apache-2.0
//! The places of the pixel port that carry a pixel of the frame.

use foveate_design::{Design, Hardware, PixelFeed};

/// Returns whether a lane of the pixel port carries a pixel of the frame at a beat, counted from
/// the first beat of the frame. A lane of a serial array has none in the slots that no region uses,
/// and the last word of a row of a raster core may reach beyond the frame. Values in such places
/// are arbitrary.
pub(super) fn has_pixel(design: &Design, beat: u64, lane: u32) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) => true,
        Hardware::Serial(own) => {
            let own = design.with_hardware(own);
            match own.feed() {
                PixelFeed::Raster => true,
                PixelFeed::Parallel => {
                    let slot = beat / u64::from(design.stream_pixels());
                    let region = u64::from(lane) * u64::from(own.fold()) + slot;
                    region < own.regions().into()
                }
            }
        }
        Hardware::Raster(own) => {
            let pixels = u64::from(design.with_hardware(own).pixels_per_clock());
            let words = u64::from(design.width()).div_ceil(pixels);
            beat % words * pixels + u64::from(lane) < design.width().into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    fn design(toml: &str) -> Design {
        DesignConfig::from_toml(toml).unwrap().validate().unwrap()
    }

    #[test]
    fn slots_without_a_region_carry_no_pixel() {
        let design = design(
            "frame={width=12,height=4}\nregion.size=4\nhardware={organization='serial',fold=2}",
        );
        let stream = u64::from(design.stream_pixels());
        let carried = |beat| (0..2).map(|lane| has_pixel(&design, beat, lane)).collect::<Vec<_>>();
        assert_eq!(carried(stream - 1), [true, true]);
        assert_eq!(carried(stream), [true, false], "three regions, four slots");
    }

    #[test]
    fn a_word_beyond_the_end_of_a_row_carries_fewer_pixels() {
        let design = design(
            "frame={width=58,height=8}\nhardware={organization='raster',pixels_per_clock=4}",
        );
        let carried = |beat| (0..4).filter(|&lane| has_pixel(&design, beat, lane)).count();
        assert_eq!([0, 13, 14, 15, 29].map(carried), [4, 4, 2, 4, 2]);
    }
}
