// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera as the kernels need it: geometry in indices, thresholds in lanes.

use std::ops::Range;

use foveate_camera::{
    Camera, Combine, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, Periphery, Reference,
};

use crate::periphery::PeripheryPlan;
use foveate_lanes::Aligned;
use foveate_lanes::{BLOCK, Lane, threshold};

/// Blocks in a batch of rows.
const BATCH: usize = 32;

/// What a camera asks for.
#[derive(Clone, Debug)]
pub(crate) struct CameraPlan<T: Lane> {
    /// Frame width without padding.
    pub(crate) width: usize,
    /// Frame height without padding.
    pub(crate) height: usize,
    /// Side of a region.
    pub(crate) side: usize,
    /// Regions side by side.
    pub(crate) columns: usize,
    /// Regions one below the other.
    pub(crate) rows: usize,
    /// Blocks of a padded row, the last perhaps beyond the padding.
    pub(crate) blocks: usize,
    pub(crate) median: bool,
    /// Where regions begin and end that do not see each other.
    pub(crate) seams: Option<SeamMasks<T>>,
    pub(crate) passes: Passes<T>,
    pub(crate) features: Vec<Feature>,
    pub(crate) combine: Combine,
    pub(crate) level: T,
    pub(crate) min_count: u32,
    pub(crate) reference: Reference,
    pub(crate) irrelevant: Irrelevant,
    pub(crate) payload: Payload,
    /// Whether the pixels that leave are not those that are scored.
    pub(crate) keeps_raw: bool,
    pub(crate) periphery: Option<PeripheryPlan<T>>,
}

/// What has to be done with the pixels of a band for the features.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passes<T: Lane> {
    /// Half of the level of `edge`.
    pub(crate) edge: Option<T::Signed>,
    /// The level of `corner`.
    pub(crate) corner: Option<T>,
    /// Whether one of those looks at windows.
    pub(crate) has_windows: bool,
    /// Whether pixels are added up.
    pub(crate) sums: bool,
    /// Whether their squares are.
    pub(crate) squares: bool,
    /// Fraction bits of the mean of `mad`.
    pub(crate) mad: Option<u32>,
}

/// A feature in the order of the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    pub(crate) kind: FeatureKind,
    pub(crate) min_score: u64,
}

/// Every bit set in the first and in the last column of each region.
#[derive(Clone, Debug)]
pub(crate) struct SeamMasks<T: Lane> {
    pub(crate) first: Aligned<T>,
    pub(crate) last: Aligned<T>,
}

impl<T: Lane> CameraPlan<T> {
    pub(crate) fn new(camera: &Camera) -> Self {
        let side = index(camera.region_size());
        let columns = index(camera.columns());
        let blocks = (columns * side).div_ceil(BLOCK);
        Self {
            width: index(camera.width()),
            height: index(camera.height()),
            side,
            columns,
            rows: index(camera.rows()),
            blocks,
            median: camera.filter() == Filter::Median3x3,
            seams: (camera.neighborhood() == Neighborhood::Isolated)
                .then(|| SeamMasks::new(side, blocks)),
            passes: Passes::of(camera),
            features: camera
                .features()
                .iter()
                .map(|feature| Feature { kind: feature.kind(), min_score: feature.min_score() })
                .collect(),
            combine: camera.combine(),
            level: threshold(camera.temporal().level),
            min_count: camera.temporal().min_count,
            reference: camera.temporal().reference,
            irrelevant: camera.irrelevant(),
            payload: camera.payload(),
            keeps_raw: camera.keeps_raw(),
            periphery: camera.periphery().map(periphery),
        }
    }

