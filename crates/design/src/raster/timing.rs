// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a raster core: the numbers of `docs/raster.md`.

use crate::timing::DepartureTiming;
use crate::{DesignTiming, FeatureHardware, Pipelining, RasterDesign};
use foveate_camera::{Periphery, ReferenceWriteTime, RegionAction};

/// Clocks by which a stall must be shorter because of the readout itself, in addition to those of
/// the queue, without a second pass.
const STALL_MARGIN: u32 = 1;
/// Least number of clocks between the edges at which the readout holds two regions.
const HOLD_INTERVAL: u32 = 2;

/// The timing of a raster core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterTiming {
    /// Pixels of a word, K.
    pub word_pixels: u32,
    /// Words of a row of the padded frame, L.
    pub row_words: u32,
    /// Words of a row that are taken, V.
    pub taken_words: u32,
    /// Rows of the frame, H.
    pub taken_rows: u32,
    /// Rows of the padded frame, R*N.
    pub rows: u32,
    /// Words of a row of a region, N/K.
    pub region_row_words: u32,
    /// Words of a region, n/K.
    pub region_words: u32,
    /// Number of windows that a word passes, w.
    pub windows: u32,
    /// Clocks from the advance of a word in the tail until it is stored, S.
    pub store_latency: u32,
    /// Clocks from the advance of a word in the tail to the edge at which its reference is taken
    /// from an external frame store.
    pub lookup_latency: u32,
    /// Clocks from the advance of the last word of a region in the tail to its decision, D.
    pub decision_latency: u32,
    /// Rows of regions whose pixels are buffered, B, or 0 if the buffer is not needed. It is 3
    /// where a second pass reads them, or where a row is too short for the way of a region to the
    /// readout.
    pub buffer_rows: u32,
    /// Least number of clocks from the edge at which an active region enters the queue to the edge
    /// at which the readout holds it.
    pub queue_latency: u32,
    /// Least number of clocks from the edge at which the readout holds a region to the edge at
    /// which it holds the next.
    pub hold_interval: u32,
    /// True if the pixels of active regions leave.
    pub has_forwarding: bool,
    /// The timing of the second pass, for designs with `mad` or `segment` only.
    pub second_pass: Option<SecondPassTiming>,
    /// Words of a region that sends its summary, q*q, for designs with a periphery only.
    pub summary_words: Option<u32>,
    /// True if a frame waits until no region of the frame before is pending. The frame then has at
    /// most B rows of regions.
    pub waits_for_pending: bool,
}

/// The timing of the second pass, which reads the stored words of a region back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SecondPassTiming {
    /// Least number of clocks from the edge at which the last word of the region is stored to the
    /// first edge of its pass.
    pub after_store: u32,
    /// Clocks from the last edge of the pass of a region to its decision.
    pub decision_latency: u32,
}

impl RasterTiming {
    /// Returns the timing of the design.
    #[must_use]
    pub fn from_design(design: RasterDesign<'_>) -> Self {
        let word_pixels = design.pixels_per_clock();
        let filter = u32::from(design.filter().has_window());
        let feature = u32::from(design.has_feature_window());
        let (store_latency, after_store, lookup_to_store, queue_latency) = match design.pipelining()
        {
            Pipelining::Plain => (2 + 4 * filter + feature, 4, 1, 2),
            Pipelining::Deep => (4 + 9 * filter + 3 * feature, 6, 2, 3),
        };
        let features = design.features().iter();
        let latencies = features.map(|f| FeatureHardware::in_raster(f.kind()).score_latency);
        let score_latency = latencies.max().unwrap_or_default();
        let (pass_after_store, pass_to_decision) = match design.pipelining() {
            Pipelining::Plain => (8, 4),
            Pipelining::Deep => (9, 6),
        };
        let second_pass = design.has_second_pass().then_some(SecondPassTiming {
            after_store: pass_after_store + score_latency,
            decision_latency: pass_to_decision,
        });
        let region_row_words = design.region_size() / word_pixels;
        let row_words = design.columns() * region_row_words;
        // With two rows in the buffer the last word of a row of regions would be overwritten before
        // it is fetched.
        let is_short = row_words - region_row_words
            < after_store + score_latency + STALL_MARGIN + queue_latency;
        let buffer_rows = match (second_pass, design.has_forwarding()) {
            (Some(_), _) => 3,
            (None, true) if is_short => 3,
            (None, true) => 2,
            (None, false) => 0,
        };
        // The reference, or the summary on the screen, depends on what the frame before has sent.
        let compares_with_sent = match design.temporal().reference.write_time() {
            ReferenceWriteTime::EveryFrame => design.periphery().is_some(),
            ReferenceWriteTime::WhenSent => true,
        };
        Self {
            word_pixels,
            row_words,
            taken_words: design.width().div_ceil(word_pixels),
            taken_rows: design.height(),
            rows: design.rows() * design.region_size(),
            region_row_words,
            region_words: design.region_pixels() / word_pixels,
            windows: filter + feature,
            store_latency,
            lookup_latency: store_latency - lookup_to_store,
            decision_latency: store_latency + after_store + score_latency,
            buffer_rows,
            queue_latency,
            hold_interval: HOLD_INTERVAL,
            has_forwarding: design.has_forwarding(),
            second_pass,
            summary_words: design.periphery().map(Periphery::mean_count),
            waits_for_pending: compares_with_sent && design.rows() <= buffer_rows,
        }
    }

