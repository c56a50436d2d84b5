// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pattern in place of a sensor, and the sums over the packets of its frames (docs/boards.md).

use foveate_design::Design;
use foveate_engine::Engine;
use foveate_packets::PacketLayout;
use foveate_pixels::ByteFrame;
use foveate_simulator::write_packets;

/// The number of frames whose sums are compared on a board.
pub(crate) const COMPARED_FRAMES: u32 = 16;
/// The number of bytes of a word of a packet.
const WORD_BYTES: usize = 8;

/// The types of the packets whose CRCs are added: ROW, REGION, END.
const ADDED_PACKETS: [u8; 3] = [2, 4, 5];

/// Returns a pixel of 8 bits of a frame of the pattern.
pub(crate) fn pattern_pixel(x: u32, y: u32, frame: u32) -> u8 {
    let mix = (5 * x + 19 * y) & 255;
    let noise = mix ^ (mix >> 3) ^ (x & y & 255);
    let ramp = ((x + 2 * y) & 511) >> 2;
    let in_square = |at: u32, moved: u32| at.wrapping_sub(moved.wrapping_mul(frame)) & 127 < 16;
    let value = if in_square(x, 3) && in_square(y, 1) {
        224 | (noise & 31)
    } else if ((x >> 6) ^ (y >> 6)) & 3 == 3 {
        (ramp >> 1) + (noise & 63)
    } else {
        ramp
    };
    // All of these values are below 256.
    u8::try_from(value).unwrap_or(u8::MAX)
}

pub(crate) fn pattern_frame(width: u32, height: u32, frame: u32) -> ByteFrame {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = places.map(|(x, y)| pattern_pixel(x, y, frame)).collect();
    ByteFrame::from_bytes(width, height, 8, pixels)
        .unwrap_or_else(|error| unreachable!("a frame of the pattern is one: {error}"))
}

pub(crate) fn packet_layout(design: &Design) -> PacketLayout {
    PacketLayout::new(design, false, 1)
        .unwrap_or_else(|error| unreachable!("the sizes of a frame fit: {error}"))
}

/// Returns the running sum over packets after each of the first `frames` frames of the pattern.
pub(crate) fn packet_sums(design: &Design, frames: u32) -> Vec<u32> {
    let (layout, mut engine) = (packet_layout(design), Engine::new(design));
    let mut sum = 0_u32;
    let mut add = |number: u32| {
        let frame = pattern_frame(design.width(), design.height(), number);
        if engine.step_byte_frame(&frame).is_err() {
            unreachable!("a frame of the pattern fits its design");
        }
        let mut bytes = Vec::new();
        let written = write_packets(&mut bytes, &layout, &engine, &frame, number, (0, number == 0));
        written.unwrap_or_else(|error| unreachable!("the layout is that of the design: {error}"));
        sum = sum.wrapping_add(crc_sum(&bytes));
        sum
    };
    (0..frames).map(&mut add).collect()
}

/// Returns the sum of the CRCs of all packets whose type is in [`ADDED_PACKETS`].
fn crc_sum(mut bytes: &[u8]) -> u32 {
    let mut sum = 0_u32;
    while let [_, kind, low, high, ..] = bytes {
        let length = WORD_BYTES * usize::from(u16::from_le_bytes([*low, *high]));
        let (packet, rest) = bytes.split_at(length);
        if let (true, Some(crc)) = (ADDED_PACKETS.contains(&(kind & 15)), packet.last_chunk()) {
            sum = sum.wrapping_add(u32::from_le_bytes(*crc));
        }
        bytes = rest;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values come from the lines in Python on the page.
    #[test]
    fn pixels_are_those_of_the_page() {
        for (place, value) in [
            ((0, 0, 0), 224),
            ((20, 3, 0), 6),
            ((200, 10, 0), 85),
            ((3, 1, 1), 231),
            ((639, 479, 5), 15),
        ] {
            assert_eq!(pattern_pixel(place.0, place.1, place.2), value, "{place:?}");
        }
    }
}
