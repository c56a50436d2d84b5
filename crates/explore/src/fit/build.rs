// SPDX-License-Identifier: MIT OR Apache-2.0
//! Builds looks: which arrays are possible, what each costs, and which is the cheapest.

use foveate_design::{
    Config, Design, FeatureKind, Filter, HardwareConfig, MemoryKind, Neighborhood, Organization,
    Reference,
};
use foveate_estimate::Device;

use super::FitRequest;
use super::constraints::{Held, all_hold, excess};
use super::looks::{Look, Search};
use super::rough::rough;
use crate::cost::Silicon;
use crate::row::real;
use crate::{ExploreError, Hooks};

/// If no look meets the limits, this many of the nearest ones are built anyway.
const NEAREST: usize = 6;
/// Designs that are synthesized before checking whether one meets the limits.
const BATCH: usize = 8;

/// A design that could be built.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) look: Look,
    pub(super) design: Design,
    pub(super) clocks_per_frame: u64,
    pub(super) frames_per_second: f64,
    pub(super) silicon: Silicon,
    /// All constraints.
    pub(super) held: Vec<Held>,
}

/// Everything that was built, the chosen one first.
pub(super) struct Built {
    candidates: Vec<Candidate>,
    /// Designs that were less promising, and were not synthesized.
    pub(super) left_out: usize,
}

impl Built {
    /// The cheapest that holds, else the nearest.
    pub(super) fn chosen(&self) -> &Candidate {
        &self.candidates[0]
    }

    pub(super) fn all(&self) -> &[Candidate] {
        &self.candidates
    }
}

impl Candidate {
    pub(super) fn holds(&self) -> bool {
        all_hold(&self.held)
    }

    pub(super) fn excess(&self) -> f64 {
        excess(&self.held)
    }

    /// The shares of the paper's device, added: LUTs, block RAM, DSP blocks, and a little for flip-flops,
    /// of which there are two for every LUT.
    pub(super) fn cost(&self) -> f64 {
        let (area, device) = (&self.silicon.array, Device::xcvu9p());
        let share = |used: u64, of: u64| real(used) / real(of);
        share(area.lut_total_packed, device.lut)
            + share(area.bram18, device.bram18)
            + share(area.dsp, device.dsp)
            + share(area.ff, device.ff) / 100.0
    }
}

/// Bounds on the ways to build a camera.
#[derive(Clone, Copy)]
struct Bounds {
    /// Clocks that a frame may take.
    max_clocks: Option<u64>,
    /// The kind of lane memory to build. If it is `None`, each design follows its own rule.
    memory: Option<MemoryKind>,
}

/// Builds what may be cheapest.
pub(super) fn build(
    search: &Search<'_>,
    request: &FitRequest<'_>,
    memory: Option<MemoryKind>,
    hooks: &dyn Hooks,
) -> Result<Built, ExploreError> {
    let holding: Vec<&Look> = search.all().filter(|look| look.holds()).collect();
    let looks = simplest(&holding);
    let max_clocks = request.constraints.min_fps.map(|fps| clocks(request.clock_hz, fps));
    let bounds = Bounds { max_clocks, memory };
    let (mut candidates, mut left_out) = in_batches(&looks, bounds, request.most, request, hooks)?;
    if !candidates.iter().any(Candidate::holds) {
        // The nearest that do not hold, and what would hold if it might be slower: for what binds.
        let mut others: Vec<&Look> = search.all().filter(|look| !look.holds()).collect();
        others.sort_by(|one, other| one.excess().total_cmp(&other.excess()));
        others.truncate(NEAREST);
        for (looks, bounds) in [(&others, bounds), (&looks, Bounds { max_clocks: None, memory })] {
            let most = request.most.min(BATCH);
            let (built, left) = in_batches(looks, bounds, most, request, hooks)?;
            candidates.extend(built);
            left_out += left;
        }
    }
    candidates.sort_by(|one, other| {
        let cost = one.cost().total_cmp(&other.cost());
        one.excess().total_cmp(&other.excess()).then(cost)
    });
    if candidates.is_empty() {
        return Err(ExploreError::NoPoints {
            settings: "all candidate cameras".to_owned(),
            reason: "none can be built".to_owned(),
        });
    }
    Ok(Built { candidates, left_out })
}

/// The simplest looks: those for which no simpler look meets the limits too.
fn simplest<'a>(looks: &[&'a Look]) -> Vec<&'a Look> {
    let simpler = |one: &Config, other: &Config| {
        let (one, other) = (complexity(one), complexity(other));
        one.0 == other.0
            && one != other
            && one.1.iter().zip(&other.1).all(|(one, other)| one <= other)
    };
    let beaten = |look: &Look| looks.iter().any(|other| simpler(&other.config, &look.config));
    let mut kept: Vec<&Look> = looks.iter().copied().filter(|look| !beaten(look)).collect();
    // Thresholds are inputs of the core: of looks that differ in nothing else that with fewest flips.
    kept.sort_by(|one, other| one.figures.action_flips.total_cmp(&other.figures.action_flips));
    let mut seen = Vec::new();
    kept.retain(|look| {
        let complexity = complexity(&look.config);
        let new = !seen.contains(&complexity);
        seen.push(complexity);
        new
    });
    kept
}