    /// Returns the number of words of the padded frame, R*N*L.
    #[must_use]
    pub fn words(&self) -> u64 {
        u64::from(self.rows) * u64::from(self.row_words)
    }

    /// Returns the number of words of a frame that are taken, H*V.
    #[must_use]
    pub fn taken_words_per_frame(&self) -> u64 {
        u64::from(self.taken_rows) * u64::from(self.taken_words)
    }

    /// Returns the advances from a word to its position in the tail, w (L + 1): a(i) = i + w (L +
    /// 1).
    #[inline]
    #[must_use]
    pub fn tail_delay(&self) -> u64 {
        u64::from(self.windows) * (u64::from(self.row_words) + 1)
    }

    /// Returns the number of advances of a frame, A.
    #[inline]
    #[must_use]
    pub fn advances(&self) -> u64 {
        self.words() + self.tail_delay()
    }

    /// Returns the clocks from T0 to the last advance of the frame, Z.
    #[must_use]
    pub fn flush_clocks(&self) -> u64 {
        let (row, taken) = (u64::from(self.row_words), u64::from(self.taken_words));
        row - taken + u64::from(self.rows - self.taken_rows) * row + self.tail_delay()
    }

    /// Returns the clocks from T0 to the edge after which `ready_o` is 1 again, Z + D. There are
    /// more where a frame waits for pending regions.
    #[inline]
    #[must_use]
    pub fn edges_to_ready(&self) -> u64 {
        self.flush_clocks() + u64::from(self.decision_latency)
    }

    /// Returns the number of rows of L clocks that a source must leave between two frames so that
    /// none of its words waits. They cover the clocks of [`Self::edges_to_ready`], less the rest of
    /// the last row.
    #[must_use]
    pub fn blank_rows(&self) -> u64 {
        let rest = u64::from(self.row_words - self.taken_words);
        (self.edges_to_ready() - rest).div_ceil(self.row_words.into())
    }

    /// Returns the clocks from the edge that takes the last word of a region inside of the frame to
    /// its decision. Words come at every clock, and the second pass does not wait.
    #[must_use]
    pub fn clocks_to_decision(&self) -> u64 {
        self.tail_delay()
            + match self.second_pass {
                None => u64::from(self.decision_latency),
                Some(pass) => u64::from(self.clocks_through_second_pass(pass)),
            }
    }

    /// Returns the largest number of clocks for which a sink may stall in all without loss, while
    /// all regions are active and words come at every clock. It is 0 without forwarding.
    #[must_use]
    pub fn max_stall_clocks(&self) -> u32 {
        let row = self.row_words;
        // Rows of words that the buffer has in addition to those of two rows of regions.
        let more = self.buffer_rows.saturating_sub(2) * self.region_words / self.region_row_words;
        let most = (more + 1) * row - self.region_row_words;
        let late = match self.second_pass {
            None => self.decision_latency - self.store_latency + STALL_MARGIN,
            Some(pass) => self.region_words + pass.after_store + pass.decision_latency,
        };
        if self.has_forwarding { most - late - self.queue_latency } else { 0 }
    }

    /// Returns the number of words of a region that leave for an action, or `None` if none leave.
    #[inline]
    #[must_use]
    pub fn words_sent(&self, action: RegionAction) -> Option<u32> {
        match action {
            RegionAction::Forward => self.has_forwarding.then_some(self.region_words),
            RegionAction::Summarize => self.summary_words,
            RegionAction::Hold | RegionAction::Blank => None,
        }
    }

    /// Returns the clocks from one frame to the next that follows at once. There are more where a
    /// frame waits for pending regions.
    #[must_use]
    pub fn clocks_per_frame(&self) -> u64 {
        self.advances() + u64::from(self.decision_latency)
    }

    /// Returns the largest number of clocks from one frame to the next that follows at once: all of
    /// its regions are active, and the next frame waits for them if it must.
    #[must_use]
    pub fn max_clocks_per_frame(&self) -> u64 {
        // The sink takes the last word at the edge after the one after which the word is on the
        // ports.
        let left =
            if self.waits_for_pending { self.take_clocks() + self.last_word() + 1 } else { 0 };
        left.max(self.clocks_per_frame())
    }

