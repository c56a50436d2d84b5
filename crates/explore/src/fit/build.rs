// SPDX-License-Identifier: MIT OR Apache-2.0
//! The designs that build the cameras of the search: the possible arrays, their costs, and the
//! cheapest of them.

use foveate_camera::Irrelevant;
use foveate_design::{
    CameraConfig, Config, Design, FeatureKind, Feed, Filter, HardwareConfig, MemoryKind,
    Neighborhood, Organization, Reference,
};
use foveate_estimate::{Device, Speed};

use super::FitRequest;
use super::constraints::{Held, all_hold, excess};
use super::looks::{Look, Search};
use super::network::Cheapest;
use super::plan::{expected, max_clocks, slower};
use super::rough::rough;
use crate::cost::{Silicon, Synthesized};
use crate::row::{bytes_per_frame, real};
use crate::{ExploreError, Hooks};

/// The number of nearest cameras that are built if no camera meets the limits.
const NEAREST: usize = 6;
/// The number of designs that are synthesized before checking whether one meets the limits.
const BATCH: usize = 8;
/// The most designs that are folded again for their own clocks.
const SLOWER: usize = 4;

/// A synthesized design.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) look: Look,
    pub(super) design: Design,
    pub(super) clocks_per_frame: u64,
    /// The speed at the clock of the request, or else at the estimated clock.
    pub(super) speed: Option<Speed>,
    pub(super) silicon: Silicon,
    /// All constraints, with the figures of this design.
    pub(super) held: Vec<Held>,
}

/// All synthesized designs, the chosen one first.
pub(super) struct Built {
    candidates: Vec<Candidate>,
    /// The number of designs that were not synthesized because they were less promising.
    pub(super) left_out: usize,
}

impl Built {
    /// Returns the cheapest design that meets all limits, or else the nearest one.
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

    /// Returns the cost of the array, as a share of the device.
    pub(super) fn cost(&self) -> f64 {
        Device::xcvu9p().cost(&self.silicon.array)
    }
}

/// The bounds on the ways to build a camera.
#[derive(Clone, Copy)]
struct Bounds {
    /// The most clocks that a frame may take.
    max_clocks: Option<u64>,
    /// Whether the bound comes from a planned clock, so that a design with a faster clock may take
    /// more clocks.
    planned: bool,
    /// The kind of lane memory to build. If it is `None`, each design follows its own rule.
    memory: Option<MemoryKind>,
}

