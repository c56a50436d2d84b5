// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera that takes all frames of a clip, with the outcomes as arrays whose first axis is
//! the frame.

use crate::array::{action_codes, changed_counts, displacement_numbers, signed_score, stacked};
use crate::camera::Camera;
use crate::camera_state::{CameraState, SizedEngine};
use crate::design::Design;
use crate::error::raise;
use crate::inputs::{ClipRequest, problem_text, warn_of_problem};
use crate::work::at_once;
use foveate_media::{ClipPlayer, PlayedFrame, ProgressStage, RunProgress};
use foveate_pixels::FramePixels;
use foveate_simulator::{PacketContent, PacketLayout, SentCounts, packet_bytes, packet_layout};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use std::time::Instant;

/// Shows a clip to a camera. Returns the design, the arrays by name, and the error that ended the footage before its end.
/// `report` is called with the number of frames, that of all, and the frames per second, as far as they are known.
#[pyfunction]
#[pyo3(signature = (camera, inputs, rendered, report, **options))]
pub(crate) fn run_clip<'py>(
    py: Python<'py>,
    camera: &Bound<'py, Camera>,
    inputs: &Bound<'py, PyAny>,
    rendered: bool,
    report: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<(Design, Bound<'py, PyDict>, Option<String>)> {
    let own = ("run", &["rendered", "progress"][..]);
    let mut request = ClipRequest::new(own, inputs, Some(camera), options)?;
    let rate = request.options.frame_rate;
    let mut player = at_once(py, move || request.open_clip())??;
    let camera = camera.get();
    let (width, height) = player.size();
    let mut guard = camera.lock_state()?;
    let state = &mut *guard;
    camera.fit(state, (width as usize, height as usize))?;
    let own = state.sized_engine.as_ref().expect("it fits the clip");
    let design = Arc::clone(&own.design);
    let layout = packet_layout(&design, PacketContent::Plain).map_err(raise)?;
    let mut columns = ClipColumns { has_screens: rendered, ..ClipColumns::default() };
    let mut stage = ProgressStage::new(Instant::now());
    let start_us = state.clock.continuation(state.frames, rate);
    loop {
        py.check_signals()?;
        let taken = py.detach(|| take_next(&mut player, state, start_us, &layout, &mut columns))?;
        if !taken {
            break;
        }
        if let Some(report) = report {
            let (done, total) = (columns.number.len() as u64, player.frames());
            stage.enter(&RunProgress::frames(done, total, ""), Instant::now());
            report.call1((done, stage.amount.total, stage.rate(Instant::now())))?;
        }
    }
    drop(guard);
    let problem = problem_text(&player);
    warn_of_problem(py, problem.clone())?;
    let columns = columns.into_python(py, &design)?;
    Ok((foveate_design::Design::clone(&design).into(), columns, problem))
}

/// Shows the next frame of a clip to a camera, and adds its outcome. Returns false at the end of the clip. Frames of a
/// camera that has seen no other have the times of the clip; those of any other follow its last frame, at `start_us`.
fn take_next(
    player: &mut ClipPlayer,
    state: &mut CameraState,
    start_us: u64,
    layout: &PacketLayout,
    columns: &mut ClipColumns,
) -> PyResult<bool> {
    let Some(frame) = player.next().transpose().map_err(raise)? else { return Ok(false) };
    let number = state.frames;
    let first_us = *columns.first_us.get_or_insert(if number == 0 { 0 } else { frame.time_us });
    let since_us = frame.time_us.saturating_sub(first_us);
    let time_us = state.clock.next(number, Some(start_us.saturating_add(since_us)))?;
    state.take_frame(&frame.frame).map_err(raise)?;
    state.clock.take(number, time_us);
    let own = state.sized_engine.as_ref().expect("it has taken a frame");
    columns.push(own, &frame, (number, time_us));
    let bytes = packet_bytes(layout, &own.engine.outcome().actions);
    columns.sent_bytes.push(bytes.cast_signed());
    Ok(true)
}

