// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine for one type of pixels: the planes that are kept between frames, and their division
//! among workers.

use std::iter;
use std::ops::Range;

use foveate_camera::{ReferencePolicy, RegionClass};

use super::change::{ChangeSearch, KnownChanges};
use super::receiver::KeptScreen;
use crate::change;
use crate::outcome::{FrameOutcome, split_off};
use crate::pixels::BorrowedFrame;
use crate::plan::{CameraPlan, index};
use crate::policy::{SAMPLE_DISTANCE, SearchPolicy, SearchStep};
use crate::state_copy::{EngineState, StateCopy};
use crate::strip::{BandStrip, KeptStripResults, SkippedWork};
use crate::workers::Workers;
use crate::working_memory::WorkingMemory;
use foveate_pixels::{vectors::AlignedBuffer, vectors::VectorPixel};

/// The number of rows of the smallest strip.
const SMALLEST_HEIGHT: usize = 96;

/// The state that is kept between frames.
#[derive(Debug)]
pub(crate) struct TypedEngine<T: VectorPixel> {
    pub(crate) plan: CameraPlan<T>,
    denoised: AlignedBuffer<T>,
    reference: AlignedBuffer<T>,
    pub(crate) screen: Vec<T>,
    reference_valid: Vec<bool>,
    black_regions: Vec<bool>,
    /// The regions whose summary the screen shows.
    summary_shown: Vec<bool>,
    means: Vec<T>,
    settled: Vec<bool>,
    /// The regions that were forgotten, or got another class, since the last frame.
    must_compute: Vec<bool>,
    /// The classes of the regions; empty if the camera has no zones.
    classes: Vec<RegionClass>,
    /// The last frame without padding. It is kept up to date while the policy asks for it.
    last_frame: Vec<T>,
    /// One flag per region and frame, in the order band, frame, column; true if pixels of the
    /// region have changed.
    changed_regions: Vec<bool>,
    policy: SearchPolicy,
    skip: bool,
    /// A copy of the state before the last step, if the caller asked for it.
    state_copy: Option<StateCopy<T>>,
    /// The working memory and the skip counts of each strip.
    scratch: Vec<(WorkingMemory<T>, Vec<SkippedWork>)>,
}

/// The buffers for results that are kept of every frame of a batch. They are empty if nothing is
/// kept.
#[derive(Debug)]
pub(crate) struct KeptBuffers<'a, T> {
    pub(crate) outcomes: &'a mut [FrameOutcome],
    /// One screen per frame, or none.
    pub(crate) screens: &'a mut [KeptScreen<T>],
}

impl<T> KeptBuffers<'_, T> {
    pub(crate) fn none() -> Self {
        Self { outcomes: &mut [], screens: &mut [] }
    }
}

impl<T: VectorPixel> TypedEngine<T> {
    pub(crate) fn new(plan: CameraPlan<T>, skip: bool) -> Self {
        let plane = plan.stride() * plan.rows * plan.side;
        let reference = match plan.reference {
            ReferencePolicy::Previous => 0,
            ReferencePolicy::LastSent => plane,
        };
        Self {
            denoised: AlignedBuffer::new(plane),
            reference: AlignedBuffer::new(reference),
            screen: vec![T::default(); plan.width * plan.height],
            reference_valid: vec![false; plan.regions()],
            black_regions: vec![true; plan.regions()],
            summary_shown: vec![false; if plan.periphery.is_some() { plan.regions() } else { 0 }],
            means: vec![T::default(); plan.rows * plan.band_means()],
            settled: vec![false; plan.rows],
            must_compute: vec![false; plan.regions()],
            classes: match plan.zones {
                Some(_) => vec![RegionClass::default(); plan.regions()],
                None => Vec::new(),
            },
            last_frame: vec![T::default(); if skip { plan.width * plan.height } else { 0 }],
            changed_regions: Vec::new(),
            policy: SearchPolicy::new(skip),
            skip,
            state_copy: None,
            scratch: vec![(WorkingMemory::new(&plan), Vec::new())],
            plan,
        }
    }

    pub(crate) fn reset(&mut self) {
        self.reference_valid.fill(false);
        self.black_regions.fill(true);
        self.summary_shown.fill(false);
        self.settled.fill(false);
        self.must_compute.fill(false);
        self.screen.fill(T::default());
        if let Some(copy) = &mut self.state_copy {
            *copy = StateCopy::default();
        }
        self.policy = SearchPolicy::new(self.skip);
    }

    /// Appends the denoised pixels of a region.
    pub(crate) fn denoised_region(&self, region: u32, pixels: &mut Vec<u16>) {
        self.plan.pixels_of(&self.denoised, region, pixels);
    }

