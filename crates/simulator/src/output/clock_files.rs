// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files `clocks.csv`, `clocks.parquet` and `clocks.npy`: the clocks at which a core decides regions, sends
//! their words and loses them. The timed model computes them beside the engine of the run, because
//! a lost region changes the values of the frames after it.

use std::path::{Path, PathBuf};

use foveate_design::Design;
use foveate_files::npy::{ElementType, NpyWriter};
use foveate_files::tables::{Column, ColumnType, TableValue};
use foveate_timed::{
    BeatOffer, DecisionRun, FrameDelivery, RegionLoss, SentKind, TimedModel, Transaction, WordRun,
};
use serde::Serialize;

use super::ClockOptions;
use super::csv::CsvFile;
use super::parquet_file::ParquetFile;
use super::sink::SinkFrame;
use crate::SimulatorError;

/// The columns of the tables.
const COLUMNS: [(&str, ColumnType); 9] = [
    ("event", ColumnType::Text),
    ("frame", ColumnType::Long),
    ("region", ColumnType::Int),
    ("clock", ColumnType::Long),
    ("last_clock", ColumnType::Long),
    ("first_word", ColumnType::Int),
    ("words", ColumnType::Int),
    ("is_last", ColumnType::Flag),
    ("is_aborted", ColumnType::Flag),
];

/// The largest number of bytes of a row, as text or in a group of a Parquet file.
const ROW_BYTES: u64 = 96;
/// The largest number of rows of a region in a frame, besides those of words that a sink delays: a
/// decision, its words, a loss.
const REGION_ROWS: u64 = 3;
/// The number of frames whose rows may have to be written after the disk is full.
const PENDING_FRAMES: u64 = 3;

/// The figures of a run in clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ClockFigures {
    /// The last clock at which a region was decided, sent or lost.
    pub last_clock: u64,
    /// The number of words that left.
    pub words: u64,
    /// The number of regions that were lost.
    pub lost_regions: u64,
}

/// The timed model and its open files.
pub(super) struct ClockFiles {
    model: TimedModel,
    clock_hz: Option<u64>,
    rows: ClockRows,
}

impl ClockFiles {
    pub(super) fn create(
        folder: &Path,
        design: &Design,
        options: &ClockOptions,
    ) -> Result<Self, SimulatorError> {
        let heading = COLUMNS.map(|(name, _)| name).join(",");
        let columns =
            COLUMNS.map(|(name, kind)| Column { name: name.to_owned(), kind, optional: false });
        let csv = options.csv.then(|| CsvFile::create(&folder.join("clocks.csv"), &heading));
        let parquet = folder.join("clocks.parquet");
        let parquet = options.parquet.then(|| ParquetFile::create(&parquet, "clocks", &columns));
        let (csv, parquet) = (csv.transpose()?, parquet.transpose()?);
        let array = folder.join("clocks.npy");
        let array =
            options.npy.then(|| NpyWriter::create(&array, ElementType::Signed64, &[COLUMNS.len()]));
        let array = array.transpose()?;
        Ok(Self {
            model: TimedModel::new(design, options.sink.sink()),
            clock_hz: options.clock_hz,
            rows: ClockRows { csv, parquet, array, figures: ClockFigures::default() },
        })
    }

    /// Returns the largest number of bytes that may have to be written after the disk is full.
    pub(super) fn max_bytes_owed(design: &Design) -> u64 {
        PENDING_FRAMES * REGION_ROWS * u64::from(design.regions()) * ROW_BYTES
    }

    /// Delivers a frame to the model, and adds the rows that are certain then.
    pub(super) fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let Self { model, clock_hz, rows } = self;
        let source = sink_frame.source;
        let offer = clock_hz.map(|hz| BeatOffer { beat: 0, clock: clock_at(source.time_us, hz) });
        let delivery = FrameDelivery {
            offers: offer.as_slice(),
            ..FrameDelivery::whole(source.frame.borrowed_pixels())
        };
        Ok(model.step(&delivery, &mut |transaction| rows.push(transaction))?)
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.rows.write_out(all)
    }

    /// Closes the Parquet file, if there is one, and returns its path, so that it can be left out.
    pub(super) fn give_up_parquet(&mut self) -> Option<PathBuf> {
        self.rows.parquet.take().map(|parquet| parquet.path())
    }

    /// Adds the rows that still come after the last frame, and completes all files but that of
    /// Parquet, which is returned: it can be left out.
    pub(super) fn finish(self) -> Result<(ClockFigures, Option<ParquetFile>), SimulatorError> {
        let Self { model, mut rows, .. } = self;
        model.finish(&mut |transaction| rows.push(transaction));
        rows.write_out(true)?;
        rows.array.map_or(Ok(()), NpyWriter::finish)?;
        Ok((rows.figures, rows.parquet))
    }
}

/// Returns the first edge of a clock at or after a time in microseconds.
fn clock_at(time_us: u64, hz: u64) -> u64 {
    let edge = (u128::from(time_us) * u128::from(hz)).div_ceil(1_000_000);
    // A clip of 2^62 edges does not exist.
    u64::try_from(edge).unwrap_or(u64::MAX).min(1 << 61)
}

/// An event of the tables.
#[derive(Clone, Copy, Debug)]
enum ClockEvent {
    Decision,
    Pixels,
    Means,
    Loss,
}

