// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges at which the output of each row of regions leaves a raster core, and the regions that
//! are lost.

use foveate_design::Design;
use foveate_timed::Transaction;

/// The output of a row of regions of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowOutput {
    /// The clock of the last decision.
    pub(crate) last_decision: u64,
    /// The clock of the last word that leaves, or `None` if none does.
    pub(crate) last_word: Option<u64>,
    /// The number of pixels and means that the regions send, without padding.
    pub(crate) values: u64,
}

/// The output of the rows of regions of all frames.
#[derive(Clone, Debug)]
pub(crate) struct RowRecord<'a> {
    pub(crate) design: &'a Design,
    /// The rows of regions, frame by frame.
    rows: Vec<RowOutput>,
    /// The number of regions that were lost.
    pub(crate) lost_regions: u64,
    /// The numbers of the frames of these regions, in ascending order.
    pub(crate) frames_with_losses: Vec<u64>,
}

impl<'a> RowRecord<'a> {
    pub(crate) fn new(design: &'a Design) -> Self {
        Self { design, rows: Vec::new(), lost_regions: 0, frames_with_losses: Vec::new() }
    }

    /// Records a transaction of the core.
    pub(crate) fn add(&mut self, transaction: &Transaction<'_>) {
        match transaction {
            Transaction::Decisions(run) => {
                for (clock, region) in run.regions.iter() {
                    let action = run.outcome.actions[region as usize];
                    let values = self.design.values_sent(region, action);
                    let row = self.row(run.frame, region);
                    row.last_decision = row.last_decision.max(clock);
                    row.values += values;
                }
            }
            Transaction::Words(run) => {
                for (first, region) in run.senders() {
                    let last = run.last_clock(first);
                    let row = self.row(run.frame, region);
                    row.last_word = row.last_word.max(Some(last));
                }
            }
            Transaction::Loss(loss) => {
                self.lost_regions += 1;
                if self.frames_with_losses.last() != Some(&loss.frame) {
                    self.frames_with_losses.push(loss.frame);
                }
            }
            Transaction::Scores(_) | Transaction::SyncError { .. } => {}
        }
    }

    /// Returns the output of every row of regions, with the numbers of its frame and row.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = ((u64, u32), &RowOutput)> {
        let rows = self.design.rows();
        let places = (0_u64..).flat_map(move |frame| (0..rows).map(move |row| (frame, row)));
        places.zip(&self.rows)
    }

    fn row(&mut self, frame: u64, region: u32) -> &mut RowOutput {
        let row = frame * u64::from(self.design.rows()) + u64::from(region / self.design.columns());
        let place = usize::try_from(row).expect("rows are in memory");
        if place >= self.rows.len() {
            self.rows.resize(place + 1, RowOutput::default());
        }
        &mut self.rows[place]
    }
}
