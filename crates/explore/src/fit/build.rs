// SPDX-License-Identifier: MIT OR Apache-2.0
//! The designs that build the cameras of the search: the possible arrays, their costs, and the
//! cheapest of them.

use foveate_camera::IrrelevantRendering;
use foveate_design::{
    CameraConfig, DenoiseFilter, Design, DesignConfig, FeatureKind, HardwareConfig, LaneMemoryKind,
    Neighborhood, Organization, OrganizationConfig, PixelFeed, RasterConfig, ReferencePolicy,
    SerialConfig,
};
use foveate_estimate::{FpgaDevice, FrameRate};
use foveate_playback::RunHooks;

use super::FitRequest;
use super::constraints::{ConstraintCheck, all_met, total_excess};
use super::network::CostObjective;
use super::plan::{expected_cost, max_clocks, slower_designs};
use super::rough_cost::rough_cost;
use super::search::{CameraSearch, ExaminedCamera};
use crate::ExploreError;
use crate::cost::{DesignArea, SynthesisResult};
use crate::row::{bytes_per_frame, count_to_f64};

/// The number of nearest cameras that are built if no camera meets the limits.
const MAX_NEAREST_CAMERAS: usize = 6;
/// The number of designs that are synthesized before checking whether one meets the limits.
const BATCH_SIZE: usize = 8;
/// The most designs that are folded again for their own clocks.
const MAX_SLOWER_DESIGNS: usize = 4;

/// A synthesized design.
#[derive(Clone, Debug)]
pub(super) struct SynthesizedDesign {
    pub(super) look: ExaminedCamera,
    pub(super) design: Design,
    pub(super) clocks_per_frame: u64,
    /// The speed at the clock of the request, or else at the estimated clock.
    pub(super) speed: Option<FrameRate>,
    pub(super) silicon: DesignArea,
    /// All constraints, with the figures of this design.
    pub(super) checks: Vec<ConstraintCheck>,
}

/// All synthesized designs, the chosen one first.
pub(super) struct SynthesizedDesigns {
    candidates: Vec<SynthesizedDesign>,
    /// The number of designs that were not synthesized because they were less promising.
    pub(super) left_out_designs: usize,
}

impl SynthesizedDesigns {
    /// Returns the cheapest design that meets all limits, or else the nearest one.
    pub(super) fn chosen(&self) -> &SynthesizedDesign {
        &self.candidates[0]
    }

    pub(super) fn designs(&self) -> &[SynthesizedDesign] {
        &self.candidates
    }
}

impl SynthesizedDesign {
    pub(super) fn meets_limits(&self) -> bool {
        all_met(&self.checks)
    }

    pub(super) fn excess(&self) -> f64 {
        total_excess(&self.checks)
    }

    /// Returns the cost of the array, as a share of the device.
    pub(super) fn cost(&self) -> f64 {
        FpgaDevice::xcvu9p().cost(&self.silicon.array)
    }
}

/// The bounds on the ways to build a camera.
#[derive(Clone, Copy)]
struct BuildBounds {
    /// The most clocks that a frame may take.
    max_clocks: Option<u64>,
    /// True if the bound comes from a planned clock, so that a design with a faster clock may take
    /// more clocks.
    is_planned: bool,
    /// The kind of lane memory to build. If it is `None`, each design follows its own rule.
    memory: Option<LaneMemoryKind>,
}