impl ClockEvent {
    fn name(self) -> &'static str {
        match self {
            Self::Decision => "decision",
            Self::Pixels => "pixels",
            Self::Means => "means",
            Self::Loss => "loss",
        }
    }

    /// Returns the number of the event in the array.
    fn number(self) -> u64 {
        match self {
            Self::Decision => 0,
            Self::Pixels => 1,
            Self::Means => 2,
            Self::Loss => 3,
        }
    }
}

/// A row of the tables.
struct ClockRow {
    event: ClockEvent,
    frame: u64,
    region: u32,
    clocks: (u64, u64),
    first_word: u32,
    words: u32,
    is_last: bool,
    is_aborted: bool,
}

impl ClockRow {
    /// Makes the row of an event without words.
    fn single(event: ClockEvent, frame: u64, region: u32, clock: u64) -> Self {
        Self {
            event,
            frame,
            region,
            clocks: (clock, clock),
            first_word: 0,
            words: 0,
            is_last: false,
            is_aborted: false,
        }
    }

    /// Returns the numbers of the columns, as the array has them. The first is that of the event.
    fn numbers(&self) -> [u64; COLUMNS.len()] {
        [
            self.event.number(),
            self.frame,
            self.region.into(),
            self.clocks.0,
            self.clocks.1,
            self.first_word.into(),
            self.words.into(),
            self.is_last.into(),
            self.is_aborted.into(),
        ]
    }
}

/// The open files, and the figures of the rows in them.
struct ClockRows {
    csv: Option<CsvFile>,
    parquet: Option<ParquetFile>,
    array: Option<NpyWriter>,
    figures: ClockFigures,
}

impl ClockRows {
    fn push(&mut self, transaction: &Transaction<'_>) {
        match transaction {
            // Scores pass the ports before a decision; the decision has all of them.
            Transaction::Scores(_) => {}
            Transaction::Decisions(run) => self.push_decisions(run),
            Transaction::Words(run) => self.push_words(run),
            Transaction::Loss(loss) => self.push_loss(loss),
            // Whole frames cause no such error.
            Transaction::SyncError { .. } => {}
        }
    }

    fn push_decisions(&mut self, run: &DecisionRun<'_>) {
        for (clock, region) in run.regions.iter() {
            self.push_row(&ClockRow::single(ClockEvent::Decision, run.frame, region, clock));
        }
    }

    fn push_words(&mut self, run: &WordRun<'_>) {
        let event = match run.kind {
            SentKind::Pixels => ClockEvent::Pixels,
            SentKind::Means => ClockEvent::Means,
        };
        let length = u64::from(run.words.saturating_sub(1)) * run.word_step;
        for (clock, region) in run.senders() {
            self.figures.words += u64::from(run.words);
            self.push_row(&ClockRow {
                clocks: (clock, clock + length),
                first_word: run.first,
                words: run.words,
                is_last: run.is_last,
                is_aborted: run.is_aborted,
                ..ClockRow::single(event, run.frame, region, clock)
            });
        }
    }

    fn push_loss(&mut self, loss: &RegionLoss) {
        self.figures.lost_regions += 1;
        self.push_row(&ClockRow::single(ClockEvent::Loss, loss.frame, loss.region, loss.clock));
    }

    fn push_row(&mut self, row: &ClockRow) {
        self.figures.last_clock = self.figures.last_clock.max(row.clocks.1);
        let numbers = row.numbers();
        let others = numbers.iter().zip(COLUMNS).skip(1);
        let event = TableValue::Text(row.event.name());
        if let Some(csv) = &mut self.csv {
            let numbers = others.clone().map(|(&number, _)| long_value(number));
            csv.line([event].into_iter().chain(numbers));
        }
        if let Some(parquet) = &mut self.parquet {
            let values = others.map(|(&number, (_, kind))| typed_value(number, kind));
            parquet.push([event].into_iter().chain(values));
        }
        if let Some(array) = &mut self.array {
            array.push(numbers.into_iter());
        }
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.csv.as_mut().map_or(Ok(()), |csv| csv.write_out(all))?;
        self.parquet.as_mut().map_or(Ok(()), ParquetFile::write_out)?;
        Ok(self.array.as_mut().map_or(Ok(()), |array| array.write_pending(all))?)
    }
}

fn long_value(number: u64) -> TableValue<'static> {
    TableValue::Long(number.cast_signed())
}

/// Returns a number as a value of a column of that type.
fn typed_value(number: u64, kind: ColumnType) -> TableValue<'static> {
    match kind {
        ColumnType::Int => {
            TableValue::Int(i32::try_from(number).expect("regions and words have 31 bits"))
        }
        ColumnType::Flag => TableValue::Flag(number == 1),
        ColumnType::Long | ColumnType::Real | ColumnType::Text => long_value(number),
    }
}

#[cfg(test)]
mod tests {
    use super::clock_at;

    #[test]
    fn a_frame_comes_at_the_first_edge_that_is_not_before_its_time() {
        assert_eq!(clock_at(0, 100_000_000), 0);
        assert_eq!(clock_at(33_333, 100_000_000), 3_333_300);
        assert_eq!(clock_at(1, 1), 1);
        assert_eq!(clock_at(1_000_000, 3), 3);
    }
}
