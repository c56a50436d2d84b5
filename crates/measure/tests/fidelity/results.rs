// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results in the form of cameras' results, real or made up.

use foveate_camera::{Camera, CameraConfig, RegionAction};
use foveate_engine::{Engine, FrameOutcome};
use foveate_ideal::{IdealCamera, IdealOutcome};
use foveate_measure::{CandidateFrame, ErrorTally, Fidelity, FrameOrder};
use foveate_pixels::{ByteFrame, FramePixels};

/// Returns a camera for frames of some size, with regions of side `side` and pixels of `bits` bits.
/// Its other settings are the defaults, with a minimum that fits into the smallest regions.
pub(crate) fn config((width, height): (u32, u32), side: u32, bits: u32) -> CameraConfig {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(width), Some(height));
    (config.region.size, config.frame.pixel_bits) = (side, bits);
    config.spatial[0].level = Some(1 << (bits - 1));
    config.spatial[0].min_score = Some(foveate_camera::Decimal::from_whole(2));
    (config.temporal.level, config.temporal.min_count) = (Some((1 << bits) / 32), 2);
    config
}

/// Runs the same frames through the ideal camera and the engine. The ideal camera gets the first of
/// each pair, and the candidate the second.
pub(crate) fn run(
    ideal: &Camera,
    candidate: &Camera,
    frames: &[(ByteFrame, ByteFrame)],
    fidelity: &mut Fidelity,
) {
    let mut camera = IdealCamera::new(ideal);
    let mut engine = Engine::new(candidate);
    for (number, (ideal_frame, candidate_frame)) in frames.iter().enumerate() {
        let ideal = camera.step(ideal_frame).unwrap();
        engine.step_byte_frame(candidate_frame).unwrap();
        let denoised = denoised_pixels(&engine);
        let candidate = CandidateFrame {
            outcome: engine.outcome(),
            screen: engine.rendered(),
            denoised: &denoised,
        };
        let order = if number == 0 { FrameOrder::First } else { FrameOrder::Later };
        fidelity.add(ideal_frame, ideal, candidate, order).unwrap();
    }
}

/// Returns the denoised frame of an engine, pixel by pixel.
fn denoised_pixels(engine: &Engine) -> Vec<u16> {
    let camera = engine.camera();
    let side = camera.region_size();
    let mut regions = vec![Vec::new(); camera.regions() as usize];
    (0..camera.regions()).for_each(|at| engine.denoised_region(at, &mut regions[at as usize]));
    let pixel = |x: u32, y: u32| {
        let region = (y / side * camera.columns() + x / side) as usize;
        regions[region][(y % side * side + x % side) as usize]
    };
    let rows = 0..camera.height();
    rows.flat_map(|y| (0..camera.width()).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
}

/// Returns the results of a candidate whose denoised frame is its screen.
pub(crate) fn shown_as_denoised<'a>(
    outcome: &'a FrameOutcome,
    screen: FramePixels<'a>,
    denoised: &'a mut Vec<u16>,
) -> CandidateFrame<'a> {
    *denoised = screen.to_words();
    CandidateFrame { outcome, screen, denoised }
}

/// Returns the tally of one clip whose frames both cameras get.
pub(crate) fn tally(ideal: &Camera, candidate: &Camera, frames: &[ByteFrame]) -> ErrorTally {
    let mut fidelity = Fidelity::new(ideal, candidate).unwrap();
    let frames: Vec<_> = frames.iter().map(|frame| (frame.clone(), frame.clone())).collect();
    run(ideal, candidate, &frames, &mut fidelity);
    fidelity.into_tally()
}

/// Returns results of the ideal camera in which nothing is relevant and everything is black.
pub(crate) fn blank_ideal(camera: &Camera) -> IdealOutcome {
    let (regions, pixels) = (camera.regions() as usize, pixels(camera));
    IdealOutcome {
        srs: vec![false; regions],
        trs: vec![false; regions],
        active: vec![false; regions],
        actions: vec![RegionAction::Blank; regions],
        scores: vec![vec![0.0; regions]; camera.features().len()],
        changed: vec![0.0; regions],
        denoised: vec![0.0; pixels],
        rendered: vec![0.0; pixels],
    }
}

/// Returns results of an engine in which nothing is relevant.
pub(crate) fn blank_outcome(camera: &Camera) -> FrameOutcome {
    let regions = camera.regions() as usize;
    FrameOutcome {
        srs: vec![false; regions],
        trs: vec![false; regions],
        active: vec![false; regions],
        actions: vec![RegionAction::Blank; regions],
        temporal_count: vec![0; regions],
        scores: vec![vec![0; regions]; camera.features().len()],
        displacements: Vec::new(),
        skipped: 0,
    }
}

pub(crate) fn pixels(camera: &Camera) -> usize {
    camera.width() as usize * camera.height() as usize
}

/// Creates a frame from words, in the type that its bits need.
pub(crate) fn frame_from_words(camera: &Camera, pixels: Vec<u16>) -> ByteFrame {
    ByteFrame::from_words(camera.width(), camera.height(), camera.pixel_bits(), pixels).unwrap()
}

pub(crate) fn greys(pixels: &[u16]) -> Vec<f64> {
    pixels.iter().map(|&pixel| pixel.into()).collect()
}

/// A generator of random numbers that are the same on every machine.
pub(crate) struct RandomNumbers(pub(crate) u64);

impl RandomNumbers {
    /// Returns a number in `0..=max`.
    pub(crate) fn below(&mut self, max: u32) -> u32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((self.0 >> 33) % (u64::from(max) + 1)).unwrap()
    }

    pub(crate) fn pixel(&mut self, max: u32) -> u16 {
        u16::try_from(self.below(max)).unwrap()
    }

    pub(crate) fn coin(&mut self) -> bool {
        self.below(1) == 1
    }
}
