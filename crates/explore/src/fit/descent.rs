// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest camera behind which a network agrees with its outputs for whole frames: a descent
//! from the task.
//!
//! The descent starts at the task, with every setting of what irrelevant regions show, and at a
//! camera that sends nearly all pixels. It examines cameras that differ from the best one so far in
//! one setting, the cheapest first, until one agrees enough; that camera becomes the best one. The
//! descent ends when no cheaper camera agrees enough.
//!
//! The cheapest of many cameras that agree enough on some frames agrees partly by chance. So the
//! descent compares the agreement that is to be expected of other frames. A camera that agrees
//! enough must also be confirmed by later frames, which are used for nothing else.

use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, FLOW_RADII, FeatureKind, IrrelevantRendering,
    PeripheryConfig, ReferencePolicy, SUMMARY_BLOCKS, SpatialConfig,
};

use super::FitRequest;
use super::camera_search::CameraSearch;
use super::constraints::ConstraintCheck;
use super::cost_objective::CostObjective;
use super::network_agreement::{
    AgreementEstimate, KnownAgreements, NetworkAgreement, known_or_measured,
};
use super::possible_designs::{can_be_built, least_rough_cost};
use super::search_frames::ClipPart;
use super::threshold_search::scale_thresholds_by;
use crate::ExploreError;

/// The sides of regions that are tried besides the task's.
const SIDES: [u32; 2] = [8, 16];
/// The octaves by which the thresholds of the task are scaled.
const OCTAVES: [i32; 6] = [-1, 1, 2, 3, 4, 5];
/// The levels of a periphery in grey levels of 8 bits: means may differ by so much.
const PERIPHERY_LEVELS: [u32; 4] = [2, 4, 8, 12];
/// The numbers of changed pixels that make a region active.
const MIN_COUNTS: [u32; 6] = [1, 2, 3, 5, 8, 12];
/// The number of depths below the task's that are tried.
const MAX_FEWER_BITS: u32 = 3;

/// The state of the descent.
pub(super) struct Descent<'s, 'a> {
    search: &'s mut CameraSearch<'a>,
    network: &'s NetworkAgreement<'a>,
    request: &'s FitRequest<'s>,
    /// The agreements that were measured so far.
    known: KnownAgreements,
}

impl<'s, 'a> Descent<'s, 'a> {
    pub(super) fn new(
        search: &'s mut CameraSearch<'a>,
        network: &'s NetworkAgreement<'a>,
        request: &'s FitRequest<'s>,
    ) -> Self {
        Self { search, network, request, known: KnownAgreements::default() }
    }

    /// Descends from the task and from a camera that sends nearly all pixels, until no cheaper
    /// camera agrees enough. If no start agrees enough, the descent tries the cameras around the
    /// one that sends nearly all pixels. The search then contains the camera where the descent
    /// ends, or the camera that sends nearly all pixels if none meets the limits.
    pub(super) fn run(mut self) -> Result<KnownAgreements, ExploreError> {
        let all = nearly_all_sent(self.search.task());
        let mut starts = irrelevant_variants(self.search.task());
        starts.push(all.clone());
        let mut best = self.cheapest_that_agrees(&starts, f64::INFINITY)?;
        loop {
            let (most, from) =
                best.as_ref().map_or((f64::INFINITY, &all), |(cost, config)| (*cost, config));
            match self.cheapest_that_agrees(&neighbor_cameras(from), most)? {
                Some(better) => best = Some(better),
                None => break,
            }
        }
        let (_, chosen) = best.unwrap_or((f64::INFINITY, all));
        let camera = chosen.validate()?;
        let expected = self
            .searched_agreement(&camera, None)?
            .expected
            .min(self.confirmed_agreement(&camera, None)?.expected);
        if self.search.get(camera.config()).is_none() {
            self.measure_figures(camera.config(), expected)?;
        }
        Ok(self.known)
    }

    /// Returns the cheapest camera that meets the limits and costs less than `most`.
    fn cheapest_that_agrees(
        &mut self,
        configs: &[CameraConfig],
        most: f64,
    ) -> Result<Option<(f64, CameraConfig)>, ExploreError> {
        let mut priced = self.with_costs(configs)?;
        priced.retain(|(cost, _)| *cost < most);
        priced.sort_by(|one, other| one.0.total_cmp(&other.0));
        for (cost, camera) in priced {
            let Some(expected) = self.least_expected_agreement(&camera)? else { continue };
            let config = camera.config();
            // Measuring all figures of a camera takes longer than running the network, so the
            // network runs first.
            if !self.search.limits_figures() || self.measure_figures(config, expected)? {
                return Ok(Some((cost, config.clone())));
            }
        }
        Ok(None)
    }