    /// Appends the means that a region sent last.
    pub(crate) fn summary(&self, region: u32, means: &mut Vec<u16>) {
        self.plan.means_of(&self.means, region, means);
    }

    /// Forgets what a region has sent. The next frame computes it even if its pixels are the same.
    pub(crate) fn forget_region(&mut self, region: u32) {
        let region = index(region);
        self.must_compute[region] = true;
        self.reference_valid[region] &= !self.plan.reference.is_lost_with_its_region();
        if self.plan.periphery.is_some() {
            self.summary_shown[region] = false;
        }
    }

    /// Returns the classes of the regions; empty if the camera has no zones.
    pub(crate) fn classes(&self) -> &[RegionClass] {
        &self.classes
    }

    /// Sets the class of every region of a camera with zones. The next frame computes the regions
    /// whose class is another one than before, even if their pixels are the same.
    pub(crate) fn set_classes(&mut self, classes: &[RegionClass]) {
        let regions = self.classes.iter_mut().zip(classes).zip(&mut self.must_compute);
        for ((own, &class), must_compute) in regions {
            *must_compute |= *own != class;
            *own = class;
        }
    }

    /// Turns the copy of the state before every step on or off.
    pub(crate) fn set_state_copying(&mut self, is_on: bool) {
        match (is_on, &self.state_copy) {
            (true, None) => self.state_copy = Some(StateCopy::default()),
            (true, Some(_)) => {}
            (false, _) => self.state_copy = None,
        }
    }

    /// Returns the state before the last step, if it was copied.
    pub(crate) fn state_copy(&self) -> Option<&StateCopy<T>> {
        self.state_copy.as_ref().filter(|memory| memory.has_state())
    }

    fn copy_state(&mut self) {
        let Self {
            plan,
            denoised,
            reference,
            reference_valid: valid,
            summary_shown: shown,
            means,
            screen,
            state_copy: copy,
            ..
        } = self;
        if let Some(copy) = copy {
            copy.copy_from(plan, &EngineState { denoised, reference, valid, shown, means, screen });
        }
    }

