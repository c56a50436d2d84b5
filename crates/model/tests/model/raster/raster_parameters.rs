// SPDX-License-Identifier: MIT OR Apache-2.0
//! A random raster design as plain numbers, and the numbers of `docs/raster.md` that follow from
//! it.

use foveate_design::{Design, FrameStoreKind, Organization, Pipelining};
use proptest::prelude::*;
use proptest::sample::select;

use crate::parameters::{DesignParameters, arbitrary_parameters_with_sides, arbitrary_zones_of};

#[derive(Clone, Debug)]
pub(crate) struct RasterParameters {
    pub(crate) base: DesignParameters,
    /// Pixels of a word, K.
    pub(crate) word_pixels: i64,
    pub(crate) deep: bool,
    /// The key `hardware.store`.
    pub(crate) store: FrameStoreKind,
    /// The key `hardware.forward`.
    pub(crate) forward: bool,
}

impl RasterParameters {
    pub(crate) fn design(&self) -> Design {
        let mut config = self.base.config();
        config.hardware.make_raster().pixels_per_clock = Some(self.word_pixels as u32);
        config.hardware.pipelining = if self.deep { Pipelining::Deep } else { Pipelining::Plain };
        config.hardware.make_raster().store = Some(self.store);
        config.hardware.make_raster().forward = Some(self.forward);
        config.validate().unwrap_or_else(|error| panic!("{error}\n{self:?}"))
    }

    fn filter(&self) -> i64 {
        i64::from(self.base.has_filter())
    }

    fn window(&self) -> i64 {
        i64::from(self.base.has_feature_window())
    }

    /// Returns the words of a row of the padded frame, L.
    pub(crate) fn row_words(&self) -> i64 {
        self.base.columns() * self.base.side / self.word_pixels
    }

    /// Returns the words of a row that are taken, V.
    pub(crate) fn taken_row_words(&self) -> i64 {
        (self.base.width + self.word_pixels - 1) / self.word_pixels
    }

    /// Returns the words of the padded frame, R*N*L.
    pub(crate) fn words(&self) -> i64 {
        self.base.rows() * self.base.side * self.row_words()
    }

    /// Returns the advances that flush the windows, w (L + 1).
    pub(crate) fn flush_advances(&self) -> i64 {
        (self.filter() + self.window()) * (self.row_words() + 1)
    }

    /// Returns the advances of a frame, A.
    pub(crate) fn advances(&self) -> i64 {
        self.words() + self.flush_advances()
    }

    /// Returns the clocks from T0 to the last advance, Z.
    pub(crate) fn flush_clocks(&self) -> i64 {
        let below = self.base.rows() * self.base.side - self.base.height;
        (self.row_words() - self.taken_row_words())
            + below * self.row_words()
            + self.flush_advances()
    }

    /// Returns the clocks from the tail to the store, S.
    pub(crate) fn store_latency(&self) -> i64 {
        let (m, f) = (self.filter(), self.window());
        if self.deep { 4 + 9 * m + 3 * f } else { 2 + 4 * m + f }
    }

    /// Returns the clocks from e(a(i)) to the edge that takes the reference of word i from an
    /// external store.
    pub(crate) fn reference_latency(&self) -> i64 {
        self.store_latency() - if self.deep { 2 } else { 1 }
    }

    pub(crate) fn has_external_store(&self) -> bool {
        self.store == FrameStoreKind::External
    }

    /// Returns the clocks from the tail to the decision, D.
    pub(crate) fn decision_latency(&self) -> i64 {
        self.store_latency() + if self.deep { 6 } else { 4 } + self.score_latency()
    }

    /// Returns the clocks from the counts of a region to the last of its other scores.
    fn score_latency(&self) -> i64 {
        if self.base.has_feature("variance") {
            3
        } else if self.base.has_feature("surface") {
            2
        } else {
            i64::from(self.base.has_feature("range"))
        }
    }

    /// Returns the clocks from e(a(i)) to the first edge of the second pass, if the pass does not
    /// wait.
    pub(crate) fn pass_latency(&self) -> i64 {
        self.store_latency() + if self.deep { 9 } else { 8 } + self.score_latency()
    }

