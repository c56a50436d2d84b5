// SPDX-License-Identifier: MIT OR Apache-2.0
//! The expected outputs after every edge, computed from the inputs. The formulas of
//! `docs/raster.md` give the edges of all advances of a frame at once; decisions and the readout
//! are then computed edge by edge.

use std::collections::BTreeMap;

use foveate_model::RasterOutput;
use foveate_pixels::Frame;

use super::driver::RasterTrace;
use super::raster_parameters::RasterParameters;
use super::readout::ReadoutHistory;
use super::streams::ExternalStoreStreams;
use crate::class_maps::ClassMapLog;
use crate::oracle::{OracleOutcome, oracle_region, outcome_without_regions};

/// The result of a check: a description of the first difference, if there is one.
pub(crate) type RasterCheckResult = Result<(), String>;

pub(crate) struct RasterOracle<'a> {
    recipe: &'a RasterParameters,
    trace: &'a RasterTrace,
    history: Vec<OracleOutcome>,
    maps: FrameMaps,
    /// The frame and the region that are decided at an edge.
    decisions: BTreeMap<i64, (usize, i64)>,
    readouts: ReadoutHistory,
    streams: ExternalStoreStreams,
    /// The edges at which the first words of rows of regions are stored, counted through all
    /// frames.
    row_store_edges: Vec<i64>,
    ready: Vec<bool>,
    /// The last edge of the latest second pass.
    second_pass_end: i64,
}

/// The maps of classes that the frames of a trace use.
struct FrameMaps {
    log: ClassMapLog,
    /// The number of edges in the log before the trace.
    start: i64,
    of_frames: Vec<Vec<u8>>,
}

impl FrameMaps {
    /// Adds a frame whose advances happen at these edges, as far as they came. The frame has `all`
    /// advances.
    fn add_frame(&mut self, trace: &RasterTrace, edges: &[i64], all: i64) {
        let Some((&first, &last)) = edges.first().zip(edges.last()) else {
            self.of_frames.push(Vec::new());
            return;
        };
        self.log_until(trace, first - 1, false);
        let is_whole = edges.len() as i64 == all;
        self.log_until(trace, if is_whole { last } else { trace.end() }, true);
        self.of_frames.push(self.log.map_of_frame(self.start + first));
    }

    /// Logs the edges up to `last` that have not been logged.
    fn log_until(&mut self, trace: &RasterTrace, last: i64, are_occupied: bool) {
        for edge in self.log.edge() - self.start + 1..=last {
            self.log.push(trace.maps[edge as usize], are_occupied);
        }
    }

    /// Compares `zone_pending_o` after every edge, after the last frame has been added.
    fn compare(&mut self, trace: &RasterTrace) -> RasterCheckResult {
        self.log_until(trace, trace.end(), false);
        for (edge, got) in (0..).zip(&trace.shown) {
            if got.zone_pending != self.log.is_pending_after(self.start + edge) {
                return Err(format!("zone_pending_o is {} after edge {edge}", got.zone_pending));
            }
        }
        Ok(())
    }
}

impl<'a> RasterOracle<'a> {
    /// Compares the outputs with those that follow from the frames and the inputs. `recipes` has
    /// the thresholds of each frame. `log` has the edges before those of the trace, and gets those
    /// of the trace. Returns the results of all frames.
    pub(crate) fn check(
        recipe: &'a RasterParameters,
        recipes: &[RasterParameters],
        clip: &[Frame],
        trace: &'a RasterTrace,
        log: &mut ClassMapLog,
    ) -> Result<Vec<OracleOutcome>, String> {
        let mut oracle = Self {
            recipe,
            trace,
            history: Vec::new(),
            maps: FrameMaps { start: log.edge(), log: log.clone(), of_frames: Vec::new() },
            decisions: BTreeMap::new(),
            readouts: ReadoutHistory::new(recipe.deep),
            streams: ExternalStoreStreams::default(),
            row_store_edges: Vec::new(),
            ready: vec![false; trace.shown.len()],
            second_pass_end: 0,
        };
        oracle.set_ready(0..=0);
        oracle.compare(0)?;
        let mut ready = 0;
        for (number, frame) in clip.iter().enumerate() {
            if ready > trace.end() {
                break;
            }
            ready = oracle.process_frame(ready, number, frame, &recipes[..=number])?;
        }
        oracle.set_ready(ready..=trace.end());
        oracle.process_until(trace.end(), recipes)?;
        oracle.maps.compare(trace)?;
        *log = oracle.maps.log;
        Ok(oracle.history)
    }

