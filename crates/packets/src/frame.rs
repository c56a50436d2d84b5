// SPDX-License-Identifier: MIT OR Apache-2.0
//! A received frame: its decisions, its regions and its losses.

use foveate_design::{Action, Irrelevant};

use crate::word::index;
use crate::{Decision, End, FrameInfo, Layout, Loss, Region, Row, Scores};

/// The pixels or means that were received for a region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// The N x N pixels of the region.
    Pixels(Vec<u16>),
    /// The q x q means of the blocks of the region.
    Means(Vec<u16>),
}

/// A received frame that has ended. Regions are numbered row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReceivedFrame {
    /// The number of the frame in the stream.
    pub number: u32,
    /// The content of its FRAME; `None` if the FRAME is missing.
    pub info: Option<FrameInfo>,
    /// The decision of each region; without SRS and TRS if it is not known.
    pub decisions: Vec<Decision>,
    /// The number of changed pixels of each region; 0 if it is not known.
    pub temporal_count: Vec<u32>,
    /// The scores, by feature and then by region; 0 if they are not known.
    pub scores: Vec<Vec<u64>>,
    /// The received pixels or means of each region; `None` if nothing was received.
    pub contents: Vec<Option<Content>>,
    rows: Vec<Known>,
    end: Option<End>,
    misplaced: u32,
}

/// Which packets of a row of regions were received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Known {
    decisions: bool,
    scores: bool,
}

impl ReceivedFrame {
    pub(crate) fn new(number: u32, info: Option<FrameInfo>, layout: &Layout) -> Self {
        let regions = layout.regions();
        let features = layout.scores().count() - 1;
        Self {
            number,
            info,
            decisions: vec![Decision::default(); regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; features],
            contents: vec![None; regions],
            rows: vec![Known::default(); index(layout.rows())],
            end: None,
            misplaced: 0,
        }
    }

    /// Returns the effect of the frame on every region of the screen. A region for which nothing
    /// was received stays as it is.
    #[must_use]
    pub fn actions(&self, irrelevant: Irrelevant) -> Vec<Action> {
        let all = self.decisions.iter().zip(&self.contents).enumerate();
        all.map(|(region, (decision, content))| match content {
            Some(Content::Pixels(_)) => Action::Forward,
            Some(Content::Means(_)) => Action::Summarize,
            None if decision.srs || !self.is_decided(region) => Action::Hold,
            None => match irrelevant {
                Irrelevant::Zero => Action::Blank,
                Irrelevant::Hold | Irrelevant::Mean => Action::Hold,
            },
        })
        .collect()
    }

    fn is_decided(&self, region: usize) -> bool {
        let columns = self.decisions.len() / self.rows.len().max(1);
        self.rows.get(region / columns.max(1)).is_some_and(|row| row.decisions)
    }

    pub(crate) fn take_row(&mut self, row: Row) {
        let (at, columns) = (index(row.row), row.decisions.len());
        match self.rows.get_mut(at) {
            Some(known) if !known.decisions => known.decisions = true,
            _ => return self.misplace(),
        }
        put(&mut self.decisions, at * columns, row.decisions);
    }

    pub(crate) fn take_scores(&mut self, scores: Scores) {
        let (at, columns) = (index(scores.row), scores.temporal_count.len());
        match self.rows.get_mut(at) {
            Some(known) if !known.scores => known.scores = true,
            _ => return self.misplace(),
        }
        put(&mut self.temporal_count, at * columns, scores.temporal_count);
        for (own, scores) in self.scores.iter_mut().zip(scores.scores) {
            put(own, at * columns, scores);
        }
    }

    pub(crate) fn take_region(&mut self, region: Region, columns: u32) {
        let at = index(region.row) * index(columns) + index(region.column);
        match self.contents.get_mut(at) {
            Some(content) if content.is_none() => {
                let (values, means) = (region.values, region.flags.summary);
                *content =
                    Some(if means { Content::Means(values) } else { Content::Pixels(values) });
            }
            _ => self.misplace(),
        }
    }

    /// Counts a packet that is ignored. The count saturates, because a stream may repeat a packet
    /// without end.
    fn misplace(&mut self) {
        self.misplaced = self.misplaced.saturating_add(1);
    }

    pub(crate) fn take_end(&mut self, end: End) {
        self.end = Some(end);
    }

    /// Compares the decisions with the received regions, and returns the losses.
    pub(crate) fn conclude(&mut self, layout: &Layout) -> Vec<Loss> {
        let (frame, mut losses) = (self.number, Vec::new());
        if self.info.is_none() {
            losses.push(Loss::Frame { frame });
        }
        let columns = index(layout.columns());
        let end = self.end.unwrap_or_default();
        for (row, known) in (0..).zip(&self.rows) {
            if !known.decisions {
                losses.push(Loss::Row { frame, row, dropped: end.rows_dropped > 0 });
            }
            if !known.scores && layout.info().has_scores {
                losses.push(Loss::Scores { frame, row });
            }
        }
        let decided: Vec<bool> =
            (0..self.contents.len()).map(|region| self.is_decided(region)).collect();
        let regions = self.decisions.iter_mut().zip(&mut self.contents).zip(decided);
        for (region, ((decision, content), is_decided)) in regions.enumerate() {
            let came = content.as_ref().map(|content| matches!(content, Content::Means(_)));
            if !is_decided {
                // The decision is derived from the received packet; a summary tells nothing about
                // TRS.
                let active = came == Some(false);
                *decision = Decision { srs: active, trs: active, summary: came == Some(true) };
                continue;
            }
            let asked = if decision.summary {
                Some(true)
            } else {
                (decision.srs && decision.trs).then_some(false)
            };
            if came != asked && content.take().is_some() {
                self.misplaced = self.misplaced.saturating_add(1);
            }
            if asked.is_some() && content.is_none() {
                let (row, column) = (region / columns, region % columns);
                let narrow = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
                let (row, column) = (narrow(row), narrow(column));
                losses.push(Loss::Region { frame, row, column, dropped: end.regions_dropped > 0 });
            }
        }
        if self.misplaced > 0 {
            losses.push(Loss::Misplaced { frame, count: self.misplaced });
        }
        if self.end.is_none() {
            losses.push(Loss::End { frame });
        }
        losses
    }
}

/// Replaces the values from index `at` on.
fn put<T>(values: &mut [T], at: usize, with: Vec<T>) {
    values.iter_mut().skip(at).zip(with).for_each(|(value, with)| *value = with);
}
