// SPDX-License-Identifier: MIT OR Apache-2.0
//! The original frame, dimmed, with what the camera thinks of every region in colour.

use foveate_model::{Frame, Outcome};

use super::png::low_byte;
use crate::convert_depth;

/// Red, green and blue of a region with SRS and TRS.
const ACTIVE: [u32; 3] = [40, 210, 90];
/// Of a region with SRS only: worth seeing, but nothing new.
const SPATIAL_ONLY: [u32; 3] = [240, 170, 30];
/// Of a region with TRS only: something new, but not worth seeing.
const TEMPORAL_ONLY: [u32; 3] = [60, 110, 245];
/// Regions smaller than this are drawn without a grid, which would cover them.
const SMALLEST_GRID: u32 = 6;

/// RGB bytes of the picture.
pub(super) fn picture(frame: &Frame, outcome: &Outcome, region_size: u32) -> Vec<u8> {
    let columns = frame.width().div_ceil(region_size) as usize;
    let mut bytes = Vec::with_capacity(3 * frame.pixels().len());
    for y in 0..frame.height() {
        let row = (y / region_size) as usize * columns;
        for x in 0..frame.width() {
            let region = row + (x / region_size) as usize;
            let grey = u32::from(convert_depth(frame.get(x, y), frame.bits(), 8));
            let line = region_size >= SMALLEST_GRID
                && (x.is_multiple_of(region_size) || y.is_multiple_of(region_size));
            bytes.extend(shade(grey, tint(outcome, region), line));
        }
    }
    bytes
}

fn tint(outcome: &Outcome, region: usize) -> Option<[u32; 3]> {
    let bit = |bits: &[bool]| bits.get(region).copied().unwrap_or(false);
    match (bit(&outcome.srs), bit(&outcome.trs)) {
        (true, true) => Some(ACTIVE),
        (true, false) => Some(SPATIAL_ONLY),
        (false, true) => Some(TEMPORAL_ONLY),
        (false, false) => None,
    }
}

/// Half the grey without a tint, else five parts of grey and three of tint; grid lines are lighter.
fn shade(grey: u32, tint: Option<[u32; 3]>, line: bool) -> [u8; 3] {
    let mixed = match tint {
        Some(tint) => tint.map(|colour| (5 * grey + 3 * colour) / 8),
        None => [grey / 2; 3],
    };
    mixed.map(|value| {
        let value = if line { (7 * value + 255) / 8 } else { value };
        low_byte(u16::try_from(value).unwrap_or(u16::MAX))
    })
}