/// Builds the designs that may be the cheapest.
pub(super) fn build(
    search: &Search<'_>,
    request: &FitRequest<'_>,
    memory: Option<MemoryKind>,
    hooks: &dyn Hooks,
) -> Result<Built, ExploreError> {
    let holding: Vec<&Look> = search.all().filter(|look| look.holds()).collect();
    let looks = match request.network.map(|goal| goal.cheapest) {
        None | Some(Cheapest::Area) => simplest(&holding),
        // All designs of a camera send the same bytes.
        Some(Cheapest::Bytes) => fewest_bytes(&holding)?,
    };
    let bounds =
        Bounds { max_clocks: max_clocks(request), planned: request.clock_hz.is_none(), memory };
    let (mut candidates, mut left_out) = in_batches(&looks, bounds, request.most, request, hooks)?;
    make_slower(&mut candidates, request, hooks)?;
    if !candidates.iter().any(Candidate::holds) {
        // Nothing meets the limits. The nearest cameras are built, and those that would meet the
        // limits at a lower speed, to find the binding limits.
        let mut others: Vec<&Look> = search.all().filter(|look| !look.holds()).collect();
        others.sort_by(|one, other| one.excess().total_cmp(&other.excess()));
        others.truncate(NEAREST);
        for (looks, bounds) in [(&others, bounds), (&looks, Bounds { max_clocks: None, ..bounds })]
        {
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

/// Looks for cheaper designs among those that meet the limits: it folds them again for their own
/// clock, which is faster than the planned one, or halves their pixels per clock. A design is
/// synthesized if it is expected to be cheaper than the cheapest so far, the most promising first.
fn make_slower(
    candidates: &mut Vec<Candidate>,
    request: &FitRequest<'_>,
    hooks: &dyn Hooks,
) -> Result<(), ExploreError> {
    let Some(min_fps) = request.constraints.min_fps else { return Ok(()) };
    let most = request.most.min(candidates.len() + SLOWER);
    while candidates.len() < most {
        let holding = || candidates.iter().filter(|candidate| candidate.holds());
        let Some(least) = holding().map(Candidate::cost).min_by(f64::total_cmp) else { break };
        let is_new = |design: &Design| candidates.iter().all(|tried| tried.design != *design);
        let slower = holding().flat_map(|candidate| {
            let speed = candidate.speed.as_ref();
            let slower = speed.map(|speed| slower(&candidate.design, speed, min_fps));
            let expected = |design| {
                let cost = expected(&design, &candidate.silicon);
                (cost, &candidate.look, design)
            };
            slower.unwrap_or_default().into_iter().filter(is_new).map(expected)
        });
        let promising = slower.filter(|(cost, ..)| *cost < least);
        let best = promising.min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((_, look, design)) = best else { break };
        let look = look.clone();
        candidates.extend(synthesize(&[(&look, design)], request, hooks)?);
    }
    Ok(())
}

/// Returns the cameras that send the fewest bytes.
fn fewest_bytes<'a>(looks: &[&'a Look]) -> Result<Vec<&'a Look>, ExploreError> {
    let bytes =
        |look: &&'a Look| Ok((bytes_per_frame(&look.config.validate()?, &look.figures), *look));
    let sent = looks.iter().map(bytes).collect::<Result<Vec<_>, ExploreError>>()?;
    let least = sent.iter().map(|(bytes, _)| *bytes).fold(f64::INFINITY, f64::min);
    Ok(sent.into_iter().filter(|(bytes, _)| *bytes <= least).map(|(_, look)| look).collect())
}

/// Returns roughly the least share of the device that a camera takes, however it is built; infinite
/// if it cannot be built.
pub(super) fn cheapest_rough(look: &CameraConfig, asked: &HardwareConfig) -> f64 {
    let bounds = Bounds { max_clocks: None, planned: true, memory: None };
    let ways = ways(look, asked, bounds);
    ways.iter().map(rough).fold(f64::INFINITY, f64::min)
}

/// Returns the simplest cameras: those for which no simpler camera also meets the limits.
fn simplest<'a>(looks: &[&'a Look]) -> Vec<&'a Look> {
    let simpler = |one: &CameraConfig, other: &CameraConfig| {
        let (one, other) = (complexity(one), complexity(other));
        one.0 == other.0
            && one != other
            && one.1.iter().zip(&other.1).all(|(one, other)| one <= other)
    };
    let beaten = |look: &Look| looks.iter().any(|other| simpler(&other.config, &look.config));
    let mut kept: Vec<&Look> = looks.iter().copied().filter(|look| !beaten(look)).collect();
    // Thresholds are inputs of the core and cost nothing. Of cameras that differ only in
    // thresholds, the one with the fewest flips is kept.
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

/// The complexity of a camera: the settings that cannot be ordered, and those that cost more the
/// larger they are.
type Complexity = ((u32, Neighborhood, Vec<FeatureKind>, Irrelevant, Option<u32>), [u32; 4]);

fn complexity(config: &CameraConfig) -> Complexity {
    let features = config.spatial.iter().map(|entry| entry.feature).collect();
    let fraction = config.spatial.iter().filter_map(|entry| entry.mean_fraction_bits).sum();
    let filter = match config.denoise.filter {
        Filter::None => 0,
        Filter::Median3x3 => 1,
    };
    let reference = match config.temporal.reference {
        Reference::Previous => 0,
        Reference::LastSent => 1,
    };
    let ordered = [config.frame.pixel_bits, filter, reference, fraction];
    let (region, shown) = (&config.region, config.render.irrelevant);
    ((region.size, region.neighborhood, features, shown, config.periphery.blocks), ordered)
}

