// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tails of all RPUs: positions, scores, decision, forwarding.

use foveate_design::{Combine, FeatureKind};
use foveate_lanes::{BLOCK, Block, Lane};
use foveate_model::Thresholds;

use crate::counts::{add_hits, reach};
use crate::moments::Moments;
use crate::plan::Plan;
use crate::rows::{Row, row};
use crate::store::Store;
use crate::temporal::{Decided, TemporalScore, keeps_sent};
use crate::wide::{Count, Sum, Types};
use crate::window::Pixels;

/// Everything behind the windows.
#[derive(Clone, Debug)]
pub(crate) struct Tail<Y: Types> {
    /// Position of the next tail step.
    position: usize,
    /// The last edge was the last tail step of a frame.
    done: bool,
    store: Store<Y::Pixel>,
    /// Hits, by place of the feature; empty where it counts none.
    hits: Vec<Row<Y::Count>>,
    moments: Option<Moments<Y::Sum>>,
    temporal: TemporalScore<Y>,
    /// With a second pass: hits and variance of the frame before.
    held: Option<Held<Y>>,
    /// Every bit is set where the last frame that was decided is active.
    active: Row<Y::Pixel>,
    /// The same as 1 or 0.
    active_bits: Row<u8>,
    any_active: bool,
    pub(crate) decision: Decision,
    pub(crate) forward: Forward<Y::Pixel>,
}

/// Hits, by place of the feature, and variance scores.
#[derive(Clone, Debug)]
struct Held<Y: Types> {
    hits: Vec<Row<Y::Count>>,
    variance: Row<Y::Sum>,
}

/// What the last window gives at a step: pixels and, by place of the feature, hits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepped<'a, T: Lane> {
    pub(crate) pixels: Pixels<'a, T>,
    pub(crate) hits: &'a [Row<T>],
}

/// The decision ports; 1 or 0 per lane.
#[derive(Clone, Debug)]
pub(crate) struct Decision {
    pub(crate) valid: bool,
    pub(crate) srs: Row<u8>,
    pub(crate) trs: Row<u8>,
    pub(crate) active: Row<u8>,
}

/// The forward ports.
#[derive(Clone, Debug)]
pub(crate) struct Forward<T: Lane> {
    /// 1 or 0 per lane.
    pub(crate) valid: Row<u8>,
    pub(crate) pixels: Row<T>,
    /// Whether any of it is not 0.
    shown: bool,
}

impl<Y: Types> Tail<Y> {
    pub(crate) fn new(plan: &Plan) -> Self {
        let counter = |&kind: &FeatureKind| row(if kind.has_window() { plan.lanes } else { 0 });
        let hits: Vec<_> = plan.features.iter().map(counter).collect();
        let moments = Moments::of(plan);
        let variances = moments.as_ref().map_or(0, |moments| moments.variance.len());
        let ports = || row(plan.lanes);
        Self {
            position: 0,
            done: false,
            store: Store::new(plan, keeps_sent(plan)),
            moments,
            temporal: TemporalScore::new(plan),
            held: plan.second_pass.then(|| Held { hits: hits.clone(), variance: row(variances) }),
            hits,
            active: row(plan.lanes),
            active_bits: row(plan.lanes),
            any_active: false,
            decision: Decision { valid: false, srs: ports(), trs: ports(), active: ports() },
            forward: Forward { valid: ports(), pixels: row(plan.lanes), shown: false },
        }
    }

    pub(crate) fn reset(&mut self) {
        self.position = 0;
        self.done = false;
        self.hits.iter_mut().for_each(|hits| hits.fill(Y::Count::default()));
        if let Some(moments) = &mut self.moments {
            moments.reset();
        }
        self.temporal.reset();
        if let Some(held) = &mut self.held {
            held.hits.iter_mut().for_each(|hits| hits.fill(Y::Count::default()));
            held.variance.fill(Y::Sum::default());
        }
        self.any_active = false;
        self.decision.clear();
        self.forward.clear();
    }

