// SPDX-License-Identifier: MIT OR Apache-2.0
//! The data from which a browser draws a frame.

use foveate_design::Design;
use foveate_simulator::ShownFrame;
use serde_json::{Value, json};

/// Returns the facts about a design that the page needs.
pub(crate) fn design_facts(design: &Design) -> Value {
    json!({
        "fingerprint": design.fingerprint(),
        "width": design.width(),
        "height": design.height(),
        "columns": design.columns(),
        "rows": design.rows(),
        "side": design.region_size(),
    })
}

/// Returns a byte per region, as the engine packs them, and then a byte per pixel.
pub(crate) fn frame_bytes(frame: &ShownFrame) -> Vec<u8> {
    let mut picture: Vec<u8> = frame.outcome.region_bytes().collect();
    frame.screen.borrowed_pixels().append_grey(frame.screen.bits(), &mut picture);
    picture
}