    /// Regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        self.columns * self.rows
    }

    /// Means of the summaries of a band.
    pub(crate) fn band_means(&self) -> usize {
        self.periphery.map_or(0, |own| self.means_in_row() * own.blocks)
    }

    /// Those of a row of blocks.
    pub(crate) fn means_in_row(&self) -> usize {
        self.periphery.map_or(0, |own| self.columns * own.blocks)
    }

    /// Values from one padded row to the next.
    pub(crate) fn stride(&self) -> usize {
        self.blocks * BLOCK
    }

    /// Where a region begins in a padded frame.
    pub(crate) fn first_pixel(&self, region: u32) -> usize {
        let (row, column) = (index(region) / self.columns, index(region) % self.columns);
        (row * self.stride() + column) * self.side
    }

    /// Where the means of a region begin, row by row of blocks of the frame, which has `blocks` in a region's side.
    pub(crate) fn first_mean(&self, region: u32, blocks: usize) -> usize {
        let (row, column) = (index(region) / self.columns, index(region) % self.columns);
        row * self.band_means() + column * blocks
    }

    /// Appends the pixels of a region of a padded plane, row by row.
    pub(crate) fn pixels_of(&self, plane: &[T], region: u32, pixels: &mut Vec<u16>) {
        let own = &plane[self.first_pixel(region)..];
        for row in own.chunks(self.stride()).take(self.side) {
            pixels.extend(row[..self.side].iter().map(|&pixel| word(pixel)));
        }
    }

    /// Appends the means of a region among those of all, row by row of blocks; nothing where regions send none.
    pub(crate) fn means_of(&self, all: &[T], region: u32, means: &mut Vec<u16>) {
        let Some(own) = self.periphery else { return };
        let rows = all[self.first_mean(region, own.blocks)..].chunks(self.means_in_row());
        for row in rows.take(own.blocks) {
            means.extend(row[..own.blocks].iter().map(|&mean| word(mean)));
        }
    }

    /// Width with padding.
    pub(crate) fn padded_width(&self) -> usize {
        self.columns * self.side
    }

    /// Rows of a run of blocks that go through each step together: in narrow ones several, since a step that reads
    /// what the one before has only just written waits for it.
    pub(crate) fn batch(&self, run: usize) -> usize {
        (BATCH / run).clamp(1, self.side)
    }

    /// Rows to keep for a batch and the rows around it: a power of two, so that the place of a row is
    /// found without a division.
    pub(crate) fn slots(&self, run: usize) -> usize {
        (self.batch(run) + 2).next_power_of_two()
    }

    /// Blocks that have to be denoised on each side of a run, for the windows at its ends.
    pub(crate) fn margin(&self) -> usize {
        // Without a look over seams, and with none across the end of a block, there are none.
        usize::from(self.seams.is_none() || !BLOCK.is_multiple_of(self.side))
    }

    /// The blocks of a summary, of so many pixels a side, that lie within a run as a whole.
    pub(crate) fn blocks_under(&self, side: usize, run: &Range<usize>) -> Range<usize> {
        let (start, end) = (run.start * BLOCK, (run.end * BLOCK).min(self.padded_width()));
        start.div_ceil(side)..(end / side).max(start.div_ceil(side))
    }

    /// Pixels of a region.
    pub(crate) fn region_pixels(&self) -> u32 {
        u32::try_from(self.side * self.side).expect("a region has at most 4096 pixels")
    }

    /// The rows that windows of a row in band `band` may reach: first and last.
    pub(crate) fn reach(&self, band: usize) -> (usize, usize) {
        match self.seams {
            Some(_) => (band * self.side, (band + 1) * self.side - 1),
            None => (0, self.rows * self.side - 1),
        }
    }
}

fn periphery<T: Lane>(own: &Periphery) -> PeripheryPlan<T> {
    PeripheryPlan {
        blocks: index(own.blocks),
        side: index(own.block_side),
        level: threshold(own.level),
        pixels: own.block_pixels(),
        shift: own.block_pixels().is_power_of_two().then(|| own.block_pixels().ilog2()),
    }
}

impl<T: Lane> Passes<T> {
    fn of(camera: &Camera) -> Self {
        let mut passes = Self {
            edge: None,
            corner: None,
            has_windows: camera.has_feature_window(),
            sums: false,
            squares: false,
            mad: None,
        };
        for feature in camera.features() {
            let level = || feature.level().expect("a feature that counts hits has a level");
            match feature.kind() {
                FeatureKind::Edge => passes.edge = Some(half(level())),
                FeatureKind::Corner => passes.corner = Some(threshold(level())),
                FeatureKind::Mad => {
                    passes.sums = true;
                    passes.mad = Some(feature.mean().expect("mad has a mean").fraction_bits);
                }
                FeatureKind::Variance => (passes.sums, passes.squares) = (true, true),
            }
        }
        passes
    }
}

impl<T: Lane> SeamMasks<T> {
    fn new(side: usize, blocks: usize) -> Self {
        let mask = |column: usize| {
            let mut mask = Aligned::<T>::new(blocks * BLOCK);
            for (x, lane) in mask.iter_mut().enumerate() {
                *lane = if x % side == column { T::MAX } else { T::default() };
            }
            mask
        };
        Self { first: mask(0), last: mask(side - 1) }
    }
}

/// Half of an edge level, rounded down, as lane type: at most 3 * 65535.
fn half<S: TryFrom<u32> + From<T>, T: Lane<Signed = S>>(level: u32) -> S {
    let half = S::try_from(level / 2);
    half.unwrap_or_else(|_| {
        unreachable!("a level is at most that of the largest gradient, not {level}")
    })
}

/// A size, coordinate or number of a region as an index. Lossless: `usize` has 32 bits or more on
/// every platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

/// A pixel as a word, in which each fits.
fn word<T: Lane>(pixel: T) -> u16 {
    u16::try_from(pixel.into()).unwrap_or(u16::MAX)
}