/// What cannot be compared, and what costs more the larger it is.
type Complexity = ((u32, Neighborhood, Vec<FeatureKind>), [u32; 4]);

fn complexity(config: &Config) -> Complexity {
    let features = config.spatial.iter().map(|entry| entry.feature).collect();
    let fraction = config.spatial.iter().filter_map(|entry| entry.mean_fraction_bits).sum();
    let ordered = [
        config.frame.pixel_bits,
        u32::from(config.denoise.filter != Filter::None),
        u32::from(config.temporal.reference != Reference::Previous),
        fraction,
    ];
    ((config.region.size, config.region.neighborhood, features), ordered)
}

/// Builds the designs of some looks, the promising ones first, until one holds or there are `most`; says
/// how many are left.
fn in_batches(
    looks: &[&Look],
    bounds: Bounds,
    most: usize,
    request: &FitRequest<'_>,
    hooks: &dyn Hooks,
) -> Result<(Vec<Candidate>, usize), ExploreError> {
    let mut designs: Vec<(&Look, Design)> = Vec::new();
    for look in looks {
        let ways = ways(&look.config, request.task, bounds);
        designs.extend(ways.into_iter().map(|design| (*look, design)));
    }
    designs.sort_by(|(_, one), (_, other)| rough(one).total_cmp(&rough(other)));
    let all = designs.len();
    let mut built = Vec::new();
    for batch in designs[..all.min(most)].chunks(BATCH) {
        built.extend(synthesize(batch, request, hooks)?);
        if built.iter().any(Candidate::holds) {
            break;
        }
    }
    let left_out = all - built.len();
    Ok((built, left_out))
}

/// Builds designs.
fn synthesize(
    designs: &[(&Look, Design)],
    request: &FitRequest<'_>,
    hooks: &dyn Hooks,
) -> Result<Vec<Candidate>, ExploreError> {
    let designs_alone = designs.iter().map(|(_, design)| design);
    let areas = request.synthesizer.areas(designs_alone, hooks)?.all()?;
    let candidate = |((look, design), silicon): (&(&Look, Design), Silicon)| {
        let clocks_per_frame = design.timing().clocks_per_frame();
        let frames_per_second = real(request.clock_hz) / real(clocks_per_frame.max(1));
        let mut held = look.held.clone();
        held.extend(request.constraints.on_speed(frames_per_second));
        held.extend(request.constraints.on_silicon(&silicon));
        let (look, design) = ((*look).clone(), design.clone());
        Candidate { look, design, clocks_per_frame, frames_per_second, silicon, held }
    };
    Ok(designs.iter().zip(areas).map(candidate).collect())
}

/// The most clocks per frame that reach this many frames per second.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "positive and below 2^53"
)]
fn clocks(clock_hz: u64, fps: f64) -> u64 {
    (real(clock_hz) / fps.max(1e-9)).floor() as u64
}

/// Ways to build a camera. If regions may share a unit, these are, for each feed, the deepest fold that is
/// fast enough and its halvings, because fewer units are not always smaller in total. If no fold is fast
/// enough, these are the organizations in which regions do not share a unit.
fn ways(look: &Config, task: &Config, bounds: Bounds) -> Vec<Design> {
    let Bounds { max_clocks, memory } = bounds;
    let with = |organization: Organization, feed| {
        let mut config = look.clone();
        config.hardware = HardwareConfig {
            organization,
            feed,
            memory: memory.filter(|kind| organization.memories().contains(kind)),
            thresholds: task.hardware.thresholds,
            ..HardwareConfig::default()
        };
        config.validate().ok()
    };
    let (folding, others): (Vec<_>, Vec<_>) = Organization::ALL.iter().partition(|o| o.folds());
    let mut found = Vec::new();
    let fed = |&organization: &Organization| {
        organization.feeds().iter().filter_map(move |&feed| with(organization, Some(feed)))
    };
    for single in folding.into_iter().flat_map(fed) {
        let fold = max_clocks.map_or(Some(single.regions()), |clocks| single.largest_fold(clocks));
        let Some(deepest) = fold.and_then(|fold| single.with_fold(fold).ok()) else { continue };
        let halvings = 0..=deepest.fold().max(1).ilog2();
        found.extend(
            halvings.filter_map(|halving| single.with_fold(deepest.fold() >> halving).ok()),
        );
    }
    if found.is_empty() {
        found.extend(others.into_iter().filter_map(|&organization| with(organization, None)));
    }
    found
}