    /// Returns the agreement to expect of other frames, if it is enough on the frames of the search
    /// and on those that confirm.
    fn least_expected_agreement(&mut self, camera: &Camera) -> Result<Option<f64>, ExploreError> {
        let least = self.network.goal.min_agreement;
        let searched = self.searched_agreement(camera, Some(least))?.expected;
        if searched < least {
            return Ok(None);
        }
        let confirmed = self.confirmed_agreement(camera, Some(least))?.expected;
        Ok((confirmed >= least).then(|| searched.min(confirmed)))
    }

    /// Returns the cost of each camera. It leaves out cameras that are invalid or cannot be built.
    fn with_costs(&self, configs: &[CameraConfig]) -> Result<Vec<(f64, Camera)>, ExploreError> {
        let mut cameras: Vec<Camera> = Vec::new();
        for camera in configs.iter().filter_map(|config| config.validate().ok()) {
            if !cameras.contains(&camera)
                && can_be_built(camera.config(), &self.request.task.hardware)
            {
                cameras.push(camera);
            }
        }
        let costs = match self.request.cheapest {
            CostObjective::Bytes => {
                self.network.bytes_per_frame_of(&cameras, self.known.count())?
            }
            CostObjective::Area | CostObjective::Mm2 | CostObjective::Energy => {
                let cost = |camera: &Camera| least_rough_cost(camera.config(), self.request);
                cameras.iter().map(cost).collect()
            }
        };
        Ok(costs.into_iter().zip(cameras).collect())
    }

    /// Returns the agreement of a camera on the frames of the search; the exact agreement if there
    /// is no `least`.
    fn searched_agreement(
        &mut self,
        camera: &Camera,
        least: Option<f64>,
    ) -> Result<AgreementEstimate, ExploreError> {
        let cameras_before = self.known.count();
        let ask =
            || self.network.measure_agreement(camera, ClipPart::Search, least, cameras_before);
        known_or_measured(&mut self.known.searched, camera, least, ask)
    }

    /// Returns the agreement of a camera on the later frames that confirm.
    fn confirmed_agreement(
        &mut self,
        camera: &Camera,
        least: Option<f64>,
    ) -> Result<AgreementEstimate, ExploreError> {
        let cameras_before = self.known.count();
        let ask = || {
            self.network.measure_agreement(camera, ClipPart::Confirmation, least, cameras_before)
        };
        known_or_measured(&mut self.known.confirmed, camera, least, ask)
    }

    /// Measures all figures of a camera. Returns whether all limits hold, including the one on the
    /// expected agreement.
    fn measure_figures(
        &mut self,
        config: &CameraConfig,
        expected: f64,
    ) -> Result<bool, ExploreError> {
        let mut holds = false;
        for mut examined in self.search.examine(std::slice::from_ref(config))? {
            examined.checks.push(ConstraintCheck::check_expected_agreement(
                expected,
                self.network.goal.min_agreement,
            ));
            holds = examined.meets_limits();
            self.search.replace(examined);
        }
        Ok(holds)
    }
}

/// Returns a camera that sends much more than the task's. If the network disagrees behind this
/// camera, it disagrees behind all others.
fn nearly_all_sent(task: &CameraConfig) -> CameraConfig {
    const OCTAVES: f64 = -2.0;
    let mut config = scale_thresholds_by(task, OCTAVES, OCTAVES);
    let fits = |blocks: &&u32| task.region.size.is_multiple_of(**blocks);
    config.render.irrelevant = IrrelevantRendering::Mean;
    config.periphery.blocks = SUMMARY_BLOCKS.iter().filter(fits).max().copied();
    config.periphery.level = Some(1 << task.frame.pixel_bits.saturating_sub(8));
    config.denoise.filter = DenoiseFilter::None;
    config.temporal.reference = ReferencePolicy::LastSent;
    config.temporal.min_count = config.temporal.min_count.min(1);
    // Content that changes in place has no displacement.
    for entry in config.spatial.iter_mut().filter(|entry| entry.feature.is_displacement()) {
        entry.min_score = Some(Decimal::from_whole(0));
    }
    config
}

