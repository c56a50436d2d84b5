// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of every layer of every frame. It is long, so it grows as a Parquet file and is none in memory.

use std::fs::File;

use crate::InferenceError;
use crate::cost::Costs;
use crate::frame::{Frame, LayerFrame};
use crate::summary::mask_bytes;
use crate::sums::ratio;
use foveate_files::tables::{Column, Kind, ParquetWriter, Value};
use foveate_network::Network;
use foveate_staging::StagedFolder;

/// The file.
pub(crate) const NAME: &str = "layers_frames.parquet";
/// Rows of a group: a few megabytes of memory.
const GROUP: usize = 1 << 16;
/// Columns whose values may be missing are those of an accelerator.
const COLUMNS: [(&str, Kind, bool); 16] = [
    ("clip", Kind::Text, false),
    ("frame", Kind::Long, false),
    ("counted", Kind::Flag, false),
    ("layer", Kind::Long, false),
    ("macs_needed", Kind::Real, false),
    ("macs_scheduled", Kind::Real, false),
    ("needed_share", Kind::Real, false),
    ("scheduled_share", Kind::Real, false),
    ("changed_share", Kind::Real, false),
    ("read_bytes", Kind::Long, false),
    ("halo_bytes", Kind::Long, false),
    ("written_bytes", Kind::Long, false),
    ("mask_bytes", Kind::Long, false),
    ("seconds", Kind::Real, false),
    ("latency_seconds", Kind::Real, true),
    ("energy_mj", Kind::Real, true),
];

/// The table, open.
pub(crate) struct Details {
    file: ParquetWriter<File>,
}

impl Details {
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn new(staging: &StagedFolder) -> Result<Self, InferenceError> {
        let file = File::create(staging.folder().join(NAME)).map_err(failed)?;
        let columns =
            COLUMNS.map(|(name, kind, optional)| Column { name: name.to_owned(), kind, optional });
        let file = ParquetWriter::new(file, "layers_frames", &columns).map_err(failed)?;
        Ok(Self { file })
    }

    /// Takes the layers of a frame.
    ///
    /// # Errors
    /// When they cannot be written.
    pub(crate) fn push(
        &mut self,
        clip: &str,
        frame: &Frame,
        network: &Network,
        costs: Option<&Costs<'_>>,
    ) -> Result<(), InferenceError> {
        for (node, layer) in frame.layers.iter().enumerate() {
            let cost = costs.zip(layer.cost).map(|(costs, cost)| costs.mean(cost, 1));
            let real = |value: Option<f64>| value.map_or(Value::None, Value::Real);
            let LayerFrame { positions, traffic, .. } = layer;
            let share = |count: u64| ratio(count, positions.all);
            #[allow(clippy::cast_precision_loss, reason = "a share of them")]
            let macs = network.macs(node) as f64;
            self.file.push([
                Value::Text(clip),
                long(frame.number),
                Value::Flag(frame.is_counted),
                long(node as u64),
                Value::Real(macs * share(positions.needed)),
                Value::Real(macs * share(positions.scheduled)),
                Value::Real(share(positions.needed)),
                Value::Real(share(positions.scheduled)),
                Value::Real(share(positions.changed)),
                long(traffic.read),
                long(traffic.halo),
                long(traffic.written),
                long(mask_bytes(network.form(node + 1))),
                Value::Real(traffic.seconds),
                real(cost.map(|cost| cost.seconds)),
                real(cost.map(|cost| cost.energy_mj)),
            ]);
        }
        if self.file.pending() >= GROUP {
            self.file.write_group().map_err(failed)?;
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn finish(self) -> Result<(), InferenceError> {
        self.file.finish().map(drop).map_err(failed)
    }
}

fn failed(source: std::io::Error) -> InferenceError {
    InferenceError::Table { name: NAME, source }
}

fn long(count: u64) -> Value<'static> {
    Value::Long(i64::try_from(count).expect("nothing is counted up to 2^63"))
}
