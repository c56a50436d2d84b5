// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine for one width of lanes: the planes between frames, and their division among workers.

use std::ops::Range;

use foveate_spec::Reference;

use crate::change;
use crate::outcome::{Outcome, split_off};
use crate::pixels::Pixels;
use crate::plan::Plan;
use crate::policy::{Policy, SAMPLE, Step};
use crate::scratch::Scratch;
use crate::strip::{Look, Skipped, Strip};
use crate::workers::Workers;
use foveate_lanes::Aligned;
use foveate_lanes::Lane;

/// The state between frames.
#[derive(Debug)]
pub(crate) struct Core<T: Lane> {
    plan: Plan<T>,
    denoised: Aligned<T>,
    reference: Aligned<T>,
    pub(crate) screen: Vec<T>,
    valid: Vec<bool>,
    black: Vec<bool>,
    settled: Vec<bool>,
    /// The last frame, without padding, while the policy wants it.
    copy: Vec<T>,
    changed: Vec<bool>,
    policy: Policy,
    skip: bool,
    /// By strip.
    scratch: Vec<(Scratch<T>, Skipped)>,
}

impl<T: Lane> Core<T> {
    pub(crate) fn new(plan: Plan<T>, skip: bool, workers: &Workers) -> Self {
        let plane = plan.stride() * plan.rows * plan.side;
        let reference = match plan.reference {
            Reference::Previous => 0,
            Reference::LastSent => plane,
        };
        let scratch = Scratch::new(&plan);
        Self {
            denoised: Aligned::new(plane),
            reference: Aligned::new(reference),
            screen: vec![T::default(); plan.width * plan.height],
            valid: vec![false; plan.regions()],
            black: vec![true; plan.regions()],
            settled: vec![false; plan.rows],
            copy: vec![T::default(); if skip { plan.width * plan.height } else { 0 }],
            changed: vec![true; plan.regions()],
            policy: Policy::new(skip),
            skip,
            scratch: vec![(scratch, Skipped::default()); workers.strips(plan.rows, plane)],
            plan,
        }
    }

    pub(crate) fn reset(&mut self) {
        self.valid.fill(false);
        self.black.fill(true);
        self.settled.fill(false);
        self.screen.fill(T::default());
        self.policy = Policy::new(self.skip);
    }

    /// Takes the next frame.
    pub(crate) fn step(&mut self, raw: Pixels<'_, T>, workers: &Workers, outcome: &mut Outcome) {
        let step = self.policy.next();
        if step != Step::Rest {
            self.look(raw, workers, step);
        }
        if step == Step::Judge {
            let (saved, blocks) = self.sample();
            if self.policy.judge(saved, blocks) {
                self.look(raw, workers, Step::Keep);
            }
        }
        self.compute(raw, workers, step == Step::Compare, outcome);
        let mut all = Skipped::default();
        self.scratch.iter().for_each(|(_, skipped)| all += *skipped);
        outcome.skipped = all.regions;
        if step == Step::Compare {
            self.policy.saved(all.blocks, self.plan.blocks * self.plan.rows);
        }
    }

    /// Blocks of the sample that would be saved, of how many.
    fn sample(&self) -> (usize, usize) {
        let plan = &self.plan;
        let (mut saved, mut blocks, mut runs) = (0, 0, Vec::new());
        for changed in self.changed.chunks_exact(plan.columns).step_by(SAMPLE) {
            change::runs(plan, changed, &mut runs);
            saved += plan.blocks - runs.iter().map(Range::len).sum::<usize>();
            blocks += plan.blocks;
        }
        (saved, blocks)
    }

    fn look(&mut self, raw: Pixels<'_, T>, workers: &Workers, step: Step) {
        let plan = &self.plan;
        let share = plan.rows.div_ceil(self.scratch.len());
        let (mut copy, mut changed) = (&mut self.copy[..], &mut self.changed[..]);
        let looks = (0..plan.rows).step_by(share).map(|first| Look {
            plan,
            raw,
            bands: first..(first + share).min(plan.rows),
            step,
            copy: split_off(&mut copy, share * plan.side * plan.width),
            changed: split_off(&mut changed, share * plan.columns),
        });
        workers.run(looks);
    }

    fn compute(
        &mut self,
        raw: Pixels<'_, T>,
        workers: &Workers,
        compared: bool,
        outcome: &mut Outcome,
    ) {
        let plan = &self.plan;
        let changed = compared.then_some(&self.changed[..]);
        let share = plan.rows.div_ceil(self.scratch.len());
        let rows = share * plan.side;
        let (mut denoised, mut reference) = (&mut self.denoised[..], &mut self.reference[..]);
        let (mut valid, mut black) = (&mut self.valid[..], &mut self.black[..]);
        let mut settled = &mut self.settled[..];
        let (mut screen, mut results) = (&mut self.screen[..], outcome.results());
        let firsts = (0..plan.rows).step_by(share);
        let strips = firsts.zip(&mut self.scratch).map(|(first, (scratch, skipped))| {
            let bands = first..(first + share).min(plan.rows);
            let regions = bands.len() * plan.columns;
            Strip {
                plan,
                raw,
                bands,
                denoised: split_off(&mut denoised, rows * plan.stride()),
                reference: split_off(&mut reference, rows * plan.stride()),
                screen: split_off(&mut screen, rows * plan.width),
                valid: split_off(&mut valid, regions),
                black: split_off(&mut black, regions),
                settled: split_off(&mut settled, share),
                results: results.split_off(regions),
                scratch,
                changed,
                skipped,
            }
        });
        workers.run(strips);
    }
}
