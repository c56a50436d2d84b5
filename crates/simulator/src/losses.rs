// SPDX-License-Identifier: MIT OR Apache-2.0
//! `losses.csv`: what was missing from a stream, a line for each. The file is there if there is one.

use std::path::{Path, PathBuf};

use foveate_packets::Loss;

use crate::SimulatorError;
use crate::output::Csv;

/// Losses that are kept in memory to be told.
const TOLD: usize = 10;

/// The file, once there is something to say.
pub(crate) struct Losses {
    path: PathBuf,
    csv: Option<Csv>,
    first: Vec<Loss>,
    count: u64,
}

impl Losses {
    pub(crate) fn new(folder: &Path) -> Self {
        Self { path: folder.join("losses.csv"), csv: None, first: Vec::new(), count: 0 }
    }

    pub(crate) fn push(&mut self, loss: Loss) -> Result<(), SimulatorError> {
        self.count += 1;
        let csv = match &mut self.csv {
            Some(csv) => csv,
            none => none.insert(Csv::create(&self.path, "what,frame,row,column,count,offset")?),
        };
        let fields =
            loss.fields().map(|field| field.map_or(String::new(), |field| field.to_string()));
        csv.line([loss.kind().to_owned()].into_iter().chain(fields));
        if self.first.len() < TOLD {
            self.first.push(loss);
        }
        csv.write_out(false)
    }

    /// Losses so far.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Completes the file; returns the first losses and their number.
    pub(crate) fn finish(mut self) -> Result<(Vec<Loss>, u64), SimulatorError> {
        self.csv.as_mut().map_or(Ok(()), |csv| csv.write_out(true))?;
        Ok((self.first, self.count))
    }
}
