// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a browser needs to draw a frame.

use foveate_design::Design;
use foveate_frame::{Plane, convert_depth};
use foveate_simulator::ShownFrame;
use serde_json::{Value, json};

/// What the page says of a design.
pub(crate) fn facts(design: &Design) -> Value {
    json!({
        "fingerprint": design.fingerprint(),
        "width": design.width(),
        "height": design.height(),
        "columns": design.columns(),
        "rows": design.rows(),
        "side": design.region_size(),
    })
}

/// A byte per region, as the engine packs them; then a byte per pixel.
pub(crate) fn picture(frame: &ShownFrame) -> Vec<u8> {
    let regions = frame.outcome.region_bytes();
    let bits = frame.screen.bits();
    let low = |pixel: u16| convert_depth(pixel, bits, 8).to_le_bytes()[0];
    match frame.screen.plane() {
        Plane::Bytes(pixels) if bits == 8 => regions.chain(pixels.iter().copied()).collect(),
        Plane::Bytes(pixels) => regions.chain(pixels.iter().map(|&p| low(p.into()))).collect(),
        Plane::Words(pixels) => regions.chain(pixels.iter().map(|&p| low(p))).collect(),
    }
}
