// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `losses.csv`, with one line for each item that is missing from a stream. It exists only
//! if something is missing.

use crate::SimulatorError;
use crate::output::CsvFile;
use foveate_packets::StreamLoss;
use std::path::{Path, PathBuf};

/// The number of losses that are kept in memory for messages.
const KEPT_LOSSES: usize = 10;

/// The file of losses, which is created at the first loss.
pub(crate) struct LossTable {
    path: PathBuf,
    csv: Option<CsvFile>,
    first: Vec<StreamLoss>,
    count: u64,
}

impl LossTable {
    pub(crate) fn new(folder: &Path) -> Self {
        Self { path: folder.join("losses.csv"), csv: None, first: Vec::new(), count: 0 }
    }

    pub(crate) fn push(&mut self, loss: StreamLoss) -> Result<(), SimulatorError> {
        self.count += 1;
        let csv = match &mut self.csv {
            Some(csv) => csv,
            none => none.insert(CsvFile::create(&self.path, "what,frame,row,column,count,offset")?),
        };
        let fields =
            loss.fields().map(|field| field.map_or(String::new(), |field| field.to_string()));
        csv.line([loss.kind().to_owned()].into_iter().chain(fields));
        if self.first.len() < KEPT_LOSSES {
            self.first.push(loss);
        }
        csv.write_pending()
    }

    /// Returns the number of losses so far.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Completes the file. Returns the first losses and the number of all.
    pub(crate) fn finish(mut self) -> Result<(Vec<StreamLoss>, u64), SimulatorError> {
        self.csv.as_mut().map_or(Ok(()), CsvFile::write_all)?;
        Ok((self.first, self.count))
    }
}
