// SPDX-License-Identifier: MIT OR Apache-2.0
//! Takes the outcome of every frame and writes it at once, so that memory stays as it is.

use std::path::Path;

use foveate_model::Outcome;
use foveate_spec::Design;

use super::npy::NpyWriter;
use super::png::PngSeries;
use super::summary::Totals;
use super::table::{FrameTable, Row};
use super::{RunOptions, Summary, overlay};
use crate::{SimulatorError, SourceFrame};

/// Every file of a run, open.
pub(crate) struct Recorder {
    design: Design,
    srs: NpyWriter<u8>,
    trs: NpyWriter<u8>,
    active: NpyWriter<u8>,
    temporal_count: NpyWriter<u32>,
    scores: Vec<NpyWriter<u64>>,
    table: FrameTable,
    rendered: Option<PngSeries>,
    overlay: Option<PngSeries>,
    totals: Totals,
}

impl Recorder {
    pub(crate) fn create(
        folder: &Path,
        design: &Design,
        options: &RunOptions,
    ) -> Result<Self, SimulatorError> {
        let (rows, columns) = (design.rows(), design.columns());
        let flags = |name: &str| NpyWriter::create(&folder.join(name), rows, columns);
        let scores = design.features().iter().map(|feature| {
            let name = format!("score_{}.npy", feature.kind());
            NpyWriter::create(&folder.join(name), rows, columns)
        });
        let series =
            |wanted: bool, name| wanted.then(|| PngSeries::create(folder.join(name))).transpose();
        Ok(Self {
            srs: flags("srs.npy")?,
            trs: flags("trs.npy")?,
            active: flags("active.npy")?,
            temporal_count: NpyWriter::create(&folder.join("t_count.npy"), rows, columns)?,
            scores: scores.collect::<Result<_, _>>()?,
            table: FrameTable::create(&folder.join("frames.csv"))?,
            rendered: series(options.rendered, "rendered")?,
            overlay: series(options.overlay, "overlay")?,
            totals: Totals::default(),
            design: design.clone(),
        })
    }

    /// Writes what came of one frame.
    pub(crate) fn push(
        &mut self,
        source: &SourceFrame,
        outcome: &Outcome,
    ) -> Result<(), SimulatorError> {
        self.push_arrays(outcome)?;
        self.push_row(source, outcome)?;
        let Self { rendered, overlay, design, .. } = self;
        let (rendered, overlay) = rayon::join(
            || rendered.as_mut().map_or(Ok(()), |series| series.push_frame(&outcome.rendered)),
            || {
                overlay.as_mut().map_or(Ok(()), |series| {
                    let bytes = overlay::picture(&source.frame, outcome, design.region_size());
                    series.push_colour(&bytes, design.width(), design.height())
                })
            },
        );
        rendered.and(overlay)
    }

    /// Completes every file and adds the summary; `problem` is why the source ended early, if it did.
    pub(crate) fn finish(
        self,
        folder: &Path,
        inputs: &[String],
        problem: Option<String>,
    ) -> Result<Summary, SimulatorError> {
        self.srs.finish()?;
        self.trs.finish()?;
        self.active.finish()?;
        self.temporal_count.finish()?;
        self.scores.into_iter().try_for_each(NpyWriter::finish)?;
        self.table.finish()?;
        let summary = self.totals.summary(&self.design, inputs, problem);
        summary.write(&folder.join("summary.json"))?;
        Ok(summary)
    }

    /// Frames so far.
    pub(crate) fn frames(&self) -> u64 {
        self.totals.frames
    }

    fn push_arrays(&mut self, outcome: &Outcome) -> Result<(), SimulatorError> {
        let bytes = |bits: &[bool]| bits.iter().copied().map(u8::from).collect::<Vec<_>>();
        self.srs.push(bytes(&outcome.srs).into_iter())?;
        self.trs.push(bytes(&outcome.trs).into_iter())?;
        self.active.push(bytes(&outcome.active).into_iter())?;
        self.temporal_count.push(outcome.temporal_count.iter().copied())?;
        for (writer, scores) in self.scores.iter_mut().zip(&outcome.scores) {
            writer.push(scores.iter().copied())?;
        }
        Ok(())
    }

    fn push_row(&mut self, source: &SourceFrame, outcome: &Outcome) -> Result<(), SimulatorError> {
        let (srs, trs) = (count(&outcome.srs), count(&outcome.trs));
        let active = count(&outcome.active);
        let pixels_forwarded = (0..)
            .zip(&outcome.active)
            .filter(|(_, active)| **active)
            .map(|(region, _)| pixels_of(&self.design, region))
            .sum();
        let (frame, time_us, name) = (self.totals.frames, source.time_us, source.name.as_str());
        let label = source.label.as_deref();
        self.totals.add(srs, trs, active, pixels_forwarded);
        self.table.push(&Row { frame, time_us, name, label, srs, trs, active, pixels_forwarded })
    }
}

fn count(bits: &[bool]) -> u64 {
    bits.iter().map(|&bit| u64::from(bit)).sum()
}

/// Pixels of a region that are in the frame, without padding.
fn pixels_of(design: &Design, region: u32) -> u64 {
    let side = design.region_size();
    let inside = |position: u32, size: u32| u64::from(side.min(size - position * side));
    inside(region % design.columns(), design.width())
        * inside(region / design.columns(), design.height())
}
