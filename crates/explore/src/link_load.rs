// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loads of designs over clips on the link of the space: the clock that each needs, its latency
//! and buffer, and the regions that a raster core loses without a buffer.

use crate::link::{ArrayLink, ArrayLoad, ClipLoad, UnbufferedFigures};
use foveate_design::Design;
use foveate_media::RunMonitor;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::progress::load_progress;
use crate::footage::ExplorationFootage;
use crate::store::{MeasurementStore, load_key};
use crate::{DesignSpace, ExploreError};

/// The load of a design on the link of the space, over one clip or several. A figure is `None` if
/// the design does not have it for every clip: if the clock of the space does not keep up with a
/// clip, or without a buffer for other organizations than `raster`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LoadFigures {
    /// The slowest clock in Hz at which the array keeps up with the frames.
    pub needed_clock_hz: u64,
    /// The longest time from reading a pixel to the last byte behind the link, in ns.
    pub delivery_longest_ns: Option<u64>,
    /// The size in bytes of the buffer in front of the link that loses nothing.
    pub buffer_bytes: Option<u64>,
    /// The number of clips that need more than the link carries, so that the buffer grows with
    /// their length.
    pub overloaded_clips: Option<u64>,
    /// The number of regions that are lost without a buffer.
    pub unbuffered_lost_regions: Option<u64>,
    /// The number of frames of these regions.
    pub unbuffered_frames_with_losses: Option<u64>,
}

impl LoadFigures {
    fn from_load(load: &ClipLoad) -> Self {
        let array = load.array.as_ref();
        let of = |take: fn(&ArrayLoad) -> u64| array.map(take);
        let unbuffered = array.and_then(|array| array.unbuffered.as_ref());
        let without = |take: fn(&UnbufferedFigures) -> u64| unbuffered.map(take);
        Self {
            needed_clock_hz: load.needed_clock_hz,
            delivery_longest_ns: of(|array| array.figures.delivery_ns.longest),
            buffer_bytes: of(|array| array.figures.buffer_bytes),
            overloaded_clips: of(|array| array.figures.overloaded.into()),
            unbuffered_lost_regions: without(|own| own.lost_regions),
            unbuffered_frames_with_losses: without(|own| own.frames_with_losses.len() as u64),
        }
    }

    fn with_clips_of(self, other: Self) -> Self {
        let both = |one: Option<u64>, two: Option<u64>, join: fn(u64, u64) -> u64| {
            one.zip(two).map(|(one, two)| join(one, two))
        };
        let longest = (self.delivery_longest_ns, other.delivery_longest_ns);
        let lost = (self.unbuffered_lost_regions, other.unbuffered_lost_regions);
        let frames = (self.unbuffered_frames_with_losses, other.unbuffered_frames_with_losses);
        Self {
            needed_clock_hz: self.needed_clock_hz.max(other.needed_clock_hz),
            delivery_longest_ns: both(longest.0, longest.1, u64::max),
            buffer_bytes: both(self.buffer_bytes, other.buffer_bytes, u64::max),
            overloaded_clips: both(self.overloaded_clips, other.overloaded_clips, |a, b| a + b),
            unbuffered_lost_regions: both(lost.0, lost.1, |a, b| a + b),
            unbuffered_frames_with_losses: both(frames.0, frames.1, |a, b| a + b),
        }
    }

    /// Returns the figures over several clips; `None` without clips, or if a clip has no figures.
    pub(crate) fn of_clips(clips: impl Iterator<Item = Option<Self>>) -> Option<Self> {
        clips.reduce(|one, other| Some(one?.with_clips_of(other?))).flatten()
    }
}

/// The measurement of designs on the link of a space.
pub(crate) struct LoadMeasurement<'a> {
    footage: &'a ExplorationFootage<'a>,
    link: ArrayLink,
}

