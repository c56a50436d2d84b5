// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of the timed model.

use foveate_pixels::FramePixels;
use foveate_timed::{FrameDelivery, RateSink, TimedModel};

use crate::page_examples::{design, random_frames};

/// Nothing that the model keeps grows with the number of frames, also if the sink is too slow.
#[test]
fn memory_stays_constant_over_long_clips() {
    for keys in [
        "",
        "hardware = { organization = 'serial', pipelining = 'deep', fold = 2 }",
        "hardware.organization = 'raster'",
        "hardware.organization = 'raster'\n[[spatial]]\nfeature = 'mad'",
        "hardware.organization = 'raster'\nrender.irrelevant = 'mean'",
    ] {
        let design = design(&format!("frame = {{ width = 32, height = 40 }}\n{keys}"));
        let frames = random_frames(&design, 5);
        let mut model = TimedModel::new(&design, Box::new(RateSink::new(1, 3)));
        let mut size_after = |count: usize| {
            for frame in frames.iter().cycle().take(count) {
                let delivery = FrameDelivery::whole(FramePixels::Bytes(frame));
                model.step(&delivery, &mut |_| ()).unwrap();
            }
            format!("{model:?}").len()
        };
        let (early, late) = (size_after(50), size_after(2000));
        assert!(late < early + early / 4, "{early} and {late} characters, {keys}");
    }
}
