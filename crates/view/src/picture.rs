// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a browser needs to draw a frame.

use foveate_design::Design;
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
    let mut picture: Vec<u8> = frame.outcome.region_bytes().collect();
    frame.screen.plane().grey(frame.screen.bits(), &mut picture);
    picture
}
