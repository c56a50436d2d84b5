// SPDX-License-Identifier: MIT OR Apache-2.0
//! The C++ program that drives the buses of the model that Verilator makes of the Verilog.

use crate::harness::render;
use askama::Template;
use foveate_design::RasterDesign;

#[derive(Template)]
#[template(path = "axi.cpp")]
struct BusProgram<'a> {
    top: &'a str,
    video_words: u32,
    has_store: bool,
}

/// Returns the source of the program for the module `top`.
pub(super) fn program(top: &str, design: RasterDesign<'_>) -> String {
    let bits = (design.pixels_per_clock() * design.pixel_bits()).next_multiple_of(8);
    let has_store = design.has_external_store();
    render(&BusProgram { top, video_words: bits.div_ceil(32), has_store })
}
