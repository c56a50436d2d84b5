// SPDX-License-Identifier: MIT OR Apache-2.0
//! What comes out of a core: runs of events at consecutive or evenly spaced clocks
//! ([`Transaction`]). The values of words that leave are those of pixels of the engine's last
//! frame, or copies of earlier ones ([`SentValues`]).

use crate::SentKind;
use foveate_camera::RegionAction;
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::FramePixels;
use std::ops::Range;

/// An event at the ports of a core, or a run of them. Transactions of one kind come in the order of
/// their clocks.
#[derive(Clone, Copy, Debug)]
pub enum Transaction<'a> {
    /// A score of regions is on the ports before they are decided.
    Scores(ScoreRun<'a>),
    /// Regions are decided. All of their scores are known.
    Decisions(DecisionRun<'a>),
    /// Words of regions leave.
    Words(WordRun<'a>),
    /// A region is lost.
    Loss(RegionLoss),
    /// The core finds that a beat fits no frame: `sync_error_o` is 1 after edge `clock`.
    SyncError {
        /// The clock of the error.
        clock: u64,
    },
}

/// Regions whose numbers and clocks are evenly spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegionRun {
    /// The clock of the first region.
    pub clock: u64,
    /// The number of the first region.
    pub region: u32,
    /// The number of regions.
    pub regions: u32,
    /// The distance from the number of a region to that of the next.
    pub region_step: u32,
    /// The clocks from a region to the next. They are 0 if all regions have the same clock.
    pub clock_step: u64,
}

impl RegionRun {
    pub(crate) fn single(clock: u64, region: u32) -> Self {
        Self { clock, region, regions: 1, region_step: 1, clock_step: 0 }
    }

    /// Returns the regions whose clocks are within a range, or `None` if there are none.
    pub(crate) fn within(self, clocks: &Range<u64>) -> Option<Self> {
        let (first, end) = (self.places_before(clocks.start), self.places_before(clocks.end));
        (first < end).then(|| Self {
            clock: self.clock + u64::from(first) * self.clock_step,
            region: self.region + first * self.region_step,
            regions: end - first,
            ..self
        })
    }

    /// Returns the number of regions whose clocks are before `clock`.
    fn places_before(self, clock: u64) -> u32 {
        let clocks = clock.saturating_sub(self.clock);
        let places = match self.clock_step {
            0 if clocks > 0 => return self.regions,
            0 => 0,
            step => clocks.div_ceil(step),
        };
        u32::try_from(places).map_or(self.regions, |places| places.min(self.regions))
    }

    /// Returns the clock and the number of each region.
    pub fn iter(self) -> impl Iterator<Item = (u64, u32)> {
        (0..self.regions).map(move |place| {
            (
                self.clock + u64::from(place) * self.clock_step,
                self.region + place * self.region_step,
            )
        })
    }
}

/// A score of regions that passes the ports.
#[derive(Clone, Copy, Debug)]
pub struct ScoreRun<'a> {
    /// The number of the frame since reset.
    pub frame: u64,
    /// The number of the score: 0 for the temporal count, 1.. for the features in the order of the
    /// camera.
    pub number: u32,
    /// The regions with their clocks.
    pub regions: RegionRun,
    /// The outcome of the frame.
    pub outcome: &'a FrameOutcome,
}

/// Regions that are decided.
#[derive(Clone, Copy, Debug)]
pub struct DecisionRun<'a> {
    /// The number of the frame since reset.
    pub frame: u64,
    /// The regions with their clocks.
    pub regions: RegionRun,
    /// The outcome of the frame. A region with [`RegionAction::Summarize`] sends its summary.
    pub outcome: &'a FrameOutcome,
}