/// Returns the camera with every setting of what irrelevant regions show.
fn irrelevant_variants(config: &CameraConfig) -> Vec<CameraConfig> {
    let mut found = Vec::new();
    for &irrelevant in IrrelevantRendering::ALL {
        let blocks: Vec<Option<u32>> = match irrelevant {
            IrrelevantRendering::Zero | IrrelevantRendering::Hold => vec![None],
            IrrelevantRendering::Mean => SUMMARY_BLOCKS.iter().copied().map(Some).collect(),
        };
        for blocks in blocks {
            let mut other = config.clone();
            other.render.irrelevant = irrelevant;
            other.periphery.blocks = blocks;
            other.periphery.level = blocks.and(other.periphery.level);
            found.push(other);
        }
    }
    found
}

/// Returns the cameras that differ in one setting.
fn neighbor_cameras(config: &CameraConfig) -> Vec<CameraConfig> {
    let bits = config.frame.pixel_bits;
    let with = |change: &dyn Fn(&mut CameraConfig)| {
        let mut other = config.clone();
        change(&mut other);
        other
    };
    let mut found = irrelevant_variants(config);
    for octaves in OCTAVES.map(f64::from) {
        let ways = [(octaves, octaves), (octaves, 0.0), (0.0, octaves)];
        found
            .extend(ways.map(|(spatial, temporal)| scale_thresholds_by(config, spatial, temporal)));
    }
    for &kind in FeatureKind::ALL {
        let alone = vec![SpatialConfig::new(kind).with_defaults(bits)];
        let alone = with(&|config| config.spatial.clone_from(&alone));
        found.extend([0.0, 1.0, 2.0].map(|octaves| scale_thresholds_by(&alone, octaves, 0.0)));
    }
    found.extend(radius_variants(config));
    found.extend(SIDES.map(|side| with(&|config| config.region.size = side)));
    found.extend(
        DenoiseFilter::ALL.iter().map(|&filter| with(&|config| config.denoise.filter = filter)),
    );
    let references = ReferencePolicy::ALL.iter();
    found.extend(references.map(|&one| with(&|config| config.temporal.reference = one)));
    found.extend(MIN_COUNTS.map(|count| with(&|config| config.temporal.min_count = count)));
    if config.validate().is_ok_and(|camera| camera.periphery().is_some()) {
        let levels = PERIPHERY_LEVELS.map(|level| periphery_level_at(level, bits));
        found.extend(levels.map(|level| with(&|config| config.periphery.level = level)));
    }
    found.extend(
        (1..=MAX_FEWER_BITS.min(bits - 1)).map(|fewer| config.scaled_to_depth(bits - fewer)),
    );
    found
}

/// Returns the camera with each radius of the feature that finds displacements, if it has one.
fn radius_variants(config: &CameraConfig) -> Vec<CameraConfig> {
    let searches = |entry: &SpatialConfig| entry.feature.is_displacement();
    let Some(index) = config.spatial.iter().position(searches) else { return Vec::new() };
    let variant = |radius| {
        let mut other = config.clone();
        other.spatial[index].radius = Some(radius);
        other
    };
    FLOW_RADII.map(variant).collect()
}

/// Converts the level of a periphery from 8 bits to another depth.
fn periphery_level_at(level: u32, bits: u32) -> Option<u32> {
    let periphery = PeripheryConfig { level: Some(level), ..PeripheryConfig::default() };
    CameraConfig { periphery, ..CameraConfig::default() }.scaled_to_depth(bits).periphery.level
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOW: &str = "[[spatial]]\nfeature = \"flow\"\nradius = 2\n";

    /// A region has no displacement without a reference, and with `last-sent` no reference without
    /// a vote.
    #[test]
    fn nearly_all_is_sent_with_flow_alone() {
        let all = nearly_all_sent(&CameraConfig::from_toml(FLOW).unwrap());
        assert_eq!(all.temporal.reference, ReferencePolicy::LastSent);
        let camera = all.validate().unwrap();
        assert_eq!(camera.features()[0].min_score(), 0);
    }

    #[test]
    fn flow_and_its_radii_are_one_step_away() {
        let radii = |text: &str| {
            let neighbors = neighbor_cameras(&CameraConfig::from_toml(text).unwrap());
            let flow = |entry: &SpatialConfig| entry.feature == FeatureKind::Flow;
            let entries = neighbors.iter().flat_map(|config| &config.spatial);
            let mut radii: Vec<_> = entries.filter(|one| flow(one)).map(|one| one.radius).collect();
            radii.sort_unstable();
            radii.dedup();
            radii
        };
        assert_eq!(radii(""), [Some(1)]);
        assert_eq!(radii(FLOW), [Some(1), Some(2), Some(3)]);
    }
}