    /// Processes a frame before which `ready_o` is 1 from edge `ready` on, and returns that edge of
    /// the next frame.
    fn process_frame(
        &mut self,
        ready: i64,
        number: usize,
        frame: &Frame,
        recipes: &[RasterParameters],
    ) -> Result<i64, String> {
        let recipe = self.recipe;
        let edges = self.advance_edges(ready);
        self.maps.add_frame(self.trace, &edges, recipe.advances());
        let outcome = outcome_without_regions(&recipe.base, frame);
        let tail = |word: i64| edges.get((word + recipe.flush_advances()) as usize).copied();
        if recipe.has_external_store() {
            self.streams.add_frame(recipe, self.trace, &outcome.denoised, tail);
        }
        self.history.push(outcome);
        for row in 0..recipe.base.rows() {
            let stored = tail(row * recipe.base.side * recipe.row_words())
                .map(|edge| edge + recipe.store_latency());
            self.row_store_edges.extend(stored);
        }
        for region in 0..recipe.base.columns() * recipe.base.rows() {
            if let Some(edge) = tail(recipe.last_word(region)) {
                let decided = self.decision_edge(edge);
                self.decisions.insert(decided, (number, region));
            }
        }
        let taken = (0..recipe.words()).filter(|&a| recipe.takes_word(a)).max().unwrap();
        let Some(&last_taken) = edges.get(taken as usize) else {
            self.process_until(self.trace.end(), recipes)?;
            return Ok(i64::MAX);
        };
        let mut next = last_taken + recipe.flush_clocks() + recipe.decision_latency();
        if recipe.waits_for_pending() {
            self.process_until(next - 1, recipes)?;
            // All outputs except `ready_o` are compared before the expected value of `ready_o` is
            // known.
            while next <= self.trace.end() {
                self.process_edge(next, recipes)?;
                let undecided = self.decisions.keys().any(|&edge| edge > next);
                self.ready[next as usize] = !undecided && !self.readouts.is_pending();
                self.compare(next)?;
                if self.ready[next as usize] {
                    break;
                }
                next += 1;
            }
        }
        Ok(next)
    }

    /// Returns the edges of all advances of a frame, as far as they came.
    fn advance_edges(&mut self, ready: i64) -> Vec<i64> {
        let (mut edges, mut last) = (Vec::new(), ready);
        for a in 0..self.recipe.advances() {
            let mut edge = last + 1;
            if self.recipe.takes_word(a) {
                while edge <= self.trace.end() && !self.trace.valid[edge as usize] {
                    edge += 1;
                }
                self.set_ready(last..=edge - 1);
            }
            if edge > self.trace.end() {
                break;
            }
            edges.push(edge);
            last = edge;
        }
        edges
    }

    fn set_ready(&mut self, edges: std::ops::RangeInclusive<i64>) {
        for edge in edges.filter(|&edge| edge <= self.trace.end()) {
            self.ready[edge as usize] = true;
        }
    }

    /// Returns the edge of the decision of a region whose last word came to the tail at that edge.
    fn decision_edge(&mut self, edge: i64) -> i64 {
        if !self.recipe.base.has_second_pass() {
            return edge + self.recipe.decision_latency();
        }
        let first = (edge + self.recipe.pass_latency()).max(self.second_pass_end + 1);
        self.second_pass_end = first + self.recipe.region_words() - 1;
        self.second_pass_end + self.recipe.pass_decision_latency()
    }

    /// Processes and compares all edges up to `last` that have not been processed.
    fn process_until(&mut self, last: i64, recipes: &[RasterParameters]) -> RasterCheckResult {
        for edge in self.readouts.shown.len() as i64..=last.min(self.trace.end()) {
            self.process_edge(edge, recipes)?;
            self.compare(edge)?;
        }
        Ok(())
    }

    /// Processes an edge: losses and decisions.
    fn process_edge(&mut self, edge: i64, recipes: &[RasterParameters]) -> RasterCheckResult {
        self.update_staleness();
        self.readouts.process_edge(edge, self.trace.sink[edge as usize]);
        for reading in self.readouts.regions.iter().filter(|reading| reading.lost == Some(edge)) {
            self.history[reading.frame].regions[reading.region as usize].lost = true;
        }
        let Some(&(frame, region)) = self.decisions.get(&edge) else { return Ok(()) };
        let (before, from) = self.history.split_at(frame);
        let is_external = self.recipe.has_external_store();
        let kept = if is_external { self.streams.history(frame) } else { before };
        let own = recipes[frame].base.of_class(self.maps.of_frames[frame][region as usize]);
        let outcome = oracle_region(&own, (before, kept), &from[0], region);
        let words = match outcome.action {
            "forward" if self.recipe.forward => self.recipe.region_words(),
            "summarize" => outcome.means.len() as i64,
            _ => 0,
        };
        if words > 0 {
            self.readouts.enqueue(frame, region, words, edge);
        }
        self.history[frame].regions.push(outcome);
        if self.history[frame].regions.len() as i64 != region + 1 {
            return Err(format!("region {region} is decided out of order"));
        }
        Ok(())
    }