/// Words that leave, region by region or from many regions at once.
#[derive(Clone, Copy, Debug)]
pub struct WordRun<'a> {
    /// The number of the frame since reset.
    pub frame: u64,
    /// The content of the words.
    pub kind: SentKind,
    /// The regions with the clocks of their first words. [`WordRun::senders`] returns those that
    /// send.
    pub regions: RegionRun,
    /// The number, in its region, of the first word: of a word of pixels, or of a mean.
    pub first: u32,
    /// The number of words of each region.
    pub words: u32,
    /// The clocks from a word of a region to its next word.
    pub word_step: u64,
    /// True if the last word is the last that leaves of its region.
    pub is_last: bool,
    /// True if no other word of the region leaves because the region was lost.
    pub is_aborted: bool,
    /// The actions of all regions, or `None` if every region of the run sends.
    pub(crate) actions: Option<&'a [RegionAction]>,
    pub(crate) values: SentValues<'a>,
}

impl WordRun<'_> {
    /// Returns the regions that send, with the clocks of their first words.
    pub fn senders(&self) -> impl Iterator<Item = (u64, u32)> {
        self.regions.iter().filter(|&(_, region)| match self.actions {
            None => true,
            Some(actions) => SentKind::from_action(actions[region as usize]) == Some(self.kind),
        })
    }

    /// Returns the clock of a region's last word in the run, from that of its first.
    #[must_use]
    pub fn last_clock(&self, first: u64) -> u64 {
        first + u64::from(self.words.saturating_sub(1)) * self.word_step
    }

    /// Appends the values of the run's words of a region: the pixels of each word, or one mean for
    /// each word.
    pub fn append_values(&self, region: u32, values: &mut Vec<u16>) {
        self.values.append_words(self.kind, region, self.first..self.first + self.words, values);
    }
}

/// A region that is lost: some of its words, or all, do not leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegionLoss {
    /// The clock of the loss.
    pub clock: u64,
    /// The number of the frame of the region since reset.
    pub frame: u64,
    /// The number of the region.
    pub region: u32,
}

/// The values that regions send.
#[derive(Clone, Copy, Debug)]
pub struct SentValues<'a> {
    word_pixels: u32,
    source: ValueSource<'a>,
}

#[derive(Clone, Copy, Debug)]
enum ValueSource<'a> {
    /// The values are those of the engine's last frame, whose raw pixels are `raw`.
    LastFrame { engine: &'a Engine, raw: FramePixels<'a> },
    /// The values of a region were copied.
    Copy(&'a [u16]),
}

impl<'a> SentValues<'a> {
    pub(crate) fn of_last_frame(engine: &'a Engine, raw: FramePixels<'a>, word: u32) -> Self {
        Self { word_pixels: word, source: ValueSource::LastFrame { engine, raw } }
    }

    /// Returns the values of a region that were copied.
    pub(crate) fn copied(values: &'a [u16], word: u32) -> Self {
        Self { word_pixels: word, source: ValueSource::Copy(values) }
    }

    /// Appends all values that a region sends: its pixels in row-major order, or its means.
    pub(crate) fn append_region(&self, region: u32, values: &mut Vec<u16>) {
        match self.source {
            ValueSource::Copy(copied) => values.extend_from_slice(copied),
            ValueSource::LastFrame { engine, raw } => engine.sent_values(raw, region, values),
        }
    }

    pub(crate) fn append_words(
        &self,
        kind: SentKind,
        region: u32,
        words: Range<u32>,
        values: &mut Vec<u16>,
    ) {
        let size = match kind {
            SentKind::Pixels => self.word_pixels,
            SentKind::Means => 1,
        };
        let start = values.len();
        self.append_region(region, values);
        values.truncate(start + (words.end * size) as usize);
        values.drain(start..start + (words.start * size) as usize);
    }
}

/// The pixels of a frame that is kept.
#[derive(Clone, Debug)]
pub(crate) enum KeptPixels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

impl KeptPixels {
    pub(crate) fn copy_of(pixels: FramePixels<'_>) -> Self {
        match pixels {
            FramePixels::Bytes(pixels) => Self::Bytes(pixels.to_vec()),
            FramePixels::Words(pixels) => Self::Words(pixels.to_vec()),
        }
    }

    pub(crate) fn borrow(&self) -> FramePixels<'_> {
        match self {
            Self::Bytes(pixels) => FramePixels::Bytes(pixels),
            Self::Words(pixels) => FramePixels::Words(pixels),
        }
    }
}
