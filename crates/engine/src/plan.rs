// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera in the form that the kernels need: geometry as indices and thresholds as vectors
//! ([`CameraPlan`]), also those of the classes of regions ([`ZonePlan`]).

use crate::feature_passes::{FeaturePasses, FeaturePlan, feature_plans};
use crate::periphery::PeripheryPlan;
use foveate_camera::{
    Camera, DenoiseFilter, IrrelevantRendering, Neighborhood, Payload, Periphery, ReferencePolicy,
    RegionClass, SpatialFeature, VoteCombination,
};
use foveate_pixels::vectors::{AlignedBuffer, BLOCK_LENGTH, VectorPixel, saturated_threshold};
use std::ops::Range;

/// The number of blocks in a batch of rows.
const BATCH_BLOCKS: usize = 32;

/// The parameters of a camera for the kernels.
#[derive(Clone, Debug)]
pub(crate) struct CameraPlan<T: VectorPixel> {
    /// The frame width without padding.
    pub(crate) width: usize,
    /// The frame height without padding.
    pub(crate) height: usize,
    /// The side of a region in pixels.
    pub(crate) side: usize,
    /// The number of columns of regions.
    pub(crate) columns: usize,
    /// The number of rows of regions.
    pub(crate) rows: usize,
    /// The number of blocks of a padded row. The last block may reach beyond the padding.
    pub(crate) blocks: usize,
    pub(crate) filter: DenoiseFilter,
    /// The masks of the first and last columns of regions, if neighborhoods are isolated.
    pub(crate) seams: Option<SeamMasks<T>>,
    pub(crate) passes: FeaturePasses<T>,
    /// The radius of the search of `flow`.
    pub(crate) flow_radius: Option<u32>,
    pub(crate) features: Vec<FeaturePlan>,
    pub(crate) combine: VoteCombination,
    pub(crate) level: T,
    pub(crate) min_count: u32,
    pub(crate) reference: ReferencePolicy,
    pub(crate) irrelevant: IrrelevantRendering,
    pub(crate) payload: Payload,
    /// True if the payload is raw pixels although denoised pixels are scored.
    pub(crate) keeps_raw: bool,
    pub(crate) periphery: Option<PeripheryPlan<T>>,
    pub(crate) zones: Option<ZonePlan<T>>,
}

/// Two masks in which every bit is set in the first and in the last column of each region.
#[derive(Clone, Debug)]
pub(crate) struct SeamMasks<T: VectorPixel> {
    pub(crate) first: AlignedBuffer<T>,
    pub(crate) last: AlignedBuffer<T>,
}

impl<T: VectorPixel> CameraPlan<T> {
    pub(crate) fn new(camera: &Camera) -> Self {
        let side = index(camera.region_size());
        let columns = index(camera.columns());
        let blocks = (columns * side).div_ceil(BLOCK_LENGTH);
        Self {
            width: index(camera.width()),
            height: index(camera.height()),
            side,
            columns,
            rows: index(camera.rows()),
            blocks,
            filter: camera.filter(),
            seams: (camera.neighborhood() == Neighborhood::Isolated)
                .then(|| SeamMasks::new(side, blocks)),
            passes: FeaturePasses::from_features(camera.features()),
            flow_radius: camera.displacement_feature().and_then(SpatialFeature::radius),
            features: feature_plans(camera.features()),
            combine: camera.combine(),
            level: saturated_threshold(camera.temporal().level),
            min_count: camera.temporal().min_count,
            reference: camera.temporal().reference,
            irrelevant: camera.irrelevant(),
            payload: camera.payload(),
            keeps_raw: camera.has_separate_raw_pixels(),
            periphery: camera.periphery().map(periphery_plan),
            zones: ZonePlan::from_camera(camera),
        }
    }

    /// Returns the number of regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the number of means in the summaries of a band.
    pub(crate) fn band_means(&self) -> usize {
        self.periphery.map_or(0, |periphery| self.means_in_row() * periphery.blocks)
    }

    /// Returns the number of means in a row of blocks of the frame.
    pub(crate) fn means_in_row(&self) -> usize {
        self.periphery.map_or(0, |periphery| self.columns * periphery.blocks)
    }

    /// Returns the number of values from one padded row to the next.
    pub(crate) fn stride(&self) -> usize {
        self.blocks * BLOCK_LENGTH
    }

    /// Returns the index of the first pixel of a region in a padded frame.
    pub(crate) fn first_pixel(&self, region: u32) -> usize {
        let (row, column) = (index(region) / self.columns, index(region) % self.columns);
        (row * self.stride() + column) * self.side
    }

    /// Returns the index of the first mean of a region among the means of the frame. A region has
    /// `blocks` blocks per side.
    pub(crate) fn first_mean(&self, region: u32, blocks: usize) -> usize {
        let (row, column) = (index(region) / self.columns, index(region) % self.columns);
        row * self.band_means() + column * blocks
    }

    /// Appends the pixels of a region of a padded plane in row-major order.
    pub(crate) fn pixels_of(&self, plane: &[T], region: u32, pixels: &mut Vec<u16>) {
        let region_plane = &plane[self.first_pixel(region)..];
        for row in region_plane.chunks(self.stride()).take(self.side) {
            pixels.extend(row[..self.side].iter().map(|&pixel| word(pixel)));
        }
    }