    /// Sets the edges from which on regions are stale, as far as they are known.
    fn update_staleness(&mut self) {
        let rows = self.recipe.base.rows();
        for reading in self.readouts.regions.iter_mut().filter(|reading| reading.stale == i64::MAX)
        {
            let row = reading.frame as i64 * rows + reading.region / self.recipe.base.columns();
            let over = (row + self.recipe.buffer_rows()) as usize;
            reading.stale = self.row_store_edges.get(over).copied().unwrap_or(i64::MAX);
        }
    }

    fn compare(&self, edge: i64) -> RasterCheckResult {
        let got = &self.trace.shown[edge as usize];
        let ready = self.ready[edge as usize];
        if got.ready != ready {
            return Err(format!("ready_o is {} after edge {edge}", got.ready));
        }
        self.streams.compare(edge, self.trace.end(), got)?;
        self.compare_decision(edge, got)?;
        self.compare_word(edge, got)?;
        let lost = self.readouts.lost_counts[edge as usize];
        if (got.lost, i64::from(got.lost_count)) != (lost > 0, lost.min(65_535)) {
            return Err(format!("{} lost after edge {edge}, due are {lost}", got.lost_count));
        }
        self.compare_loss(edge, got)
    }

    fn compare_loss(&self, edge: i64, got: &RasterOutput) -> RasterCheckResult {
        let expected = self.readouts.lost_at(edge);
        let due: Vec<_> =
            expected.iter().map(|lost| (lost.region, frame_number_on_port(lost.frame))).collect();
        let shown = (i64::from(got.lost_region), i64::from(got.lost_frame));
        let shown = if got.lost_valid { vec![shown] } else { Vec::new() };
        let agrees = shown == due;
        agrees.then_some(()).ok_or_else(|| format!("after edge {edge} lost {shown:?}, not {due:?}"))
    }

    fn compare_decision(&self, edge: i64, got: &RasterOutput) -> RasterCheckResult {
        let bits = [got.srs, got.trs, got.active, got.summary];
        let Some(&(frame, region)) = self.decisions.get(&edge) else {
            return match (got.decision_valid, bits) {
                (false, [false, false, false, false]) => Ok(()),
                _ => Err(format!("a decision of region {} after edge {edge}", got.region)),
            };
        };
        let expected = &self.history[frame].regions[region as usize];
        let scores = expected.scores.iter().map(|&score| score as u64);
        let agrees = got.decision_valid
            && i64::from(got.region) == region
            && bits
                == [expected.srs, expected.trs, expected.active, expected.action == "summarize"]
            && i64::from(got.temporal_count) == expected.temporal_count
            && scores.eq(got.scores.into_iter().take(expected.scores.len()));
        agrees.then_some(()).ok_or_else(|| {
            format!("after edge {edge}: {got:?}, due is region {region} of frame {frame}")
        })
    }

    fn compare_word(&self, edge: i64, got: &RasterOutput) -> RasterCheckResult {
        let expected_word = self.readouts.shown[edge as usize];
        let Some((reading, word)) = expected_word else {
            return if got.forward_valid {
                Err(format!("a word leaves after edge {edge}"))
            } else {
                Ok(())
            };
        };
        let reading = &self.readouts.regions[reading];
        let expected = &self.history[reading.frame].regions[reading.region as usize];
        let is_mean = expected.action == "summarize";
        let (position, pixels) = if is_mean {
            let position = self.recipe.first_position_of_block(word);
            (position, vec![expected.means[word as usize]; self.recipe.word_pixels as usize])
        } else {
            let position = word * self.recipe.word_pixels;
            (
                position,
                expected.payload[position as usize..][..self.recipe.word_pixels as usize].to_vec(),
            )
        };
        let aborts = reading.is_abort(word);
        let flags = (word == 0, word + 1 == reading.words || aborts, aborts);
        let agrees = got.forward_valid
            && (got.forward_first, got.forward_last, got.forward_abort) == flags
            && got.forward_summary == is_mean
            && i64::from(got.forward_frame) == frame_number_on_port(reading.frame)
            && i64::from(got.forward_region) == reading.region
            && i64::from(got.forward_position) == position
            && pixels.into_iter().eq(got.forward_pixels.iter().map(|&pixel| i64::from(pixel)));
        agrees
            .then_some(())
            .ok_or_else(|| format!("after edge {edge}: {got:?}, due is word {word} of {reading:?}"))
    }
}

/// Returns the number of a frame as the ports show it.
fn frame_number_on_port(frame: usize) -> i64 {
    frame as i64 % 256
}
