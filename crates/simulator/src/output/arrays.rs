// SPDX-License-Identifier: MIT OR Apache-2.0
//! The NumPy arrays of a run: bits, counts and scores by frame, row and column.

use std::path::Path;

use foveate_design::Design;

use super::npy::NpyWriter;
use super::sink::{Sink, Step};
use crate::SimulatorError;

/// Every array, open.
pub(super) struct Arrays {
    srs: NpyWriter<u8>,
    trs: NpyWriter<u8>,
    active: NpyWriter<u8>,
    temporal_count: NpyWriter<u32>,
    scores: Vec<NpyWriter<u64>>,
}

impl Arrays {
    pub(super) fn create(folder: &Path, design: &Design) -> Result<Self, SimulatorError> {
        let (rows, columns) = (design.rows(), design.columns());
        let flags = |name: &str| NpyWriter::create(&folder.join(name), rows, columns);
        let scores = design.features().iter().map(|feature| {
            let name = format!("score_{}.npy", feature.kind());
            NpyWriter::create(&folder.join(name), rows, columns)
        });
        Ok(Self {
            srs: flags("srs.npy")?,
            trs: flags("trs.npy")?,
            active: flags("active.npy")?,
            temporal_count: NpyWriter::create(&folder.join("t_count.npy"), rows, columns)?,
            scores: scores.collect::<Result<_, _>>()?,
        })
    }
}

impl Sink for Arrays {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let outcome = step.outcome;
        self.srs.push(outcome.srs.iter().copied().map(u8::from));
        self.trs.push(outcome.trs.iter().copied().map(u8::from));
        self.active.push(outcome.active.iter().copied().map(u8::from));
        self.temporal_count.push(outcome.temporal_count.iter().copied());
        for (writer, scores) in self.scores.iter_mut().zip(&outcome.scores) {
            writer.push(scores.iter().copied());
        }
        Ok(())
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        for flags in [&mut self.srs, &mut self.trs, &mut self.active] {
            flags.write_out(all)?;
        }
        self.temporal_count.write_out(all)?;
        self.scores.iter_mut().try_for_each(|scores| scores.write_out(all))
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.srs.finish()?;
        self.trs.finish()?;
        self.active.finish()?;
        self.temporal_count.finish()?;
        self.scores.into_iter().try_for_each(NpyWriter::finish)
    }
}