    /// Returns the clocks from the last edge of the second pass to the decision.
    pub(crate) fn pass_decision_latency(&self) -> i64 {
        if self.deep { 6 } else { 4 }
    }

    /// Returns the words of a region, n/K.
    pub(crate) fn region_words(&self) -> i64 {
        self.base.region_pixels() / self.word_pixels
    }

    /// Returns the position of the first pixel of a block.
    pub(crate) fn first_position_of_block(&self, number: i64) -> i64 {
        let blocks = self.base.periphery.unwrap().blocks;
        let block = |at: i64, of: i64| at % of * blocks / of;
        let (row, column) = (number / blocks, number % blocks);
        let side = self.base.side;
        (0..self.base.region_pixels())
            .find(|&at| (block(at / side, side), block(at, side)) == (row, column))
            .unwrap()
    }

    /// Returns the rows of regions in the buffer, B.
    pub(crate) fn buffer_rows(&self) -> i64 {
        let spare = self.row_words() - self.base.side / self.word_pixels;
        let is_short = spare < self.score_latency() + if self.deep { 10 } else { 7 };
        if self.base.has_second_pass() || is_short { 3 } else { 2 }
    }

    pub(crate) fn waits_for_pending(&self) -> bool {
        let is_small = self.base.rows() <= self.buffer_rows();
        let compares = self.base.last_sent || self.base.periphery.is_some();
        compares && is_small
    }

    /// Returns true if advance `a` takes a word.
    pub(crate) fn takes_word(&self, a: i64) -> bool {
        a < self.words()
            && a % self.row_words() < self.taken_row_words()
            && a / self.row_words() < self.base.height
    }

    pub(crate) fn last_word(&self, region: i64) -> i64 {
        let (row, column) = (region / self.base.columns(), region % self.base.columns());
        let wide = self.base.side / self.word_pixels;
        ((row + 1) * self.base.side - 1) * self.row_words() + (column + 1) * wide - 1
    }
}

/// Generates every kind of raster design, with about four regions or sixteen words in a row.
pub(crate) fn arbitrary_raster_parameters() -> impl Strategy<Value = RasterParameters> {
    let sides = prop_oneof![6 => select(vec![2i64, 3, 4, 4, 5, 6, 8, 8]), 1 => 2i64..=9];
    let size = (0i64..=100, 0i64..=100, 0i64..=1);
    let stores = select(vec![
        FrameStoreKind::Block,
        FrameStoreKind::Ultra,
        FrameStoreKind::SinglePort,
        FrameStoreKind::External,
    ]);
    let built = (any::<bool>(), stores, select(vec![true, true, false]));
    (
        arbitrary_parameters_with_sides(sides, Organization::Raster.feature_kinds()),
        select(vec![1i64, 2, 4]),
        built,
        size,
    )
        .prop_map(|(mut base, pixels, (deep, store, forward), (wide, high, more))| {
            let side = base.side;
            let block = base.periphery.map_or(side, |periphery| side / periphery.blocks);
            let pixels = if block % pixels == 0 { pixels } else { 2 - block % 2 };
            let forward = forward || base.periphery.is_some();
            let columns = 4.max((16 * pixels + side - 1) / side) + more;
            base.width = (columns - 1) * side + 1 + wide % side;
            // The frame has up to five rows of regions.
            base.height = 1 + high % (5 * side);
            // All other designs need the reference `previous`.
            base.last_sent &=
                forward && matches!(store, FrameStoreKind::Block | FrameStoreKind::Ultra);
            RasterParameters { base, word_pixels: pixels, deep, store, forward }
        })
}

/// Generates every kind of raster design with zones.
pub(crate) fn arbitrary_zoned_raster_parameters() -> impl Strategy<Value = RasterParameters> {
    arbitrary_raster_parameters().prop_flat_map(|recipe| {
        arbitrary_zones_of(recipe.base.clone())
            .prop_map(move |base| RasterParameters { base, ..recipe.clone() })
    })
}