    /// Returns the clocks in which the words of a frame are taken, if words come at every clock.
    fn take_clocks(&self) -> u64 {
        let whole = u64::from(self.taken_rows - 1) * u64::from(self.row_words);
        whole + u64::from(self.taken_words)
    }

    /// Returns the timing in terms that every organization has.
    pub(super) fn to_design_timing(self) -> DesignTiming {
        let clocks = self.clocks_per_frame();
        let mut figures = vec![
            ("cycles_per_frame", clocks),
            ("taken_words", self.taken_words_per_frame()),
            ("advances", self.advances()),
            ("row_words", self.row_words.into()),
            ("store_latency", self.store_latency.into()),
            ("decision_latency", self.decision_latency.into()),
            ("buffer_rows", self.buffer_rows.into()),
        ];
        if let Some(words) = self.summary_words {
            figures.push(("summary_words", words.into()));
        }
        let mut decision =
            format!("{} clocks after its region's last word", self.clocks_to_decision());
        if let Some(pass) = self.second_pass {
            figures.push(("second_pass_words", self.region_words.into()));
            figures.push(("second_pass_latency", pass.decision_latency.into()));
            decision.push_str(", after its second pass");
        }
        let shown = format!(
            "{clocks}: {} advances, {} clocks until the last is decided",
            self.advances(),
            self.decision_latency
        );
        let leave = if self.has_forwarding {
            format!("from {} clocks after their decision on", self.clocks_to_first_word())
        } else {
            "never: only decisions leave this core".to_owned()
        };
        DesignTiming {
            clocks_per_frame: clocks,
            pixels_per_frame: self.taken_words_per_frame(),
            figures,
            phases: Vec::new(),
            descriptions: vec![
                ("cycles per frame", shown),
                ("decision", decision),
                ("pixels leave", leave),
            ],
            departure: DepartureTiming {
                take_clocks: self.take_clocks(),
                decision_frames: 0,
                decision_clocks: self.last_decision(),
                forward_frames: 0,
                forward_clocks: self.last_word(),
                slot_clocks: 0,
                buffered_rows: (!self.waits_for_pending).then_some(self.buffer_rows),
                has_independent_units: false,
            },
        }
    }

    /// Returns the clocks from the advance of the last word of a region in the tail to its
    /// decision, if its pass does not wait.
    fn clocks_through_second_pass(&self, pass: SecondPassTiming) -> u32 {
        self.store_latency + pass.after_store + self.region_words - 1 + pass.decision_latency
    }

    /// Returns the clocks from T0 to the advance, in the tail, of the last word of the first region
    /// of the last row of regions, plus L, so that the number is never negative. The last advance
    /// is that of the last region of that row.
    fn clocks_to_last_region_row(&self) -> u64 {
        self.flush_clocks() + u64::from(self.region_row_words)
    }

    /// Returns the clocks from T0 to the last decision of the frame, if words come at every clock.
    fn last_decision(&self) -> u64 {
        match self.second_pass {
            None => self.edges_to_ready(),
            Some(pass) => {
                // The passes of the regions of a row follow each other without a gap.
                let first = self.clocks_to_last_region_row()
                    + u64::from(self.clocks_through_second_pass(pass));
                first + self.words_per_region_row()
                    - u64::from(self.region_words)
                    - u64::from(self.row_words)
            }
        }
    }

    /// Returns the clocks from the decision of a region to its first word on the ports, if it does
    /// not wait: it enters the queue, leaves it, and the word is fetched.
    #[must_use]
    pub fn clocks_to_first_word(&self) -> u64 {
        u64::from(1 + self.queue_latency + 2)
    }

    /// Returns the clocks from T0 to the last word that leaves, if all regions of the last row are
    /// active and the sink takes a word at every clock. If no word leaves, the clocks end with the
    /// last decision.
    fn last_word(&self) -> u64 {
        match self.second_pass {
            _ if !self.has_forwarding => self.last_decision(),
            // The words of a row of regions follow each other without a gap.
            None => {
                let first = self.clocks_to_last_region_row() + u64::from(self.decision_latency);
                first + self.clocks_to_first_word() + self.words_per_region_row()
                    - 1
                    - u64::from(self.row_words)
            }
            Some(_) => {
                self.last_decision() + self.clocks_to_first_word() + u64::from(self.region_words)
                    - 1
            }
        }
    }

    /// Returns the number of words of a row of regions, N*L.
    #[inline]
    #[must_use]
    pub fn words_per_region_row(&self) -> u64 {
        let rows = u64::from(self.region_words / self.region_row_words);
        rows * u64::from(self.row_words)
    }
}