/// Builds the designs that may be the cheapest.
pub(super) fn build_designs(
    search: &CameraSearch<'_>,
    request: &FitRequest<'_>,
    memory: Option<LaneMemoryKind>,
    hooks: &dyn RunHooks,
) -> Result<SynthesizedDesigns, ExploreError> {
    let holding: Vec<&ExaminedCamera> = search.all().filter(|look| look.meets_limits()).collect();
    let looks = match request.network.map(|goal| goal.cheapest) {
        None | Some(CostObjective::Area) => simplest_cameras(&holding),
        // All designs of a camera send the same bytes.
        Some(CostObjective::Bytes) => fewest_bytes(&holding)?,
    };
    let bounds = BuildBounds {
        max_clocks: max_clocks(request),
        is_planned: request.clock_hz.is_none(),
        memory,
    };
    let (mut candidates, mut left_out) =
        synthesize_in_batches(&looks, bounds, request.max_designs, request, hooks)?;
    add_slower_designs(&mut candidates, request, hooks)?;
    if !candidates.iter().any(SynthesizedDesign::meets_limits) {
        // Nothing meets the limits. The nearest cameras are built, and those that would meet the
        // limits at a lower speed, to find the binding limits.
        let mut others: Vec<&ExaminedCamera> =
            search.all().filter(|look| !look.meets_limits()).collect();
        others.sort_by(|one, other| one.excess().total_cmp(&other.excess()));
        others.truncate(MAX_NEAREST_CAMERAS);
        for (looks, bounds) in
            [(&others, bounds), (&looks, BuildBounds { max_clocks: None, ..bounds })]
        {
            let most = request.max_designs.min(BATCH_SIZE);
            let (built, left) = synthesize_in_batches(looks, bounds, most, request, hooks)?;
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
            reason: "no design can be built from any of them".to_owned(),
        });
    }
    Ok(SynthesizedDesigns { candidates, left_out_designs: left_out })
}

/// Looks for cheaper designs among those that meet the limits: it folds them again for their own
/// clock, which is faster than the planned one, or halves their pixels per clock. A design is
/// synthesized if it is expected to be cheaper than the cheapest so far, the most promising first.
fn add_slower_designs(
    candidates: &mut Vec<SynthesizedDesign>,
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<(), ExploreError> {
    let Some(min_fps) = request.constraints.min_fps else { return Ok(()) };
    let most = request.max_designs.min(candidates.len() + MAX_SLOWER_DESIGNS);
    while candidates.len() < most {
        let holding = || candidates.iter().filter(|candidate| candidate.meets_limits());
        let Some(least) = holding().map(SynthesizedDesign::cost).min_by(f64::total_cmp) else {
            break;
        };
        let is_new = |design: &Design| candidates.iter().all(|tried| tried.design != *design);
        let slower = holding().flat_map(|candidate| {
            let speed = candidate.speed.as_ref();
            let slower = speed.map(|speed| slower_designs(&candidate.design, speed, min_fps));
            let expected = |design| {
                let cost = expected_cost(&design, &candidate.silicon);
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
fn fewest_bytes<'a>(looks: &[&'a ExaminedCamera]) -> Result<Vec<&'a ExaminedCamera>, ExploreError> {
    let bytes = |look: &&'a ExaminedCamera| {
        Ok((bytes_per_frame(&look.config.validate()?, &look.figures), *look))
    };
    let sent = looks.iter().map(bytes).collect::<Result<Vec<_>, ExploreError>>()?;
    let least = sent.iter().map(|(bytes, _)| *bytes).fold(f64::INFINITY, f64::min);
    Ok(sent.into_iter().filter(|(bytes, _)| *bytes <= least).map(|(_, look)| look).collect())
}

/// Returns roughly the least share of the device that a camera takes, however it is built; infinite
/// if it cannot be built.
pub(super) fn least_rough_cost(look: &CameraConfig, asked: &HardwareConfig) -> f64 {
    let bounds = BuildBounds { max_clocks: None, is_planned: true, memory: None };
    let ways = possible_designs(look, asked, bounds);
    ways.iter().map(rough_cost).fold(f64::INFINITY, f64::min)
}

/// Returns the simplest cameras: those for which no simpler camera also meets the limits.
fn simplest_cameras<'a>(looks: &[&'a ExaminedCamera]) -> Vec<&'a ExaminedCamera> {
    let simpler = |one: &CameraConfig, other: &CameraConfig| {
        let (one, other) = (complexity(one), complexity(other));
        one.0 == other.0
            && one != other
            && one.1.iter().zip(&other.1).all(|(one, other)| one <= other)
    };
    let beaten =
        |look: &ExaminedCamera| looks.iter().any(|other| simpler(&other.config, &look.config));
    let mut kept: Vec<&ExaminedCamera> =
        looks.iter().copied().filter(|look| !beaten(look)).collect();
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
type CameraComplexity =
    ((u32, Neighborhood, Vec<FeatureKind>, IrrelevantRendering, Option<u32>), [u32; 4]);