/// The arrays, frame by frame.
#[derive(Default)]
struct ClipColumns {
    /// True if screens are kept.
    has_screens: bool,
    /// The time in the clip that is the beginning of the run.
    first_us: Option<u64>,
    number: Vec<i64>,
    time_us: Vec<i64>,
    sent_pixels: Vec<i64>,
    sent_bytes: Vec<i64>,
    names: Vec<String>,
    srs: Vec<bool>,
    trs: Vec<bool>,
    active: Vec<bool>,
    action: Vec<u8>,
    changed: Vec<i64>,
    scores: Vec<Vec<i64>>,
    displacements: Vec<i8>,
    /// Screens of up to 8 bits per pixel, and those of more.
    bytes: Vec<u8>,
    words: Vec<u16>,
}

impl ClipColumns {
    /// Adds the outcome of the last frame of an engine.
    fn push(&mut self, own: &SizedEngine, frame: &PlayedFrame, (number, time_us): (u64, u64)) {
        let result = own.engine.outcome();
        self.number.push(number.cast_signed());
        self.time_us.push(time_us.cast_signed());
        let sent = SentCounts::of_actions(&own.design, &result.actions).pixels;
        self.sent_pixels.push(sent.cast_signed());
        self.names.push(frame.name.clone());
        self.srs.extend(&result.srs);
        self.trs.extend(&result.trs);
        self.active.extend(&result.active);
        self.action.extend(action_codes(result));
        self.changed.extend(changed_counts(result));
        self.scores.resize_with(result.scores.len(), Vec::new);
        for (column, scores) in self.scores.iter_mut().zip(&result.scores) {
            column.extend(scores.iter().map(signed_score));
        }
        self.displacements.extend(displacement_numbers(result));
        match own.engine.rendered() {
            _ if !self.has_screens => {}
            FramePixels::Bytes(pixels) => self.bytes.extend(pixels),
            FramePixels::Words(pixels) => self.words.extend(pixels),
        }
    }

    /// Returns the arrays by the names of the attributes of an outcome.
    fn into_python<'py>(
        self,
        py: Python<'py>,
        design: &foveate_design::Design,
    ) -> PyResult<Bound<'py, PyDict>> {
        let frames = self.number.len();
        let regions = [frames, design.rows() as usize, design.columns() as usize];
        let pixels = [frames, design.height() as usize, design.width() as usize];
        let found = PyDict::new(py);
        let numbers = [
            ("number", self.number),
            ("time_us", self.time_us),
            ("sent_pixels", self.sent_pixels),
            ("sent_bytes", self.sent_bytes),
        ];
        for (name, values) in numbers {
            found.set_item(name, stacked(py, values, [frames])?)?;
        }
        found.set_item("names", self.names)?;
        for (name, values) in [("srs", self.srs), ("trs", self.trs), ("active", self.active)] {
            found.set_item(name, stacked(py, values, regions)?)?;
        }
        found.set_item("action", stacked(py, self.action, regions)?)?;
        found.set_item("changed", stacked(py, self.changed, regions)?)?;
        let scores = PyDict::new(py);
        for (feature, column) in design.features().iter().zip(self.scores) {
            scores.set_item(feature.kind().to_string(), stacked(py, column, regions)?)?;
        }
        found.set_item("scores", scores)?;
        let displacements = design
            .displacement_feature()
            .map(|_| stacked(py, self.displacements, [frames, regions[1], regions[2], 2]));
        found.set_item("displacements", displacements.transpose()?)?;
        let screens = match (self.has_screens, design.pixel_bits()) {
            (false, _) => None,
            (true, ..=8) => Some(stacked(py, self.bytes, pixels)?),
            (true, _) => Some(stacked(py, self.words, pixels)?),
        };
        found.set_item("rendered", screens)?;
        Ok(found)
    }
}