    /// Appends the means of a region, row by row of blocks, from the means of the frame. Appends
    /// nothing if regions of this camera send no summaries.
    pub(crate) fn means_of(&self, all: &[T], region: u32, means: &mut Vec<u16>) {
        let Some(periphery) = self.periphery else { return };
        let rows = all[self.first_mean(region, periphery.blocks)..].chunks(self.means_in_row());
        for row in rows.take(periphery.blocks) {
            means.extend(row[..periphery.blocks].iter().map(|&mean| word(mean)));
        }
    }

    /// Returns the frame width with padding.
    pub(crate) fn padded_width(&self) -> usize {
        self.columns * self.side
    }

    /// Returns the number of rows of a batch, which go through each step of the pass together. A
    /// batch of a short run has several rows. With a single short row, each step would have to wait
    /// for data that the step before it has only just written.
    pub(crate) fn batch_rows(&self, run: usize) -> usize {
        (BATCH_BLOCKS / run).clamp(1, self.side)
    }

    /// Returns the number of rows to keep for a batch and the rows around it. It is a power of two,
    /// so that the place of a row is found without a division.
    pub(crate) fn row_slots(&self, run: usize) -> usize {
        (self.batch_rows(run) + 2).next_power_of_two()
    }

    /// Returns the number of blocks to denoise on each side of a run for the windows at its ends.
    pub(crate) fn margin_blocks(&self) -> usize {
        // With isolated neighborhoods and regions that do not cross the ends of blocks, no window
        // reaches beyond the run.
        usize::from(self.seams.is_none() || !BLOCK_LENGTH.is_multiple_of(self.side))
    }

    /// Returns the range of columns of summary blocks, `side` pixels wide, that lie completely
    /// within a run.
    pub(crate) fn blocks_under(&self, side: usize, run: &Range<usize>) -> Range<usize> {
        let (start, end) =
            (run.start * BLOCK_LENGTH, (run.end * BLOCK_LENGTH).min(self.padded_width()));
        start.div_ceil(side)..(end / side).max(start.div_ceil(side))
    }

    /// Returns the side of a region in pixels, as a number.
    pub(crate) fn side_pixels(&self) -> u32 {
        u32::try_from(self.side).expect("a region is at most 64 pixels wide")
    }

    pub(crate) fn region_pixels(&self) -> u32 {
        self.side_pixels().pow(2)
    }

    /// Returns the first and the last row that windows of a row in band `band` may reach.
    pub(crate) fn reachable_rows(&self, band: usize) -> (usize, usize) {
        match self.seams {
            Some(_) => (band * self.side, (band + 1) * self.side - 1),
            None => (0, self.rows * self.side - 1),
        }
    }
}

fn periphery_plan<T: VectorPixel>(periphery: &Periphery) -> PeripheryPlan<T> {
    PeripheryPlan {
        blocks: index(periphery.blocks),
        side: index(periphery.block_side),
        level: saturated_threshold(periphery.level),
        pixels: periphery.block_pixels(),
        shift: periphery.block_pixels().is_power_of_two().then(|| periphery.block_pixels().ilog2()),
    }
}

impl<T: VectorPixel> SeamMasks<T> {
    fn new(side: usize, blocks: usize) -> Self {
        let mask = |column: usize| {
            let mut mask = AlignedBuffer::<T>::new(blocks * BLOCK_LENGTH);
            for (x, element) in mask.iter_mut().enumerate() {
                *element = if x % side == column { T::MAX } else { T::default() };
            }
            mask
        };
        Self { first: mask(0), last: mask(side - 1) }
    }
}

/// Converts a size, a coordinate or the number of a region to an index. The conversion is lossless:
/// `usize` has 32 bits or more on every platform that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

/// Converts a pixel to a word. Every pixel fits.
fn word<T: VectorPixel>(pixel: T) -> u16 {
    u16::try_from(pixel.into()).unwrap_or(u16::MAX)
}

/// The thresholds of the classes of regions that differ from those of the camera.
#[derive(Clone, Debug)]
pub(crate) struct ZonePlan<T: VectorPixel> {
    /// The passes with the levels of keen regions. They are the same passes as those of the camera.
    pub(crate) keen_passes: FeaturePasses<T>,
    /// The features with the minimum scores of keen regions.
    pub(crate) keen_features: Vec<FeaturePlan>,
    /// The level of the temporal score of keen regions.
    pub(crate) keen_level: T,
    pub(crate) keen_min_count: u32,
    keen_summary_level: T,
    off_summary_level: T,
}

impl<T: VectorPixel> ZonePlan<T> {
    /// Returns the thresholds of a camera, or `None` if it has no zones.
    pub(crate) fn from_camera(camera: &Camera) -> Option<Self> {
        camera.zones()?;
        let keen = camera.class_thresholds(RegionClass::Keen);
        let off = camera.class_thresholds(RegionClass::Off);
        // Without summaries their levels have no meaning.
        let summary_level = |level: Option<u32>| saturated_threshold(level.unwrap_or(0));
        Some(Self {
            keen_passes: FeaturePasses::from_features(keen.features),
            keen_features: feature_plans(keen.features),
            keen_level: saturated_threshold(keen.temporal_level),
            keen_min_count: keen.min_count,
            keen_summary_level: summary_level(keen.summary_level),
            off_summary_level: summary_level(off.summary_level),
        })
    }

    /// Returns the level of the summaries of a region. `own` is that of the camera.
    #[inline(always)]
    pub(crate) fn summary_level(&self, class: RegionClass, own: T) -> T {
        match class {
            RegionClass::Normal | RegionClass::Always => own,
            RegionClass::Off => self.off_summary_level,
            RegionClass::Keen => self.keen_summary_level,
        }
    }
}
