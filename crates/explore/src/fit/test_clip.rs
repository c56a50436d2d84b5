// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip of image files, for tests of fits. It can lose frames while it is used.

use std::ops::Range;
use std::path::{Path, PathBuf};

/// Writes a folder with frames of 48x32 pixels, in which a square moves over a background of a few
/// levels.
pub(super) fn write_clip(folder: &Path, frames: u32) {
    std::fs::create_dir(folder).unwrap();
    for number in 0..frames {
        let square = 3 * number % 40..3 * number % 40 + 8;
        let pixel = |(x, y): (u32, u32)| {
            let is_inside = square.contains(&x) && (10..18).contains(&y);
            if is_inside { 170 } else { [60, 65, 70, 75, 80][((x / 4 + y / 4) % 5) as usize] }
        };
        let pixels = (0..32).flat_map(|y| (0..48).map(move |x| (x, y))).map(pixel);
        let file = [b"P5\n48 32\n255\n".to_vec(), pixels.collect()].concat();
        std::fs::write(frame_path(folder, number), file).unwrap();
    }
}

pub(super) fn remove_frames(folder: &Path, frames: Range<u32>) {
    frames.for_each(|number| std::fs::remove_file(frame_path(folder, number)).unwrap());
}

fn frame_path(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("{number:02}.pgm"))
}