    /// Takes the next frames. `outcome` becomes the outcome of the last one.
    pub(crate) fn step(
        &mut self,
        frames: &[BorrowedFrame<'_, T>],
        workers: &Workers,
        outcome: &mut FrameOutcome,
        kept_buffers: KeptBuffers<'_, T>,
    ) {
        self.copy_state();
        self.set_strip_count(frames.len(), workers);
        let first = self.find_changes(frames, workers);
        self.compute(frames, workers, first, outcome, kept_buffers);
    }

    /// Sets the number of strips. Small frames are divided into fewer strips, because the threads
    /// would gain nothing.
    fn set_strip_count(&mut self, frames: usize, workers: &Workers) {
        let plan = &self.plan;
        let pixels = plan.stride() * plan.rows * plan.side * frames;
        // A strip denoises one row of each neighbor again, which does not pay for a few rows.
        let max_strips = (plan.rows * plan.side / SMALLEST_HEIGHT).clamp(1, plan.rows);
        let strips = workers.strips(max_strips, pixels);
        self.scratch.resize_with(strips, || (WorkingMemory::new(plan), Vec::new()));
    }

    /// Finds the regions that have changed, if the search pays. Returns the number of the first
    /// frame whose changes are known.
    fn find_changes(&mut self, frames: &[BorrowedFrame<'_, T>], workers: &Workers) -> usize {
        let step = self.policy.next_step(frames.len());
        if step == SearchStep::Rest {
            return frames.len();
        }
        self.changed_regions.resize(self.plan.regions() * frames.len(), true);
        self.run_change_search(step, frames, workers);
        match step {
            SearchStep::CompareAll => 0,
            SearchStep::CompareSample(frame) => {
                let (saved, blocks) = self.count_saved_in_sample(frame, frames.len());
                if self.policy.record_sample(saved, blocks) {
                    self.run_change_search(SearchStep::CompareWithinBatch, frames, workers);
                    return 1;
                }
                frames.len()
            }
            SearchStep::Rest | SearchStep::CopySample | SearchStep::CompareWithinBatch => {
                frames.len()
            }
        }
    }

    fn run_change_search(
        &mut self,
        step: SearchStep,
        frames: &[BorrowedFrame<'_, T>],
        workers: &Workers,
    ) {
        let plan = &self.plan;
        let (mut copy, mut changed) = (&mut self.last_frame[..], &mut self.changed_regions[..]);
        let searches = divide_bands(plan.rows, self.scratch.len()).map(|bands| ChangeSearch {
            plan,
            frames,
            step,
            last_frame: split_off(&mut copy, bands.len() * plan.side * plan.width),
            changed_regions: split_off(&mut changed, bands.len() * plan.columns * frames.len()),
            bands,
        });
        workers.run(searches);
    }

    /// Returns the number of blocks of the sample that need no computation in one frame, and the
    /// number of blocks of the sample.
    fn count_saved_in_sample(&self, frame: usize, frames: usize) -> (usize, usize) {
        let plan = &self.plan;
        let (mut saved, mut blocks, mut runs) = (0, 0, Vec::new());
        let bands =
            self.changed_regions.chunks_exact(plan.columns * frames).step_by(SAMPLE_DISTANCE);
        for changed in bands.map(|band| &band[frame * plan.columns..][..plan.columns]) {
            change::collect_runs(plan, changed, &mut runs);
            saved += plan.blocks - runs.iter().map(Range::len).sum::<usize>();
            blocks += plan.blocks;
        }
        (saved, blocks)
    }

    /// Takes the frames through all strips. Changes are known from frame `first` on.
    fn compute(
        &mut self,
        frames: &[BorrowedFrame<'_, T>],
        workers: &Workers,
        first: usize,
        outcome: &mut FrameOutcome,
        kept_buffers: KeptBuffers<'_, T>,
    ) {
        let plan = &self.plan;
        let changes = KnownChanges {
            changed: &self.changed_regions,
            frames: frames.len(),
            first_known: first,
        };
        let (mut denoised, mut reference) = (&mut self.denoised[..], &mut self.reference[..]);
        let (mut valid, mut black) = (&mut self.reference_valid[..], &mut self.black_regions[..]);
        let (mut shown, mut means) = (&mut self.summary_shown[..], &mut self.means[..]);
        let (mut settled, mut screen) = (&mut self.settled[..], &mut self.screen[..]);
        let (mut must_compute, classes) = (&mut self.must_compute[..], &self.classes[..]);
        let mut results = outcome.results();
        let KeptBuffers { outcomes, screens } = kept_buffers;
        let screens = screens.iter_mut();
        let screens = screens.map(|screen| (&mut screen.pixels[..], &mut screen.black_regions[..]));
        let screens = screens.chain(iter::repeat_with(|| (&mut [][..], &mut [][..])));
        let kept = outcomes.iter_mut().map(FrameOutcome::results).zip(screens);
        let mut kept: Vec<_> = kept
            .map(|(results, (screen, black))| KeptStripResults { results, screen, black })
            .collect();
        let bands = divide_bands(plan.rows, self.scratch.len());
        let strips = bands.zip(&mut self.scratch).map(|(bands, (scratch, skipped))| {
            let (rows, regions) = (bands.len() * plan.side, bands.len() * plan.columns);
            let kept = kept.iter_mut().map(|kept| KeptStripResults {
                results: kept.results.split_off(regions),
                screen: split_off(&mut kept.screen, rows * plan.width),
                black: split_off(&mut kept.black, regions),
            });
            BandStrip {
                plan,
                frames,
                denoised: split_off(&mut denoised, rows * plan.stride()),
                reference: split_off(&mut reference, rows * plan.stride()),
                screen: split_off(&mut screen, rows * plan.width),
                reference_valid: split_off(&mut valid, regions),
                black_regions: split_off(&mut black, regions),
                summary_shown: split_off(&mut shown, regions),
                means: split_off(&mut means, bands.len() * plan.band_means()),
                is_settled: split_off(&mut settled, bands.len()),
                must_compute: split_off(&mut must_compute, regions),
                classes: {
                    let regions = bands.start * plan.columns..bands.end * plan.columns;
                    classes.get(regions).unwrap_or_default()
                },
                bands,
                results: results.split_off(regions),
                kept: kept.collect(),
                scratch,
                changes,
                skipped,
            }
        });
        workers.run(strips);
        self.count_skipped(first..frames.len(), outcome, outcomes);
    }

    /// Adds up what the strips have skipped, and reports it to the policy.
    fn count_skipped(
        &mut self,
        known: Range<usize>,
        last: &mut FrameOutcome,
        outcomes: &mut [FrameOutcome],
    ) {
        let frame = |number: usize| {
            let mut total = SkippedWork::default();
            self.scratch.iter().for_each(|(_, skipped)| total += skipped[number]);
            total
        };
        for (number, outcome) in outcomes.iter_mut().enumerate() {
            outcome.skipped = frame(number).regions;
        }
        last.skipped = frame(known.end - 1).regions;
        if !known.is_empty() {
            let blocks = self.plan.blocks * self.plan.rows * known.len();
            self.policy.record_comparison(known.map(|number| frame(number).blocks).sum(), blocks);
        }
    }
}

/// Divides all bands among the strips, in shares that differ by at most one band.
fn divide_bands(bands: usize, strips: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
    (0..strips).map(move |strip| bands * strip / strips..bands * (strip + 1) / strips)
}
