// SPDX-License-Identifier: MIT OR Apache-2.0
//! The staleness of the candidate's screen, in the regions that are relevant in the ideal.

use foveate_camera::Camera;
use serde::{Deserialize, Serialize};

use super::fixed_point::ratio;
use crate::sample::PixelSample;

/// The staleness, summed over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct StalenessTally {
    /// The largest difference.
    pub(crate) max: u32,
    /// The sum of the differences of all pixels of relevant regions.
    pub(crate) sum: u64,
    /// The number of pixels of relevant regions.
    pub(crate) pixels: u64,
    /// The number of relevant regions.
    pub(crate) relevant: u64,
    /// The number of relevant regions that are stale.
    pub(crate) stale: u64,
    /// The longest run of one region in frames.
    pub(crate) longest: u64,
}

impl StalenessTally {
    pub(crate) fn add(&mut self, other: &Self) {
        self.max = self.max.max(other.max);
        self.sum += other.sum;
        self.pixels += other.pixels;
        self.relevant += other.relevant;
        self.stale += other.stale;
        self.longest = self.longest.max(other.longest);
    }

    /// Returns the share of the relevant regions that are stale; 0 without relevant regions.
    pub(crate) fn share(&self) -> f64 {
        ratio(self.stale, self.relevant, 0.0)
    }
}

/// The staleness of the regions of one clip.
#[derive(Clone, Debug)]
pub(crate) struct StalenessTracker<T: PixelSample> {
    width: usize,
    height: usize,
    side: usize,
    columns: usize,
    level: T,
    min_count: u32,
    /// The number of frames for which every region has been stale.
    runs: Vec<u64>,
    /// The sum of differences of every column of one row of regions; `largest` has the largest
    /// difference, and `counts` the number of differences above the level.
    sums: Vec<T::Sum>,
    largest: Vec<T>,
    counts: Vec<u8>,
}

impl<T: PixelSample> StalenessTracker<T> {
    pub(crate) fn new(ideal: &Camera) -> Self {
        let width = ideal.width() as usize;
        Self {
            width,
            height: ideal.height() as usize,
            side: ideal.region_size() as usize,
            columns: ideal.columns() as usize,
            level: T::from_word(u16::try_from(ideal.temporal().level).expect("a level is a pixel")),
            min_count: ideal.temporal().min_count.max(1),
            runs: vec![0; ideal.regions() as usize],
            sums: vec![T::Sum::default(); width],
            largest: vec![T::default(); width],
            counts: vec![0; width],
        }
    }

    pub(crate) fn end_runs(&mut self) {
        self.runs.fill(0);
    }

    /// Adds one frame: the SRS and the denoised frame of the ideal, and the candidate's screen.
    pub(crate) fn add_frame(
        &mut self,
        srs: &[bool],
        denoised: &[T],
        screen: &[T],
        tally: &mut StalenessTally,
    ) {
        let band = self.width * self.side;
        let bands = denoised.chunks(band).zip(screen.chunks(band));
        for ((row, srs), (denoised, screen)) in srs.chunks(self.columns).enumerate().zip(bands) {
            if srs.contains(&true) {
                self.sum_differences(denoised, screen);
            }
            let rows = self.side.min(self.height - row * self.side);
            for (column, &srs) in srs.iter().enumerate() {
                self.add_region((row * self.columns + column, column), rows, srs, tally);
            }
        }
    }

    /// Sums the differences of a row of regions, which has at most 64 rows of pixels, column by
    /// column.
    fn sum_differences(&mut self, denoised: &[T], screen: &[T]) {
        self.sums.fill(T::Sum::default());
        self.largest.fill(T::default());
        self.counts.fill(0);
        let rows = denoised.chunks_exact(self.width).zip(screen.chunks_exact(self.width));
        for (denoised, screen) in rows {
            let results = self.sums.iter_mut().zip(&mut self.largest).zip(&mut self.counts);
            for (((sum, largest), count), (&denoised_pixel, &shown)) in
                results.zip(denoised.iter().zip(screen))
            {
                let difference = denoised_pixel.difference(shown);
                *sum += T::Sum::from(difference);
                *largest = difference.max(*largest);
                *count += u8::from(difference > self.level);
            }
        }
    }

    fn add_region(
        &mut self,
        (region, column): (usize, usize),
        rows: usize,
        srs: bool,
        tally: &mut StalenessTally,
    ) {
        if !srs {
            self.runs[region] = 0;
            return;
        }
        let columns = column * self.side..((column + 1) * self.side).min(self.width);
        let pixels = (columns.len() * rows) as u64;
        let sum = |sum: u32, &value: &T::Sum| sum + value.into();
        tally.sum += u64::from(self.sums[columns.clone()].iter().fold(0, sum));
        tally.pixels += pixels;
        let largest = self.largest[columns.clone()].iter().copied().max();
        let largest = largest.expect("a region has pixels");
        tally.max = tally.max.max(largest.into());
        let above: u32 = self.counts[columns].iter().map(|&count| u32::from(count)).sum();
        let stale = u64::from(above) >= u64::from(self.min_count).min(pixels);
        tally.relevant += 1;
        tally.stale += u64::from(stale);
        self.runs[region] = if stale { self.runs[region] + 1 } else { 0 };
        tally.longest = tally.longest.max(self.runs[region]);
    }
}
