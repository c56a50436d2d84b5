// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest camera that a network cannot tell from whole frames: a descent from the task.
//!
//! It begins at the task, whatever its irrelevant regions show, and at a camera that sends nearly all. Cameras that differ from the best one so far in
//! one thing are examined, the cheapest first, until one agrees enough; that is the best one then. It ends when none is cheaper.

use std::collections::BTreeMap;

use foveate_camera::{
    Camera, CameraConfig, FeatureKind, Filter, Irrelevant, Reference, SUMMARY_BLOCKS, SpatialConfig,
};
use foveate_design::HardwareConfig;

use super::build::cheapest_rough;
use super::constraints::Held;
use super::looks::{Look, Search};
use super::network::{Agreed, Cheapest, Half, Jury};
use super::target::scaled_by;
use crate::ExploreError;

/// Sides of regions that are tried beside the task's.
const SIDES: [u32; 2] = [8, 16];
/// Octaves by which thresholds of the task are scaled.
const OCTAVES: [i32; 6] = [-1, 1, 2, 3, 4, 5];
/// Grey levels of 8 bits by which means may differ.
const LEVELS: [u32; 4] = [2, 4, 8, 12];
/// Bits per pixel that are tried below the task's.
const FEWER_BITS: u32 = 3;

/// Where the descent is.
pub(super) struct Descent<'s, 'a> {
    search: &'s mut Search<'a>,
    jury: &'s Jury<'a>,
    hardware: &'s HardwareConfig,
    /// What the network said of cameras, by their configurations.
    pub(super) asked: BTreeMap<String, Agreed>,
}

impl<'s, 'a> Descent<'s, 'a> {
    pub(super) fn new(
        search: &'s mut Search<'a>,
        jury: &'s Jury<'a>,
        hardware: &'s HardwareConfig,
    ) -> Self {
        Self { search, jury, hardware, asked: BTreeMap::new() }
    }

    /// Goes down from the task and from a camera that sends nearly all, until nothing is cheaper. The camera where it ends is in the search then, or
    /// that which sends nearly all if none holds.
    pub(super) fn run(&mut self) -> Result<(), ExploreError> {
        let all = nearly_all(self.search.task());
        let mut starts = ways_to_show(self.search.task());
        starts.push(all.clone());
        let mut best = self.cheapest(&starts, f64::INFINITY)?;
        loop {
            let (most, from) = match &best {
                Some((cost, config)) => (*cost, config.clone()),
                None => (f64::INFINITY, all.clone()),
            };
            match self.cheapest(&neighbors(&from), most)? {
                Some(better) => best = Some(better),
                None => break,
            }
        }
        let (_, chosen) = best.unwrap_or((f64::INFINITY, all));
        let camera = chosen.validate()?;
        let agreed = self.jury.ask(&camera, Half::First, None, self.asked.len())?;
        self.asked.insert(chosen.to_toml(), agreed);
        self.look(&chosen, agreed).map(drop)
    }

    /// The cheapest that holds and costs less than `most`.
    fn cheapest(
        &mut self,
        configs: &[CameraConfig],
        most: f64,
    ) -> Result<Option<(f64, CameraConfig)>, ExploreError> {
        let mut priced = self.priced(configs)?;
        priced.retain(|(cost, _)| *cost < most);
        priced.sort_by(|one, other| one.0.total_cmp(&other.0));
        for (cost, camera) in priced {
            let (config, agreed) = (camera.config(), self.ask(&camera)?);
            let agrees = agreed.share >= self.jury.goal.min_agreement;
            // To know what else a camera shows takes longer than to ask.
            if agrees && (!self.search.limits_figures() || self.look(config, agreed)?) {
                return Ok(Some((cost, config.clone())));
            }
        }
        Ok(None)
    }

    /// What each camera costs. Those that are none are left out.
    fn priced(&self, configs: &[CameraConfig]) -> Result<Vec<(f64, Camera)>, ExploreError> {
        let mut cameras: Vec<Camera> = Vec::new();
        for camera in configs.iter().filter_map(|config| config.validate().ok()) {
            if !cameras.contains(&camera) {
                cameras.push(camera);
            }
        }
        let costs = match self.jury.goal.cheapest {
            Cheapest::Bytes => self.jury.bytes_sent(&cameras, self.asked.len())?,
            Cheapest::Area => {
                let cost = |camera: &Camera| cheapest_rough(camera.config(), self.hardware);
                cameras.iter().map(cost).collect()
            }
        };
        Ok(costs.into_iter().zip(cameras).collect())
    }

    fn ask(&mut self, camera: &Camera) -> Result<Agreed, ExploreError> {
        let key = camera.config().to_toml();
        if let Some(agreed) = self.asked.get(&key) {
            return Ok(*agreed);
        }
        let least = Some(self.jury.goal.min_agreement);
        let agreed = self.jury.ask(camera, Half::First, least, self.asked.len())?;
        self.asked.insert(key, agreed);
        Ok(agreed)
    }

