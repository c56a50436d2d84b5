// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame as the pixel port of a core takes it.

use foveate_design::RasterDesign;
use foveate_frame::Frame;

/// The words of a frame, row by row. Pixels of the last word of a row that lie beyond the frame are `nothing`.
pub(crate) fn words(
    design: RasterDesign<'_>,
    frame: &Frame,
    mut nothing: impl FnMut() -> u16,
) -> Vec<Vec<u16>> {
    let pixels = design.pixels_per_clock() as usize;
    let mut words = Vec::new();
    for y in 0..frame.height() {
        for word in frame.row(y).chunks(pixels) {
            let mut word = word.to_vec();
            word.resize_with(pixels, &mut nothing);
            words.push(word);
        }
    }
    words
}
