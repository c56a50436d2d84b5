// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that a core on AXI gets. Whole frames ([`BusFrameSource`]) have regions that
//! become active, are held, and are irrelevant in turn, or noise all over, or as many active
//! regions as possible. Frames can be damaged in each way of the table of `docs/axi.md`
//! ([`VideoDamage`]), which also says what the core must make of them.

use super::traffic::{Traffic, rows};
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

/// The number of random draws of lines to damage in a frame.
const DAMAGED_LINES: usize = 3;
/// The largest number of transfers by which a line is too long.
const MAX_EXTRA_TRANSFERS: u64 = 8;

/// A kind of damage to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VideoDamage {
    /// Some lines end early.
    ShortLines,
    /// The first and the last line end after one transfer.
    ShortEnds,
    /// Some lines do not end in time.
    LongLines,
    /// The last line does not end in time.
    LongEnd,
    /// The next frame begins between two lines, or within the line of a frame that has no others.
    EarlyBetween,
    /// The next frame begins within a line.
    EarlyWithin,
    /// Transfers follow a whole frame.
    Late,
    /// The frame has no start.
    NoStart,
}

impl VideoDamage {
    pub(super) const ALL: [Self; 8] = [
        Self::ShortLines,
        Self::ShortEnds,
        Self::LongLines,
        Self::LongEnd,
        Self::EarlyBetween,
        Self::EarlyWithin,
        Self::Late,
        Self::NoStart,
    ];

    /// Returns the event that reports the damage.
    pub(super) fn event(self) -> &'static str {
        match self {
            Self::ShortLines | Self::ShortEnds => "eol_early",
            Self::LongLines | Self::LongEnd => "eol_late",
            Self::EarlyBetween | Self::EarlyWithin => "sof_early",
            Self::Late | Self::NoStart => "sof_late",
        }
    }

    /// Returns true if the core counts the frame as repaired.
    pub(super) fn is_repaired(self) -> bool {
        !matches!(self, Self::Late | Self::NoStart)
    }

    /// Sends a frame with this damage; a whole frame must follow. Returns the frame that the array
    /// must see, or `None` if it sees none.
    pub(super) fn send(
        self,
        traffic: &mut Traffic<'_>,
        random: &mut Random,
        frame: &Frame,
    ) -> Option<Frame> {
        let mut repaired = frame.clone();
        let height = frame.height();
        let chosen: Vec<u32> = (0..DAMAGED_LINES).map(|_| random.up_to_u32(height - 1)).collect();
        let stop = if height > 1 { 1 + random.up_to_u32(height - 2) } else { 0 };
        for (y, row) in (0..).zip(rows(frame)) {
            let is_last = y == height - 1;
            let some = self.damages_line(chosen.contains(&y), y == 0 || is_last, is_last);
            match self {
                Self::EarlyBetween if y == stop && y > 0 => {
                    return Some(repeat_last_row(repaired, stop));
                }
                Self::EarlyBetween | Self::EarlyWithin if y == stop => {
                    let line = send_line_start(traffic, random, row, (y == 0, false));
                    repaired.write_row(0, y, &line);
                    return Some(repeat_last_row(repaired, stop + 1));
                }
                Self::ShortLines | Self::ShortEnds if some => {
                    let line = match self {
                        Self::ShortLines => send_line_start(traffic, random, row, (y == 0, true)),
                        _ => send_first_words(traffic, 1, row, (y == 0, true)),
                    };
                    repaired.write_row(0, y, &line);
                }
                Self::LongLines | Self::LongEnd if some => {
                    send_long_line(traffic, random, row, y == 0);
                }
                _ => send_line(traffic, row, (y == 0 && self != Self::NoStart, true)),
            }
        }
        if self == Self::Late {
            let count = 1 + random.index(2 * traffic.words_per_line());
            for _ in 0..count {
                let eol = random.one_in(3);
                send_noise(traffic, random, eol);
            }
        }
        (self != Self::NoStart).then_some(repaired)
    }

    /// Returns true if a line has this damage. `is_chosen` marks a randomly chosen line, `is_end`
    /// the first or last line, `is_last` the last line.
    fn damages_line(self, is_chosen: bool, is_end: bool, is_last: bool) -> bool {
        match self {
            Self::ShortLines | Self::LongLines => is_chosen,
            Self::ShortEnds => is_end,
            Self::LongEnd => is_last,
            _ => false,
        }
    }
}

/// Returns the frame with every row from `from` on replaced by the row before `from`.
fn repeat_last_row(mut frame: Frame, from: u32) -> Frame {
    let last = frame.row(from - 1).to_vec();
    (from..frame.height()).for_each(|y| frame.write_row(0, y, &last));
    frame
}

/// Sends a line. `sof` says that it begins a frame, `eol` that its last transfer is marked.
fn send_line(traffic: &mut Traffic<'_>, row: &[u16], (sof, eol): (bool, bool)) {
    send_first_words(traffic, traffic.words_per_line(), row, (sof, eol));
}

/// Sends a random part of the beginning of a line. Returns the line that the core makes of it.
fn send_line_start(
    traffic: &mut Traffic<'_>,
    random: &mut Random,
    row: &[u16],
    ends: (bool, bool),
) -> Vec<u16> {
    let words = 1 + random.index(traffic.words_per_line() - 2);
    send_first_words(traffic, words, row, ends)
}

/// Sends the first `words` transfers of a line. `sof` says that the first of them begins a frame,
/// `eol` that the last of them is marked as the end of the line. Returns the line that the core
/// makes of it.
pub(super) fn send_first_words(
    traffic: &mut Traffic<'_>,
    words: usize,
    row: &[u16],
    (sof, eol): (bool, bool),
) -> Vec<u16> {
    let mut kept = Vec::with_capacity(row.len());
    for (at, pixels) in traffic.split_line(row).take(words).enumerate() {
        traffic.send_beat(sof && at == 0, eol && at == words - 1, pixels);
        kept.extend(pixels);
    }
    let last = kept.last().copied().unwrap_or_default();
    kept.resize(row.len(), last);
    kept
}

/// Sends a line that does not end in time, with up to `MAX_EXTRA_TRANSFERS` transfers too many.
fn send_long_line(traffic: &mut Traffic<'_>, random: &mut Random, row: &[u16], sof: bool) {
    send_line(traffic, row, (sof, false));
    let more = random.up_to(MAX_EXTRA_TRANSFERS - 1);
    for _ in 0..more {
        send_noise(traffic, random, false);
    }
    send_noise(traffic, random, true);
}

/// Sends a transfer that the core must ignore.
fn send_noise(traffic: &mut Traffic<'_>, random: &mut Random, eol: bool) {
    let max = traffic.max_pixel();
    let pixels: Vec<u16> =
        (0..traffic.design().pixels_per_clock()).map(|_| random.pixel(max)).collect();
    traffic.send_beat(false, eol, &pixels);
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
