// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results as cameras would give them, real or made up.

use foveate_camera::Action;
use foveate_camera::{Camera, CameraConfig};
use foveate_engine::{Engine, FrameOutcome};
use foveate_fidelity::{ErrorTally, Fidelity};
use foveate_frame::Raster;
use foveate_ideal::{IdealCamera, IdealOutcome};

/// A camera for frames of some size with regions of some side and pixels of some bits; otherwise the
/// defaults, with a minimum that fits into the smallest regions.
pub(crate) fn config((width, height): (u32, u32), side: u32, bits: u32) -> CameraConfig {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(width), Some(height));
    (config.region.size, config.frame.pixel_bits) = (side, bits);
    config.spatial[0].level = Some(1 << (bits - 1));
    config.spatial[0].min_score = Some(foveate_camera::Decimal::whole(2));
    (config.temporal.level, config.temporal.min_count) = (Some((1 << bits) / 32), 2);
    config
}

/// The same frames through the ideal camera and the engine; the ideal sees `own`, the candidate `other`.
pub(crate) fn run(
    ideal: &Camera,
    candidate: &Camera,
    frames: &[(Raster, Raster)],
    fidelity: &mut Fidelity,
) {
    let mut camera = IdealCamera::new(ideal);
    let mut engine = Engine::new(candidate);
    for (own, other) in frames {
        let seen = camera.step(own).unwrap();
        engine.step_raster(other).unwrap();
        fidelity.add(own, seen, engine.outcome(), engine.rendered()).unwrap();
    }
}

/// The tally of one clip that both see alike.
pub(crate) fn tally(ideal: &Camera, candidate: &Camera, frames: &[Raster]) -> ErrorTally {
    let mut fidelity = Fidelity::new(ideal, candidate).unwrap();
    let frames: Vec<_> = frames.iter().map(|frame| (frame.clone(), frame.clone())).collect();
    run(ideal, candidate, &frames, &mut fidelity);
    fidelity.into_tally()
}

/// Results in which nothing is relevant and everything black.
pub(crate) fn blank_ideal(camera: &Camera) -> IdealOutcome {
    let (regions, pixels) = (camera.regions() as usize, pixels(camera));
    IdealOutcome {
        srs: vec![false; regions],
        trs: vec![false; regions],
        active: vec![false; regions],
        actions: vec![Action::Blank; regions],
        scores: vec![vec![0.0; regions]; camera.features().len()],
        changed: vec![0.0; regions],
        denoised: vec![0.0; pixels],
        rendered: vec![0.0; pixels],
    }
}

/// The same for an engine.
pub(crate) fn blank(camera: &Camera) -> FrameOutcome {
    let regions = camera.regions() as usize;
    FrameOutcome {
        srs: vec![false; regions],
        trs: vec![false; regions],
        active: vec![false; regions],
        actions: vec![Action::Blank; regions],
        temporal_count: vec![0; regions],
        scores: vec![vec![0; regions]; camera.features().len()],
        skipped: 0,
    }
}

pub(crate) fn pixels(camera: &Camera) -> usize {
    camera.width() as usize * camera.height() as usize
}

/// A frame of words in whatever type its bits need.
pub(crate) fn raster(camera: &Camera, pixels: Vec<u16>) -> Raster {
    Raster::from_words(camera.width(), camera.height(), camera.pixel_bits(), pixels).unwrap()
}

pub(crate) fn greys(pixels: &[u16]) -> Vec<f64> {
    pixels.iter().map(|&pixel| pixel.into()).collect()
}

/// Random numbers, the same on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// A number in `0..=max`.
    pub(crate) fn below(&mut self, max: u32) -> u32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((self.0 >> 33) % (u64::from(max) + 1)).unwrap()
    }

    pub(crate) fn pixel(&mut self, max: u32) -> u16 {
        u16::try_from(self.below(max)).unwrap()
    }

    pub(crate) fn yes(&mut self) -> bool {
        self.below(1) == 1
    }
}
