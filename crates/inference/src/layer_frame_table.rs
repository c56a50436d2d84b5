// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of every layer of every frame. It is long, so it is written to a Parquet file as it
//! grows and is not kept in memory.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::computation::PositionCounts;
use super::cost::TrafficTally;
use crate::InferenceError;
use crate::cost::{FrameCost, NodeCosts};
use crate::frame::{FrameFigures, LayerFigures};
use crate::summary::mask_bytes;
use ColumnType::{Flag, Long, Real, Text};
use foveate_network::Network;
use foveate_output::tables::{Column, ColumnType, ParquetWriter, TableValue};
use foveate_tools::{StagedFolder, StagingError};

pub(crate) const FILE_NAME: &str = "layers_frames.parquet";
/// The number of rows of a group, which takes a few megabytes of memory.
const ROWS_PER_GROUP: usize = 1 << 16;

struct LayerFrameRow<'a> {
    frame: &'a FrameFigures,
    node: usize,
    positions: PositionCounts,
    traffic: TrafficTally,
    macs: f64,
    mask_bytes: u64,
    cost: Option<FrameCost>,
}

/// A column: its name, its type, whether its value may be missing (only without an accelerator),
/// and its value.
type LayerFrameColumn =
    (&'static str, ColumnType, bool, for<'a> fn(&LayerFrameRow<'a>) -> TableValue<'a>);

const COLUMNS: [LayerFrameColumn; 16] = [
    ("clip", Text, false, |row| TableValue::Text(&row.frame.clip)),
    ("frame", Long, false, |row| long(row.frame.number)),
    ("counted", Flag, false, |row| TableValue::Flag(row.frame.is_counted)),
    ("layer", Long, false, |row| long(row.node as u64)),
    ("macs_needed", Real, false, |row| TableValue::Real(row.macs * row.positions.needed_share())),
    ("macs_scheduled", Real, false, |row| {
        TableValue::Real(row.macs * row.positions.scheduled_share())
    }),
    ("needed_share", Real, false, |row| TableValue::Real(row.positions.needed_share())),
    ("scheduled_share", Real, false, |row| TableValue::Real(row.positions.scheduled_share())),
    ("changed_share", Real, false, |row| TableValue::Real(row.positions.changed_share())),
    ("read_bytes", Long, false, |row| long(row.traffic.read)),
    ("halo_bytes", Long, false, |row| long(row.traffic.halo)),
    ("written_bytes", Long, false, |row| long(row.traffic.written)),
    ("mask_bytes", Long, false, |row| long(row.mask_bytes)),
    ("seconds", Real, false, |row| TableValue::Real(row.traffic.seconds)),
    ("latency_seconds", Real, true, |row| real(row.cost.map(|cost| cost.seconds))),
    ("energy_mj", Real, true, |row| real(row.cost.map(|cost| cost.energy_mj))),
];

/// The open table.
pub(crate) struct LayerFrameTable {
    file: ParquetWriter<File>,
    path: PathBuf,
}

impl LayerFrameTable {
    /// Creates the file of the table.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub(crate) fn new(staging: &StagedFolder) -> Result<Self, InferenceError> {
        let path = staging.folder().join(FILE_NAME);
        let file = File::create(&path).map_err(write_error(&path))?;
        let columns = COLUMNS.map(|(name, kind, optional, _)| Column {
            name: name.to_owned(),
            kind,
            optional,
        });
        let file = ParquetWriter::new(file, "layers_frames", &columns);
        Ok(Self { file: file.map_err(write_error(&path))?, path })
    }

    /// Adds the layers of a frame.
    ///
    /// # Errors
    /// Fails if they cannot be written.
    pub(crate) fn push(
        &mut self,
        frame: &FrameFigures,
        layers: &[LayerFigures],
        network: &Network,
        costs: Option<&NodeCosts<'_>>,
    ) -> Result<(), InferenceError> {
        for (node, layer) in layers.iter().enumerate() {
            #[allow(clippy::cast_precision_loss, reason = "a share of them")]
            let macs = network.macs(node) as f64;
            let mask_bytes = mask_bytes(network.form(node + 1));
            let LayerFigures { positions, traffic, .. } = *layer;
            let cost = costs.zip(layer.cost).map(|(costs, cost)| costs.mean_cost(cost, 1));
            let row = LayerFrameRow { frame, node, positions, traffic, macs, mask_bytes, cost };
            self.file.push(COLUMNS.map(|(_, _, _, value)| value(&row)));
        }
        if self.file.pending_rows() >= ROWS_PER_GROUP {
            self.file.write_group().map_err(write_error(&self.path))?;
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// Fails if it cannot be written.
    pub(crate) fn finish(self) -> Result<(), InferenceError> {
        self.file.finish().map(drop).map_err(write_error(&self.path))
    }
}

fn write_error(path: &Path) -> impl Fn(std::io::Error) -> InferenceError + '_ {
    |source| StagingError::Unwritable { path: path.to_owned(), source }.into()
}

fn long(count: u64) -> TableValue<'static> {
    TableValue::Long(i64::try_from(count).expect("nothing is counted up to 2^63"))
}

fn real(value: Option<f64>) -> TableValue<'static> {
    value.map_or(TableValue::None, TableValue::Real)
}
