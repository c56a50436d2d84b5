// SPDX-License-Identifier: MIT OR Apache-2.0
//! Takes the outcome of every frame and writes it at once, so that memory stays as it is.

use std::path::Path;

use foveate_engine::{Engine, Outcome};
use foveate_spec::Design;
use rayon::prelude::*;

use super::arrays::Arrays;
use super::data_set::{self, DataSet};
use super::gallery::Gallery;
use super::heatmap::Heatmap;
use super::overlay::Overlay;
use super::pixel_events::PixelRecorder;
use super::sink::{Sink, Step};
use super::summary::Totals;
use super::table::{FrameTable, Row};
use super::{RunOptions, Summary, events};
use crate::{SetForm, SimulatorError, SourceFrame};

/// Every file of a run, open.
pub(crate) struct Recorder {
    design: Design,
    table: FrameTable,
    /// Apart from the others because the summary asks for its number of events.
    pixels: Option<PixelRecorder>,
    sinks: Vec<Box<dyn Sink>>,
    data_set: Option<DataSet>,
    totals: Totals,
}

impl Recorder {
    pub(crate) fn create(
        folder: &Path,
        design: &Design,
        form: &SetForm,
        options: &RunOptions,
    ) -> Result<Self, SimulatorError> {
        let mut sinks: Vec<Box<dyn Sink>> = vec![Box::new(Arrays::create(folder, design)?)];
        sinks.append(&mut events::sinks(folder, design, options.events)?);
        if let Some(medium) = options.rendered {
            sinks.push(Box::new(Gallery::rendered(folder, medium)?));
        }
        if let Some(medium) = options.overlay {
            let overlay = Overlay::default();
            sinks.push(Box::new(Gallery::painted(folder, "overlay", medium, overlay)?));
        }
        if let Some(medium) = options.heatmap {
            for (name, map) in Heatmap::all(design) {
                sinks.push(Box::new(Gallery::painted(folder, &name, medium, map)?));
            }
        }
        let table = FrameTable::create(&folder.join("frames.csv"))?;
        // After the others: its names are the user's, and it takes none that is taken.
        if options.data_set {
            sinks.append(&mut data_set::sinks(folder, form)?);
        }
        let pixels = options.pixel_events;
        let pixels = pixels.wanted().then(|| PixelRecorder::create(folder, design, pixels));
        Ok(Self {
            table,
            data_set: options.data_set.then(|| DataSet::of(form)),
            pixels: pixels.transpose()?,
            sinks,
            totals: Totals::default(),
            design: design.clone(),
        })
    }

    /// Writes what came of one frame, the last that `engine` has taken.
    pub(crate) fn push(
        &mut self,
        source: &SourceFrame,
        engine: &Engine,
    ) -> Result<(), SimulatorError> {
        let number = self.totals.frames;
        self.push_row(source, engine.outcome())?;
        let Self { pixels, sinks, .. } = self;
        let step = Step::new(engine, number, source);
        let (pixels, sinks) = rayon::join(
            || pixels.as_mut().map_or(Ok(()), |pixels| pixels.push(&step)),
            || sinks.par_iter_mut().try_for_each(|sink| sink.push(&step)),
        );
        pixels.and(sinks)
    }

    /// Completes every file and adds the summary; `problem` is why the source ended early, if it did.
    pub(crate) fn finish(
        self,
        folder: &Path,
        inputs: &[String],
        problem: Option<String>,
    ) -> Result<Summary, SimulatorError> {
        self.table.finish()?;
        self.sinks.into_iter().try_for_each(Sink::finish)?;
        let pixel_events = self.pixels.map(PixelRecorder::finish).transpose()?;
        let mut summary = self.totals.summary(&self.design, inputs, problem, pixel_events);
        summary.data_set = self.data_set;
        summary.write(&folder.join("summary.json"))?;
        Ok(summary)
    }

    /// Frames so far.
    pub(crate) fn frames(&self) -> u64 {
        self.totals.frames
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
        self.totals.at(time_us);
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