    /// Measures a camera in full; says whether all limits hold.
    fn look(&mut self, config: &CameraConfig, agreed: Agreed) -> Result<bool, ExploreError> {
        let mut holds = false;
        for mut look in self.search.look(std::slice::from_ref(config))? {
            look.agree(agreed, self.jury.goal.min_agreement);
            holds = look.holds();
            self.search.replace(look);
        }
        Ok(holds)
    }
}

impl Look {
    /// Takes what a network says.
    fn agree(&mut self, agreed: Agreed, least: f64) {
        self.held.retain(|held| held.name != "min-agreement");
        self.held.push(Held::agreement(agreed.share, least));
    }
}

/// A camera that sends much more than the task's: if the network tells this one from whole frames, it tells all others.
fn nearly_all(task: &CameraConfig) -> CameraConfig {
    const OCTAVES: f64 = -2.0;
    let mut config = scaled_by(task, OCTAVES, OCTAVES);
    let fits = |blocks: &&u32| task.region.size.is_multiple_of(**blocks);
    config.render.irrelevant = Irrelevant::Mean;
    config.periphery.blocks = SUMMARY_BLOCKS.iter().filter(fits).max().copied();
    config.periphery.level = Some(1 << task.frame.pixel_bits.saturating_sub(8));
    config.denoise.filter = Filter::None;
    config.temporal.reference = Reference::LastSent;
    config.temporal.min_count = config.temporal.min_count.min(1);
    config
}

/// All that irrelevant regions can show.
fn ways_to_show(config: &CameraConfig) -> Vec<CameraConfig> {
    let mut found = Vec::new();
    for &irrelevant in Irrelevant::ALL {
        let blocks: Vec<Option<u32>> = match irrelevant {
            Irrelevant::Zero | Irrelevant::Hold => vec![None],
            Irrelevant::Mean => SUMMARY_BLOCKS.iter().copied().map(Some).collect(),
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

/// Cameras that differ in one thing.
fn neighbors(config: &CameraConfig) -> Vec<CameraConfig> {
    let mut found = ways_to_show(config);
    let mut other = |change: &dyn Fn(&mut CameraConfig)| {
        let mut other = config.clone();
        change(&mut other);
        found.push(other);
    };
    for octave in OCTAVES {
        let octaves = f64::from(octave);
        let scaled = scaled_by(config, octaves, octaves);
        let (spatial, temporal) =
            (scaled_by(config, octaves, 0.0), scaled_by(config, 0.0, octaves));
        other(&|config| *config = scaled.clone());
        other(&|config| *config = spatial.clone());
        other(&|config| *config = temporal.clone());
    }
    let bits = config.frame.pixel_bits;
    for kind in FeatureKind::ALL {
        let mut alone = config.clone();
        alone.spatial = vec![SpatialConfig::new(*kind).with_defaults(bits)];
        for octave in [0, 1, 2] {
            let scaled = scaled_by(&alone, f64::from(octave), 0.0);
            other(&|config| *config = scaled.clone());
        }
    }
    for side in SIDES {
        other(&|config| config.region.size = side);
    }
    for &filter in Filter::ALL {
        other(&|config| config.denoise.filter = filter);
    }
    for &reference in Reference::ALL {
        other(&|config| config.temporal.reference = reference);
    }
    for count in [1, 2, 3, 5, 8, 12] {
        other(&|config| config.temporal.min_count = count);
    }
    if config.validate().is_ok_and(|camera| camera.periphery().is_some()) {
        for level in LEVELS {
            other(&|config| {
                config.periphery.level =
                    Some(if bits < 8 { level >> (8 - bits) } else { level << (bits - 8) });
            });
        }
    }
    for fewer in 1..=FEWER_BITS.min(bits - 1) {
        other(&|config| *config = config.at_depth(bits - fewer));
    }
    found
}

/// What one change of the chosen camera would do that is cheaper or not, in the order of the keys.
pub(super) fn steps(asked: &BTreeMap<String, Agreed>, chosen: &CameraConfig) -> Vec<String> {
    let own = settings(&chosen.to_toml());
    let step = |(text, agreed): (&String, &Agreed)| {
        let other = settings(text);
        let mut changed = other.iter().filter(|line| !own.contains(line));
        let lost = own.iter().filter(|line| !other.contains(line)).count();
        let line = changed.next().filter(|_| lost <= 1 && changed.next().is_none())?;
        let bound = if agreed.at_most { "at most " } else { "" };
        Some(format!("{line}: agreement {bound}{:.1} %", 100.0 * agreed.share))
    };
    asked.iter().filter_map(step).collect()
}

/// The settings of a configuration, each with the name of its table.
fn settings(toml: &str) -> Vec<String> {
    let mut table = String::new();
    let mut found = Vec::new();
    for line in toml.lines() {
        match line.strip_prefix('[') {
            Some(name) => table = name.trim_matches(['[', ']']).to_owned(),
            None if line.contains('=') => found.push(format!("{table}.{line}")),
            None => {}
        }
    }
    found
}
