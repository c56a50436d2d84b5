// SPDX-License-Identifier: MIT OR Apache-2.0
//! A received frame ([`ReceivedFrame`]): its decisions, its regions and its losses.

use super::packet_layout::index;
use crate::{
    EndPacket, FlowPacket, FrameInfo, PacketLayout, RegionDecision, RegionPacket, RowPacket,
    ScoresPacket, StreamLoss,
};
use foveate_camera::{Displacement, IrrelevantRendering, RegionAction};

/// The pixels or means that were received for a region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RegionContent {
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
    pub decisions: Vec<RegionDecision>,
    /// The number of changed pixels of each region; 0 if it is not known.
    pub temporal_count: Vec<u32>,
    /// The scores, by feature and then by region; 0 if they are not known.
    pub scores: Vec<Vec<u64>>,
    /// The displacement of each region; 0 if it is not known. It is empty for a design without
    /// `flow`.
    pub displacements: Vec<Displacement>,
    /// The received pixels or means of each region; `None` if nothing was received.
    pub contents: Vec<Option<RegionContent>>,
    rows: Vec<ReceivedRowParts>,
    end: Option<EndPacket>,
    misplaced: u32,
}

/// The packets that were received of a row of regions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct ReceivedRowParts {
    decisions: bool,
    scores: bool,
    flow: bool,
}

impl ReceivedFrame {
    pub(crate) fn new(number: u32, info: Option<FrameInfo>, layout: &PacketLayout) -> Self {
        let regions = layout.regions();
        let features = layout.score_fields().count() - 1;
        let displaced = if layout.has_flow() { regions } else { 0 };
        Self {
            number,
            info,
            decisions: vec![RegionDecision::default(); regions],
            temporal_count: vec![0; regions],
            scores: vec![vec![0; regions]; features],
            displacements: vec![Displacement::default(); displaced],
            contents: vec![None; regions],
            rows: vec![ReceivedRowParts::default(); index(layout.rows())],
            end: None,
            misplaced: 0,
        }
    }

    /// Returns the effect of the frame on every region of the screen. A region for which nothing
    /// was received stays as it is.
    #[must_use]
    pub fn actions(&self, irrelevant: IrrelevantRendering) -> Vec<RegionAction> {
        let all = self.decisions.iter().zip(&self.contents).enumerate();
        all.map(|(region, (decision, content))| match content {
            Some(RegionContent::Pixels(_)) => RegionAction::Forward,
            Some(RegionContent::Means(_)) => RegionAction::Summarize,
            None if decision.srs || !self.is_decided(region) => RegionAction::Hold,
            None => match irrelevant {
                IrrelevantRendering::Zero => RegionAction::Blank,
                IrrelevantRendering::Hold | IrrelevantRendering::Mean => RegionAction::Hold,
            },
        })
        .collect()
    }

    fn is_decided(&self, region: usize) -> bool {
        let columns = self.decisions.len() / self.rows.len().max(1);
        self.rows.get(region / columns.max(1)).is_some_and(|row| row.decisions)
    }

    pub(crate) fn take_row(&mut self, row: RowPacket) {
        let (at, columns) = (index(row.row), row.decisions.len());
        match self.rows.get_mut(at) {
            Some(parts) if !parts.decisions => parts.decisions = true,
            _ => return self.count_misplaced(),
        }
        replace_from(&mut self.decisions, at * columns, row.decisions);
    }

    pub(crate) fn take_scores(&mut self, scores: ScoresPacket) {
        let (at, columns) = (index(scores.row), scores.temporal_count.len());
        match self.rows.get_mut(at) {
            Some(parts) if !parts.scores => parts.scores = true,
            _ => return self.count_misplaced(),
        }
        replace_from(&mut self.temporal_count, at * columns, scores.temporal_count);
        for (values, scores) in self.scores.iter_mut().zip(scores.scores) {
            replace_from(values, at * columns, scores);
        }
    }

    pub(crate) fn take_flow(&mut self, flow: FlowPacket) {
        let (at, columns) = (index(flow.row), flow.displacements.len());
        match self.rows.get_mut(at) {
            Some(parts) if !parts.flow => parts.flow = true,
            _ => return self.count_misplaced(),
        }
        replace_from(&mut self.displacements, at * columns, flow.displacements);
    }

    pub(crate) fn take_region(&mut self, region: RegionPacket, columns: u32) {
        let at = index(region.row) * index(columns) + index(region.column);
        match self.contents.get_mut(at) {
            Some(content) if content.is_none() => {
                let (values, means) = (region.values, region.flags.summary);
                *content = Some(if means {
                    RegionContent::Means(values)
                } else {
                    RegionContent::Pixels(values)
                });
            }
            _ => self.count_misplaced(),
        }
    }

    /// Counts a packet that is ignored. The count saturates, because a stream may repeat a packet
    /// without end.
    fn count_misplaced(&mut self) {
        self.misplaced = self.misplaced.saturating_add(1);
    }

    pub(crate) fn take_end(&mut self, end: EndPacket) {
        self.end = Some(end);
    }

    /// Compares the decisions with the received regions, and returns the losses.
    pub(crate) fn compare_with_decisions(&mut self, layout: &PacketLayout) -> Vec<StreamLoss> {
        let (frame, mut losses) = (self.number, Vec::new());
        if self.info.is_none() {
            losses.push(StreamLoss::Frame { frame });
        }
        let columns = index(layout.columns());
        let end = self.end.unwrap_or_default();
        for (row, parts) in (0..).zip(&self.rows) {
            if !parts.decisions {
                losses.push(StreamLoss::Row { frame, row, dropped: end.rows_dropped > 0 });
            }
            if !parts.scores && layout.info().has_scores {
                losses.push(StreamLoss::Scores { frame, row });
            }
            if !parts.flow && layout.has_flow() {
                losses.push(StreamLoss::Flow { frame, row });
            }
        }
        let decided: Vec<bool> =
            (0..self.contents.len()).map(|region| self.is_decided(region)).collect();
        let regions = self.decisions.iter_mut().zip(&mut self.contents).zip(decided);
        for (region, ((decision, content), is_decided)) in regions.enumerate() {
            // In both values, `None` stands for no packet, true for a packet of means, and false
            // for one of pixels.
            let received_means =
                content.as_ref().map(|content| matches!(content, RegionContent::Means(_)));
            if !is_decided {
                // The decision is derived from the received packet; a summary tells nothing about
                // TRS.
                let active = received_means == Some(false);
                *decision = RegionDecision {
                    srs: active,
                    trs: active,
                    summary: received_means == Some(true),
                };
                continue;
            }
            let expected_means = if decision.summary {
                Some(true)
            } else {
                (decision.srs && decision.trs).then_some(false)
            };
            if received_means != expected_means && content.take().is_some() {
                self.misplaced = self.misplaced.saturating_add(1);
            }
            if expected_means.is_some() && content.is_none() {
                let (row, column) = (region / columns, region % columns);
                let narrow = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
                let (row, column) = (narrow(row), narrow(column));
                losses.push(StreamLoss::Region {
                    frame,
                    row,
                    column,
                    dropped: end.regions_dropped > 0,
                });
            }
        }
        if self.misplaced > 0 {
            losses.push(StreamLoss::Misplaced { frame, count: self.misplaced });
        }
        if self.end.is_none() {
            losses.push(StreamLoss::End { frame });
        }
        losses
    }
}

/// Replaces the values from index `at` on.
fn replace_from<T>(values: &mut [T], at: usize, with: Vec<T>) {
    values.iter_mut().skip(at).zip(with).for_each(|(value, with)| *value = with);
}
