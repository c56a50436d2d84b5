// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for the buses: regions that become active, are held, and are irrelevant in turn, frames
//! of noise, in which most regions are active, and frames in which as many as possible are active.

use crate::stimulus::StimulusPattern::{self, *};
use crate::stimulus::{FrameFeed, FrameGenerator, PatternAim, Random, Texture};
use foveate_camera::Camera;
use foveate_design::RasterDesign;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

/// The patterns that each region shows in turn in quiet frames. Few regions are relevant, so that
/// few packets are long. The means of irrelevant regions just meet the summary level, or exceed it.
const QUIET_PATTERNS: &[StimulusPattern] = &[Flat, MeanStep, Same, MeanStep, Noise, Flicker, Same];
/// The patterns of a frame in which each row of regions has some active regions, and no more.
const SPARSE_PATTERNS: &[StimulusPattern] = &[Noise, Flat, Flat, Flat, Flat, Flat, Flat, Flat];
/// The patterns that are tried, one after the other, in regions that are not active yet. A filter
/// smooths noise, so that it has few corners; a large shape keeps its corners.
const ACTIVE_PATTERNS: &[StimulusPattern] = &[
    Noise,
    Binary,
    Blocks,
    Quadrant,
    TwoPoint,
    Texture(Texture::Checkers(2)),
    Quadrant,
    Texture(Texture::Halves),
    Texture(Texture::Dots(1, 2)),
    Texture(Texture::Dots(1, 3)),
    Texture(Texture::Dots(2, 3)),
    Noise,
    Blocks,
    Noise,
];
/// One in so many frames is noise all over.
const NOISE_PERIOD: usize = 3;

/// A source of frames for a design, one after the other.
pub(super) struct BusFrameSource {
    /// The drawing states of quiet frames and of frames of noise. A quiet frame follows the last
    /// quiet one.
    quiet: FrameGenerator,
    noise: FrameGenerator,
    camera: Camera,
    frame_number: usize,
    random: Random,
}

impl BusFrameSource {
    pub(super) fn new(design: RasterDesign<'_>, random: &mut Random) -> Self {
        let feed = FrameFeed::for_design(design.design());
        let [quiet, noise] = [0; 2].map(|_| FrameGenerator::new(&feed, random));
        let camera = Camera::clone(&design);
        Self { quiet, noise, camera, frame_number: 0, random: random.fork() }
    }

    /// Returns the next frame; every third one is noise.
    pub(super) fn next(&mut self) -> Frame {
        match self.frame_number % NOISE_PERIOD == NOISE_PERIOD - 1 {
            true => self.noise_frame(),
            false => self.quiet_frame(),
        }
    }

    /// Returns the next frame, which is noise all over.
    pub(super) fn noise_frame(&mut self) -> Frame {
        self.frame_number += 1;
        draw_frame(&mut self.noise, &[Noise], 0, &mut self.random)
    }

    /// Returns the next frame, in which few regions are active.
    pub(super) fn quiet_frame(&mut self) -> Frame {
        self.frame_number += 1;
        draw_frame(&mut self.quiet, QUIET_PATTERNS, self.frame_number, &mut self.random)
    }

    /// Returns the next frame; one in eight regions is noise, and the others are flat.
    pub(super) fn sparse_frame(&mut self) -> Frame {
        self.frame_number += 1;
        draw_frame(&mut self.noise, SPARSE_PATTERNS, 0, &mut self.random)
    }

    /// Returns the next two frames, in which as many regions as possible are active: in the first
    /// one as the first of a core, and in each as the successor of the other.
    pub(super) fn active_frames(&mut self) -> [Frame; 2] {
        let mut model = FunctionalCamera::new(&self.camera);
        [(); 2].map(|()| {
            let frame = self.active_frame(&model);
            model.step(&frame).expect("frames are of the design");
            frame
        })
    }

    /// Returns the next frame. Regions that would not be active behind the frames that `model` has
    /// seen are drawn again with other patterns.
    fn active_frame(&mut self, model: &FunctionalCamera) -> Frame {
        let mut frame = self.noise_frame();
        for &pattern in ACTIVE_PATTERNS {
            let mut next = model.clone();
            let outcome = next.step(&frame).expect("frames are of the design");
            if outcome.active.iter().all(|&active| active) {
                break;
            }
            self.noise.draw_where(pattern, |region| !outcome.active[region]);
            frame = drawn_frame(&self.noise);
        }
        frame
    }

    /// Returns the next frame, which is noise in the lower half of the levels. So no change from
    /// one such frame to the next sets the highest bit.
    pub(super) fn dark_frame(&mut self) -> Frame {
        let noise = self.noise_frame();
        let pixels = noise.pixels().iter().map(|pixel| pixel / 2).collect();
        Frame::new(noise.width(), noise.height(), noise.bits(), pixels)
            .expect("half of a pixel is a pixel")
    }
}

fn draw_frame(
    generator: &mut FrameGenerator,
    patterns: &[StimulusPattern],
    turn: usize,
    random: &mut Random,
) -> Frame {
    generator.draw(patterns, turn, true, PatternAim::Free, random);
    drawn_frame(generator)
}

fn drawn_frame(generator: &FrameGenerator) -> Frame {
    generator.frame().expect("pixels are those of the design")
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_camera::DenoiseFilter;
    use foveate_design::{Design, DesignConfig, Organization};

    /// Returns the numbers of active regions of the two frames, drawn with a seed.
    fn active_counts(design: &Design, seed: u64) -> [usize; 2] {
        let raster = design.as_raster().unwrap();
        let mut source = BusFrameSource::new(raster, &mut Random::new(seed));
        let mut model = FunctionalCamera::new(design);
        source
            .active_frames()
            .map(|frame| model.step(&frame).unwrap().active.iter().filter(|&&on| on).count())
    }

    /// Noise alone has hardly a corner behind a filter, and a median keeps few corners of any
    /// pattern.
    #[test]
    fn most_regions_of_active_frames_are_active_with_every_feature_and_filter() {
        for (kind, filter) in Organization::Raster
            .feature_kinds()
            .into_iter()
            .flat_map(|kind| DenoiseFilter::ALL.iter().map(move |filter| (kind, filter)))
        {
            for (side, bits) in [(4, 4), (5, 10), (8, 8)] {
                let toml = format!(
                    "frame={{width={},height={},pixel_bits={bits}}}\nregion.size={side}\n\
                     spatial=[{{feature='{kind}',min_score=1}}]\ndenoise.filter='{filter}'\n\
                     hardware.organization='raster'\n",
                    16 * side,
                    2 * side
                );
                let design = DesignConfig::from_toml(&toml).unwrap().validate().unwrap();
                for seed in 0..4 {
                    let counts = active_counts(&design, seed);
                    assert!(counts.iter().all(|&count| count >= 24), "{counts:?} of 32: {toml}");
                }
            }
        }
    }
}
