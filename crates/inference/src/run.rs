// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run under way: what every frame did, and the sums.

use crate::camera::Seen;
use crate::charts::Counted;
use crate::cost::Costs;
use crate::player::Player;
use crate::summary::{Summary, Tuning, error, layers, macs, mask_bytes, ratio};
use crate::tally::{NotFinite, Positions, Reference};
use crate::traffic::Traffic;
use crate::{Goal, Mapping, Recorded};
use foveate_design::Design;
use foveate_network::{Executor, Network};
use foveate_tables::{Cell, Cells, Table};
use std::time::Instant;

/// What a summary says that no frame says.
pub(crate) struct Told {
    pub(crate) mode: String,
    /// What the accelerator is called.
    pub(crate) accelerator: Option<String>,
    /// With its goal.
    pub(crate) tuning: Option<(Tuning, Goal)>,
    pub(crate) problem: Option<String>,
    pub(crate) network: String,
    pub(crate) inputs: Vec<String>,
    pub(crate) mapping: Mapping,
    /// Files of the outputs.
    pub(crate) outputs: Vec<Recorded>,
}

/// A run at its end.
pub(crate) struct Ended {
    pub(crate) summary: Summary,
    /// A row per frame.
    pub(crate) frames: Table,
    pub(crate) counted: Vec<Counted>,
}

/// A run under way.
pub(crate) struct Run<'a> {
    design: &'a Design,
    network: &'a Network,
    player: Player<'a>,
    reference: Option<Reference<'a>>,
    costs: Option<Costs<'a>>,
    sums: Vec<Positions>,
    traffic: Vec<Traffic>,
    rows: Vec<Cells>,
    counted: Vec<Counted>,
    active: u64,
    changed: u64,
    seconds: f64,
    overhead: f64,
    not_finite: NotFinite,
}

impl<'a> Run<'a> {
    pub(crate) fn new(
        design: &'a Design,
        network: &'a Network,
        player: Player<'a>,
        reference: bool,
        costs: Option<Costs<'a>>,
    ) -> Self {
        Self {
            design,
            network,
            player,
            reference: reference.then(|| Reference::new(network)),
            costs,
            sums: vec![Positions::default(); network.nodes().len()],
            traffic: vec![Traffic::default(); network.nodes().len()],
            rows: Vec::new(),
            counted: Vec::new(),
            active: 0,
            changed: 0,
            seconds: 0.0,
            overhead: 0.0,
            not_finite: NotFinite::default(),
        }
    }

    pub(crate) fn step(&mut self, seen: Seen<'_>) {
        let start = Instant::now();
        let work = self.player.step(seen).to_vec();
        let seconds = start.elapsed().as_secs_f64();
        self.not_finite.look(seen.number, self.network, self.player.executor());
        let is_counted = self.player.is_counted();
        let judge = |reference: &mut Reference<'_>| {
            reference.judge(seen.values, self.player.executor(), is_counted)
        };
        let close = self.reference.as_mut().map(judge);
        let mut own = vec![Positions::default(); work.len()];
        let mut traffic = Traffic::default();
        for (node, work) in work.iter().enumerate() {
            let places = self.network.form(node + 1).places();
            own[node].add(work, places);
            let moved = Traffic::of(self.network, self.player.executor(), node);
            traffic += moved;
            if is_counted {
                self.sums[node].add(work, places);
                self.traffic[node] += moved;
            }
        }
        if is_counted {
            self.active += seen.active_regions;
            self.changed += seen.changed_regions;
            self.seconds += seconds;
            if let Some(costs) = &mut self.costs {
                costs.add(self.player.executor());
            }
            self.overhead += self.player.executor().overhead().as_secs_f64();
        }
        let (macs, traffic) = (macs(self.network, &own), traffic.mean(1));
        let share = |count| ratio(count, u64::from(self.design.regions()));
        let real = |value: f64| Cell::Real(Some(value));
        if is_counted {
            self.counted.push(Counted {
                number: seen.number,
                name: seen.name.to_owned(),
                active: share(seen.active_regions),
                changed: share(seen.changed_regions),
                macs,
                seconds,
                relative_rms: close.as_ref().map(|close| close.distance.relative()),
            });
        }
        self.rows.push(
            [
                ("frame", Cell::Count(Some(seen.number))),
                ("name", Cell::Text(seen.name.to_owned())),
                ("t_us", Cell::Count(Some(seen.time_us))),
                ("active_share", real(share(seen.active_regions))),
                ("changed_share", real(share(seen.changed_regions))),
                ("macs_dense", real(macs.dense)),
                ("macs_needed", real(macs.needed)),
                ("macs_scheduled", real(macs.scheduled)),
                ("read_bytes", real(traffic.read_bytes)),
                ("halo_bytes", real(traffic.halo_bytes)),
                ("written_bytes", real(traffic.written_bytes)),
                ("seconds", real(seconds)),
                ("relative_rms", Cell::Real(close.map(|close| close.distance.relative()))),
            ]
            .map(|(name, cell)| (name.to_owned(), cell))
            .into(),
        );
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        self.player.executor()
    }

    /// What is to be written.
    pub(crate) fn end(self, told: Told) -> Ended {
        let executor = self.player.executor();
        let counted_frames = self.counted.len() as u64;
        let traffic: Vec<_> = self.traffic.iter().map(|sum| sum.mean(counted_frames)).collect();
        let layers = layers(
            self.network,
            (&self.sums, &traffic),
            executor,
            self.reference.as_ref(),
            self.costs.as_ref(),
        );
        let mut all = Traffic::default();
        self.traffic.iter().for_each(|sum| all += *sum);
        let counted_regions = counted_frames * u64::from(self.design.regions());
        let forms = || (0..=self.network.nodes().len()).map(|value| self.network.form(value));
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let counted = counted_frames.max(1) as f64;
        let of_weights = self.network.not_finite().iter().map(|(name, count)| {
            format!(
                "the weights `{name}` hold {count} infinite values, or such that are no numbers"
            )
        });
        let warnings = of_weights.chain(self.not_finite.warning(self.network)).collect();
        let summary = Summary {
            format_version: 1,
            foveate_version: env!("CARGO_PKG_VERSION"),
            complete: told.problem.is_none(),
            problem: told.problem,
            warnings,
            inputs: told.inputs,
            network: told.network,
            mode: told.mode,
            mapping: told.mapping,
            width: self.design.width(),
            height: self.design.height(),
            frames: self.rows.len() as u64,
            counted_frames,
            active_share: ratio(self.active, counted_regions),
            changed_share: ratio(self.changed, counted_regions),
            macs: macs(self.network, &self.sums),
            weight_bytes: layers.iter().map(|layer| layer.weight_bytes).sum(),
            kept_bytes: self.network.kept_bytes(),
            mask_bytes: forms().map(mask_bytes).sum(),
            traffic: all.mean(counted_frames),
            seconds_per_frame: self.seconds / counted,
            overhead_seconds_per_frame: self.overhead / counted,
            accelerator: self
                .costs
                .as_ref()
                .zip(told.accelerator)
                .map(|(costs, name)| costs.summary(&name)),
            error: self.reference.as_ref().map(error),
            tuning: told.tuning.map(|(tuning, goal)| {
                let reference = self.reference.as_ref().expect("what is tuned is compared");
                Tuning { holds: goal.holds(&reference.outputs), ..tuning }
            }),
            outputs: told.outputs,
            layers,
        };
        Ended { summary, frames: Table::of(self.rows.into_iter()), counted: self.counted }
    }
}
