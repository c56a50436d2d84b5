// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tools and the library of tests of silicon, and the figures of their reports.

use std::path::Path;

use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

/// The library of Debian's package `qflow-tech-osu018`.
pub(crate) const LIBRARY: &str = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

/// Returns true if the tools are there; where tools are required, the library must be there, too.
pub(crate) fn is_ready() -> bool {
    require_tools(&[Tool::Yosys, Tool::OpenSta])
        && (Path::new(LIBRARY).exists()
            || std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_none_or(|_| panic!("no {LIBRARY}")))
        && Path::new(LIBRARY).exists()
}

/// Returns the number at a place of a report.
pub(crate) fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer}: {value}"))
}

/// The number of frames of [`write_clip`].
const FRAMES: u32 = 20;

/// Writes the folder `clip` with frames of `width` x 8 pixels, in which a square moves faster and faster over a ramp.
pub(crate) fn write_clip(folder: &Path, width: u32) {
    write_frames(folder, width, FRAMES);
}

/// Writes a longer clip of 8x8 pixels: with four regions, each part of a fit has the 49 regions that a share of
/// flips needs.
pub(crate) fn write_long_clip(folder: &Path) {
    write_frames(folder, 8, 4 * FRAMES);
}

fn write_frames(folder: &Path, width: u32, frames: u32) {
    std::fs::create_dir(folder.join("clip")).unwrap();
    for number in 0..frames {
        let left = number * number / 8 % 6;
        let pixel = |x: u32, y: u32| {
            let is_inside = (left..left + 3).contains(&x) && (2..5).contains(&y);
            if is_inside { 200 } else { u8::try_from(40 + 6 * x + 4 * y).unwrap() }
        };
        let pixels = (0..8).flat_map(|y| (0..width).map(move |x| pixel(x, y)));
        let file = [format!("P5\n{width} 8\n255\n").into_bytes(), pixels.collect()].concat();
        std::fs::write(folder.join(format!("clip/{number:02}.pgm")), file).unwrap();
    }
}