    /// One edge; the decision ports show afterwards what the thresholds make of it.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        plan: &Plan,
        step: Option<Stepped<'_, Y::Pixel>>,
        thresholds: &Thresholds,
    ) {
        if self.done {
            self.finish(plan, thresholds);
        }
        self.done = false;
        self.forward.clear();
        if let Some(step) = step {
            self.take(plan, step, thresholds);
        }
    }

    /// The edge that ends the clock of a decision: what was combinational becomes state.
    fn finish(&mut self, plan: &Plan, thresholds: &Thresholds) {
        self.decide(plan, thresholds);
        let Self { store, hits, moments, temporal, held, active, decision, .. } = self;
        let decided =
            decision.valid.then_some(Decided { srs: &decision.srs, active: &decision.active });
        temporal.finish(plan, decided);
        if let Some(held) = held {
            held.hits.clone_from(hits);
            if let Some(moments) = moments {
                held.variance.copy_from_slice(&moments.variance);
            }
        }
        hits.iter_mut().for_each(|hits| hits.fill(Y::Count::default()));
        if let Some(moments) = moments {
            moments.finish();
        }
        for (mask, bit) in active.iter_mut().zip(decision.active.iter()) {
            *mask = if *bit == 0 { Y::Pixel::default() } else { Y::Pixel::MAX };
        }
        self.active_bits.copy_from_slice(&decision.active);
        self.any_active = decision.active.iter().any(|&bit| bit != 0);
        if self.any_active {
            store.send_decided(active);
        }
    }

    /// A tail step.
    #[inline(always)]
    fn take(
        &mut self,
        plan: &Plan,
        Stepped { pixels, hits }: Stepped<'_, Y::Pixel>,
        thresholds: &Thresholds,
    ) {
        let position = self.position;
        let last = position + 1 == plan.pixels;
        if self.any_active {
            let leaving = self.store.leaving(position);
            self.forward.show(leaving, &self.active, &self.active_bits);
        }
        self.temporal.step(&self.store, position, pixels, thresholds.temporal_level);
        for ((counts, hits), kind) in self.hits.iter_mut().zip(hits).zip(&plan.features) {
            if kind.has_window() {
                add_hits::<Y>(counts, hits.blocks());
            }
        }
        if let Some(moments) = &mut self.moments {
            let before = self.temporal.has_previous.then(|| self.store.previous(position));
            moments.step(pixels.scored, before, last);
        }
        self.store.write(position, pixels);
        self.position = if last { 0 } else { position + 1 };
        self.done = last;
    }

    /// Puts the decision of this clock, if there is one, on the ports.
    pub(crate) fn decide(&mut self, plan: &Plan, thresholds: &Thresholds) {
        // With a second pass the first frame that is done only starts the second pass.
        if !self.done || (plan.second_pass && !self.temporal.has_previous) {
            return self.decision.clear();
        }
        let mut decision = std::mem::replace(&mut self.decision, Decision::nothing());
        let Decision { valid, srs, trs, active } = &mut decision;
        *valid = true;
        let all = plan.combine == Combine::All;
        srs.fill(u8::from(all));
        for (place, &minimum) in (0..plan.features.len()).zip(&thresholds.min_score) {
            self.vote(plan, place, minimum, active);
            for (srs, vote) in srs.iter_mut().zip(active.iter()) {
                *srs = if all { *srs & vote } else { *srs | vote };
            }
        }
        let minimum = Y::Count::minimum(thresholds.temporal_min_count.into());
        reach(self.temporal.shown(), minimum, trs);
        for ((active, srs), trs) in active.iter_mut().zip(srs.iter()).zip(trs.iter()) {
            *active = srs & trs;
        }
        self.decision = decision;
    }

    fn vote(&self, plan: &Plan, place: usize, minimum: u64, votes: &mut Row<u8>) {
        match self.scores(plan, place) {
            Scores::Counts(scores) => reach(scores, Y::Count::minimum(minimum), votes),
            Scores::Sums(scores) => reach(scores, Y::Sum::minimum(minimum), votes),
        }
    }

    /// What the score ports of the feature at `place` show.
    pub(crate) fn scores(&self, plan: &Plan, place: usize) -> Scores<'_, Y> {
        let kind = plan.features[place];
        if kind.has_window() {
            let held = self.held.as_ref().map(|held| &held.hits);
            return Scores::Counts(&held.unwrap_or(&self.hits)[place]);
        }
        let moments = self.moments.as_ref().expect("a feature that counts no hits has sums");
        Scores::Sums(moments.scores(kind, self.held.as_ref().map(|held| &held.variance)))
    }

    /// What the temporal count ports show.
    pub(crate) fn temporal_count(&self, lane: usize) -> u64 {
        self.temporal.shown()[lane].get()
    }
}

/// Score ports of either type.
pub(crate) enum Scores<'a, Y: Types> {
    Counts(&'a [Y::Count]),
    Sums(&'a [Y::Sum]),
}

impl<Y: Types> Scores<'_, Y> {
    pub(crate) fn get(&self, lane: usize) -> u64 {
        match self {
            Self::Counts(scores) => scores[lane].get(),
            Self::Sums(scores) => scores[lane].get(),
        }
    }
}

impl Decision {
    fn nothing() -> Self {
        Self { valid: false, srs: row(0), trs: row(0), active: row(0) }
    }

    fn clear(&mut self) {
        if self.valid {
            self.valid = false;
            [&mut self.srs, &mut self.trs, &mut self.active]
                .into_iter()
                .for_each(|row| row.fill(0));
        }
    }
}

impl<T: Lane> Forward<T> {
    fn clear(&mut self) {
        if self.shown {
            self.shown = false;
            self.valid.fill(0);
            self.pixels.fill(T::default());
        }
    }

    #[inline(always)]
    fn show(&mut self, leaving: &[Block<T>], active: &Row<T>, active_bits: &Row<u8>) {
        self.shown = true;
        let masks = active.blocks();
        for (at, out) in self.pixels.blocks_mut().iter_mut().enumerate() {
            for lane in 0..BLOCK {
                out[lane] = leaving[at][lane] & masks[at][lane];
            }
        }
        self.valid.copy_from_slice(active_bits);
    }
}