impl<'a> LoadMeasurement<'a> {
    /// Returns the measurement, or `None` if the space has no link.
    pub(crate) fn of_space(
        space: &DesignSpace,
        footage: &'a ExplorationFootage<'a>,
    ) -> Option<Self> {
        let clock_hz = space.clock_mhz.map(|mhz| u64::from(mhz) * 1_000_000);
        let link = |rate: crate::link::LinkRate| ArrayLink { bits_per_second: rate.0, clock_hz };
        space.link.map(|rate| Self { footage, link: link(rate) })
    }

    /// Returns the names of the loads of designs over one clip, which is given by its number.
    pub(crate) fn keys(&self, clip: usize, designs: &[Design]) -> Vec<String> {
        let (clip, ideal) = self.footage.clip_texts(clip);
        let key = |design: &Design| load_key(&clip, &ideal, self.link, &design.config());
        designs.iter().map(key).collect()
    }

    pub(crate) fn measure_clips(
        &self,
        designs: &[Design],
        store: &MeasurementStore,
    ) -> Result<Vec<Vec<Option<LoadFigures>>>, ExploreError> {
        let clips = 0..self.footage.clips.clips().len();
        clips.map(|clip| self.measure_clip(clip, designs, store)).collect()
    }

    /// Returns the loads of designs over one clip, which is given by its number. A design that
    /// sends no pixels has none.
    pub(crate) fn measure_clip(
        &self,
        clip: usize,
        designs: &[Design],
        store: &MeasurementStore,
    ) -> Result<Vec<Option<LoadFigures>>, ExploreError> {
        let keys = self.keys(clip, designs);
        let measure = |(design, key): (&Design, String)| match design.has_forwarding() {
            true => self.measure(clip, design, &key, store).map(Some),
            false => Ok(None),
        };
        designs.par_iter().zip(keys).map(measure).collect()
    }

    fn measure(
        &self,
        clip: usize,
        design: &Design,
        key: &str,
        store: &MeasurementStore,
    ) -> Result<LoadFigures, ExploreError> {
        if let Some(known) = store.get(key) {
            return Ok(known);
        }
        let clips = &self.footage.clips;
        let monitor = RunMonitor::of_stage(self.footage.hooks, &load_progress);
        let load = ClipLoad::measure((clips, clip), design, self.link, &monitor)?;
        let figures = LoadFigures::from_load(&load);
        // A clip that ended early may be complete the next time.
        if load.problem.is_none() {
            store.put(key, &figures)?;
        }
        Ok(figures)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_of_clips_is_the_largest_or_the_sum_and_needs_every_clip() {
        let one = LoadFigures {
            needed_clock_hz: 10,
            delivery_longest_ns: Some(7),
            buffer_bytes: Some(100),
            overloaded_clips: Some(1),
            unbuffered_lost_regions: Some(3),
            unbuffered_frames_with_losses: Some(2),
        };
        let other = LoadFigures {
            needed_clock_hz: 5,
            delivery_longest_ns: Some(9),
            buffer_bytes: Some(90),
            ..one
        };
        let both = LoadFigures::of_clips([Some(one), Some(other)].into_iter()).unwrap();
        assert_eq!((both.needed_clock_hz, both.delivery_longest_ns), (10, Some(9)));
        assert_eq!((both.buffer_bytes, both.overloaded_clips), (Some(100), Some(2)));
        assert_eq!(both.unbuffered_lost_regions, Some(6));
        assert_eq!(both.unbuffered_frames_with_losses, Some(4));
        let slow = LoadFigures { buffer_bytes: None, ..one };
        let both = LoadFigures::of_clips([Some(one), Some(slow)].into_iter()).unwrap();
        assert_eq!((both.buffer_bytes, both.overloaded_clips), (None, Some(2)));
        assert_eq!(LoadFigures::of_clips([Some(one), None].into_iter()), None);
        assert_eq!(LoadFigures::of_clips([Some(one)].into_iter()), Some(one));
        assert_eq!(LoadFigures::of_clips([].into_iter()), None);
    }
}