fn complexity(config: &CameraConfig) -> CameraComplexity {
    let features = config.spatial.iter().map(|entry| entry.feature).collect();
    let fraction = config.spatial.iter().filter_map(|entry| entry.mean_fraction_bits).sum();
    let filter = match config.denoise.filter {
        DenoiseFilter::None => 0,
        DenoiseFilter::Median3x3 => 1,
    };
    let reference = match config.temporal.reference {
        ReferencePolicy::Previous => 0,
        ReferencePolicy::LastSent => 1,
    };
    let ordered = [config.frame.pixel_bits, filter, reference, fraction];
    let (region, shown) = (&config.region, config.render.irrelevant);
    ((region.size, region.neighborhood, features, shown, config.periphery.blocks), ordered)
}

/// Synthesizes the designs of some cameras, the promising ones first, until one meets the limits or
/// there are `most` of them. Returns the number of designs that are left out.
fn synthesize_in_batches(
    looks: &[&ExaminedCamera],
    bounds: BuildBounds,
    most: usize,
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<(Vec<SynthesizedDesign>, usize), ExploreError> {
    let mut designs: Vec<(&ExaminedCamera, Design)> = Vec::new();
    for look in looks {
        let ways = possible_designs(&look.config, &request.task.hardware, bounds);
        designs.extend(ways.into_iter().map(|design| (*look, design)));
    }
    sort_by_rough_cost(&mut designs);
    let all = designs.len();
    let mut built = Vec::new();
    for batch in designs[..all.min(most)].chunks(BATCH_SIZE) {
        built.extend(synthesize(batch, request, hooks)?);
        if built.iter().any(SynthesizedDesign::meets_limits) {
            break;
        }
    }
    let left_out = all - built.len();
    Ok((built, left_out))
}

/// Sorts designs by their rough cost, and takes the organizations in turn. A limit on a unit may
/// exclude one organization, and the others must not wait behind all its designs.
fn sort_by_rough_cost(designs: &mut Vec<(&ExaminedCamera, Design)>) {
    designs.sort_by(|(_, one), (_, other)| rough_cost(one).total_cmp(&rough_cost(other)));
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
    designs: &[(&ExaminedCamera, Design)],
    request: &FitRequest<'_>,
    hooks: &dyn RunHooks,
) -> Result<Vec<SynthesizedDesign>, ExploreError> {
    let designs_alone = designs.iter().map(|(_, design)| design);
    let found = request.synthesizer.synthesize_designs(designs_alone, hooks)?.into_results()?;
    let candidate =
        |((look, design), synthesized): (&(&ExaminedCamera, Design), SynthesisResult)| {
            let SynthesisResult { silicon, speed: estimated } = synthesized;
            let clocks_per_frame = design.timing().clocks_per_frame();
            let given = request.clock_hz.map(|hertz| {
                FrameRate::at_given_clock(count_to_f64(hertz) / 1e6, clocks_per_frame)
            });
            let speed = given.or(estimated);
            let mut held = look.checks.clone();
            held.extend(request.constraints.check_speed(speed.as_ref()));
            held.extend(request.constraints.check_area(&silicon));
            let (look, design) = ((*look).clone(), design.clone());
            SynthesizedDesign { look, design, clocks_per_frame, speed, silicon, checks: held }
        };
    Ok(designs.iter().zip(found).map(candidate).collect())
}

/// Returns the ways to build a camera. For each feed of a serial array these are the folds that are
/// fast enough and may be the cheapest, and halvings of the deepest fold, because only a synthesis
/// shows which one is the cheapest. If no fold is fast enough, the pipelined array is a way, and at
/// a planned clock also fold 1. A raster core has the fewest pixels per clock that are fast enough;
/// at a planned clock it has the most, if none is fast enough.
fn possible_designs(
    look: &CameraConfig,
    asked: &HardwareConfig,
    bounds: BuildBounds,
) -> Vec<Design> {
    let (arrays, is_fast) = serial_arrays(look, asked, bounds);
    let of = |organization| match organization {
        Organization::Serial => arrays.clone(),
        Organization::Pipelined if is_fast => Vec::new(),
        Organization::Pipelined => {
            let array = possible_design(look, asked, OrganizationConfig::Pipelined);
            array.into_iter().collect()
        }
        Organization::Raster => {
            let core = |pixels| {
                let pixels_per_clock = Some(pixels);
                let own = RasterConfig { pixels_per_clock, ..RasterConfig::default() };
                possible_design(look, asked, OrganizationConfig::Raster(own))
            };
            let cores = [1, 2, 4].into_iter().filter_map(core).collect();
            fewest_pixels_per_clock(cores, bounds).into_iter().collect()
        }
    };
    Organization::ALL.iter().flat_map(|&organization| of(organization)).collect()
}

/// Returns a design of that organization with the thresholds and `sync` of the task; `None` if it is
/// not valid.
fn possible_design(
    look: &CameraConfig,
    asked: &HardwareConfig,
    organization: OrganizationConfig,
) -> Option<Design> {
    let &HardwareConfig { thresholds, sync, .. } = asked;
    let hardware = HardwareConfig { organization, thresholds, sync, ..HardwareConfig::default() };
    DesignConfig { camera: look.clone(), hardware }.validate().ok()
}

/// Returns the serial arrays of every feed, and whether one is fast enough.
fn serial_arrays(
    look: &CameraConfig,
    asked: &HardwareConfig,
    bounds: BuildBounds,
) -> (Vec<Design>, bool) {
    let (mut found, mut is_fast) = (Vec::new(), false);
    let fed = |&feed| {
        let own = SerialConfig { fold: 1, feed: Some(feed), memory: bounds.memory };
        possible_design(look, asked, OrganizationConfig::Serial(own))
    };
    for single in PixelFeed::ALL.iter().filter_map(fed) {
        let (folds, enough) = folded_arrays(&single, bounds);
        is_fast |= enough;
        found.extend(folds);
    }
    (found, is_fast)
}

/// Returns the folds of a serial array, and whether one is fast enough.
fn folded_arrays(single: &Design, bounds: BuildBounds) -> (Vec<Design>, bool) {
    let folds = single.pareto_folds(bounds.max_clocks.unwrap_or(u64::MAX));
    let is_fast = !folds.is_empty();
    let folds = if folds.is_empty() && bounds.is_planned { vec![1] } else { folds };
    let deepest = folds.first().map_or(0, |deepest| deepest / 2);
    let halvings = std::iter::successors(Some(deepest), |fold| Some(fold / 2));
    let halvings = halvings.take_while(|fold| *fold > 0).filter(|fold| !folds.contains(fold));
    let all = folds.iter().copied().chain(halvings);
    (all.filter_map(|fold| single.with_fold(fold).ok()).collect(), is_fast)
}

/// Returns the first raster core that is fast enough; `cores` have rising numbers of pixels per
/// clock.
fn fewest_pixels_per_clock(
    cores: Vec<Design>,
    BuildBounds { max_clocks, is_planned: planned, .. }: BuildBounds,
) -> Option<Design> {
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
        let look = DesignConfig::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap();
        let bounds =
            BuildBounds { max_clocks: Some(max_clocks), is_planned: planned, memory: None };
        let ways = possible_designs(&look.camera, &look.hardware, bounds);
        let of = |organization| ways.iter().filter(move |d| d.organization() == organization);
        let words =
            of(Organization::Raster).map(|d| d.as_raster().unwrap().pixels_per_clock()).collect();
        (words, of(Organization::Pipelined).next().is_some())
    }

    /// There are 784 regions. At most 17 regions per lane are fast enough; 16 and 8 take fewer
    /// block RAMs.
    #[test]
    fn lanes_share_as_many_regions_as_may_be_cheapest_and_halvings_of_the_most() {
        let look = DesignConfig::from_toml("").unwrap();
        let bounds = BuildBounds { max_clocks: Some(210_623), is_planned: true, memory: None };
        let ways = possible_designs(&look.camera, &look.hardware, bounds);
        let arrays = ways.iter().filter_map(Design::as_serial);
        let folds =
            arrays.filter(|array| array.feed() == PixelFeed::Raster).map(|array| array.fold());
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
