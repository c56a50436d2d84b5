// SPDX-License-Identifier: MIT OR Apache-2.0
//! The NumPy arrays of a run: bits, counts, scores and displacements by frame, row and column. Each
//! has the smallest type that holds its range, which the camera defines.

use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use foveate_camera::{Camera, RegionAction};
use foveate_output::npy::{ElementType, NpyWriter};
use std::path::Path;

/// The writers of all arrays.
pub(super) struct ArraySink {
    srs: NpyWriter,
    trs: NpyWriter,
    active: NpyWriter,
    /// The flags of regions whose summary was sent. It exists only if irrelevant regions send
    /// summaries.
    summary: Option<NpyWriter>,
    /// The temporal counts. They are missing for a stream without scores.
    temporal_count: Option<NpyWriter>,
    scores: Vec<NpyWriter>,
    /// The displacements. They exist only for a camera with `flow`.
    flow: Option<NpyWriter>,
}

impl ArraySink {
    pub(super) fn create(
        folder: &Path,
        camera: &Camera,
        has_scores: bool,
    ) -> Result<Self, SimulatorError> {
        let shape = [camera.rows() as usize, camera.columns() as usize];
        let array = |name: &str, max: u64| {
            NpyWriter::create(&folder.join(name), ElementType::smallest_for(max), &shape)
        };
        let features = if has_scores { camera.features() } else { &[] };
        let scores = features
            .iter()
            .map(|feature| array(&format!("score_{}.npy", feature.kind()), feature.score_max()));
        let flow = camera.displacement_feature().map(|_| {
            let shape = [&shape[..], &[2]].concat();
            NpyWriter::create(&folder.join("flow.npy"), ElementType::Signed8, &shape)
        });
        Ok(Self {
            srs: array("srs.npy", 1)?,
            trs: array("trs.npy", 1)?,
            active: array("active.npy", 1)?,
            summary: camera.periphery().map(|_| array("summary.npy", 1)).transpose()?,
            temporal_count: has_scores
                .then(|| array("t_count.npy", camera.region_pixels().into()))
                .transpose()?,
            scores: scores.collect::<Result<_, _>>()?,
            flow: flow.transpose()?,
        })
    }
}

impl FrameSink for ArraySink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let outcome = sink_frame.outcome;
        self.srs.push(outcome.srs.iter().copied().map(u64::from));
        self.trs.push(outcome.trs.iter().copied().map(u64::from));
        self.active.push(outcome.active.iter().copied().map(u64::from));
        if let Some(summary) = &mut self.summary {
            let sent = |action: &RegionAction| u64::from(*action == RegionAction::Summarize);
            summary.push(outcome.actions.iter().map(sent));
        }
        if let Some(count) = &mut self.temporal_count {
            count.push(outcome.temporal_count.iter().copied().map(u64::from));
        }
        for (writer, scores) in self.scores.iter_mut().zip(&outcome.scores) {
            writer.push(scores.iter().copied());
        }
        if let Some(flow) = &mut self.flow {
            let numbers = outcome.displacements.iter().flat_map(|one| [one.dx, one.dy]);
            flow.push(numbers.map(|number| number.cast_unsigned().into()));
        }
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        let flags = [&mut self.srs, &mut self.trs, &mut self.active];
        let others = self.summary.iter_mut().chain(&mut self.temporal_count).chain(&mut self.flow);
        for array in flags.into_iter().chain(others) {
            array.write_pending()?;
        }
        Ok(self.scores.iter_mut().try_for_each(NpyWriter::write_pending)?)
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.srs.finish()?;
        self.trs.finish()?;
        self.active.finish()?;
        for array in self.summary.into_iter().chain(self.temporal_count).chain(self.flow) {
            array.finish()?;
        }
        Ok(self.scores.into_iter().try_for_each(NpyWriter::finish)?)
    }
}