/// Synthesizes the designs of some cameras, the promising ones first, until one meets the limits or
/// there are `most` of them. Returns the number of designs that are left out.
fn in_batches(
    looks: &[&Look],
    bounds: Bounds,
    most: usize,
    request: &FitRequest<'_>,
    hooks: &dyn Hooks,
) -> Result<(Vec<Candidate>, usize), ExploreError> {
    let mut designs: Vec<(&Look, Design)> = Vec::new();
    for look in looks {
        let ways = ways(&look.config, &request.task.hardware, bounds);
        designs.extend(ways.into_iter().map(|design| (*look, design)));
    }
    in_turn(&mut designs);
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

/// Sorts designs by their rough cost, and takes the organizations in turn. A limit on a unit may
/// exclude one organization, and the others must not wait behind all its designs.
fn in_turn(designs: &mut Vec<(&Look, Design)>) {
    designs.sort_by(|(_, one), (_, other)| rough(one).total_cmp(&rough(other)));
    let mut turns = [0; Organization::ALL.len()];
    let turn = |(look, design): (_, Design)| {
        let number = design.organization() as usize;
        turns[number] += 1;
        (turns[number], (look, design))
    };
    let mut turned: Vec<_> = designs.drain(..).map(turn).collect();
    turned.sort_by_key(|(turn, _)| *turn);
    designs.extend(turned.into_iter().map(|(_, design)| design));
}

/// Synthesizes designs.
fn synthesize(
    designs: &[(&Look, Design)],
    request: &FitRequest<'_>,
    hooks: &dyn Hooks,
) -> Result<Vec<Candidate>, ExploreError> {
    let designs_alone = designs.iter().map(|(_, design)| design);
    let found = request.synthesizer.areas(designs_alone, hooks)?.all()?;
    let candidate = |((look, design), synthesized): (&(&Look, Design), Synthesized)| {
        let Synthesized { silicon, speed: estimated } = synthesized;
        let clocks_per_frame = design.timing().clocks_per_frame();
        let given = request.clock_hz.map(|hertz| Speed::given(real(hertz) / 1e6, clocks_per_frame));
        let speed = given.or(estimated);
        let mut held = look.held.clone();
        held.extend(request.constraints.on_speed(speed.as_ref()));
        held.extend(request.constraints.on_silicon(&silicon));
        let (look, design) = ((*look).clone(), design.clone());
        Candidate { look, design, clocks_per_frame, speed, silicon, held }
    };
    Ok(designs.iter().zip(found).map(candidate).collect())
}

/// Returns the ways to build a camera. For each feed of a serial array these are the folds that are
/// fast enough and may be the cheapest, and halvings of the deepest fold, because only a synthesis
/// shows which one is the cheapest. If no fold is fast enough, the pipelined array is a way, and at
/// a planned clock also fold 1. A raster core has the fewest pixels per clock that are fast enough;
/// at a planned clock it has the most, if none is fast enough.
fn ways(look: &CameraConfig, asked: &HardwareConfig, bounds: Bounds) -> Vec<Design> {
    let (arrays, is_fast) = serial_arrays(look, asked, bounds);
    let of = |organization| match organization {
        Organization::Serial => arrays.clone(),
        Organization::Pipelined if is_fast => Vec::new(),
        Organization::Pipelined => {
            let array = way(look, asked, organization, &HardwareConfig::default());
            array.into_iter().collect()
        }
        Organization::Raster => {
            let core = |pixels| {
                let pixels_per_clock = Some(pixels);
                let own = HardwareConfig { pixels_per_clock, ..HardwareConfig::default() };
                way(look, asked, organization, &own)
            };
            let cores = [1, 2, 4].into_iter().filter_map(core).collect();
            fewest_words(cores, bounds).into_iter().collect()
        }
    };
    Organization::ALL.iter().flat_map(|&organization| of(organization)).collect()
}

/// Returns a design of that organization; `None` if it is not valid.
fn way(
    look: &CameraConfig,
    asked: &HardwareConfig,
    organization: Organization,
    own: &HardwareConfig,
) -> Option<Design> {
    let (thresholds, sync, interface) = (asked.thresholds, asked.sync, asked.interface);
    let hardware = HardwareConfig { organization, thresholds, sync, interface, ..*own };
    Config { camera: look.clone(), hardware }.validate().ok()
}

/// Returns the serial arrays of every feed, and whether one is fast enough.
fn serial_arrays(
    look: &CameraConfig,
    asked: &HardwareConfig,
    bounds: Bounds,
) -> (Vec<Design>, bool) {
    let (mut found, mut is_fast) = (Vec::new(), false);
    let fed = |&feed| {
        let (feed, memory) = (Some(feed), bounds.memory);
        let own = HardwareConfig { feed, memory, ..HardwareConfig::default() };
        way(look, asked, Organization::Serial, &own)
    };
    for single in Feed::ALL.iter().filter_map(fed) {
        let (folds, enough) = folded(&single, bounds);
        is_fast |= enough;
        found.extend(folds);
    }
    (found, is_fast)
}

/// Returns the folds of a serial array, and whether one is fast enough.
fn folded(single: &Design, bounds: Bounds) -> (Vec<Design>, bool) {
    let folds = single.frugal_folds(bounds.max_clocks.unwrap_or(u64::MAX));
    let is_fast = !folds.is_empty();
    let folds = if folds.is_empty() && bounds.planned { vec![1] } else { folds };
    let deepest = folds.first().map_or(0, |deepest| deepest / 2);
    let halvings = std::iter::successors(Some(deepest), |fold| Some(fold / 2));
    let halvings = halvings.take_while(|fold| *fold > 0).filter(|fold| !folds.contains(fold));
    let all = folds.iter().copied().chain(halvings);
    (all.filter_map(|fold| single.with_fold(fold).ok()).collect(), is_fast)
}

/// Returns the first raster core that is fast enough; `cores` have rising numbers of pixels per
/// clock.
fn fewest_words(cores: Vec<Design>, Bounds { max_clocks, planned, .. }: Bounds) -> Option<Design> {
    let is_fast = |design: &Design| {
        max_clocks.is_none_or(|clocks| design.timing().clocks_per_frame() <= clocks)
    };
    let most = cores.last().filter(|_| planned).cloned();
    cores.into_iter().find(is_fast).or(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the pixels per clock of the raster designs among the ways to build a camera of 64x48
    /// pixels, and whether one way is pipelined.
    fn words(max_clocks: u64, planned: bool) -> (Vec<u32>, bool) {
        let look = Config::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap();
        let bounds = Bounds { max_clocks: Some(max_clocks), planned, memory: None };
        let ways = ways(&look.camera, &look.hardware, bounds);
        let of = |organization| ways.iter().filter(move |d| d.organization() == organization);
        let words =
            of(Organization::Raster).map(|d| d.raster().unwrap().pixels_per_clock()).collect();
        (words, of(Organization::Pipelined).next().is_some())
    }

    /// There are 784 regions. At most 17 regions per lane are fast enough; 16 and 8 take fewer
    /// block RAMs.
    #[test]
    fn lanes_share_as_many_regions_as_may_be_cheapest_and_halvings_of_the_most() {
        let look = Config::from_toml("").unwrap();
        let bounds = Bounds { max_clocks: Some(210_623), planned: true, memory: None };
        let ways = ways(&look.camera, &look.hardware, bounds);
        let arrays = ways.iter().filter_map(Design::serial);
        let folds = arrays.filter(|array| array.feed() == Feed::Raster).map(|array| array.fold());
        assert_eq!(folds.collect::<Vec<_>>(), [17, 16, 8, 4, 2, 1]);
    }

    /// The 3,072 pixels take 3,072, 1,536 or 768 clocks, and some more between frames.
    #[test]
    fn a_raster_core_has_the_fewest_pixels_per_clock_that_are_fast_enough() {
        assert_eq!(words(1_000_000, false), (vec![1], false));
        assert_eq!(words(3_072, false), (vec![2], true));
        assert_eq!(words(1_536, false), (vec![4], true));
        assert_eq!(words(64, false), (vec![], true));
        assert_eq!(words(64, true), (vec![4], true));
    }
}
